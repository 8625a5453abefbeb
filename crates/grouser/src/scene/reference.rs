//! Measurements that a scene is compared with: published numbers, each with where they are from.

use serde::{Deserialize, Serialize};

/// Kinds of measurements.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Reference {
    /// Mean pressure under plates against their sinkage.
    PressureSinkage(PressureSinkage),
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
