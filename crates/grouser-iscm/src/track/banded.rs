//! A symmetric banded matrix: the stiffness of a chain, whose joints know their neighbours only.

use nalgebra::SMatrix;

/// Symmetric matrix whose rows reach three to the left of the diagonal.
pub struct Banded {
    rows: Vec<[f64; 4]>,
    /// Least pivot of the factor.
    least: f64,
}

impl Banded {
    /// `n` rows with `value` on the diagonal, a millionth of which is the least pivot.
    pub fn diagonal(value: f64, n: usize) -> Self {
        Self { rows: vec![[0.0, 0.0, 0.0, value]; n], least: 1e-6 * value }
    }

    /// Adds `value` to every element of the diagonal.
    pub fn add_to_diagonal(&mut self, value: f64) {
        self.rows.iter_mut().for_each(|row| row[3] += value);
    }

    /// Adds `value` at row `i` and column `j`; what lies right of the diagonal is known by symmetry.
    #[inline(always)]
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        if j <= i {
            self.rows[i][3 + j - i] += value;
        }
    }

    /// Adds `k` between joints `a` and `b`, for displacement a − b and force on a; joints count from 1, others are held.
    pub fn add_between(&mut self, a: usize, b: usize, k: [[f64; 2]; 2], n: usize) {
        let is_free = |j: usize| (1..=n).contains(&j);
        for (p, q) in [(a, a), (b, b), (a, b), (b, a)] {
            if is_free(p) && is_free(q) {
                let sign = if p == q { 1.0 } else { -1.0 };
                for r in 0..2 {
                    for c in 0..2 {
                        self.add(2 * (p - 1) + r, 2 * (q - 1) + c, sign * k[r][c]);
                    }
                }
            }
        }
    }

    /// Cholesky's factor L in place.
    pub fn factorise(&mut self) {
        for i in 0..self.rows.len() {
            for j in i.saturating_sub(3)..=i {
                let mut sum = self.rows[i][3 + j - i];
                for k in i.saturating_sub(3).max(j.saturating_sub(3))..j {
                    sum -= self.rows[i][3 + k - i] * self.rows[j][3 + k - j];
                }
                self.rows[i][3 + j - i] =
                    if i == j { sum.max(self.least).sqrt() } else { sum / self.rows[j][3] };
            }
        }
    }

    /// Solves with the factor, for one right side or several.
    pub fn solve<const N: usize>(&self, rhs: &mut [SMatrix<f64, 1, N>]) {
        let n = self.rows.len();
        for i in 0..n {
            for k in i.saturating_sub(3)..i {
                let known = rhs[k];
                rhs[i] -= known * self.rows[i][3 + k - i];
            }
            rhs[i] /= self.rows[i][3];
        }
        for i in (0..n).rev() {
            for k in i + 1..(i + 4).min(n) {
                let known = rhs[k];
                rhs[i] -= known * self.rows[k][3 + i - k];
            }
            rhs[i] /= self.rows[i][3];
        }
    }
}
