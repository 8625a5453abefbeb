//! Conjugate gradients with a preconditioner (Hestenes & Stiefel 1952); the solver that P0 section 3.4 uses.

use grouser_geometry::Vec3;

use super::block_matrix::BlockMatrix;
use super::incomplete_cholesky::IncompleteCholesky;

/// How an iteration ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Convergence {
    /// Iterations made.
    pub iterations: usize,
    /// Residual over right-hand side, in the Euclidean norm.
    pub relative_residual: f64,
}

/// Solves A x = b to a relative residual, starting from the given `x`.
///
/// Returns how it ended; the caller compares `relative_residual` with the `tolerance` asked for.
pub fn solve(
    a: &BlockMatrix,
    preconditioner: &IncompleteCholesky,
    b: &[Vec3],
    x: &mut [Vec3],
    tolerance: f64,
    max_iterations: usize,
) -> Convergence {
    let n = b.len();
    let norm_b = dot(b, b).sqrt();
    if norm_b == 0.0 {
        x.fill(Vec3::zeros());
        return Convergence { iterations: 0, relative_residual: 0.0 };
    }
    let (mut r, mut z, mut q) = (vec![Vec3::zeros(); n], vec![Vec3::zeros(); n], vec![Vec3::zeros(); n]);
    a.multiply(x, &mut q);
    for i in 0..n {
        r[i] = b[i] - q[i];
    }
    preconditioner.solve(&r, &mut z);
    let mut p = z.clone();
    let mut rz = dot(&r, &z);
    for iterations in 0..max_iterations {
        let relative_residual = dot(&r, &r).sqrt() / norm_b;
        if relative_residual <= tolerance {
            return Convergence { iterations, relative_residual };
        }
        a.multiply(&p, &mut q);
        let alpha = rz / dot(&p, &q);
        for i in 0..n {
            x[i] += alpha * p[i];
            r[i] -= alpha * q[i];
        }
        preconditioner.solve(&r, &mut z);
        let rz_before = std::mem::replace(&mut rz, dot(&r, &z));
        let beta = rz / rz_before;
        for i in 0..n {
            p[i] = z[i] + beta * p[i];
        }
    }
    Convergence { iterations: max_iterations, relative_residual: dot(&r, &r).sqrt() / norm_b }
}

fn dot(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}
