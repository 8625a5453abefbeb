//! Measurements that a scene is compared with: published numbers, each with where they are from.

use serde::{Deserialize, Serialize};

/// Kinds of measurements.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Reference {
    /// Mean pressure under plates against their sinkage.
    PressureSinkage(PressureSinkage),
    /// A wheel at steady state against its slip.
    Wheel(WheelMeasured),
}

impl Reference {
    /// The plate curves, when it is such.
    pub fn plates(&self) -> Option<&PressureSinkage> {
        match self {
            Reference::PressureSinkage(measured) => Some(measured),
            Reference::Wheel(_) => None,
        }
    }

    /// The wheel, when it is such.
    pub fn wheel(&self) -> Option<&WheelMeasured> {
        match self {
            Reference::PressureSinkage(_) => None,
            Reference::Wheel(measured) => Some(measured),
        }
    }

    /// Where it is from.
    pub fn source(&self) -> &str {
        match self {
            Reference::PressureSinkage(measured) => &measured.source,
            Reference::Wheel(measured) => &measured.source,
        }
    }
}

/// A wheel of one source.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WheelMeasured {
    /// Who measured it, and where it is published.
    pub source: String,
    /// Steady states.
    pub points: Vec<WheelPoint>,
}

/// A measured steady state.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WheelPoint {
    /// Slip (ωR − v)/(ωR) [-].
    pub slip: f64,
    /// Undisturbed surface minus lowest point of the wheel [m].
    pub sinkage_m: f64,
    /// Drawbar pull over load [-].
    pub pull_over_load: f64,
}

/// Plate curves of one source.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PressureSinkage {
    /// Who measured it, and where it is published.
    pub source: String,
    /// One curve a plate.
    pub plates: Vec<PlateCurve>,
}

/// Mean pressure under one plate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlateCurve {
    /// Diameter of the plate [m].
    pub diameter_m: f64,
    /// Sinkage [m] and mean pressure [Pa], by rising sinkage.
    pub points: Vec<(f64, f64)>,
}
