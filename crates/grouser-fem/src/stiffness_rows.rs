//! Internal forces of a linear solid from its assembled stiffness: f = −K (u + β v), a row of 3 × 3 blocks for each node.
//!
//! Where stresses are linear in displacements the elements' constants need not be read each step: K has 15 blocks of 72 bytes a node in a
//! mesh of linear tetrahedra, and its product is a stream of them (`docs/performance.md`). Every row is summed in the order of
//! its columns: the same bits for any number of threads and on every machine.

use std::ops::Range;

use grouser_geometry::Vec3;
use rayon::prelude::*;

use crate::internal_force::Viscosity;
use crate::statics::BlockMatrix;

/// Rows that one task works on; powers are summed in this grain, whatever the number of threads.
const CHUNK: usize = 1024;

/// K by rows, with the memory that results go to.
#[derive(Clone, Debug)]
pub(crate) struct StiffnessRows {
    /// Blocks of row i: `starts[i]..starts[i + 1]`.
    starts: Vec<u32>,
    /// Node of each block, ascending in each row.
    columns: Vec<u32>,
    /// Nine numbers a block, by columns [N/m]; one number more, so that every column can be read as four.
    values: Vec<f64>,
    /// Forces of the nodes of the last product [N].
    forces: Vec<Vec3>,
    /// Power that damping takes in each chunk of rows [W].
    powers: Vec<f64>,
}

impl StiffnessRows {
    pub fn new(stiffness: &BlockMatrix) -> Self {
        let n = stiffness.n_rows();
        let mut starts = vec![0];
        let mut columns = Vec::with_capacity(stiffness.n_blocks());
        let mut values = Vec::with_capacity(9 * stiffness.n_blocks() + 1);
        for i in 0..n {
            for (j, block) in stiffness.row(i) {
                columns.push(j as u32);
                values.extend_from_slice(block.as_slice());
            }
            starts.push(columns.len() as u32);
        }
        values.push(0.0);
        Self { starts, columns, values, forces: vec![Vec3::zeros(); n], powers: vec![0.0; n.div_ceil(CHUNK)] }
    }

    /// Forces of the last [`Self::update`] [N].
    pub fn forces(&self) -> &[Vec3] {
        &self.forces
    }

    /// Whether there are rows enough for threads to pay: about 20 µs of work each.
    pub fn is_worth_threads(&self) -> bool {
        self.powers.len() >= 4
    }

    /// Bytes that a product must move at least: blocks with their columns, row ends, displacements once, forces.
    pub fn bytes(&self) -> usize {
        self.columns.len() * (9 * 8 + 4) + self.forces.len() * (4 + 24 + 24)
    }

    /// f = −K (u + β v); returns the power β vᵀ K v that damping takes [W].
    pub fn update(&mut self, displacement: &[Vec3], viscosity: Option<Viscosity<'_>>) -> f64 {
        assert!(displacement.len() == self.forces.len(), "a displacement for each node");
        assert!(viscosity.is_none_or(|v| v.velocity.len() == self.forces.len()), "a velocity for each node");
        let is_parallel = self.is_worth_threads();
        let Self { starts, columns, values, forces, powers } = self;
        let rows = Rows { starts, columns, values, displacement, viscosity };
        let run = |(c, (forces, power)): (usize, (&mut [Vec3], &mut f64))| {
            *power = rows.multiply(c * CHUNK, forces);
        };
        if is_parallel {
            forces.par_chunks_mut(CHUNK).zip(powers.par_iter_mut()).enumerate().for_each(run);
        } else {
            forces.chunks_mut(CHUNK).zip(powers.iter_mut()).enumerate().for_each(run);
        }
        powers.iter().sum()
    }
}

/// What a product reads.
#[derive(Clone, Copy)]
struct Rows<'a> {
    starts: &'a [u32],
    columns: &'a [u32],
    values: &'a [f64],
    displacement: &'a [Vec3],
    viscosity: Option<Viscosity<'a>>,
}

