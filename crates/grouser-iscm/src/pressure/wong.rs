//! Wong's relationship for organic ground with a surface mat, J. Y. Wong, *Theory of Ground Vehicles*, 4th ed., 2008, §2.4.

use serde::{Deserialize, Serialize};

use super::{PressureError, positive};

/// p = k_p z + 4 m_m z²/D_h: peat below, a mat of living roots above.
///
/// ```
/// use grouser_iscm::pressure::Wong;
/// let muskeg = Wong { peat_stiffness: 407e3, mat_strength: 97e3, hydraulic_diameter: 0.3 };
/// assert!((muskeg.pressure(0.1) - (40.7e3 + 4.0 * 97e3 * 0.01 / 0.3)).abs() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wong {
    /// Stiffness of the peat k_p \[Pa/m\].
    pub peat_stiffness: f64,
    /// Strength of the surface mat m_m \[Pa/m\].
    pub mat_strength: f64,
    /// Hydraulic diameter of the loaded area D_h = 4 area/perimeter \[m\].
    pub hydraulic_diameter: f64,
}

impl Wong {
    /// Pressure \[Pa\] at `sinkage` \[m\].
    pub fn pressure(&self, sinkage: f64) -> f64 {
        let (k_p, m_m, d_h) = (self.peat_stiffness, self.mat_strength, self.hydraulic_diameter);
        k_p * sinkage + 4.0 / d_h * m_m * sinkage * sinkage
    }

    pub(super) fn check(&self) -> Result<(), PressureError> {
        positive("Wong", "peat_stiffness", self.peat_stiffness)?;
        positive("Wong", "hydraulic_diameter", self.hydraulic_diameter)?;
        if self.mat_strength.is_finite() && self.mat_strength >= 0.0 {
            return Ok(());
        }
        let value = self.mat_strength;
        Err(PressureError::Parameter {
            law: "Wong",
            parameter: "mat_strength",
            value,
            expected: "a finite value of zero or more",
        })
    }
}
