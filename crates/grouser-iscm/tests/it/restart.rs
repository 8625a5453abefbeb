//! A run state written to bytes and read back goes on as if nothing had happened.

use grouser_iscm::equilibrium::SearchSettings;
use grouser_iscm::route::Route;
use grouser_iscm::run::{RunError, RunSettings, RunState};
use grouser_iscm::verification::{component_vehicle, flat_ground};

#[test]
fn a_restarted_run_has_the_same_bytes() {
    let machine = component_vehicle(30_000.0, false, 0.05);
    let settings = RunSettings {
        route: Route { points: vec![[2.0, 0.0], [3.0, 0.0]] },
        run_step: 0.12,
        intermediate_steps: 2,
        search: SearchSettings { position_tolerance: 1e-6, ..SearchSettings::default() },
    };
    let mut straight = RunState::start(&machine, flat_ground(0.08, 9.0), &settings).unwrap();
    straight.step(&machine, &settings).unwrap();
    let bytes = postcard::to_stdvec(&straight).unwrap();
    let mut resumed: RunState = postcard::from_bytes(&bytes).unwrap();
    straight.step(&machine, &settings).unwrap();
    resumed.step(&machine, &settings).unwrap();
    assert_eq!(postcard::to_stdvec(&straight).unwrap(), postcard::to_stdvec(&resumed).unwrap());
}

#[test]
fn a_step_below_the_limit_and_a_route_off_the_terrain_are_refused() {
    let machine = component_vehicle(30_000.0, false, 0.0);
    let settings = |from: f64, run_step| RunSettings {
        route: Route { points: vec![[from, 0.0], [from + 1.0, 0.0]] },
        run_step,
        intermediate_steps: 0,
        search: SearchSettings::default(),
    };
    let error = RunState::start(&machine, flat_ground(0.08, 9.0), &settings(2.0, 0.1)).unwrap_err();
    assert!(matches!(error, RunError::StepTooShort { .. }), "{error}");
    let error = RunState::start(&machine, flat_ground(0.08, 9.0), &settings(4.4, 0.12)).unwrap_err();
    assert!(error.to_string().contains("off the terrain"), "{error}");
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let machine = component_vehicle(30_000.0, true, 0.05);
    let settings = RunSettings {
        route: Route { points: vec![[2.0, 0.0], [3.0, 0.0]] },
        run_step: 0.12,
        intermediate_steps: 4,
        search: SearchSettings { position_tolerance: 1e-6, ..SearchSettings::default() },
    };
    let bytes = [1, 2, 3].map(|n_threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().unwrap();
        pool.install(|| {
            let mut state = RunState::start(&machine, flat_ground(0.08, 9.0), &settings).unwrap();
            let step = state.step(&machine, &settings).unwrap();
            postcard::to_stdvec(&(state, step)).unwrap()
        })
    });
    assert!(bytes[0] == bytes[1] && bytes[0] == bytes[2]);
}
