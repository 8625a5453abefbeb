//! Sixteen headings over flat ground: rolling resistance and ruts must not know the grid.

use super::{Row, bogie, ground};
use crate::equilibrium::SearchSettings;
use crate::machine::Machine;
use crate::route::Route;
use crate::run::{RunSettings, RunState};
use std::f64::consts::TAU;

/// Rolling resistance and sinkage over the last third of a short drive, for each heading.
fn drives(machine: &Machine, spacing: f64) -> Vec<[f64; 2]> {
    (0..16)
        .map(|k| {
            let heading = TAU * f64::from(k) / 16.0;
            let along = |s: f64| [0.0017 + s * heading.cos(), 0.0043 + s * heading.sin()];
            let settings = RunSettings {
                route: Route { points: vec![along(0.0), along(0.31)] },
                run_step: 0.06,
                intermediate_steps: 5,
                search: SearchSettings { position_tolerance: 1e-6, ..SearchSettings::default() },
            };
            let terrain = ground(spacing, [-2.2, -2.2], [4.4, 4.4], |_, _| 0.0);
            let run = || -> Option<[f64; 2]> {
                let mut state = RunState::start(machine, terrain, &settings).ok()?;
                let (mut coefficient, mut height, mut n) = (0.0, 0.0, 0.0);
                while state.can_go_on(&settings) {
                    let step = state.step(machine, &settings).ok()?;
                    if step.distance > 0.15 {
                        coefficient += step.total.coefficient();
                        height += 0.5 - step.configuration.height;
                        n += 1.0;
                    }
                }
                Some([coefficient / n, height / n])
            };
            run().unwrap_or([f64::NAN; 2])
        })
        .collect()
}

/// Cells at the edges of the gear remember which share of them it pressed; plates of a track also begin and end within cells along it.
fn rows(case: &'static str, machine: &Machine, [force, sinkage]: [f64; 2]) -> Vec<Row> {
    let drives = drives(machine, 0.02);
    let mean = |k: usize| drives.iter().map(|d| d[k]).sum::<f64>() / drives.len() as f64;
    let farthest = |k: usize| drives.iter().map(|d| (d[k] - mean(k)).abs()).fold(0.0, f64::max);
    // A sum, so that a failed drive shows as no number.
    let all = 0.0 * drives.iter().flatten().sum::<f64>();
    let source = "mean of 16 headings";
    let row = |quantity, computed, tolerance| Row::new(case, quantity, computed, 0.0, tolerance, "-", source);
    vec![
        row("largest deviation of F_R per load", farthest(0) + all, force),
        row("largest deviation of the sinkage per mean", farthest(1) / mean(1) + all, sinkage),
    ]
}

/// A bogie on wheels.
pub fn wheeled() -> Vec<Row> {
    rows("P2 test 22: drive direction, wheels", &bogie(4_000.0, None), [0.001, 0.001])
}

/// A bogie with a track.
pub fn tracked() -> Vec<Row> {
    rows("P2 test 23: drive direction, track", &bogie(4_000.0, Some(10.0)), [0.002, 0.004])
}
