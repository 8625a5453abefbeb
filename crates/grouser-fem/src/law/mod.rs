//! Elastic laws: from the displacement gradient of a point to stored energy and first Piola–Kirchhoff stress.
//!
//! Every law stores ψ(F) = W(F) + U(θ(F)): a part W that stays bounded as ν → 0.5 and a volumetric part U of the measure θ of
//! volume change. An element without nodal averaging takes P = ∂W/∂F + U'(θ) ∂θ/∂F; with it, the pressure U' comes from the
//! nodes (`docs/theory/elastic_solids.md`, step 4).

mod corotational;
mod isochoric;
mod mooney_rivlin;
mod neo_hookean;
mod small_strain;
mod yeoh;

use crate::number::Real;
use crate::tensor::Tensor;

pub use corotational::Corotational;
pub use mooney_rivlin::MooneyRivlin;
pub use neo_hookean::NeoHookean;
pub use small_strain::SmallStrain;
pub use yeoh::Yeoh;

/// What a law answers to a displacement gradient.
#[derive(Clone, Copy, Debug)]
pub struct Response<S> {
    /// ∂W/∂F [Pa].
    pub stress_at_constant_volume: Tensor<S>,
    /// Measure θ of volume change: 0 when undeformed.
    pub volume_change: S,
    /// ∂θ/∂F.
    pub volume_gradient: Tensor<S>,
}

/// Elastic law ψ(F) = W(F) + U(θ(F)) [J/m³]; `gradient` is H = F − I = ∂u/∂X everywhere.
pub trait ElasticLaw: Copy + Send + Sync {
    /// Stress without its volumetric part, and the volume change with its gradient.
    fn response<S: Real>(&self, gradient: &Tensor<S>) -> Response<S>;
    /// U'(θ) [Pa], positive in tension.
    fn pressure<S: Real>(&self, volume_change: S) -> S;
    /// W [J/m³].
    fn energy_at_constant_volume(&self, gradient: &Tensor<f64>) -> f64;
    /// U [J/m³].
    fn volume_energy(&self, volume_change: f64) -> f64;
    /// Lamé parameters (λ, μ) of the undeformed material [Pa].
    fn lame(&self) -> (f64, f64);

    /// Viscous first Piola–Kirchhoff stress [Pa] of the rate Ḟ [1/s] for stiffness-proportional damping `beta` [s]:
    /// β (2μ d + λ tr d I) cof F with the rate of deformation d = sym(Ḟ F⁻¹): objective, without couple, never a source.
    #[inline(always)]
    fn viscous_stress<S: Real>(&self, gradient: &Tensor<S>, rate: &Tensor<S>, beta: f64) -> Tensor<S> {
        let f = *gradient + Tensor::identity();
        let cofactor = f.cofactor();
        let inverse = cofactor.transpose().times(S::constant(1.0) / f.determinant());
        hooke(self.lame(), &(*rate * inverse).symmetric()).times(S::constant(beta)) * cofactor
    }

    /// First Piola–Kirchhoff stress P = ∂ψ/∂F [Pa].
    #[inline(always)]
    fn stress<S: Real>(&self, gradient: &Tensor<S>) -> Tensor<S> {
        let r = self.response(gradient);
        r.stress_at_constant_volume + r.volume_gradient.times(self.pressure(r.volume_change))
    }

    /// Stored energy ψ [J/m³].
    fn energy(&self, gradient: &Tensor<f64>) -> f64 {
        self.energy_at_constant_volume(gradient) + self.volume_energy(self.response(gradient).volume_change)
    }
}

/// 2μ ε + λ tr(ε) I.
#[inline(always)]
pub(crate) fn hooke<S: Real>((lambda, mu): (f64, f64), strain: &Tensor<S>) -> Tensor<S> {
    strain.times(S::constant(2.0 * mu)) + Tensor::identity().times(strain.trace().scaled(lambda))
}

/// One of the laws; [`with_law!`](crate::with_law) turns it into a type once per block of elements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// Linear elasticity of small strains and small rotations.
    SmallStrain(SmallStrain),
    /// Linear elasticity in a frame that turns with each element.
    Corotational(Corotational),
    /// Compressible neo-Hookean solid.
    NeoHookean(NeoHookean),
    /// Mooney–Rivlin rubber.
    MooneyRivlin(MooneyRivlin),
    /// Yeoh rubber.
    Yeoh(Yeoh),
}

/// Evaluates an expression with the concrete type of a [`Law`].
#[macro_export]
macro_rules! with_law {
    ($law:expr, |$name:ident| $body:expr) => {
        match $law {
            $crate::law::Law::SmallStrain($name) => $body,
            $crate::law::Law::Corotational($name) => $body,
            $crate::law::Law::NeoHookean($name) => $body,
            $crate::law::Law::MooneyRivlin($name) => $body,
            $crate::law::Law::Yeoh($name) => $body,
        }
    };
}

impl Law {
    /// First Piola–Kirchhoff stress [Pa] at one displacement gradient.
    pub fn stress(&self, gradient: &Tensor<f64>) -> Tensor<f64> {
        with_law!(*self, |law| law.stress(gradient))
    }

    /// Stored energy [J/m³] at one displacement gradient.
    pub fn energy(&self, gradient: &Tensor<f64>) -> f64 {
        with_law!(*self, |law| law.energy(gradient))
    }
}

#[cfg(test)]
mod tests {
    use grouser_geometry::Vec3;
    use grouser_geometry::nalgebra::{Matrix3, Rotation3};
    use proptest::prelude::*;

