//! Invariants of the deformation at constant volume, J^(−1/3) F, and their derivatives by F
//! (Holzapfel 2000, Nonlinear Solid Mechanics, section 6.4).

use crate::number::Real;
use crate::tensor::Tensor;

/// Modified invariants Ī₁ = J^(−2/3) I₁ and Ī₂ = J^(−4/3) I₂ with gradients.
pub struct Isochoric<S> {
    /// Deformation gradient F.
    f: Tensor<S>,
    /// F⁻ᵀ.
    inverse_transposed: Tensor<S>,
    /// J.
    pub volume_ratio: S,
    /// Cofactors of F, ∂J/∂F.
    pub cofactor: Tensor<S>,
    /// J^(−2/3).
    scale: S,
    /// I₁ = F : F.
    first: S,
}

impl<S: Real> Isochoric<S> {
    /// Invariants of the displacement gradient H = F − I.
    #[inline(always)]
    pub fn new(gradient: &Tensor<S>) -> Self {
        let f = *gradient + Tensor::identity();
        let (cofactor, volume_ratio) = (f.cofactor(), f.determinant());
        let root = volume_ratio.cbrt();
        Self {
            f,
            inverse_transposed: cofactor.times(S::constant(1.0) / volume_ratio),
            volume_ratio,
            cofactor,
            scale: S::constant(1.0) / (root * root),
            first: f.dot(&f),
        }
    }

    /// Ī₁.
    #[inline(always)]
    pub fn first(&self) -> S {
        self.scale * self.first
    }

    /// ∂Ī₁/∂F = 2 J^(−2/3) (F − I₁/3 F⁻ᵀ).
    #[inline(always)]
    pub fn first_gradient(&self) -> Tensor<S> {
        (self.f - self.inverse_transposed.times(self.first.scaled(1.0 / 3.0))).times(self.scale.scaled(2.0))
    }

    /// Ī₂, with I₂ = (I₁² − C:C)/2 and C = FᵀF.
    #[inline(always)]
    pub fn second(&self) -> S {
        let c = self.f.transpose() * self.f;
        self.scale * self.scale * (self.first * self.first - c.dot(&c)).scaled(0.5)
    }

    /// ∂Ī₂/∂F = 2 J^(−4/3) (I₁ F − F C − 2/3 I₂ F⁻ᵀ).
    #[inline(always)]
    pub fn second_gradient(&self) -> Tensor<S> {
        let c = self.f.transpose() * self.f;
        let second = (self.first * self.first - c.dot(&c)).scaled(0.5);
        (self.f.times(self.first) - self.f * c - self.inverse_transposed.times(second.scaled(2.0 / 3.0)))
            .times((self.scale * self.scale).scaled(2.0))
    }
}
