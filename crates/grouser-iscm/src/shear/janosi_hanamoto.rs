//! Shear stress that grows with displacement to the strength of Mohr and Coulomb, Z. Janosi & B. Hanamoto,
//! *Proc. 1st Int. Conf. Mechanics of Soil–Vehicle Systems*, Torino, 1961.

use serde::{Deserialize, Serialize};

use crate::pressure::PressureError;

/// τ = (c + σ tan φ)(1 − exp(−j/K)).
///
/// ```
/// use grouser_iscm::shear::JanosiHanamoto;
/// let sand = JanosiHanamoto { cohesion: 1e3, friction_angle: 0.5, shear_deformation_modulus: 0.01 };
/// assert!((sand.strength(1e4) - (1e3 + 1e4 * 0.5_f64.tan())).abs() < 1e-9);
/// // At j = K the stress is 1 − 1/e of the strength.
/// assert!((sand.stress(1e4, 0.01) / sand.strength(1e4) - 0.632_120_558_8).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JanosiHanamoto {
    /// Cohesion c, or adhesion of a smooth gear \[Pa\].
    pub cohesion: f64,
    /// Angle of internal friction φ, or of friction between gear and ground \[rad\].
    pub friction_angle: f64,
    /// Shear deformation modulus K \[m\].
    pub shear_deformation_modulus: f64,
}

impl JanosiHanamoto {
    /// Largest shear stress \[Pa\] under the normal `pressure` \[Pa\].
    #[inline(always)]
    pub fn strength(&self, pressure: f64) -> f64 {
        self.cohesion + pressure * self.friction_angle.tan()
    }

    /// Shear stress \[Pa\] under the normal `pressure` \[Pa\] after a shear displacement of `displacement` ≥ 0 \[m\].
    #[inline(always)]
    pub fn stress(&self, pressure: f64, displacement: f64) -> f64 {
        // exp_m1 keeps all digits where the displacement is small.
        -self.strength(pressure) * (-displacement / self.shear_deformation_modulus).exp_m1()
    }

    /// Refuses parameters without meaning.
    pub fn check(&self) -> Result<(), PressureError> {
        let law = "Janosi–Hanamoto";
        super::super::pressure::positive(law, "shear_deformation_modulus", self.shear_deformation_modulus)?;
        let bad =
            |parameter, value, expected| Err(PressureError::Parameter { law, parameter, value, expected });
        if !(self.cohesion.is_finite() && self.cohesion >= 0.0) {
            return bad("cohesion", self.cohesion, "a finite value of zero or more");
        }
        if !(0.0..std::f64::consts::FRAC_PI_2).contains(&self.friction_angle) {
            return bad("friction_angle", self.friction_angle, "an angle from 0 to below π/2 rad");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SAND: JanosiHanamoto =
        JanosiHanamoto { cohesion: 500.0, friction_angle: 0.5, shear_deformation_modulus: 0.012 };

    #[test]
    fn the_stress_starts_along_the_tangent_and_never_exceeds_the_strength() {
        let (p, step) = (8e3, 1e-9);
        assert_eq!(SAND.stress(p, 0.0), 0.0);
        let slope = SAND.stress(p, step) / step;
        assert!((slope / (SAND.strength(p) / 0.012) - 1.0).abs() < 1e-6);
        assert!((0..200).all(|k| SAND.stress(p, f64::from(k) * 0.01) <= SAND.strength(p)));
    }

    #[test]
    fn parameters_without_meaning_are_refused() {
        for bad in [
            JanosiHanamoto { cohesion: -1.0, ..SAND },
            JanosiHanamoto { friction_angle: 29.0, ..SAND },
            JanosiHanamoto { shear_deformation_modulus: 0.0, ..SAND },
            JanosiHanamoto { cohesion: f64::NAN, ..SAND },
        ] {
            assert!(bad.check().is_err(), "{bad:?}");
        }
        assert!(SAND.check().is_ok());
    }
}
