//! A bogie over a stump and a rock.

use super::plane::bisect;
use super::{Row, bogie, ground};
use crate::equilibrium::SearchSettings;
use crate::machine::Machine;
use crate::mechanism::GRAVITY;
use crate::route::Route;
use crate::run::{RunSettings, RunState};
use crate::terrain::{RigidShape, Terrain};
use grouser_geometry::Vec3;
use std::f64::consts::PI;

/// The object: where it stands, its radius and height \[m\].
const CENTRE: [f64; 2] = [1.15, 0.02];
const RADIUS: f64 = 0.175;
const HEIGHT: f64 = 0.15;
/// How far a track reaches below the axles \[m\].
const REACH: f64 = 0.52;

/// How deep the object stands in the straight span between two axles \[m\]: a flat top at its middle, a rock where it reaches deepest.
fn depth(axles: &[Vec3], shape: RigidShape) -> f64 {
    let way = axles[1] - axles[0];
    let below = |s: f64| {
        let along = CENTRE[0] + s - axles[0].x;
        axles[0].z + way.z / way.x * along - REACH * way.norm() / way.x
    };
    match shape {
        RigidShape::Stump => HEIGHT - below(0.0),
        RigidShape::Rock => (-100..=100)
            .map(|k| f64::from(k) / 100.0)
            .map(|s| HEIGHT * (1.0 - s * s).sqrt() - below(RADIUS * s))
            .fold(f64::NEG_INFINITY, f64::max),
    }
}

/// Depth \[m\] at which the object carries `weight` \[N\], K = 1 GPa/m: K times the volume of a cylinder or of the cap of an ellipsoid.
fn depth_under(weight: f64, shape: RigidShape) -> f64 {
    let volume = |z: f64| match shape {
        RigidShape::Stump => PI * RADIUS.powi(2) * z,
        RigidShape::Rock => PI * (RADIUS / HEIGHT * z).powi(2) * (HEIGHT - z / 3.0),
    };
    bisect(|z| Terrain::FIXED_STIFFNESS * volume(z) - weight, 0.0, HEIGHT)
}

/// What a drive over an object leaves.
struct Drive {
    /// Rigid nodes that moved.
    moved: f64,
    /// Largest sinkage of a rigid node \[m\].
    sunk: f64,
    /// Largest sinkage of the soil \[m\].
    rut: f64,
    /// Highest place of the front axle \[m\].
    highest: f64,
    /// Depth of the object in the span once the pivot is above its middle \[m\].
    depth: f64,
}

/// Drives over the object until the pivot is above its middle; nothing where that fails.
fn drive(machine: &Machine, shape: RigidShape, spacing: f64) -> Option<Drive> {
    let mut terrain = ground(spacing, [-2.0, -1.0], [5.0, 2.0], |_, _| 0.0);
    terrain.add_rigid_object(CENTRE, 2.0 * RADIUS, HEIGHT, shape).ok()?;
    let heights = terrain.grid().heights().to_vec();
    let settings = RunSettings {
        route: Route { points: vec![[0.0, CENTRE[1]], CENTRE] },
        run_step: CENTRE[0] / 15.0,
        intermediate_steps: 4,
        search: SearchSettings { position_tolerance: 1e-5, ..SearchSettings::default() },
    };
    let mut state = RunState::start(machine, terrain, &settings).ok()?;
    let mut drive = Drive { moved: 0.0, sunk: 0.0, rut: 0.0, highest: f64::NEG_INFINITY, depth: f64::NAN };
    while state.can_go_on(&settings) {
        state.step(machine, &settings).ok()?;
        drive.highest = drive.highest.max(state.wheel_centres[0][1].z);
        drive.depth = depth(&state.wheel_centres[0], shape);
    }
    for (node, height) in heights.into_iter().enumerate() {
        let sinkage = state.terrain.sinkage()[node];
        if state.terrain.is_fixed(node) {
            drive.moved += f64::from(u8::from(state.terrain.height(node) != height));
            drive.sunk = drive.sunk.max(sinkage);
        } else {
            drive.rut = drive.rut.max(sinkage);
        }
    }
    Some(drive)
}

/// Rigid objects keep their height and take no sinkage; the bogie climbs them; the soil around is rutted.
pub fn rigid_objects() -> Vec<Row> {
    let case = "P2 test 18: rigid objects";
    let mut rows = Vec::new();
    for (track, name) in [(None, "wheels"), (Some(10.0), "track")] {
        // The outline of a flat top lies on points of the grid, half a cell inside on the average: 7 % of its area.
        let stump = (RigidShape::Stump, "stump", 1.0, 5e-5);
        for (shape, object, order, tolerance) in [stump, (RigidShape::Rock, "rock", 2.0, 2e-4)] {
            let machine = bogie(4_000.0, track);
            let over = format!("{name} over a {object}");
            let Some(fine) = drive(&machine, shape, 0.0125) else {
                rows.push(Row::missing(case, &over));
                continue;
            };
            let row = |quantity: &str, computed, reference, tolerance, unit, source| {
                Row::new(case, format!("{quantity}, {over}"), computed, reference, tolerance, unit, source)
            };
            rows.push(row("rigid nodes that moved", fine.moved, 0.0, 0.0, "-", "P2 §2.2.1"));
            rows.push(row("sinkage of rigid nodes", fine.sunk, 0.0, 0.0, "m", "P2 §2.2.1"));
            let yields = f64::from(u8::from(fine.rut > 0.01));
            rows.push(row("soil that yields (1 = yes)", yields, 1.0, 0.0, "-", "plastic soil"));
            if track.is_none() {
                // A flat top yields by less than a millimetre under half a bogie, a rock by six.
                let source = "the object's height and the gear's radius";
                rows.push(row(
                    "highest place of the front axle",
                    fine.highest,
                    0.5 + HEIGHT,
                    0.01,
                    "m",
                    source,
                ));
                continue;
            }
            // The stiff span see-saws on the object and nothing else carries it at the end.
            let reference = depth_under(GRAVITY * machine.mechanism.mass(), shape);
            let source = "volume in the span, that of the weight";
            rows.push(row("depth in the span", fine.depth, reference, tolerance, "m", source));
            let coarse = drive(&machine, shape, 0.025).map_or(f64::NAN, |coarse| coarse.depth);
            let observed = ((coarse - reference) / (fine.depth - reference)).abs().log2();
            let between = format!("of the depth, {over}, 2.5 to 1.25 cm");
            rows.push(Row::order_at_least(case, &between, observed, order, source));
        }
    }
    rows
}
