//! A single rigid wheel, and the slips at which it is driven.

use serde::{Deserialize, Serialize};

/// A smooth rigid wheel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RigidWheel {
    /// Radius [m].
    pub radius_m: f64,
    /// Width [m].
    pub width_m: f64,
}

/// Steady states, one a slip.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Slips {
    /// Slip and load of each.
    pub points: Vec<SlipPoint>,
    /// Cells of ground in a radius of the wheel, for the grid.
    #[serde(default = "many_cells")]
    pub cells_per_radius: f64,
}

/// One steady state.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SlipPoint {
    /// Slip (ωR − v)/(ωR) [-].
    pub slip: f64,
    /// Vertical load [N].
    pub load_n: f64,
}

fn many_cells() -> f64 {
    64.0
}
