//! A machine at rest does not remember where the search began; where it cannot rest, the reason is named.

use grouser_geometry::{HeightGrid, Vec3};
use grouser_iscm::equilibrium::{NoEquilibrium, SearchSettings, equilibrium};
use grouser_iscm::gear::{Foot, Wheel};
use grouser_iscm::machine::Machine;
use grouser_iscm::mechanism::{Body, Configuration, Joint, Mechanism};
use grouser_iscm::pressure::{Linear, PressureArray, PressureField, PressureLaw};
use grouser_iscm::terrain::{RigidShape, Terrain};
use grouser_iscm::verification::{component_vehicle, flat_ground};

fn ground(height: impl Fn(f64, f64) -> f64) -> Terrain {
    ground_of(0.05, height)
}

fn ground_of(spacing: f64, height: impl Fn(f64, f64) -> f64) -> Terrain {
    let grid = HeightGrid::covering([-3.0, -3.0], [6.0, 6.0], spacing, height).unwrap();
    let law = PressureLaw::Linear(Linear { stiffness: 1.5e6 });
    Terrain::new(grid, PressureField::uniform(PressureArray::new(&law, 0.005, 0.6).unwrap())).unwrap()
}

/// A stiff frame on four wheels.
fn frame(centre_of_mass: Vec3) -> Machine {
    let body = Body {
        name: "frame".into(),
        parent: None,
        attachment: Vec3::zeros(),
        joint: Joint::Held { axis: Vec3::y() },
        mass: 8_000.0,
        centre_of_mass,
    };
    let foot = |x: f64, y: f64| Foot {
        body: 0,
        wheels: vec![Wheel::cylinder(Vec3::new(x, y, 0.0), 0.5, 0.4)],
        belts: Vec::new(),
    };
    let feet = vec![foot(1.0, 0.8), foot(1.0, -0.8), foot(-1.0, 0.8), foot(-1.0, -0.8)];
    Machine::new(Mechanism::new(vec![body]).unwrap(), feet).unwrap()
}

/// Numbers between −1 and 1, the same every time.
fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

#[test]
fn a_thousand_random_starts_find_the_same_rest() {
    let machine = frame(Vec3::new(0.15, 0.1, 0.2));
    let settings = SearchSettings { position_tolerance: 1e-7, ..SearchSettings::default() };
    let slope = 30.0_f64.to_radians().tan();
    let mut stump = ground(|_, _| 0.0);
    stump.add_rigid_object([1.02, 0.81], 0.35, 0.15, RigidShape::Stump).unwrap();
    let places: [(&str, Terrain, [f64; 3]); 5] = [
        ("flat", ground(|_, _| 0.0), [0.01, 0.02, 0.3]),
        ("slope of 30°", ground(|x, _| slope * x), [0.01, 0.02, 0.0]),
        (
            "one wheel over a pit",
            ground(|x, y| if x < -0.3 && y < -0.2 { -0.7 } else { 0.0 }),
            [0.01, 0.02, 0.0],
        ),
        ("stump", stump, [0.01, 0.02, 0.0]),
        ("step edge", ground(|x, _| if x > 0.9 { 0.3 } else { 0.0 }), [0.01, 0.02, 0.0]),
    ];
    let mut failures = Vec::new();
    for (name, terrain, [x, y, heading]) in &places {
        let mut next = noise(7);
        let mut first: Option<Configuration> = None;
        for start in 0..200 {
            let mut from = machine.mechanism.at([*x, *y], *heading, 0.0);
            from.height = 0.5 + terrain.grid().height_at(*x, *y) + 0.25 * next();
            from.pitch = 0.25 * next() - if *name == "slope of 30°" { 0.5 } else { 0.0 };
            from.roll = 0.25 * next();
            match equilibrium(&machine, terrain, &from, 0.0, &settings) {
                Err(error) => failures.push(format!("{name} {start}: {error}")),
                Ok(rest) => {
                    let at = rest.configuration;
                    let same = first.get_or_insert_with(|| at.clone());
                    let off = (at.height - same.height).abs().max((at.pitch - same.pitch).abs());
                    if off.max((at.roll - same.roll).abs()) > 1e-6 {
                        failures.push(format!("{name} {start}: {at:?} instead of {same:?}"));
                    }
                }
            }
        }
    }
    assert!(failures.is_empty(), "{} of 1000: {:#?}", failures.len(), &failures[..failures.len().min(12)]);
}

#[test]
fn a_machine_too_tall_for_its_slope_rolls_over_by_name() {
    let machine = frame(Vec3::new(0.0, 0.0, 2.5));
    let slope = 30.0_f64.to_radians().tan();
    let terrain = ground(|_, y| slope * y);
    let mut from = machine.mechanism.at([0.0, 0.0], 0.0, 0.5);
    from.roll = 0.5;
    let error = equilibrium(&machine, &terrain, &from, 0.0, &SearchSettings::default()).unwrap_err();
    assert!(matches!(error, NoEquilibrium::RollOver { .. } | NoEquilibrium::OffTerrain { .. }), "{error}");
    assert!(error.to_string().contains("remedy"), "{error}");
}

#[test]
fn joints_that_rest_on_their_stops_are_named() {
    // The right rear bogie hangs over a pit: it turns to its stop.
    let machine = component_vehicle(12_000.0, false, 0.0);
    let mut pit = flat_ground(0.05, 9.0);
    let (n_x, spacing) = (pit.grid().n_x(), 0.05);
    let nodes: Vec<usize> = (0..pit.grid().n_nodes())
        .filter(|n| {
            let [x, y] = pit.grid().position(n % n_x, n / n_x);
            y < -0.3 && x < -2.0 + spacing
        })
        .collect();
    nodes.into_iter().for_each(|n| pit.stamp(n, -1.5));
    let from = machine.mechanism.at([2.0, 0.0], 0.0, 0.45);
    let rest = equilibrium(&machine, &pit, &from, 0.0, &SearchSettings::default()).unwrap();
    assert!(rest.at_stop.iter().any(|name| name == "rear axle 1 right"), "{:?}", rest.at_stop);
}

#[test]
fn a_machine_that_stands_still_does_not_sink_further() {
    let machine = frame(Vec3::new(0.1, 0.05, 0.2));
    // Polygons at the ends of the contact lose their pressure, w K s d²/4 each with slope s: about 0.1 mm at 2 cm.
    let mut terrain = ground_of(0.02, |x, y| 0.05 * (2.0 * x).sin() + 0.03 * y);
    let settings = SearchSettings::default();
    let from = machine.mechanism.at([0.01, 0.02], 0.2, 0.5);
    let first = equilibrium(&machine, &terrain, &from, 0.0, &settings).unwrap();
    for imprint in &first.frozen.imprints {
        imprint.stamp(&mut terrain, &grouser_geometry::Pose::identity());
    }
    let again = equilibrium(&machine, &terrain, &first.configuration, 0.0, &settings).unwrap();
    let sunk = first.configuration.height - again.configuration.height;
    assert!(sunk.abs() < 3e-4, "{sunk} m");
}
