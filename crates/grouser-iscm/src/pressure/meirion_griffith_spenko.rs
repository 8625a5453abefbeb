//! Relationship for wheels of small diameter, G. Meirion-Griffith & M. Spenko, *J. Terramechanics* 50 (2013) 37.

use serde::{Deserialize, Serialize};

use super::{PressureError, positive};

/// p = k zⁿ Dᵐ with the wheel's diameter D.
///
/// ```
/// use grouser_iscm::pressure::MeirionGriffithSpenko;
/// let law = MeirionGriffithSpenko { modulus: 1e6, exponent: 1.0, diameter_exponent: 0.5, diameter: 0.25 };
/// assert!((law.pressure(0.02) - 1e4).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeirionGriffithSpenko {
    /// Modulus k \[Pa/m^(n+m)\].
    pub modulus: f64,
    /// Exponent of the sinkage n \[-\].
    pub exponent: f64,
    /// Exponent of the diameter m \[-\].
    pub diameter_exponent: f64,
    /// Diameter of the wheel D \[m\].
    pub diameter: f64,
}

impl MeirionGriffithSpenko {
    /// Pressure \[Pa\] at `sinkage` \[m\].
    pub fn pressure(&self, sinkage: f64) -> f64 {
        self.modulus * sinkage.powf(self.exponent) * self.diameter.powf(self.diameter_exponent)
    }

    pub(super) fn check(&self) -> Result<(), PressureError> {
        positive("Meirion-Griffith & Spenko", "modulus", self.modulus)?;
        positive("Meirion-Griffith & Spenko", "exponent", self.exponent)?;
        positive("Meirion-Griffith & Spenko", "diameter", self.diameter)
    }
}
