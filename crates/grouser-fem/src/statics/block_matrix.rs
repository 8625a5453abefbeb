//! Symmetric sparse matrix of 3 × 3 blocks, one row of blocks for each node.

use grouser_geometry::Vec3;
use grouser_geometry::nalgebra::Matrix3;
use rayon::prelude::*;

/// Sparse matrix of 3 × 3 blocks with ascending columns in each row; both triangles are stored.
#[derive(Clone, Debug)]
pub struct BlockMatrix {
    /// Blocks of row i: `starts[i]..starts[i + 1]`.
    starts: Vec<usize>,
    /// Column of each block, below the number of rows.
    columns: Vec<u32>,
    /// One block more than columns, so that four numbers of every block's last column can be read.
    blocks: Vec<Matrix3<f64>>,
}

impl BlockMatrix {
    /// Zero matrix of `n` block rows that can hold the blocks between all nodes of each group.
    pub fn with_pattern<'a>(n: usize, groups: impl Iterator<Item = &'a [u32]> + Clone) -> Self {
        let mut neighbours: Vec<Vec<u32>> = vec![Vec::new(); n];
        for group in groups {
            for &i in group {
                neighbours[i as usize].extend_from_slice(group);
            }
        }
        let mut starts = vec![0];
        let mut columns = Vec::new();
        for (i, row) in neighbours.iter_mut().enumerate() {
            row.push(i as u32);
            row.sort_unstable();
            row.dedup();
            columns.append(row);
            starts.push(columns.len());
        }
        let blocks = vec![Matrix3::zeros(); columns.len() + 1];
        Self { starts, columns, blocks }
    }

    /// Number of block rows.
    pub fn n_rows(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of stored blocks.
    pub fn n_blocks(&self) -> usize {
        self.columns.len()
    }

    /// Columns and blocks of row `i`.
    pub fn row(&self, i: usize) -> impl DoubleEndedIterator<Item = (usize, &Matrix3<f64>)> {
        let range = self.starts[i]..self.starts[i + 1];
        self.columns[range.clone()].iter().map(|&c| c as usize).zip(&self.blocks[range])
    }

    /// Block (i, j) to change; it must be part of the pattern.
    pub fn block_mut(&mut self, i: usize, j: usize) -> &mut Matrix3<f64> {
        let row = &self.columns[self.starts[i]..self.starts[i + 1]];
        let k = row.partition_point(|&c| (c as usize) < j);
        assert_eq!(row[k] as usize, j, "block ({i}, {j}) is not in the pattern");
        &mut self.blocks[self.starts[i] + k]
    }

    /// Diagonal block of row `i`.
    pub fn diagonal(&self, i: usize) -> Matrix3<f64> {
        self.row(i).find(|&(j, _)| j == i).map_or_else(Matrix3::zeros, |(_, b)| *b)
    }

    /// y = A x.
    pub fn multiply(&self, x: &[Vec3], y: &mut [Vec3]) {
        y.par_chunks_mut(2048).enumerate().for_each(|(k, y)| self.rows_times(2048 * k, x, y));
    }

    /// Rows from `first` on times `x`, as many as `y` has; with 256-bit instructions where the machine has them, none fused: the
    /// same bits everywhere.
    pub fn rows_times(&self, first: usize, x: &[Vec3], y: &mut [Vec3]) {
        assert!(x.len() == self.n_rows(), "a vector for each row");
        #[cfg(target_arch = "x86_64")]
        {
            #[target_feature(enable = "avx2")]
            fn wide(matrix: &BlockMatrix, first: usize, x: &[Vec3], y: &mut [Vec3]) {
                for (i, y) in y.iter_mut().enumerate() {
                    // SAFETY: `x` has a vector for each row.
                    *y = unsafe { matrix.row_by_four(first + i, x) };
                }
            }
            if is_x86_feature_detected!("avx2") {
                // SAFETY: the instructions were just found on this machine.
                return unsafe { wide(self, first, x, y) };
            }
        }
        y.iter_mut().enumerate().for_each(|(i, y)| *y = self.row_plainly(first + i, x));
    }

    /// A sum for each column of the blocks, then their sum.
    fn row_plainly(&self, i: usize, x: &[Vec3]) -> Vec3 {
        let mut sums = [Vec3::zeros(); 3];
        for (j, block) in self.row(i) {
            for (c, sum) in sums.iter_mut().enumerate() {
                *sum += block.column(c) * x[j][c];
            }
        }
        sums[0] + sums[1] + sums[2]
    }

    /// Four numbers of a column at a time; the last one belongs to the next column and is left aside.
    ///
    /// # Safety
    /// `x` must have a vector for each row.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    unsafe fn row_by_four(&self, i: usize, x: &[Vec3]) -> Vec3 {
        use std::arch::x86_64::*;
        let range = self.starts[i]..self.starts[i + 1];
        let mut sums = [_mm256_setzero_pd(); 3];
        // SAFETY: columns are below the number of rows; a block follows the last one; vectors and blocks are three and nine numbers
        // without gaps.
        unsafe {
            let (x, mut block) =
                (x.as_ptr().cast::<f64>(), self.blocks.as_ptr().add(range.start).cast::<f64>());
            for &column in &self.columns[range] {
                let x = x.add(3 * column as usize);
                for (c, sum) in sums.iter_mut().enumerate() {
                    let product = _mm256_mul_pd(_mm256_loadu_pd(block.add(3 * c)), _mm256_set1_pd(*x.add(c)));
                    *sum = _mm256_add_pd(*sum, product);
                }
                block = block.add(9);
            }
            let mut y = [0.0; 4];
            _mm256_storeu_pd(y.as_mut_ptr(), _mm256_add_pd(_mm256_add_pd(sums[0], sums[1]), sums[2]));
            Vec3::new(y[0], y[1], y[2])
        }
    }

    /// Replaces rows and columns of held components by those of the identity times their old diagonal.
    ///
    /// Returns what the held values of `prescribed` add to the right-hand side: −A_free,held x_held on free components.
    pub fn hold(&mut self, is_held: &[[bool; 3]], prescribed: &[Vec3]) -> Vec<Vec3> {
        let mut right_hand_side = vec![Vec3::zeros(); self.n_rows()];
        for i in 0..self.n_rows() {
            for k in self.starts[i]..self.starts[i + 1] {
                let j = self.columns[k] as usize;
                let block = &mut self.blocks[k];
                for (r, c) in (0..3).flat_map(|r| (0..3).map(move |c| (r, c))) {
                    if is_held[i][r] || is_held[j][c] {
                        if !is_held[i][r] {
                            right_hand_side[i][r] -= block[(r, c)] * prescribed[j][c];
                        }
                        if (i, r) != (j, c) {
                            block[(r, c)] = 0.0;
                        }
                    }
                }
            }
            for r in (0..3).filter(|&r| is_held[i][r]) {
                let diagonal = self.block_mut(i, i);
                if diagonal[(r, r)] <= 0.0 {
                    diagonal[(r, r)] = 1.0;
                }
                right_hand_side[i][r] = diagonal[(r, r)] * prescribed[i][r];
            }
        }
        right_hand_side
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_give_the_same_bits_with_and_without_vectors_and_those_of_dense_blocks() {
        let groups: Vec<Vec<u32>> = (0..20).map(|k| vec![k, (7 * k + 3) % 23, (5 * k + 1) % 23]).collect();
        let mut matrix = BlockMatrix::with_pattern(23, groups.iter().map(Vec::as_slice));
        let number = |i: usize| (1.0 + i as f64 * 0.37).sin();
        for i in 0..23 {
            let columns: Vec<usize> = matrix.row(i).map(|(j, _)| j).collect();
            for j in columns {
                *matrix.block_mut(i, j) = Matrix3::from_fn(|r, c| number(31 * i + 17 * j + 3 * r + c));
            }
        }
        let x: Vec<Vec3> = (0..23).map(|i| Vec3::from_fn(|c, _| number(3 * i + c))).collect();
        let mut y = [Vec3::zeros(); 20];
        matrix.rows_times(3, &x, &mut y);
        for (i, y) in (3..).zip(y) {
            let dense: Vec3 = matrix.row(i).map(|(j, block)| block * x[j]).sum();
            assert!((y - dense).norm() < 1e-13, "row {i}");
            assert_eq!(y, matrix.row_plainly(i, &x), "row {i}");
        }
    }
}
