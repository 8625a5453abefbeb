//! The fast search and the nested one of the source (loops within loops) rest at the same place, on every scene with a vehicle.

use grouser::scene::{self, Motion, Soil, Tool};
use grouser_iscm::equilibrium::{SearchSettings, Solver, equilibrium, start_position};
use grouser_iscm::machine::Machine;
use grouser_iscm::mechanism::Configuration;
use grouser_iscm::terrain::Terrain;
use std::path::Path;

/// Distance of the ground's points [m]: the nested search draws and integrates a hundred thousand times.
const SPACING: f64 = 0.16;

/// The rest found from near `from`.
fn rest(machine: &Machine, terrain: &Terrain, from: &Configuration, solver: Solver) -> Configuration {
    let search = SearchSettings {
        solver,
        position_tolerance: 2e-7,
        integration_resolution: 2,
        ..SearchSettings::default()
    };
    equilibrium(machine, terrain, from, 0.0, &search).unwrap().configuration
}

/// Both searches with the machine of a scene `along` \[m\] its route.
fn compare(name: &str, along: f64) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios").join(name);
    let text = std::fs::read_to_string(&path).unwrap();
    let scenario = scene::read(&path.display().to_string(), &text, false, &[]).unwrap();
    let (Soil::PressureSinkage(ground), Some(Tool::Vehicle(vehicle)), Some(Motion::Route(route))) =
        (&scenario.soil, &scenario.tool, &scenario.motion)
    else {
        panic!("{name} has no vehicle on its way")
    };
    let terrain = ground.terrain(SPACING).unwrap();
    let (at, _) = route.way().at(along);
    for equipment in &vehicle.equipment {
        let machine = vehicle.machine(equipment).unwrap();
        let height = terrain.grid().height_at(at[0], at[1]) + 1.0;
        let above = machine.mechanism.at(at, 0.0, height);
        let start = start_position(&machine, &terrain, &above, 0.0, &SearchSettings::default()).unwrap();
        let fast = rest(&machine, &terrain, &start, Solver::Fast);
        // The nested one begins a little aside: each of its drawings costs some ten thousand integrations.
        let mut aside = fast.clone();
        let dofs: Vec<f64> = machine.mechanism.dofs(&fast).iter().map(|q| q + 5e-4).collect();
        machine.mechanism.set_dofs(&mut aside, &dofs);
        let nested = rest(&machine, &terrain, &aside, Solver::Nested);
        let [fast, nested] = [&fast, &nested].map(|at| machine.mechanism.dofs(at));
        for (dof, (a, b)) in fast.iter().zip(&nested).enumerate() {
            let dof = machine.mechanism.dof_name(dof);
            assert!((a - b).abs() <= 1e-6, "{name}, {equipment}, {dof}: {a} and {b}");
        }
    }
}

#[test]
fn both_searches_rest_at_the_same_place_on_the_waves_of_the_forwarder() {
    compare("forwarder.ron", 0.5);
}

#[test]
fn both_searches_rest_at_the_same_place_on_the_stump() {
    compare("stump.ron", 1.65);
}

#[test]
fn both_searches_rest_at_the_same_place_on_spatial_soil() {
    compare("spatial_soil.ron", 0.5);
}

#[test]
fn both_searches_rest_at_the_same_place_on_the_ground_of_the_convergence_study() {
    compare("iscm_convergence.ron", 2.1);
}
