//! Linear elasticity of small strains: σ = 2μ ε + λ tr(ε) I (P0 Eq. 29). It cannot rotate; use it in a frame that turns with
//! the body.

use super::{ElasticLaw, Response, hooke};
use crate::number::Real;
use crate::tensor::Tensor;

/// Hooke's law with ε = sym(∂u/∂X).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmallStrain {
    /// First Lamé parameter λ [Pa].
    pub lambda: f64,
    /// Shear modulus μ [Pa].
    pub mu: f64,
}

impl ElasticLaw for SmallStrain {
    #[inline(always)]
    fn response<S: Real>(&self, gradient: &Tensor<S>) -> Response<S> {
        Response {
            stress_at_constant_volume: gradient.symmetric().times(S::constant(2.0 * self.mu)),
            volume_change: gradient.trace(),
            volume_gradient: Tensor::identity(),
        }
    }

    #[inline(always)]
    fn pressure<S: Real>(&self, volume_change: S) -> S {
        volume_change.scaled(self.lambda)
    }

    fn energy_at_constant_volume(&self, gradient: &Tensor<f64>) -> f64 {
        let strain = gradient.symmetric();
        self.mu * strain.dot(&strain)
    }

    fn volume_energy(&self, volume_change: f64) -> f64 {
        0.5 * self.lambda * volume_change * volume_change
    }

    #[inline(always)]
    fn viscous_stress<S: Real>(&self, _: &Tensor<S>, rate: &Tensor<S>, beta: f64) -> Tensor<S> {
        hooke(self.lame(), &rate.symmetric()).times(S::constant(beta))
    }

    fn lame(&self) -> (f64, f64) {
        (self.lambda, self.mu)
    }
}
