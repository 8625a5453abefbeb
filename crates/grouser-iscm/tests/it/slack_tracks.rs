//! Slack tracks bend where stiff spans would carry: what that does to forces, stiffness, sinkage and ruts.

use grouser_geometry::{HeightGrid, Pose, Vec3};
use grouser_iscm::contact::FootImprint;
use grouser_iscm::equilibrium::{SearchSettings, equilibrium, start_position};
use grouser_iscm::gear::{Belt, Fit, Foot, Hull, Shoe, ShoeShape, Wheel};
use grouser_iscm::machine::Machine;
use grouser_iscm::mechanism::{Body, Joint, Mechanism};
use grouser_iscm::polygon::PartialLoad;
use grouser_iscm::pressure::{Linear, PressureArray, PressureField, PressureLaw};
use grouser_iscm::rolling_resistance::{WheelResistance, foot_resistance};
use grouser_iscm::route::Route;
use grouser_iscm::run::{RunSettings, RunState};
use grouser_iscm::rut::rut_depths;
use grouser_iscm::terrain::Terrain;
use grouser_iscm::track::tight_pitch;

const N_SHOES: usize = 40;
const SHOE_MASS: f64 = 15.0;

fn ground(height: impl Fn(f64, f64) -> f64) -> Terrain {
    let grid = HeightGrid::covering([-2.0, -0.6], [6.0, 1.2], 0.04, height).unwrap();
    let law = PressureLaw::Linear(Linear { stiffness: 1.0e6 });
    Terrain::new(grid, PressureField::uniform(PressureArray::new(&law, 0.005, 0.5).unwrap())).unwrap()
}

/// A bogie of 6 t with wheels of 0.5 m; the track tight, or slack by a share.
fn bogie(slack: Option<f64>) -> Machine {
    let wheels: Vec<Wheel> =
        [-0.75, 0.75].map(|x| Wheel::cylinder(Vec3::new(x, 0.0, 0.0), 0.5, 0.5)).to_vec();
    let circles = [[-0.75, 0.0, 0.5], [0.75, 0.0, 0.5]];
    let (pitch, fit) = match slack {
        None => (Hull::around(&circles).length() / N_SHOES as f64, Fit::Tight),
        Some(slack) => (tight_pitch(&circles, N_SHOES) * (1.0 + slack), Fit::Slack),
    };
    let shape = ShoeShape::Band { width: 0.6, depth: 0.02, n_pieces: 1 };
    let belt = Belt {
        wheels: vec![0, 1],
        link_offset: 0.0,
        n_shoes: N_SHOES,
        pitch,
        shoe: Shoe { mass: SHOE_MASS, shape },
        fit,
    };
    let body = Body {
        name: "bogie".into(),
        parent: None,
        attachment: Vec3::zeros(),
        joint: Joint::Held { axis: Vec3::y() },
        mass: 6_000.0,
        centre_of_mass: Vec3::new(0.0, 0.0, -0.1),
    };
    Machine::new(Mechanism::new(vec![body]).unwrap(), vec![Foot { body: 0, wheels, belts: vec![belt] }])
        .unwrap()
}

fn sinkage(slack: Option<f64>) -> f64 {
    let (machine, terrain, search) = (bogie(slack), ground(|_, _| 0.0), SearchSettings::default());
    let above = machine.mechanism.at([0.0, 0.0], 0.0, 0.7);
    let start = start_position(&machine, &terrain, &above, 0.0, &search).unwrap();
    0.52 - equilibrium(&machine, &terrain, &start, 0.0, &search).unwrap().configuration.height
}

#[test]
fn the_more_slack_the_deeper_until_each_wheel_stands_for_itself() {
    let [tight, taut, slack, loose, slackest] =
        [None, Some(0.0), Some(0.003), Some(0.015), Some(0.025)].map(sinkage);
    // Even links without slack carry less than a stiff span: pull is load L²/8f for a rise f, and steel links stretch.
    assert!(
        tight < 0.75 * taut && taut < 0.9 * slack && slack < 0.9 * slackest,
        "{tight} {taut} {slack} {slackest}"
    );
    // Once no link is pulled, more slack changes nothing.
    assert!((slackest - loose).abs() < 5e-3 * loose, "{slackest} {loose}");
    // Two cylinders of 0.52 m × 0.6 m: K w (r² acos(1 − z/r) − (r − z) √(2rz − z²)) = W/2. Shoes are chords, up to p²/8r = 6 mm higher.
    let area = |z: f64| 0.52_f64.powi(2) * (1.0 - z / 0.52).acos() - (0.52 - z) * (1.04 * z - z * z).sqrt();
    let (mut low, mut high) = (0.0, 0.3);
    for _ in 0..60 {
        let z = 0.5 * (low + high);
        if 0.6e6 * area(z) < 3_000.0 * 9.81 { low = z } else { high = z }
    }
    assert!(slackest > low && slackest < low + 0.008, "{slackest} {low}");
}

