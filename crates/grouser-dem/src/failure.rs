//! Numerical failure: a named value, found between phases.

use grouser_geometry::Vec3;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Why a bed cannot go on.
#[derive(Clone, Copy, Debug, PartialEq, Error, Serialize, Deserialize)]
pub enum Failure {
    /// A position, velocity or spin is infinite or not a number.
    #[error("the motion of grain {grain} is not a finite number")]
    NonFinite {
        /// Permanent number of the grain.
        grain: u32,
    },
    /// Two bodies overlap further than any contact law means.
    #[error(
        "grain {grain} at ({:.4}, {:.4}, {:.4}) m overlaps its partner by {:.0} % of the smaller radius",
        .position.x, .position.y, .position.z, 100.0 * .depth
    )]
    OverlapTooLarge {
        /// Permanent number of the grain.
        grain: u32,
        /// Its centre [m].
        position: Vec3,
        /// Overlap over the smaller radius [-].
        depth: f64,
    },
    /// A grain left the box.
    #[error("grain {grain} left the box at ({:.4}, {:.4}, {:.4}) m", .position.x, .position.y, .position.z)]
    Lost {
        /// Permanent number of the grain.
        grain: u32,
        /// Its centre [m].
        position: Vec3,
    },
}

impl Failure {
    /// What to do about it.
    pub fn remedy(&self) -> &'static str {
        match self {
            Self::NonFinite { .. } => {
                "reduce the time-step fraction; look for coincident grains and extreme speeds"
            }
            Self::OverlapTooLarge { .. } => {
                "raise Young's modulus (the bed is too soft for its load), slow the tool down, or reduce the time step"
            }
            Self::Lost { .. } => {
                "close the box with walls or make it higher; reduce the time step if walls are closed"
            }
        }
    }
}
