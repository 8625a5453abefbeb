//! Reece's relationship, A. R. Reece, *Proc. IMechE* 180 (1965) 45.

use serde::{Deserialize, Serialize};

use super::{PressureError, positive};

/// p = (c k′_c + γ b k′_φ) (z/b)ⁿ: the moduli are dimensionless.
///
/// ```
/// use grouser_iscm::pressure::Reece;
/// // At z = b the power is one: p = 1000·20 + 15000·0.1·30.
/// let soil = Reece {
///     cohesion: 1e3, unit_weight: 15e3, cohesive_modulus: 20.0, frictional_modulus: 30.0, exponent: 0.8, plate_width: 0.1,
/// };
/// assert!((soil.pressure(0.1) - 65e3).abs() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reece {
    /// Cohesion c \[Pa\].
    pub cohesion: f64,
    /// Weight per volume γ \[N/m³\].
    pub unit_weight: f64,
    /// Cohesive modulus k′_c \[-\].
    pub cohesive_modulus: f64,
    /// Frictional modulus k′_φ \[-\].
    pub frictional_modulus: f64,
    /// Exponent n \[-\].
    pub exponent: f64,
    /// Width of the loaded area b \[m\].
    pub plate_width: f64,
}

impl Reece {
    /// Pressure \[Pa\] at `sinkage` \[m\].
    pub fn pressure(&self, sinkage: f64) -> f64 {
        self.modulus() * (sinkage / self.plate_width).powf(self.exponent)
    }

    /// c k′_c + γ b k′_φ \[Pa\].
    pub fn modulus(&self) -> f64 {
        self.cohesion * self.cohesive_modulus + self.unit_weight * self.plate_width * self.frictional_modulus
    }

    pub(super) fn check(&self) -> Result<(), PressureError> {
        positive("Reece", "exponent", self.exponent)?;
        positive("Reece", "plate_width", self.plate_width)?;
        positive("Reece", "cohesion·k′_c + γ b k′_φ", self.modulus())
    }
}
