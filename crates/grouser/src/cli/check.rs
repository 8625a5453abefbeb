//! `grouser check`: what a scene is and what it will cost.

use super::{FAILED, Scene};
use crate::run::{Estimate, estimate};
use crate::scene::resolved;

pub(super) fn check(scene: &Scene) -> u8 {
    let scenario = match scene.read() {
        Ok(scenario) => scenario,
        Err(status) => return status,
    };
    print!("{}", resolved(&scenario));
    match estimate(&scenario) {
        Ok(estimate) => {
            println!("\n{}", described(&estimate));
            0
        }
        Err(error) => {
            eprintln!("error: {error}");
            FAILED
        }
    }
}

/// The estimate in a few lines.
pub(super) fn described(estimate: &Estimate) -> String {
    let wall = estimate.wall.map(|wall| ("run time", format!("about {:.0} s", wall.as_secs_f64())));
    let lines = estimate.lines.iter().cloned().chain(wall);
    lines.map(|(name, text)| format!("{name:<11} {text}")).collect::<Vec<_>>().join("\n")
}
