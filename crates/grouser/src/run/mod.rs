//! Running a scene: the bed, the tools, and the files that a run leaves.

mod bed;
mod cache;
mod clock;
mod collapse;
mod collapse_outcome;
mod compose;
mod drive;
mod driver;
mod driving;
mod driving_outcome;
mod ended;
mod estimate;
mod experiment;
mod frames;
mod indenter;
mod law;
mod leave;
mod level;
mod materials;
mod on_bed;
mod press;
mod press_outcome;
mod progress;
mod report;
mod rigid_tool;
mod slip_outcome;
mod slip_sweep;
mod slope;
mod study;
mod study_outcome;
mod time_step;
mod tire;
mod tool_ledger;
mod vehicle_frames;
mod zone;

pub use bed::SETTLED_SOLID_FRACTION;
pub use compose::run;
pub use driver::Options;
pub use ended::{Ended, RunError};
pub use estimate::{Estimate, estimate};
pub use experiment::{Advanced, Experiment, Outcome, Picture, Section, Status, Verdict};
pub use law::{Law, LawBed, Possible, WithLaw, with_law};
pub use materials::Materials;
pub use on_bed::{OnBed, Pass};
pub use press::Pressing;
pub use progress::{Progress, Stage};
pub use time_step::{COLLISION_FRACTION, TRAVEL_FRACTION, time_step};
pub use tire::shape;
pub use tool_ledger::ToolLedger;

use grouser_contact::ParameterError;
use grouser_dem::{BedError, PackingError};

/// Why a checked scenario cannot be built after all.
#[derive(Debug, thiserror::Error)]
pub enum SetupError {
    /// A material constant.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// The packing.
    #[error(transparent)]
    Packing(#[from] PackingError),
    /// The bed.
    #[error(transparent)]
    Bed(#[from] BedError),
    /// The settled bed.
    #[error("the settled bed cannot be used: {0}; remedy: {remedy}", remedy = .0.remedy())]
    Motion(#[from] grouser_dem::Failure),
    /// The shape of a tool.
    #[error(transparent)]
    Shape(#[from] grouser_geometry::generate::ShapeError),
    /// The motion of a tool.
    #[error(transparent)]
    Rigid(#[from] grouser_rigid::RigidError),
    /// Soft ground, a vehicle on it, or its start.
    #[error("{0}")]
    Vehicle(String),
    /// The tread of a tire.
    #[error(transparent)]
    Tire(#[from] tire::TreadError),
    /// The file of a tool's surface.
    #[error("{0}")]
    Mesh(String),
    /// A single wheel and its ground.
    #[error("{0}")]
    Wheel(String),
    /// A variant of a study.
    #[error("{0}")]
    Variant(String),
    /// The settling bed did not come to rest.
    #[error(
        "the bed did not settle within {longest_s} s: kinetic energy over Σ m g r is {ratio:.1e}, expected {asked:.1e}; \
         usual cause: grains that lose too little (restitution near 1) or a very deep bed; \
         remedy: raise soil.settle.longest_s, or lower the restitution"
    )]
    NotSettled {
        /// Time allowed [s].
        longest_s: f64,
        /// Ratio reached [-].
        ratio: f64,
        /// Ratio asked for [-].
        asked: f64,
    },
}
