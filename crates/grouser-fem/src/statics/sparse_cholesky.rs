//! Sparse Cholesky factorisation (faer) in the order of a geometric nested dissection.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Conj, Mat, Par, Side, Spec};
use grouser_geometry::Vec3;

use super::block_matrix::BlockMatrix;
use super::nested_dissection;

/// Why a matrix has no Cholesky factor.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CholeskyError {
    /// A pivot is not positive.
    #[error(
        "the stiffness matrix is not positive: {0}; usual causes are a solid that can still move as a rigid body, or an elastic law that has lost stability at this deformation"
    )]
    NotPositive(String),
    /// The factor does not fit.
    #[error("the sparse factor cannot be stored: {0}; use conjugate gradients")]
    Storage(String),
}

/// L Lᵀ of a block matrix, for any number of right-hand sides.
pub struct SparseCholesky {
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
    /// Node at each place of the elimination.
    order: Vec<u32>,
}

impl SparseCholesky {
    /// Factorises a symmetric positive matrix; `positions` [m] of its nodes guide the order of elimination.
    ///
    /// # Errors
    /// [`CholeskyError`].
    pub fn new(matrix: &BlockMatrix, positions: &[Vec3]) -> Result<Self, CholeskyError> {
        let storage = |e: &dyn std::fmt::Debug| CholeskyError::Storage(format!("{e:?}"));
        let order = nested_dissection::order(matrix, positions);
        let mut place = vec![0; order.len()];
        order.iter().enumerate().for_each(|(k, &n)| place[n as usize] = k);
        let mut triplets = Vec::with_capacity(9 * matrix.n_blocks() / 2);
        for i in 0..matrix.n_rows() {
            for (j, block) in matrix.row(i) {
                for (r, c) in (0..3).flat_map(|r| (0..3).map(move |c| (r, c))) {
                    let (row, column) = (3 * place[i] + r, 3 * place[j] + c);
                    if row <= column {
                        triplets.push(Triplet::new(row, column, block[(r, c)]));
                    }
                }
            }
        }
        let n = 3 * matrix.n_rows();
        let a =
            SparseColMat::<usize, f64>::try_new_from_triplets(n, n, &triplets).map_err(|e| storage(&e))?;
        let symbolic = factorize_symbolic_cholesky(
            a.symbolic(),
            Side::Upper,
            SymmetricOrdering::Identity,
            CholeskySymbolicParams::default(),
        )
        .map_err(|e| storage(&e))?;
        let mut values = vec![0.0; symbolic.len_val()];
        // One thread: dense kernels shared between threads would add in another order.
        let request = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default());
        let mut memory = MemBuffer::try_new(request).map_err(|e| storage(&e))?;
        symbolic
            .factorize_numeric_llt::<f64>(
                &mut values,
                a.as_ref(),
                Side::Upper,
                Default::default(),
                Par::Seq,
                MemStack::new(&mut memory),
                Spec::default(),
            )
            .map_err(|e| CholeskyError::NotPositive(format!("{e:?}")))?;
        Ok(Self { symbolic, values, order })
    }

    /// Number of stored entries of the factor.
    pub fn n_entries(&self) -> usize {
        self.values.len()
    }

    /// x = (L Lᵀ)⁻¹ b.
    pub fn solve(&self, b: &[Vec3], x: &mut [Vec3]) {
        let n = self.order.len();
        let mut work = Mat::from_fn(3 * n, 1, |row, _| b[self.order[row / 3] as usize][row % 3]);
        let mut memory = MemBuffer::new(self.symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        LltRef::<'_, usize, f64>::new(&self.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            work.as_mut(),
            Par::Seq,
            MemStack::new(&mut memory),
        );
        for (k, &node) in self.order.iter().enumerate() {
            x[node as usize] = Vec3::new(work[(3 * k, 0)], work[(3 * k + 1, 0)], work[(3 * k + 2, 0)]);
        }
    }
}