/// The slack bogie over waves and a rut, standing a little askew.
fn over_a_rut() -> (Machine, Terrain, Pose, FootImprint) {
    let (machine, mut terrain) = (bogie(Some(0.003)), ground(|x, y| 0.05 * (2.0 * x).sin() + 0.02 * y));
    let n_x = terrain.grid().n_x();
    for node in 0..terrain.grid().n_nodes() {
        if terrain.grid().position(node % n_x, node / n_x)[0] > 0.3 {
            terrain.stamp(node, terrain.height(node) - 0.06);
        }
    }
    let mut at = machine.mechanism.at([0.01, 0.02], 0.1, 0.42);
    (at.pitch, at.roll) = (0.03, 0.01);
    let pose = machine.mechanism.poses(&at)[0];
    // Drawn again where the links come to rest.
    let mut imprint = machine.feet[0].imprint(&terrain, &pose, 0.013, PartialLoad::Proportional);
    for _ in 0..3 {
        let shape = imprint.tracks[0].shape(&terrain, &Pose::identity(), 1.0);
        imprint = machine.feet[0].imprint_with(&terrain, &pose, 0.013, PartialLoad::Proportional, &[shape]);
    }
    (machine, terrain, pose, imprint)
}

#[test]
fn links_keep_their_length_and_stay_outside_the_wheels() {
    let (machine, _, _, imprint) = over_a_rut();
    let (belt, joints) = (&machine.feet[0].belts[0], &imprint.tracks[0].joints);
    let mut n_lower = 0;
    for k in 0..N_SHOES {
        let (a, b) = (joints[k], joints[(k + 1) % N_SHOES]);
        if a[1] < -0.05 && b[1] < -0.05 {
            n_lower += 1;
            let length = (a[0] - b[0]).hypot(a[1] - b[1]);
            assert!((length / belt.pitch - 1.0).abs() < 1e-3, "link {k}: {length} {}", belt.pitch);
            for centre in [-0.75, 0.75] {
                assert!((a[0] - centre).hypot(a[1]) > 0.5 - 1e-4, "joint {k}");
            }
        }
    }
    assert!(n_lower > 15, "{n_lower}");
}

#[test]
fn stiffness_of_a_slack_foot_is_the_derivative_of_its_force() {
    let (_, terrain, _, imprint) = over_a_rut();
    let integration = SearchSettings::default().integration();
    let lifted = |height: f64| {
        let load = imprint.load(&terrain, &Pose::translation(0.0, 0.0, height), &integration);
        (load.wrench.force.z, load.stiffness[(2, 2)])
    };
    let step = 2e-4;
    let slope = (lifted(-step).0 - lifted(step).0) / (2.0 * step);
    let felt = lifted(0.0).1;
    // Points of the ground under shoes stand for polygons: equal to first order.
    assert!((felt / slope - 1.0).abs() < 0.1, "{felt} {slope}");
}

#[test]
fn wheels_receive_what_the_ground_gives_less_the_weight_of_the_track() {
    let (machine, terrain, pose, imprint) = over_a_rut();
    let integration = SearchSettings::default().integration();
    let load = imprint.load(&terrain, &Pose::identity(), &integration);
    let polygons = imprint.polygons(&terrain, &Pose::identity(), &integration);
    let wheels =
        foot_resistance(&machine.feet[0], &pose, 0.013, pose.rotation * Vec3::x(), &polygons, &imprint);
    let received = WheelResistance::total(&wheels).vertical_force;
    let exact = load.wrench.force.z - N_SHOES as f64 * SHOE_MASS * 9.81;
    assert!((received / exact - 1.0).abs() < 1e-9, "{received} {exact}");
    assert!(wheels.iter().all(|wheel| wheel.vertical_force > 0.1 * exact));
}

#[test]
fn a_slack_track_leaves_a_deeper_rut_and_goes_on_the_same_after_a_restart() {
    let settings = RunSettings {
        route: Route { points: vec![[0.0, 0.0], [3.0, 0.0]] },
        run_step: 0.1,
        intermediate_steps: 5,
        search: SearchSettings { position_tolerance: 1e-5, ..SearchSettings::default() },
    };
    let drive = |slack: Option<f64>| {
        let machine = bogie(slack);
        let mut state = RunState::start(&machine, ground(|_, _| 0.0), &settings).unwrap();
        for n in 0..22 {
            if n == 11 {
                state = postcard::from_bytes(&postcard::to_allocvec(&state).unwrap()).unwrap();
                assert_eq!(state.configuration.tracks.len(), usize::from(slack.is_some()));
            }
            state.step(&machine, &settings).unwrap();
        }
        let ruts = rut_depths(&state.terrain, [0.6, 0.0], [1.35, 0.0], 0.5, 0.25);
        (ruts.iter().sum::<f64>() / ruts.len() as f64, state)
    };
    let ((tight, _), (slack, state)) = (drive(None), drive(Some(0.004)));
    assert!(slack > 1.15 * tight, "rut of the slack track {slack} m, of the tight one {tight} m");
    let machine = bogie(Some(0.004));
    let mut straight = RunState::start(&machine, ground(|_, _| 0.0), &settings).unwrap();
    (0..22).for_each(|_| drop(straight.step(&machine, &settings).unwrap()));
    assert!(straight == state, "a restart changed the run");
}
