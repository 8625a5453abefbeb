//! Compressible neo-Hookean solid in Ciarlet's polyconvex form:
//! ψ = μ/2 (F:F − 3) − μ ln J + λ/4 (J² − 1 − 2 ln J) (Ciarlet 1988, Mathematical Elasticity I, section 4.10).

use super::{ElasticLaw, Response};
use crate::number::Real;
use crate::tensor::Tensor;

/// Neo-Hookean law of Lamé parameters λ, μ; Hooke's law at small strain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeoHookean {
    /// First Lamé parameter λ [Pa].
    pub lambda: f64,
    /// Shear modulus μ [Pa].
    pub mu: f64,
}

impl ElasticLaw for NeoHookean {
    #[inline(always)]
    fn response<S: Real>(&self, gradient: &Tensor<S>) -> Response<S> {
        let f = *gradient + Tensor::identity();
        let cofactor = f.cofactor();
        let volume_ratio = f.determinant();
        Response {
            stress_at_constant_volume: (f - cofactor.times(S::constant(1.0) / volume_ratio))
                .times(S::constant(self.mu)),
            volume_change: volume_ratio - S::constant(1.0),
            volume_gradient: cofactor,
        }
    }

    #[inline(always)]
    fn pressure<S: Real>(&self, volume_change: S) -> S {
        let one = S::constant(1.0);
        let ratio = volume_change + one;
        (ratio - one / ratio).scaled(0.5 * self.lambda)
    }

    fn energy_at_constant_volume(&self, gradient: &Tensor<f64>) -> f64 {
        let f = *gradient + Tensor::identity();
        self.mu * (0.5 * (f.dot(&f) - 3.0) - f.determinant().ln())
    }

    fn volume_energy(&self, volume_change: f64) -> f64 {
        let ratio = 1.0 + volume_change;
        0.25 * self.lambda * (ratio * ratio - 1.0 - 2.0 * ratio.ln())
    }

    fn lame(&self) -> (f64, f64) {
        (self.lambda, self.mu)
    }
}
