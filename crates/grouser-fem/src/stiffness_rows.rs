//! Internal forces of a linear solid from its assembled stiffness: f = −K (u + β v), a row of 3 × 3 blocks for each node.
//!
//! Where stresses are linear in displacements the elements' constants need not be read each step: K has 15 blocks of 72 bytes a node in a
//! mesh of linear tetrahedra, and its product is a stream of them (`docs/performance.md`). Every row is summed in the order of
//! its columns: the same bits for any number of threads and on every machine.

use grouser_geometry::Vec3;
use rayon::prelude::*;

use crate::internal_force::Viscosity;
use crate::statics::BlockMatrix;

/// Rows that one task works on; powers are summed in this grain, whatever the number of threads.
const CHUNK: usize = 1024;
/// Rows that are multiplied by displacements and then by velocities, the second time from a near cache.
const GROUP: usize = 128;

/// K, with the memory that results go to.
#[derive(Clone, Debug)]
pub(crate) struct StiffnessRows {
    stiffness: BlockMatrix,
    /// Forces of the nodes of the last product [N].
    forces: Vec<Vec3>,
    /// Power that damping takes in each chunk of rows [W].
    powers: Vec<f64>,
}

impl StiffnessRows {
    pub fn new(stiffness: BlockMatrix) -> Self {
        let n = stiffness.n_rows();
        Self { stiffness, forces: vec![Vec3::zeros(); n], powers: vec![0.0; n.div_ceil(CHUNK)] }
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
        self.stiffness.n_blocks() * (9 * 8 + 4) + self.forces.len() * (8 + 24 + 24)
    }

    /// f = −K (u + β v); returns the power β vᵀ K v that damping takes [W].
    pub fn update(&mut self, displacement: &[Vec3], viscosity: Option<Viscosity<'_>>) -> f64 {
        let is_parallel = self.is_worth_threads();
        let Self { stiffness, forces, powers } = self;
        let run = |(chunk, (forces, power)): (usize, (&mut [Vec3], &mut f64))| {
            *power = 0.0;
            for (group, forces) in forces.chunks_mut(GROUP).enumerate() {
                let first = chunk * CHUNK + group * GROUP;
                stiffness.rows_times(first, displacement, forces);
                forces.iter_mut().for_each(|force| *force = -*force);
                if let Some(Viscosity { velocity, beta }) = viscosity {
                    let mut viscous = [Vec3::zeros(); GROUP];
                    let viscous = &mut viscous[..forces.len()];
                    stiffness.rows_times(first, velocity, viscous);
                    for ((force, viscous), velocity) in forces.iter_mut().zip(viscous).zip(&velocity[first..])
                    {
                        *force -= *viscous * beta;
                        *power += (*viscous * beta).dot(velocity);
                    }
                }
            }
        };
        if is_parallel {
            forces.par_chunks_mut(CHUNK).zip(powers.par_iter_mut()).enumerate().for_each(run);
        } else {
            forces.chunks_mut(CHUNK).zip(powers.iter_mut()).enumerate().for_each(run);
        }
        powers.iter().sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use grouser_geometry::nalgebra::Matrix3;

    #[test]
    fn forces_and_the_power_of_damping_are_those_of_the_matrix_in_chunks_and_threads() {
        let n = 4 * CHUNK + 5;
        let groups: Vec<Vec<u32>> = (0..n as u32).map(|i| vec![i, (i + 1) % n as u32]).collect();
        let mut matrix = BlockMatrix::with_pattern(n, groups.iter().map(Vec::as_slice));
        let number = |i: usize| (1.0 + i as f64 * 0.37).sin();
        for i in 0..n {
            for j in [i, (i + 1) % n] {
                *matrix.block_mut(i, j) = Matrix3::from_fn(|r, c| number(31 * i + 17 * j + 3 * r + c));
            }
        }
        let vectors =
            |k: usize| -> Vec<Vec3> { (0..n).map(|i| Vec3::from_fn(|c, _| number(k + 3 * i + c))).collect() };
        let (u, velocity, beta) = (vectors(1), vectors(2), 0.3);
        let mut rows = StiffnessRows::new(matrix.clone());
        assert!(rows.is_worth_threads());
        let power = rows.update(&u, Some(Viscosity { velocity: &velocity, beta }));
        let (mut elastic, mut viscous) = (vec![Vec3::zeros(); n], vec![Vec3::zeros(); n]);
        matrix.multiply(&u, &mut elastic);
        matrix.multiply(&velocity, &mut viscous);
        let expected: f64 = velocity.iter().zip(&viscous).map(|(v, f)| beta * v.dot(f)).sum();
        assert!((power - expected).abs() < 1e-11 * n as f64, "{power} {expected}");
        for i in 0..n {
            assert!((rows.forces[i] + elastic[i] + viscous[i] * beta).norm() < 1e-13, "row {i}");
        }
        assert_eq!(rows.update(&u, None), 0.0);
        assert_eq!(rows.forces[7], -elastic[7]);
    }
}
