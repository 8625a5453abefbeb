//! A column of grains that loses its support.

use serde::{Deserialize, Serialize};

/// Everything beyond a column is taken away at once, down to the grains on the floor; the column slides into a slope.
///
/// The column stands between the wall at x = 0 and x = `column_m`. Grains that lie on the floor are held where they are, over the
/// whole length of the container: a floor as rough as the bed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Collapse {
    /// Length of the column along x [m].
    pub column_m: f64,
    /// The slope is at rest when its kinetic energy over Σ m g r is below this [-].
    #[serde(default = "energy_ratio")]
    pub energy_ratio: f64,
    /// Time after which the slope is measured even if it still moves [s].
    pub longest_s: f64,
}

fn energy_ratio() -> f64 {
    1e-3
}
