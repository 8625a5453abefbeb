//! Symmetric sparse matrix of 3 × 3 blocks, one row of blocks for each node.

use grouser_geometry::Vec3;
use grouser_geometry::nalgebra::Matrix3;
use rayon::prelude::*;

/// Sparse matrix of 3 × 3 blocks with ascending columns in each row; both triangles are stored.
#[derive(Clone, Debug)]
pub struct BlockMatrix {
    /// Blocks of row i: `starts[i]..starts[i + 1]`.
    starts: Vec<usize>,
    columns: Vec<u32>,
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
        let blocks = vec![Matrix3::zeros(); columns.len()];
        Self { starts, columns, blocks }
    }

    /// Number of block rows.
    pub fn n_rows(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of stored blocks.
    pub fn n_blocks(&self) -> usize {
        self.blocks.len()
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
        y.par_iter_mut().with_min_len(2048).enumerate().for_each(|(i, y)| {
            *y = self.row(i).fold(Vec3::zeros(), |sum, (j, block)| sum + block * x[j]);
        });
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
