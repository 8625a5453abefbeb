//! Bound of the stable time step from the elements' largest frequencies (Irons & Treharne 1971; Fried 1972).
//!
//! The largest eigenvalue of M⁻¹K never exceeds the largest of the elements' own M_e⁻¹K_e, so the bound is never above the true
//! limit. Averaged nodal pressure only lowers the frequencies (the mean of squares is above the square of the mean).

use grouser_geometry::nalgebra::{DMatrix, SymmetricEigen};
use rayon::prelude::*;

use crate::element_state::ElementStates;
use crate::mass::{MassKind, consistent_element_mass, lumped_shares};
use crate::solid::Solid;

/// Largest stable step and the element that binds it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StableStep {
    /// Largest step [s].
    pub dt: f64,
    /// Number of the element.
    pub element: u64,
    /// Its largest angular frequency [rad/s].
    pub angular_frequency: f64,
}

impl Solid {
    /// Stable step at the present deformation, damping included.
    pub fn stable_time_step(&self) -> StableStep {
        let states = ElementStates::new(&self.mesh, &self.laws, &self.state.displacement, false);
        let omega = |e: usize| self.largest_eigenvalue(&states, e).max(0.0).sqrt();
        let all: Vec<f64> = (0..self.mesh.n_elements()).into_par_iter().map(omega).collect();
        let (e, &omega) =
            all.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).expect("a solid has elements");
        // dt <= 2/w (sqrt(1 + xi^2) - xi); xi grows with beta w, so the largest frequency binds it, and alpha counts there too.
        let xi = 0.5 * (self.settings.mass_damping / omega + self.settings.stiffness_damping * omega);
        let dt = 2.0 / (omega * ((1.0 + xi * xi).sqrt() + xi));
        StableStep { dt, element: self.mesh.element_label(e), angular_frequency: omega }
    }

    /// Largest eigenvalue of M_e⁻¹ K_e [1/s²].
    fn largest_eigenvalue(&self, states: &ElementStates<'_>, e: usize) -> f64 {
        let density = self.materials[self.mesh.region_of_element[e] as usize].density;
        let n = self.mesh.order.n_nodes();
        // C with M_e = (C^-1)^T C^-1, the same for each component.
        let scale = match self.settings.mass {
            MassKind::Lumped => {
                let mass = density * self.mesh.element_volume(e);
                let shares = lumped_shares(self.mesh.order);
                DMatrix::from_fn(n, n, |i, j| if i == j { 1.0 / (shares[i] * mass).sqrt() } else { 0.0 })
            }
            MassKind::Consistent => {
                let factor = (consistent_element_mass(&self.mesh, e) * density).cholesky();
                let inverse = factor.and_then(|f| f.l().try_inverse());
                inverse.expect("the mass of an element with volume is positive").transpose()
            }
        };
        let scale = scale.kronecker(&DMatrix::identity(3, 3));
        let k = states.stiffness(e);
        let scaled = scale.transpose() * ((&k + k.transpose()) * 0.5) * scale;
        SymmetricEigen::new(scaled).eigenvalues.max()
    }
}
