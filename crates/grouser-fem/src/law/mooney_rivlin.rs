//! Mooney–Rivlin rubber: ψ = c10 (Ī₁ − 3) + c01 (Ī₂ − 3) + κ/2 (J − 1)² (Mooney 1940, J. Appl. Phys. 11, 582).

use super::isochoric::Isochoric;
use super::{ElasticLaw, Response};
use crate::material::lame_of_bulk;
use crate::number::Real;
use crate::tensor::Tensor;

/// Mooney–Rivlin law; initial shear modulus 2 (c10 + c01).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MooneyRivlin {
    /// Factor of Ī₁ − 3 [Pa].
    pub c10: f64,
    /// Factor of Ī₂ − 3 [Pa].
    pub c01: f64,
    /// Bulk modulus κ [Pa].
    pub bulk_modulus: f64,
}

impl ElasticLaw for MooneyRivlin {
    #[inline(always)]
    fn response<S: Real>(&self, gradient: &Tensor<S>) -> Response<S> {
        let invariants = Isochoric::new(gradient);
        Response {
            stress_at_constant_volume: invariants.first_gradient().times(S::constant(self.c10))
                + invariants.second_gradient().times(S::constant(self.c01)),
            volume_change: invariants.volume_ratio - S::constant(1.0),
            volume_gradient: invariants.cofactor,
        }
    }

    #[inline(always)]
    fn pressure<S: Real>(&self, volume_change: S) -> S {
        volume_change.scaled(self.bulk_modulus)
    }

    fn energy_at_constant_volume(&self, gradient: &Tensor<f64>) -> f64 {
        let invariants = Isochoric::new(gradient);
        self.c10 * (invariants.first() - 3.0) + self.c01 * (invariants.second() - 3.0)
    }

    fn volume_energy(&self, volume_change: f64) -> f64 {
        0.5 * self.bulk_modulus * volume_change * volume_change
    }

    fn lame(&self) -> (f64, f64) {
        lame_of_bulk(self.bulk_modulus, 2.0 * (self.c10 + self.c01))
    }
}
