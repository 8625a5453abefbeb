//! Bekker's relationship, M. G. Bekker, *Introduction to Terrain-Vehicle Systems*, 1969.

use serde::{Deserialize, Serialize};

use super::{PressureError, positive};

/// p = (k_c/b + k_φ) zⁿ.
///
/// ```
/// use grouser_iscm::pressure::Bekker;
/// // LETE sand (Wong 2008, Table 2.3) under a plate of b = 0.05 m at 0.02 m: 333.86 kPa.
/// let sand = Bekker { cohesive_modulus: 102e3, frictional_modulus: 5301e3, exponent: 0.79, plate_width: 0.05 };
/// assert!((sand.pressure(0.02) - 333.86e3).abs() < 5.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bekker {
    /// Cohesive modulus k_c \[Pa/m^(n−1)\]; may be negative where fitted.
    pub cohesive_modulus: f64,
    /// Frictional modulus k_φ \[Pa/mⁿ\].
    pub frictional_modulus: f64,
    /// Exponent n \[-\].
    pub exponent: f64,
    /// Smaller side of the loaded area, or radius of a circular plate, b \[m\].
    pub plate_width: f64,
}

impl Bekker {
    /// Pressure \[Pa\] at `sinkage` \[m\].
    pub fn pressure(&self, sinkage: f64) -> f64 {
        self.modulus() * sinkage.powf(self.exponent)
    }

    /// k_c/b + k_φ \[Pa/mⁿ\].
    pub fn modulus(&self) -> f64 {
        self.cohesive_modulus / self.plate_width + self.frictional_modulus
    }

    pub(super) fn check(&self) -> Result<(), PressureError> {
        positive("Bekker", "exponent", self.exponent)?;
        positive("Bekker", "plate_width", self.plate_width)?;
        positive("Bekker", "cohesive_modulus/plate_width + frictional_modulus", self.modulus())
    }
}
