//! A bogie over a stump and a rock.

use super::{Row, bogie, ground};
use crate::equilibrium::SearchSettings;
use crate::route::Route;
use crate::run::{RunSettings, RunState};
use crate::terrain::RigidShape;

/// Rigid objects keep their height and take no sinkage; the bogie climbs them; the soil around is rutted.
pub fn rigid_objects() -> Vec<Row> {
    let case = "P2 test 18: rigid objects";
    let mut rows = Vec::new();
    for (has_track, name) in [(false, "wheels"), (true, "track")] {
        for (shape, object) in [(RigidShape::Stump, "stump"), (RigidShape::Rock, "rock")] {
            let machine = bogie(4_000.0, if has_track { Some(10.0) } else { None });
            let mut terrain = ground(0.05, [-2.0, -1.0], [5.0, 2.0], |_, _| 0.0);
            let covered = terrain.add_rigid_object([1.15, 0.02], 0.35, 0.15, shape);
            let heights = terrain.grid().heights().to_vec();
            let settings = RunSettings {
                route: Route { points: vec![[0.0, 0.0], [1.2, 0.0]] },
                run_step: 0.075,
                intermediate_steps: 4,
                search: SearchSettings { position_tolerance: 1e-5, ..SearchSettings::default() },
            };
            let run = || -> Option<(f64, f64, f64, f64)> {
                covered.as_ref().ok()?;
                let mut state = RunState::start(&machine, terrain.clone(), &settings).ok()?;
                let mut highest = f64::NEG_INFINITY;
                while state.can_go_on(&settings) {
                    state.step(&machine, &settings).ok()?;
                    highest = highest.max(state.wheel_centres[0][1].z);
                }
                let (mut changed, mut sunk, mut rut) = (0.0, 0.0_f64, 0.0_f64);
                for node in 0..heights.len() {
                    let sinkage = state.terrain.sinkage()[node];
                    if state.terrain.is_fixed(node) {
                        changed += f64::from(u8::from(state.terrain.height(node) != heights[node]));
                        sunk = sunk.max(sinkage);
                    } else {
                        rut = rut.max(sinkage);
                    }
                }
                Some((changed, sunk, rut, highest))
            };
            let (changed, sunk, rut, highest) = run().unwrap_or((f64::NAN, f64::NAN, f64::NAN, f64::NAN));
            let row = |quantity: &str, computed, reference, tolerance, unit, source| {
                Row::new(
                    case,
                    format!("{quantity}, {name} over a {object}"),
                    computed,
                    reference,
                    tolerance,
                    unit,
                    source,
                )
            };
            rows.push(row("rigid nodes that moved", changed, 0.0, 0.0, "-", "P2 §2.2.1"));
            rows.push(row("sinkage of rigid nodes", sunk, 0.0, 0.0, "m", "P2 §2.2.1"));
            rows.push(row(
                "soil that yields (1 = yes)",
                f64::from(u8::from(rut > 0.01)),
                1.0,
                0.0,
                "-",
                "plastic soil",
            ));
            // A flat top yields by less than a millimetre under half a bogie; a rock's top lies between nodes.
            if has_track {
                continue; // a stiff span see-saws on the object: its ends rise higher
            }
            rows.push(row(
                "highest place of the front axle",
                highest,
                0.5 + 0.15,
                0.01,
                "m",
                "the object's height and the gear's radius",
            ));
        }
    }
    rows
}
