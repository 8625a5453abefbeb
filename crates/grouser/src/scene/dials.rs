//! The dials between speed and accuracy.

use serde::{Deserialize, Serialize};

/// Choices that change cost and accuracy but not what the scene is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Dials {
    /// Time step over the smallest critical step of every criterion [-].
    pub time_step_fraction: f64,
    /// What happens while the dashpot would pull two parting grains together.
    pub restitution_tail: RestitutionTail,
    /// How grains rotate.
    pub rotation: Rotation,
    /// Scalars that grains are computed with.
    pub precision: Precision,
}

impl Default for Dials {
    fn default() -> Self {
        Dials {
            time_step_fraction: 0.2,
            restitution_tail: RestitutionTail::default(),
            rotation: Rotation::default(),
            precision: Precision::default(),
        }
    }
}

/// End of a damped normal contact.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum RestitutionTail {
    /// The contact lasts until the overlap is zero; the force may pull shortly. Restitution is met exactly.
    Keep,
    /// The force never pulls; damping is corrected so that the restitution asked for is the one obtained.
    #[default]
    CutCorrected,
}

/// How grains rotate.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Rotation {
    /// As spheres do.
    #[default]
    Free,
    /// Not at all: an upper bound of strength.
    Fixed,
}

/// Scalars that grains are computed with.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Precision {
    /// Double precision throughout.
    #[default]
    F64,
    /// Positions and their differences in double precision, contacts and motion in single precision.
    Mixed,
    /// Single precision throughout: overlaps are differences of rounded positions.
    F32,
}
