//! Yeoh rubber: ψ = Σ ci0 (Ī₁ − 3)^i, i = 1…3, + κ/2 (J − 1)² (Yeoh 1993, Rubber Chem. Technol. 66, 754).

use super::isochoric::Isochoric;
use super::{ElasticLaw, Response};
use crate::material::lame_of_bulk;
use crate::number::Real;
use crate::tensor::Tensor;

/// Yeoh law; initial shear modulus 2 c10.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Yeoh {
    /// Factor of Ī₁ − 3 [Pa].
    pub c10: f64,
    /// Factor of (Ī₁ − 3)² [Pa].
    pub c20: f64,
    /// Factor of (Ī₁ − 3)³ [Pa].
    pub c30: f64,
    /// Bulk modulus κ [Pa].
    pub bulk_modulus: f64,
}

impl ElasticLaw for Yeoh {
    #[inline(always)]
    fn response<S: Real>(&self, gradient: &Tensor<S>) -> Response<S> {
        let invariants = Isochoric::new(gradient);
        let stretch = invariants.first() - S::constant(3.0);
        // dW/dI1 = c10 + 2 c20 x + 3 c30 x^2
        let slope = S::constant(self.c10)
            + stretch * (S::constant(2.0 * self.c20) + stretch * S::constant(3.0 * self.c30));
        Response {
            stress_at_constant_volume: invariants.first_gradient().times(slope),
            volume_change: invariants.volume_ratio - S::constant(1.0),
            volume_gradient: invariants.cofactor,
        }
    }

    #[inline(always)]
    fn pressure<S: Real>(&self, volume_change: S) -> S {
        volume_change.scaled(self.bulk_modulus)
    }

    fn energy_at_constant_volume(&self, gradient: &Tensor<f64>) -> f64 {
        let x = Isochoric::new(gradient).first() - 3.0;
        x * (self.c10 + x * (self.c20 + x * self.c30))
    }

    fn volume_energy(&self, volume_change: f64) -> f64 {
        0.5 * self.bulk_modulus * volume_change * volume_change
    }

    fn lame(&self) -> (f64, f64) {
        lame_of_bulk(self.bulk_modulus, 2.0 * self.c10)
    }
}
