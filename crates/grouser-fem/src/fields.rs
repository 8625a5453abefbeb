//! Fields for output: strain, Cauchy stress, von Mises stress and energy of each element.

use grouser_geometry::nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

use crate::element_state::ElementStates;
use crate::law::Law;
use crate::polar::rotation;
use crate::solid::Solid;
use crate::tensor::Tensor;

/// Means over one element.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ElementFields {
    /// Strain along the axes of the solid's frame: ε of small strains, otherwise V − I of F = V R.
    pub strain: Matrix3<f64>,
    /// Cauchy stress σ [Pa].
    pub stress: Matrix3<f64>,
    /// Stored energy [J].
    pub energy: f64,
}

impl ElementFields {
    /// Von Mises stress √(3/2 s:s) [Pa].
    pub fn von_mises(&self) -> f64 {
        let deviator = self.stress - Matrix3::identity() * (self.stress.trace() / 3.0);
        (1.5 * deviator.component_mul(&deviator).sum()).sqrt()
    }
}

impl Solid {
    /// Fields of each element at the present displacements.
    pub fn element_fields(&self) -> Vec<ElementFields> {
        let states =
            ElementStates::new(&self.mesh, &self.laws, &self.state.displacement, self.is_pressure_averaged());
        (0..self.mesh.n_elements()).map(|e| fields_of(&states, e)).collect()
    }
}

fn fields_of(states: &ElementStates<'_>, e: usize) -> ElementFields {
    let mut mean =
        ElementFields { strain: Matrix3::zeros(), stress: Matrix3::zeros(), energy: states.energy(e) };
    let mut volume = 0.0;
    for (h, _, weight) in states.points(e) {
        let p = states.stress(e, &h).to_matrix();
        let f = h + Tensor::identity();
        let (strain, stress) = match states.law(e) {
            Law::SmallStrain(_) => (h.symmetric().to_matrix(), p),
            law => {
                let r = rotation(&f).to_matrix();
                let left_stretch = f.to_matrix() * r.transpose();
                // The corotational law's stress belongs to the undeformed areas, turned.
                let stress = match law {
                    Law::Corotational(_) => p * r.transpose(),
                    _ => p * f.to_matrix().transpose() / f.determinant(),
                };
                (left_stretch - Matrix3::identity(), stress)
            }
        };
        mean.strain += strain * weight;
        mean.stress += stress * weight;
        volume += weight;
    }
    mean.strain /= volume;
    mean.stress /= volume;
    mean
}
