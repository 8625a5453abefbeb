//! How a run ends.

use super::SetupError;
use crate::output::checkpoint::CheckpointError;
use grouser_dem::Failure;
use std::io;
use thiserror::Error;

/// A run that ended without an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// At the end of the scene.
    Done,
    /// By request, with a checkpoint.
    Interrupted,
}

/// Why a run broke off.
#[derive(Debug, Error)]
pub enum RunError {
    /// The scene cannot be built.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// The motion has become meaningless.
    #[error(
        "{what} (step {step}, {time_s:.6} s{place}); remedy: {remedy}; the last good checkpoint was kept"
    )]
    Numerics {
        /// What happened, to which grain or element.
        what: String,
        /// What to do.
        remedy: String,
        /// Step within its stage.
        step: u64,
        /// Simulated time within its stage [s].
        time_s: f64,
        /// Which stage.
        place: String,
    },
    /// A file cannot be written.
    #[error("{0}; usual cause: no space or no permission; remedy: choose another folder with --out")]
    Output(#[from] io::Error),
    /// The checkpoint cannot be used.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    /// The checkpoint belongs to another scene.
    #[error(
        "the checkpoint in {folder} belongs to another scenario; expected the one that this run was started with; \
         usual cause: the scenario, --quick or --set differ; remedy: repeat the first command with --resume, or run anew"
    )]
    OtherScenario {
        /// The run's folder.
        folder: String,
    },
}

impl RunError {
    /// A failure of the grains' motion.
    pub fn numerics(failure: &Failure, step: u64, time_s: f64, place: &str) -> Self {
        Self::Numerics {
            what: failure.to_string(),
            remedy: failure.remedy().to_string(),
            step,
            time_s,
            place: place.to_owned(),
        }
    }

    /// Exit status of the program: 2 the input is wrong, 3 the numerics failed.
    pub fn exit_status(&self) -> u8 {
        match self {
            Self::Numerics { .. } => 3,
            Self::Setup(SetupError::NotSettled { .. }) => 3,
            _ => 2,
        }
    }
}