    use super::*;
    use crate::material::{Elasticity, Formulation};
    use crate::number::{Dual, LANES, Lanes};

    const RUBBERS: [Elasticity; 3] = [
        Elasticity::Hooke { young_modulus: 20e6, poisson_ratio: 0.45 },
        Elasticity::MooneyRivlin { c10: 0.6e6, c01: 0.2e6, bulk_modulus: 80e6 },
        Elasticity::Yeoh { c10: 0.8e6, c20: -0.05e6, c30: 0.02e6, bulk_modulus: 80e6 },
    ];

    fn all_laws() -> Vec<Law> {
        let mut laws: Vec<Law> = RUBBERS.iter().map(|e| e.law(Formulation::FiniteStrain)).collect();
        laws.extend([Formulation::BodyAttached, Formulation::Corotational].map(|f| RUBBERS[0].law(f)));
        laws
    }

    fn gradient() -> impl Strategy<Value = Tensor<f64>> {
        let entries = prop::array::uniform9(-0.25..0.25f64);
        (entries, prop::array::uniform3(-2.0..2.0f64)).prop_map(|(h, axis)| {
            let turn = Rotation3::new(Vec3::from(axis)).into_inner();
            let f = turn * (Matrix3::identity() + Matrix3::from_row_slice(&h));
            Tensor::from_matrix(&(f - Matrix3::identity()))
        })
    }

    proptest! {
        #[test]
        fn stress_is_the_derivative_of_the_stored_energy_by_central_differences(h in gradient()) {
            for law in all_laws() {
                let stress = law.stress(&h);
                let step = 1e-6;
                for i in 0..3 {
                    for j in 0..3 {
                        let at = |d: f64| { let mut g = h; g.0[i][j] += d; law.energy(&g) };
                        let difference = (at(step) - at(-step)) / (2.0 * step);
                        prop_assert!((stress.0[i][j] - difference).abs() < 1e-2 * 20e6 * 1e-4, "{law:?}: {} against {difference}", stress.0[i][j]);
                    }
                }
            }
        }

        #[test]
        fn duals_and_lanes_give_what_plain_numbers_give(h in gradient(), d in gradient()) {
            for law in all_laws() {
                let stress = law.stress(&h);
                let dual = Tensor::from_fn(|i, j| Dual { value: h.0[i][j], derivative: d.0[i][j] });
                let lanes = Tensor::from_fn(|i, j| Lanes([h.0[i][j]; LANES]));
                let by_dual = with_law!(law, |l| l.stress(&dual));
                let by_lanes = with_law!(law, |l| l.stress(&lanes));
                let step = 1e-6;
                let ahead = law.stress(&(h + d.times(step)));
                let behind = law.stress(&(h - d.times(step)));
                for i in 0..3 {
                    for j in 0..3 {
                        prop_assert_eq!(by_lanes.0[i][j].0[3], stress.0[i][j]);
                        prop_assert!((by_dual.0[i][j].value - stress.0[i][j]).abs() < 1e-7 * 20e6);
                        let difference = (ahead.0[i][j] - behind.0[i][j]) / (2.0 * step);
                        prop_assert!((by_dual.0[i][j].derivative - difference).abs() < 1e-5 * 80e6, "{:?}", law);
                    }
                }
            }
        }

        #[test]
        fn a_rotation_stores_nothing_except_in_the_body_attached_law(axis in prop::array::uniform3(-3.0..3.0f64)) {
            let turn = Rotation3::new(Vec3::from(axis)).into_inner() - Matrix3::identity();
            for law in all_laws() {
                let stress = law.stress(&Tensor::from_matrix(&turn)).to_matrix().norm();
                match law {
                    Law::SmallStrain(_) => prop_assert!(turn.norm() < 0.1 || stress > 1e3),
                    _ => prop_assert!(stress < 1e-6 * 1e3, "{law:?}: {stress}"),
                }
            }
        }

        #[test]
        fn stress_turns_with_the_frame_and_has_no_net_couple(h in gradient(), axis in prop::array::uniform3(-3.0..3.0f64)) {
            let q = Rotation3::new(Vec3::from(axis)).into_inner();
            let f = h.to_matrix() + Matrix3::identity();
            for law in all_laws().into_iter().filter(|l| !matches!(l, Law::SmallStrain(_))) {
                let p = law.stress(&h).to_matrix();
                let turned = law.stress(&Tensor::from_matrix(&(q * f - Matrix3::identity()))).to_matrix();
                prop_assert!((turned - q * p).norm() < 1e-9 * 20e6);
                let kirchhoff = p * f.transpose();
                prop_assert!((kirchhoff - kirchhoff.transpose()).norm() < 1e-9 * 20e6);
            }
        }
    }

    #[test]
    fn every_law_begins_with_hookes_stiffness() {
        // sigma_xx = (lambda + 2 mu) e, sigma_yy = lambda e, sigma_xy = 2 mu e_xy
        let e = 1e-7;
        for elasticity in RUBBERS {
            let (lambda, mu) = elasticity.lame();
            for formulation in
                [Formulation::BodyAttached, Formulation::Corotational, Formulation::FiniteStrain]
            {
                let mut h = Tensor::zero();
                h.0[0][0] = e;
                h.0[0][1] = e;
                let stress = elasticity.law(formulation).stress(&h);
                let scale = (lambda + 2.0 * mu) * e;
                assert!((stress.0[0][0] - scale).abs() < 1e-5 * scale);
                assert!((stress.0[1][1] - lambda * e).abs() < 1e-5 * scale);
                assert!((stress.0[1][0] - mu * e).abs() < 1e-5 * scale);
            }
        }
    }
}
