//! Sixteen headings over flat ground: rolling resistance and ruts must not know the grid.

use super::{Row, bogie, ground};
use crate::equilibrium::SearchSettings;
use crate::machine::Machine;
use crate::route::Route;
use crate::run::{RunSettings, RunState};
use std::f64::consts::TAU;

/// Length of a drive \[m\].
const LENGTH: f64 = 0.7;
/// Where the means begin \[m\].
const FROM: f64 = 0.15;

/// F_R per load and sinkage \[m\] of gear that reaches `radius` \[m\] below the axle, means over a drive in each heading.
///
/// The run step is no multiple of the spacing: along the grid, gear would meet the same few places of its cells again and again.
fn drives(machine: &Machine, radius: f64, spacing: f64) -> Vec<[f64; 2]> {
    (0..16)
        .map(|k| {
            let heading = TAU * f64::from(k) / 16.0;
            let along = |s: f64| [0.0017 + s * heading.cos(), 0.0043 + s * heading.sin()];
            let settings = RunSettings {
                route: Route { points: vec![along(0.0), along(LENGTH)] },
                run_step: 0.0613,
                intermediate_steps: 5,
                search: SearchSettings { position_tolerance: 1e-6, ..SearchSettings::default() },
            };
            let half = LENGTH + 1.8;
            let terrain = ground(spacing, [-half, -half], [2.0 * half, 2.0 * half], |_, _| 0.0);
            let run = || -> Option<[f64; 2]> {
                let mut state = RunState::start(machine, terrain, &settings).ok()?;
                let (mut coefficient, mut sinkage, mut n) = (0.0, 0.0, 0.0);
                while state.can_go_on(&settings) {
                    let step = state.step(machine, &settings).ok()?;
                    if step.distance > FROM {
                        coefficient += step.total.coefficient();
                        sinkage += radius - step.configuration.height;
                        n += 1.0;
                    }
                }
                Some([coefficient / n, sinkage / n])
            };
            run().unwrap_or([f64::NAN; 2])
        })
        .collect()
}

/// A thousandth of the load and a thousandth of the sinkage.
fn rows(case: &'static str, drives: &[[f64; 2]]) -> Vec<Row> {
    let mean = |k: usize| drives.iter().map(|d| d[k]).sum::<f64>() / drives.len() as f64;
    let farthest = |k: usize| drives.iter().map(|d| (d[k] - mean(k)).abs()).fold(0.0, f64::max);
    // A sum, so that a failed drive shows as no number.
    let all = 0.0 * drives.iter().flatten().sum::<f64>();
    let row = |quantity: &str, computed| {
        Row::new(case, quantity, computed + all, 0.0, 1e-3, "-", "mean of 16 headings")
    };
    vec![
        row("largest deviation of F_R per load", farthest(0)),
        row("largest deviation of the sinkage per mean", farthest(1) / mean(1)),
    ]
}

/// A bogie on wheels.
pub fn wheeled() -> Vec<Row> {
    let case = "P2 test 22: drive direction, wheels";
    let drives = drives(&bogie(4_000.0, None), 0.5, 0.01);
    let mut rows = rows(case, &drives);
    let mean = drives.iter().map(|d| d[0]).sum::<f64>() / drives.len() as f64;
    rows[0].quantity = "largest deviation of F_R per mean".into();
    rows[0].computed /= mean;
    rows
}

/// A bogie with a track, whose F_R is a hundredth of its load: what a heading across the grid smears over cells is told of the load.
pub fn tracked() -> Vec<Row> {
    let bogie = bogie(4_000.0, Some(10.0));
    rows("P2 test 23: drive direction, track", &drives(&bogie, 0.52, 0.02))
}
