//! Incomplete Cholesky factorisation on the pattern of a block matrix, as a preconditioner.
//!
//! Where a pivot block loses definiteness (ν → 0.5), the diagonal is raised and the factorisation repeated
//! (Manteuffel 1980, Math. Comp. 34, 473).

use grouser_geometry::Vec3;
use grouser_geometry::nalgebra::Matrix3;

use super::block_matrix::BlockMatrix;

/// Lower block-triangular L with A ≈ L Lᵀ.
#[derive(Clone, Debug)]
pub struct IncompleteCholesky {
    /// Blocks left of the diagonal of row i: `starts[i]..starts[i + 1]`.
    starts: Vec<usize>,
    columns: Vec<u32>,
    blocks: Vec<Matrix3<f64>>,
    /// Inverses of the diagonal blocks of L.
    inverse_diagonal: Vec<Matrix3<f64>>,
    /// Relative increase of the diagonal that the factorisation needed.
    pub shift: f64,
}

impl IncompleteCholesky {
    /// Factors of a symmetric matrix with positive diagonal blocks; `None` where even a doubled diagonal does not help (the
    /// matrix is far from positive).
    pub fn new(matrix: &BlockMatrix) -> Option<Self> {
        let shifts = std::iter::once(0.0).chain((0..11).map(|k| 1e-3 * 2f64.powi(k)));
        shifts.into_iter().find_map(|shift| Self::with_shift(matrix, shift))
    }

    fn with_shift(matrix: &BlockMatrix, shift: f64) -> Option<Self> {
        let n = matrix.n_rows();
        let mut l = Self {
            starts: vec![0],
            columns: Vec::new(),
            blocks: Vec::new(),
            inverse_diagonal: Vec::new(),
            shift,
        };
        for i in 0..n {
            let row_start = l.columns.len();
            let mut pivot = matrix.diagonal(i);
            for r in 0..3 {
                pivot[(r, r)] *= 1.0 + shift;
            }
            for (j, a) in matrix.row(i).filter(|&(j, _)| j < i) {
                // L_ij = (A_ij - sum_k L_ik L_jk^T) L_jj^-T over the columns k that rows i and j share.
                let mut block = *a;
                let (mut p, mut q) = (row_start, l.starts[j]);
                while p < l.columns.len() && q < l.starts[j + 1] {
                    match l.columns[p].cmp(&l.columns[q]) {
                        std::cmp::Ordering::Less => p += 1,
                        std::cmp::Ordering::Greater => q += 1,
                        std::cmp::Ordering::Equal => {
                            block -= l.blocks[p] * l.blocks[q].transpose();
                            p += 1;
                            q += 1;
                        }
                    }
                }
                let block = block * l.inverse_diagonal[j].transpose();
                pivot -= block * block.transpose();
                l.columns.push(j as u32);
                l.blocks.push(block);
            }
            l.starts.push(l.columns.len());
            let floor = 1e-6 * matrix.diagonal(i).trace();
            let factor = pivot.cholesky()?.l();
            if (0..3).any(|r| factor[(r, r)] * factor[(r, r)] < floor / 3.0 * 1e-3) {
                return None;
            }
            l.inverse_diagonal.push(factor.try_inverse()?);
        }
        Some(l)
    }

    /// z = (L Lᵀ)⁻¹ r.
    pub fn solve(&self, r: &[Vec3], z: &mut [Vec3]) {
        for i in 0..r.len() {
            let row = self.starts[i]..self.starts[i + 1];
            let sum = row.fold(r[i], |sum, k| sum - self.blocks[k] * z[self.columns[k] as usize]);
            z[i] = self.inverse_diagonal[i] * sum;
        }
        for i in (0..r.len()).rev() {
            z[i] = self.inverse_diagonal[i].tr_mul(&z[i]);
            for k in self.starts[i]..self.starts[i + 1] {
                let contribution = self.blocks[k].tr_mul(&z[i]);
                z[self.columns[k] as usize] -= contribution;
            }
        }
    }
}
