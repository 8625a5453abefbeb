//! What gives the internal forces of a solid: blocks of elements, or its assembled stiffness where that is constant and sparse.

use grouser_geometry::{ElementOrder, TetrahedralMesh, Vec3};

use crate::element_blocks::NodeGather;
use crate::element_state::ElementStates;
use crate::internal_force::{BlockSet, Inversion, Viscosity};
use crate::law::Law;
use crate::statics::assemble;
use crate::stiffness_rows::StiffnessRows;

/// Elements of a solid, ready to give forces.
#[derive(Clone, Debug)]
pub(crate) enum Elements {
    Linear(BlockSet<3, 1>),
    Quadratic(BlockSet<9, 4>),
    /// Elements of laws that are linear in the displacements; the elements themselves are asked for inverted ones alone.
    Assembled(StiffnessRows, Box<Elements>),
}

/// Internal forces of the nodes, of the last call of [`Elements::update`].
#[derive(Clone, Copy)]
pub(crate) enum NodeForces<'a> {
    /// Every node adds the forces of its blocks.
    Gathered { gather: &'a NodeGather, forces: &'a [Vec3] },
    /// One force for each node.
    Whole(&'a [Vec3]),
}

impl NodeForces<'_> {
    /// Internal force of node `n` [N].
    #[inline]
    pub fn of(&self, n: usize) -> Vec3 {
        match self {
            Self::Gathered { gather, forces } => {
                let mut sum = Vec3::zeros();
                for &place in gather.of(n) {
                    sum += forces[place as usize];
                }
                sum
            }
            Self::Whole(forces) => forces[n],
        }
    }
}

impl Elements {
    /// Elements of a mesh; laws that are linear in the displacements get one assembled stiffness.
    pub fn new(mesh: &TetrahedralMesh, laws: &[Law], is_averaged: bool) -> Self {
        let blocks = match mesh.order {
            ElementOrder::Linear => Self::Linear(BlockSet::new(mesh, laws, is_averaged)),
            ElementOrder::Quadratic => Self::Quadratic(BlockSet::new(mesh, laws, false)),
        };
        // Averages around nodes reach further than an element.
        if is_averaged || !laws.iter().all(|law| matches!(law, Law::SmallStrain(_))) {
            return blocks;
        }
        let undeformed = vec![Vec3::zeros(); mesh.nodes.len()];
        let states = ElementStates::new(mesh, laws, &undeformed, false);
        Self::Assembled(StiffnessRows::new(assemble(&states, &[])), Box::new(blocks))
    }

    /// Computes the internal forces of the displacements [m]; returns the power of the viscous stress [W]. An assembled stiffness
    /// does not see its elements: [`Self::refuse_inversion`].
    pub fn update(
        &mut self,
        displacement: &[Vec3],
        viscosity: Option<Viscosity<'_>>,
    ) -> Result<f64, Inversion> {
        match self {
            Self::Linear(set) => set.update(displacement, viscosity),
            Self::Quadratic(set) => set.update(displacement, viscosity),
            Self::Assembled(rows, _) => Ok(rows.update(displacement, viscosity)),
        }
    }

    /// Looks for inverted elements where [`Self::update`] does not.
    pub fn refuse_inversion(&mut self, displacement: &[Vec3]) -> Result<(), Inversion> {
        match self {
            Self::Assembled(_, elements) => elements.update(displacement, None).map(|_| ()),
            Self::Linear(_) | Self::Quadratic(_) => Ok(()),
        }
    }

    /// Forces of the last [`Self::update`].
    pub fn node_forces(&self) -> NodeForces<'_> {
        match self {
            Self::Linear(set) => set.node_forces(),
            Self::Quadratic(set) => set.node_forces(),
            Self::Assembled(rows, _) => NodeForces::Whole(rows.forces()),
        }
    }

    /// Bytes that the forces must move at least: constants of the elements once (twice with averaged pressure), for every node of every
    /// block its number, displacement, and force written and read; or the rows of the stiffness and, at each node, the force read.
    pub fn bytes_per_step(&self, is_averaged: bool) -> f64 {
        let passes = if is_averaged { 2 } else { 1 };
        // Number 4 + displacement 24 + force out 24 and in 24 + place 4.
        let bytes = match self {
            Self::Linear(set) => passes * set.element_bytes() + 80 * set.n_block_nodes(),
            Self::Quadratic(set) => set.element_bytes() + 80 * set.n_block_nodes(),
            Self::Assembled(rows, _) => rows.bytes() + 24 * rows.forces().len(),
        };
        bytes as f64
    }

    /// Whether the solid is large enough for threads to pay.
    pub fn is_worth_threads(&self) -> bool {
        match self {
            Self::Linear(set) => set.is_worth_threads(),
            Self::Quadratic(set) => set.is_worth_threads(),
            Self::Assembled(rows, _) => rows.is_worth_threads(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Formulation, Material};
    use grouser_geometry::box_mesh;

    #[test]
    fn assembled_stiffness_gives_the_forces_of_its_elements() {
        let linear = box_mesh(Vec3::new(1.0, 0.5, 0.2), [4, 3, 2]);
        for mesh in [linear.to_quadratic(), linear] {
            let law = Material::hooke(1100.0, 20e6, 0.45).elasticity.law(Formulation::BodyAttached);
            let mut assembled = Elements::new(&mesh, &[law], false);
            let Elements::Assembled(_, elements) = &assembled else { panic!("its law is linear") };
            let mut elements = elements.clone();
            let wave = |x: &Vec3| 1e-3 * Vec3::new((7.0 * x.y).sin(), x.x * x.z, (5.0 * x.x).cos());
            let displacement: Vec<Vec3> = mesh.nodes.iter().map(wave).collect();
            let velocity: Vec<Vec3> = displacement.iter().map(|u| 3.0 * u.yzx()).collect();
            let viscosity = || Some(Viscosity { velocity: &velocity, beta: 0.1 });
            let powers =
                [&mut assembled, &mut *elements].map(|e| e.update(&displacement, viscosity()).unwrap());
            assert!((powers[0] / powers[1] - 1.0).abs() < 1e-10, "{powers:?}");
            let largest =
                (0..displacement.len()).map(|n| elements.node_forces().of(n).norm()).fold(0.0, f64::max);
            for n in 0..displacement.len() {
                let missed = (assembled.node_forces().of(n) - elements.node_forces().of(n)).norm();
                assert!(missed < 1e-11 * largest, "node {n}: {missed} of {largest}");
            }
        }
    }
}
