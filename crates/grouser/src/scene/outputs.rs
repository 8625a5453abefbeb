//! What a run writes, and how often.

use serde::{Deserialize, Serialize};

/// Intervals of simulated time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Outputs {
    /// One row of the time series [s].
    pub sample_every_s: f64,
    /// One VTK frame [s].
    pub vtk_every_s: f64,
    /// One checkpoint [s].
    pub checkpoint_every_s: f64,
}

impl Default for Outputs {
    fn default() -> Self {
        Outputs { sample_every_s: 1e-3, vtk_every_s: 5e-2, checkpoint_every_s: 0.1 }
    }
}
