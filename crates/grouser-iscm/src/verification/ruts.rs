//! Rut depths of standing vehicles.

use super::plane::bisect;
use super::{Row, component_vehicle, flat_ground};
use crate::equilibrium::{SearchSettings, Solver, equilibrium, start_position};
use crate::mechanism::GRAVITY;

const CLOSED_FORM: &str = "closed form: circular segment in linear soil, exact value by bisection";

/// Vertical force \[N\] on a level cylinder at `sinkage` in linear soil: w K (segment area), all SI.
fn cylinder_force(radius: f64, width: f64, stiffness: f64, sinkage: f64) -> f64 {
    let (r, z) = (radius, sinkage.max(0.0));
    width * stiffness * (r * r * ((r - z) / r).acos() - (r - z) * (2.0 * r * z - z * z).sqrt())
}

fn sinkage(spacing: f64, mass: f64, has_tracks: bool, radius: f64) -> f64 {
    let (machine, terrain) = (component_vehicle(mass, has_tracks, 0.0), flat_ground(spacing, 9.0));
    let settings = SearchSettings::default();
    let from = machine.mechanism.at([2.003, 0.0021], 0.0, 0.5);
    let start = start_position(&machine, &terrain, &from, 0.0, &settings);
    let rest = start.and_then(|start| equilibrium(&machine, &terrain, &start, 0.0, &settings));
    rest.map_or(f64::NAN, |rest| radius - rest.configuration.height)
}

/// Sinkage at a fine and at the usual spacing, and the order from a coarse one down: `spacings` from coarse to fine.
fn rut_rows(
    case: &'static str,
    [mass, radius, exact]: [f64; 3],
    has_tracks: bool,
    spacings: [f64; 3],
    source: &'static str,
) -> Vec<Row> {
    let [coarse, usual, fine] = spacings.map(|d| sinkage(d, mass, has_tracks, radius));
    let halvings = (spacings[0] / spacings[1]).log2();
    let observed = ((coarse - exact).abs() / (usual - exact).abs()).log2() / halvings;
    let at = |d: f64| format!("sinkage at {} cm terrain", 100.0 * d);
    let between = format!("{} cm to {} cm", 100.0 * spacings[0], 100.0 * spacings[1]);
    vec![
        Row::new(case, at(spacings[2]), fine, exact, 3e-5, "m", CLOSED_FORM),
        Row::new(case, at(spacings[1]), usual, exact, 3e-5, "m", CLOSED_FORM),
        Row::order_at_least(case, &between, observed, 2.0, source),
    ]
}

/// Eight wheels, 30,000 kg.
pub fn wheels_on_bogies() -> Vec<Row> {
    let exact = bisect(|z| 8.0 * cylinder_force(0.5, 0.5, 1.5e6, z) - 30_000.0 * GRAVITY, 0.0, 0.5);
    let source = "parabolas through heights and slopes of an arc";
    let case = "P2 test 12: rut depth, wheels on bogies";
    rut_rows(case, [30_000.0, 0.5, exact], false, [0.16, 0.04, 0.01], source)
}

/// Four tracked bogies, 32,400 kg.
pub fn tracks_on_bogies() -> Vec<Row> {
    let bogie = |z: f64| cylinder_force(0.52, 0.6, 1.5e6, z) + 0.6 * 1.5 * 1.5e6 * z;
    let exact = bisect(|z| 4.0 * bogie(z) - 32_400.0 * GRAVITY, 0.0, 0.5);
    let source = "flat pieces of a band under an arc";
    let case = "P2 test 16: rut depth, tracks on bogies";
    rut_rows(case, [32_400.0, 0.52, exact], true, [0.04, 0.02, 0.01], source)
}

