//! A tire that sinks into a bed and rolls over it: rigid, or an elastic tread on a rim.

mod axle;
mod body;
mod elastic_tire;
mod ledger;
mod outcome;
mod pictures;
mod tire_run;
mod traction;
mod tread;

pub use tire_run::TireRun;
pub use tread::{TreadError, shape};

use crate::scene::{Motion, Roll, Scenario, Tire, Tool};

/// Tire and motion of a scene that has both.
pub fn parts(scenario: &Scenario) -> Option<(&Tire, &Roll)> {
    match (&scenario.tool, &scenario.motion) {
        (Some(Tool::Tire(tire)), Some(Motion::Roll(roll))) => Some((tire, roll)),
        _ => None,
    }
}
