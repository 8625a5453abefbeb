//! Rut depths of the published test cases against their closed forms.

use grouser_iscm::equilibrium::{SearchSettings, equilibrium, start_position};

use crate::vehicles::{component_vehicle, flat};

fn sinkage(spacing: f64, mass: f64, band: bool, radius: f64) -> f64 {
    let (machine, terrain) = (component_vehicle(mass, band), flat(spacing, 9.0));
    let settings = SearchSettings::default();
    let from = machine.mechanism.at([2.003, 0.0021], 0.0, 0.5);
    let start = start_position(&machine, &terrain, &from, 0.0, &settings).unwrap();
    let rest = equilibrium(&machine, &terrain, &start, 0.0, &settings).unwrap();
    println!(
        "{spacing} {:?} drawings {} evals {} change {:e} start {}",
        rest.configuration, rest.n_drawings, rest.n_evaluations, rest.last_change, start.height
    );
    radius - rest.configuration.height
}

#[test]
fn test_12_wheels_on_bogies() {
    for d in [0.04, 0.02, 0.01] {
        let z = sinkage(d, 30_000.0, false, 0.5);
        println!("test 12 at {d}: {z} error {:e}", z - 0.113_246_089);
    }
    assert!((sinkage(0.01, 30_000.0, false, 0.5) - 0.113_246_089).abs() < 3e-5);
}

#[test]
fn test_16_tracks_on_bogies() {
    for d in [0.04, 0.02, 0.01] {
        let z = sinkage(d, 32_400.0, true, 0.52);
        println!("test 16 at {d}: {z} error {:e}", z - 0.049_129_673);
    }
    assert!((sinkage(0.01, 32_400.0, true, 0.52) - 0.049_129_673).abs() < 3e-5);
}