/// Load shifted 0.1 m to the left: the ground's forces follow the lever rule.
pub fn off_centre_load() -> Vec<Row> {
    let case = "P2 test 13: off-centre load";
    let (machine, terrain) = (component_vehicle(30_000.0, false, 0.1), flat_ground(0.02, 9.0));
    let settings = SearchSettings::default();
    let from = machine.mechanism.at([2.003, 0.0021], 0.0, 0.39);
    let Ok(rest) = equilibrium(&machine, &terrain, &from, 0.0, &settings) else {
        return vec![Row {
            case,
            quantity: "equilibrium".into(),
            computed: f64::NAN,
            reference: 0.0,
            tolerance: 0.0,
            unit: "-",
            source: "must exist",
        }];
    };
    // Moments about the roll axis: the ground under leaning wheels pushes sideways too, which no degree of freedom balances.
    let loads = rest.frozen.loads;
    let centre = machine.mechanism.centre_of_mass(&rest.frozen.poses);
    let axis = rest.frozen.poses[0].translation.vector;
    let total: f64 = loads.iter().map(|l| l.wrench.force.z).sum();
    let about_axis = loads
        .iter()
        .zip(&rest.frozen.imprints)
        .map(|(l, print)| (l.wrench.moment + (print.reference - axis).cross(&l.wrench.force)).x);
    let moment: f64 = about_axis.sum();
    let weight = 30_000.0 * GRAVITY;
    let row = |quantity: &str, computed, reference, tolerance, unit| Row {
        case,
        quantity: quantity.into(),
        computed,
        reference,
        tolerance,
        unit,
        source: "statics",
    };
    vec![
        row("force of the ground", total, weight, 1.0, "N"),
        row("moment about the roll axis", moment, weight * (centre.y - axis.y), 5.0, "N·m"),
        row(
            "lean to the heavy side (1 = yes)",
            f64::from(u8::from(rest.configuration.roll < -1e-3)),
            1.0,
            0.0,
            "-",
        ),
    ]
}

/// The simplified search agrees with the full one where nothing turns.
pub fn start_position_against_equilibrium() -> Vec<Row> {
    let case = "P2 test 9: start position";
    let (machine, terrain) = (component_vehicle(30_000.0, false, 0.0), flat_ground(0.02, 9.0));
    let settings = SearchSettings::default();
    let from = machine.mechanism.at([2.0, 0.0], 0.0, 0.7);
    let start = start_position(&machine, &terrain, &from, 0.0, &settings);
    let rest = start.clone().and_then(|start| equilibrium(&machine, &terrain, &start, 0.0, &settings));
    let (computed, reference) =
        (start.map_or(f64::NAN, |s| s.height), rest.map_or(f64::NAN, |r| r.configuration.height));
    vec![Row {
        case,
        quantity: "height of the frame".into(),
        computed,
        reference,
        tolerance: 1e-5,
        unit: "m",
        source: "full equilibrium search",
    }]
}

/// Both solvers on the off-centre vehicle over coarse ground.
pub fn nested_and_fast() -> Vec<Row> {
    let case = "nested and fast search";
    let (machine, terrain) = (component_vehicle(30_000.0, false, 0.1), flat_ground(0.12, 9.0));
    let from = machine.mechanism.at([2.003, 0.0021], 0.0, 0.39);
    let solve = |solver| {
        let settings = SearchSettings {
            solver,
            position_tolerance: 1e-6,
            integration_resolution: 2,
            ..SearchSettings::default()
        };
        equilibrium(&machine, &terrain, &from, 0.0, &settings)
            .map(|rest| machine.mechanism.dofs(&rest.configuration))
    };
    let (Ok(fast), Ok(nested)) = (solve(Solver::Fast), solve(Solver::Nested)) else {
        return vec![Row {
            case,
            quantity: "equilibrium".into(),
            computed: f64::NAN,
            reference: 0.0,
            tolerance: 0.0,
            unit: "-",
            source: "must exist",
        }];
    };
    let row = |(k, (&computed, &reference)): (usize, (&f64, &f64))| Row {
        case,
        quantity: machine.mechanism.dof_name(k).to_string(),
        computed,
        reference,
        tolerance: 1e-6,
        unit: if k == 0 { "m" } else { "rad" },
        source: "nested search, P2 Fig. 6",
    };
    fast.iter().zip(&nested).enumerate().map(row).collect()
}
