//! Nodes that others move, and what the solid exchanges with them: carried nodes, reactions, momentum.

use grouser_geometry::{MeshError, Pose, Vec3, Wrench};

use crate::material::Formulation;
use crate::solid::Solid;

impl Solid {
    /// Carries nodes with a rigid body (a rim): after the next step of `dt` [s] they lie at `pose` applied to their undeformed
    /// positions. Call it before each step; unlike [`Self::prescribe`] it neither restarts the solid nor its ledger.
    pub fn carry(&mut self, nodes: &[u32], pose: &Pose, dt: f64) {
        for &node in nodes {
            let x = self.mesh.nodes[node as usize];
            let target = (pose * grouser_geometry::nalgebra::Point3::from(x)).coords - x;
            let displacement = self.state.displacement[node as usize];
            let support = self.state.supports.entry(node).or_default();
            support.held = [true; 3];
            support.displacement = displacement;
            support.velocity = (target - displacement) / dt;
            if let Some(held) = self.held_mask.get_mut(node as usize) {
                *held = [true; 3];
            }
        }
    }

    /// Where the force on a node acts for moments: small strains balance moments about the undeformed positions.
    fn place_of_force(&self, node: u32) -> Vec3 {
        match self.settings.formulation {
            Formulation::BodyAttached => self.mesh.nodes[node as usize],
            _ => self.position(node),
        }
    }

    /// Force and moment about `point` [m] that the supports of a named surface or node set exert on the solid, in its frame;
    /// levers are those of the undeformed solid where it is body-attached.
    ///
    /// # Errors
    /// [`MeshError::UnknownName`].
    pub fn reaction_on(&self, name: &str, point: &Vec3) -> Result<Wrench, MeshError> {
        let nodes = self.mesh.nodes_of(name)?;
        let mut sum = Wrench::default();
        for ((node, _), force) in self.state.supports.iter().zip(&self.state.reaction) {
            if nodes.binary_search(node).is_ok() {
                sum += Wrench::of_force_at(*force, &self.place_of_force(*node), point);
            }
        }
        Ok(sum)
    }

    /// Momentum and angular momentum about `point` [m] in the solid's frame, as force × time and moment × time.
    pub fn momentum(&self, point: &Vec3) -> Wrench {
        let of_node = |n: usize| {
            Wrench::of_force_at(
                self.state.velocity[n] * self.nodal_mass[n],
                &self.place_of_force(n as u32),
                point,
            )
        };
        (0..self.nodal_mass.len()).map(of_node).fold(Wrench::default(), |sum, w| sum + w)
    }
}
