//! Seconds per metre of a forwarder with chains and tracks: `cargo xtask bench iscm_vehicles`.
//!
//! 27,445 kg on eight wheels of 0.67 m, ground points 4 cm apart, run step 6 cm, 21 intermediate steps, integration resolution 4,
//! position tolerance 1 µm.

use clap::Parser;
use grouser_geometry::{HeightGrid, HeightShape, Vec3};
use grouser_iscm::equilibrium::SearchSettings;
use grouser_iscm::gear::{Belt, Fit, Hull, Shoe, ShoeShape, WheelShape};
use grouser_iscm::imprint::Plate;
use grouser_iscm::pressure::{Linear, Noisy, PressureArray, PressureField, PressureLaw};
use grouser_iscm::route::Route;
use grouser_iscm::run::{RunSettings, RunState};
use grouser_iscm::terrain::Terrain;
use grouser_iscm::vehicle::{Articulation, Axle, Component, vehicle};
use std::time::Instant;

fn belt(wheels: Vec<usize>, circles: &[[f64; 3]], n_shoes: usize, width: f64) -> Belt {
    let pitch = Hull::around(circles).length() / n_shoes as f64;
    let plate = |along, depth| Plate { along, across: [-width / 2.0, width / 2.0], depth };
    let half = 0.4 * pitch;
    let shape = ShoeShape::Steel {
        plates: vec![plate([-half, half], 0.03)],
        grousers: vec![plate([-0.02, 0.02], 0.06)],
    };
    Belt { wheels, link_offset: 0.0, n_shoes, pitch, shoe: Shoe { mass: 10.0, shape }, fit: Fit::Tight }
}

/// Pace of vehicles on soft ground.
#[derive(Parser)]
struct Arguments {
    /// Run steps of 6 cm
    #[arg(long, default_value_t = 50)]
    steps: usize,
    /// Threads
    #[arg(long, default_value_t = 2)]
    threads: usize,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments = Arguments::parse();
    rayon::ThreadPoolBuilder::new().num_threads(arguments.threads).build_global()?;
    forwarder(&arguments)
}

fn forwarder(arguments: &Arguments) -> Result<(), Box<dyn std::error::Error>> {
    let shapes = [
        HeightShape::Sine { amplitude: 0.1, wavelength: 7.0, heading: 0.0, phase: 0.3 },
        HeightShape::Sine { amplitude: 0.05, wavelength: 4.0, heading: 0.9, phase: 1.0 },
    ];
    let grid = HeightGrid::covering([-2.0, -2.5], [30.0, 5.0], 0.04, |x, y| HeightShape::sum(&shapes, x, y))?;
    let smooth = Box::new(PressureLaw::Linear(Linear { stiffness: 1.0e6 }));
    let law = PressureLaw::Noisy(Noisy { law: smooth, amplitude: 0.05, interval: 0.05, seed: 1 });
    let terrain = Terrain::new(grid, PressureField::uniform(PressureArray::new(&law, 0.005, 0.6)?))?;
    let radius = 0.67;
    let axle = |along, mass, belts| Axle {
        along,
        height: 0.0,
        half_track: 1.05,
        lever: 0.75,
        mass,
        max_angle: 0.5,
        radius,
        shape: WheelShape::Cylinder { width: 0.7 },
        belts,
    };
    let chain = belt(vec![0], &[[-0.75, 0.0, radius]], 40, 0.7);
    let track = belt(vec![0, 1], &[[-0.75, 0.0, radius], [0.75, 0.0, radius]], 60, 0.8);
    let component = |name: &str, mass, axle| Component {
        name: name.into(),
        mass,
        centre_of_mass: Vec3::new(0.0, 0.0, 0.7),
        axles: vec![axle],
    };
    let machine = vehicle(
        &[
            component("front", 9_000.0, axle(0.0, 1_900.0, vec![chain])),
            component("rear", 10_445.0, axle(0.0, 2_100.0, vec![track])),
        ],
        &[Articulation {
            position: Vec3::new(-2.0, 0.0, 0.0),
            offset: 2.5,
            max_roll: Some(0.3),
            is_steered: true,
        }],
    )?;
    let settings = RunSettings {
        route: Route { points: vec![[5.5, 0.0], [23.5, 0.0]] },
        run_step: 0.06,
        intermediate_steps: 21,
        search: SearchSettings { position_tolerance: 1e-6, ..SearchSettings::default() },
    };
    let start = Instant::now();
    let mut state = RunState::start(&machine, terrain, &settings)?;
    println!("start position, rest and footprint: {:.3} s", start.elapsed().as_secs_f64());
    let (start, mut n, mut evaluations, mut coefficient) = (Instant::now(), 0, 0, 0.0);
    while state.can_go_on(&settings) && n < arguments.steps {
        let result = state.step(&machine, &settings)?;
        n += 1;
        evaluations += result.n_evaluations;
        coefficient += result.total.coefficient();
    }
    println!(
        "forwarder: {:.3} s per metre on {} threads over {n} steps; {:.1} evaluations per step, mean C_RR {:.4}",
        start.elapsed().as_secs_f64() / state.distance(&settings),
        rayon::current_num_threads(),
        evaluations as f64 / n as f64,
        coefficient / n as f64
    );
    Ok(())
}
