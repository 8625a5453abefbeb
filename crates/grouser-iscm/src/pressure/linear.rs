//! p = k z.

use serde::{Deserialize, Serialize};

use super::{PressureError, positive};

/// Pressure proportional to sinkage.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Linear {
    /// Pressure per sinkage k \[Pa/m\].
    pub stiffness: f64,
}

impl Linear {
    /// Pressure \[Pa\] at `sinkage` \[m\].
    pub fn pressure(&self, sinkage: f64) -> f64 {
        self.stiffness * sinkage
    }

    pub(super) fn check(&self) -> Result<(), PressureError> {
        positive("linear", "stiffness", self.stiffness)
    }
}
