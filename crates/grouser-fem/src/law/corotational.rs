//! Corotational linear elasticity: Hooke's law in the frame R of the polar decomposition F = R S.
//!
//! With ψ = μ |F − R|² + λ/2 (tr S − 3)² the stress P = 2μ (F − R) + λ (tr S − 3) R is its exact derivative, because R is
//! stationary for both terms (Chao, Pinkall, Sanan & Schröder 2010, ACM Trans. Graph. 29, 38): energy and both momenta are kept.

use super::{ElasticLaw, Response};
use crate::number::Real;
use crate::polar::rotation;
use crate::tensor::Tensor;

/// Hooke's law with the Biot strain S − I.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corotational {
    /// First Lamé parameter λ [Pa].
    pub lambda: f64,
    /// Shear modulus μ [Pa].
    pub mu: f64,
}

impl ElasticLaw for Corotational {
    #[inline(always)]
    fn response<S: Real>(&self, gradient: &Tensor<S>) -> Response<S> {
        let f = *gradient + Tensor::identity();
        let r = rotation(&f);
        Response {
            stress_at_constant_volume: (f - r).times(S::constant(2.0 * self.mu)),
            volume_change: r.dot(&(f - r)),
            volume_gradient: r,
        }
    }

    #[inline(always)]
    fn pressure<S: Real>(&self, volume_change: S) -> S {
        volume_change.scaled(self.lambda)
    }

    fn energy_at_constant_volume(&self, gradient: &Tensor<f64>) -> f64 {
        let f = *gradient + Tensor::identity();
        let stretch = f - rotation(&f);
        self.mu * stretch.dot(&stretch)
    }

    fn volume_energy(&self, volume_change: f64) -> f64 {
        0.5 * self.lambda * volume_change * volume_change
    }

    fn lame(&self) -> (f64, f64) {
        (self.lambda, self.mu)
    }
}
