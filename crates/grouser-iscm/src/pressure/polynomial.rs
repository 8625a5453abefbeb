//! p = c₁ z + c₂ z² + …

use serde::{Deserialize, Serialize};

use super::PressureError;

/// Polynomial of the sinkage without constant term.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Polynomial {
    /// Coefficients c₁, c₂, … \[Pa/m, Pa/m², …\].
    pub coefficients: Vec<f64>,
}

impl Polynomial {
    /// Pressure \[Pa\] at `sinkage` \[m\].
    pub fn pressure(&self, sinkage: f64) -> f64 {
        self.coefficients.iter().rev().fold(0.0, |sum, c| (sum + c) * sinkage)
    }

    pub(super) fn check(&self) -> Result<(), PressureError> {
        let (law, parameter) = ("polynomial", "coefficient");
        match self.coefficients.iter().find(|c| !c.is_finite()) {
            Some(&value) => {
                Err(PressureError::Parameter { law, parameter, value, expected: "a finite value" })
            }
            None if self.coefficients.is_empty() => Err(PressureError::None),
            None => Ok(()),
        }
    }
}
