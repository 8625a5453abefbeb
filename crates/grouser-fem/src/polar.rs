//! Polar decomposition F = R S by Newton's iteration (Higham 1986, SIAM J. Sci. Stat. Comput. 7, 1160).

use crate::number::Real;
use crate::tensor::Tensor;

/// Rotation R of the polar decomposition of `f`, whose determinant must be positive.
///
/// R ← (R + R⁻ᵀ)/2 converges quadratically from F; the iteration ends once a step changes R by less than 1e-8, which leaves
/// an error of 1e-16. Never more than 20 rounds: an inverted F is told by its determinant, not here.
#[inline(always)]
pub fn rotation<S: Real>(f: &Tensor<S>) -> Tensor<S> {
    let mut r = *f;
    for _ in 0..20 {
        let cofactor = r.cofactor();
        let determinant =
            r.0[0][0] * cofactor.0[0][0] + r.0[0][1] * cofactor.0[0][1] + r.0[0][2] * cofactor.0[0][2];
        let inverse_transposed = cofactor.times(S::constant(1.0) / determinant);
        let next = (r + inverse_transposed).times(S::constant(0.5));
        let change = next - r;
        r = next;
        if !S::norm_above(&change.0, 1e-8) {
            break;
        }
    }
    r
}

#[cfg(test)]
mod tests {
    use grouser_geometry::Vec3;
    use grouser_geometry::nalgebra::{Matrix3, Rotation3};
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_rotation_is_found_again_from_its_product_with_a_stretch(
            axis in prop::array::uniform3(-3.0..3.0f64),
            stretch in prop::array::uniform3(0.2..3.0f64),
            tilt in prop::array::uniform3(-3.0..3.0f64),
        ) {
            let r = Rotation3::new(Vec3::from(axis)).into_inner();
            let q = Rotation3::new(Vec3::from(tilt)).into_inner();
            let s = q * Matrix3::from_diagonal(&Vec3::from(stretch)) * q.transpose();
            let found = rotation(&Tensor::from_matrix(&(r * s))).to_matrix();
            prop_assert!((found - r).norm() < 1e-13);
        }
    }
}