impl Rows<'_> {
    /// Forces of the rows from `first` on; returns the power that damping takes [W].
    fn multiply(&self, first: usize, forces: &mut [Vec3]) -> f64 {
        #[cfg(target_arch = "x86_64")]
        {
            #[target_feature(enable = "avx2")]
            fn wide(rows: &Rows<'_>, first: usize, forces: &mut [Vec3]) -> f64 {
                // SAFETY: the columns are nodes, and there is a number beyond the last block.
                rows.multiply_with(first, forces, |range, x| unsafe { rows.row_by_four(range, x) })
            }
            if is_x86_feature_detected!("avx2") {
                // SAFETY: the instructions were just found on this machine.
                return unsafe { wide(self, first, forces) };
            }
        }
        self.multiply_with(first, forces, |range, x| self.row(range, x))
    }

    #[inline(always)]
    fn multiply_with(
        &self,
        first: usize,
        forces: &mut [Vec3],
        row: impl Fn(Range<usize>, &[Vec3]) -> Vec3,
    ) -> f64 {
        let mut power = 0.0;
        for (i, force) in forces.iter_mut().enumerate() {
            let n = first + i;
            let range = self.starts[n] as usize..self.starts[n + 1] as usize;
            *force = -row(range.clone(), self.displacement);
            if let Some(Viscosity { velocity, beta }) = self.viscosity {
                // The row comes from the nearest cache the second time.
                let viscous = row(range, velocity) * beta;
                *force -= viscous;
                power += viscous.dot(&velocity[n]);
            }
        }
        power
    }

    /// Blocks `range`, all of one row, times `x`: a sum for each column of the blocks.
    #[inline(always)]
    fn row(&self, range: Range<usize>, x: &[Vec3]) -> Vec3 {
        let mut sums = [Vec3::zeros(); 3];
        let blocks = self.values[9 * range.start..9 * range.end].chunks_exact(9);
        for (block, &column) in blocks.zip(&self.columns[range]) {
            for c in 0..3 {
                sums[c] += Vec3::from_column_slice(&block[3 * c..3 * c + 3]) * x[column as usize][c];
            }
        }
        sums[0] + sums[1] + sums[2]
    }

    /// [`Self::row`] with four numbers of a column at a time, of which the last belongs to the next column and is left aside.
    ///
    /// # Safety
    /// `x` must have a vector for every column that occurs, and `values` a number beyond the last block.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    unsafe fn row_by_four(&self, range: Range<usize>, x: &[Vec3]) -> Vec3 {
        use std::arch::x86_64::*;
        let mut sums = [_mm256_setzero_pd(); 3];
        // SAFETY: by the caller.
        unsafe {
            let (x, mut block) = (x.as_ptr().cast::<f64>(), self.values.as_ptr().add(9 * range.start));
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
}

#[cfg(test)]
mod tests {
    use super::*;
    use grouser_geometry::{box_mesh, nalgebra::Matrix3};

    #[test]
    fn products_are_those_of_the_matrix_and_the_same_bits_with_and_without_vectors_and_threads() {
        let mesh = box_mesh(Vec3::repeat(1.0), [15, 16, 17]);
        let n = mesh.nodes.len();
        let groups = (0..mesh.n_elements()).map(|e| mesh.element(e));
        let mut matrix = BlockMatrix::with_pattern(n, groups);
        let number = |i: usize| (1.0 + i as f64 * 0.37).sin();
        for i in 0..n {
            let columns: Vec<usize> = matrix.row(i).map(|(j, _)| j).collect();
            for j in columns {
                *matrix.block_mut(i, j) = Matrix3::from_fn(|r, c| number(31 * i + 17 * j + 3 * r + c));
            }
        }
        let vectors =
            |k: usize| -> Vec<Vec3> { (0..n).map(|i| Vec3::from_fn(|c, _| number(k + 3 * i + c))).collect() };
        let (u, velocity, beta) = (vectors(1), vectors(2), 0.3);
        let mut rows = StiffnessRows::new(&matrix);
        assert!(rows.is_worth_threads());
        let power = rows.update(&u, Some(Viscosity { velocity: &velocity, beta }));
        let (mut elastic, mut viscous) = (vec![Vec3::zeros(); n], vec![Vec3::zeros(); n]);
        matrix.multiply(&u, &mut elastic);
        matrix.multiply(&velocity, &mut viscous);
        let expected: f64 = velocity.iter().zip(&viscous).map(|(v, f)| beta * v.dot(f)).sum();
        assert!((power - expected).abs() < 1e-9, "{power} {expected}");
        let viscosity = Some(Viscosity { velocity: &velocity, beta });
        let plain = Rows {
            starts: &rows.starts,
            columns: &rows.columns,
            values: &rows.values,
            displacement: &u,
            viscosity,
        };
        let mut one = vec![Vec3::zeros(); n];
        plain.multiply_with(0, &mut one, |range, x| plain.row(range, x));
        for i in 0..n {
            assert!((rows.forces[i] + elastic[i] + viscous[i] * beta).norm() < 1e-12);
            assert_eq!(rows.forces[i], one[i], "row {i}");
        }
    }
}
