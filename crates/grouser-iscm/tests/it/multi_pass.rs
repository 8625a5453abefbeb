//! Two passes over elastic and plastic ground: rut and work against the closed form of a rolling wheel.

use grouser_geometry::{HeightGrid, Vec3};
use grouser_iscm::equilibrium::SearchSettings;
use grouser_iscm::gear::{Foot, Wheel};
use grouser_iscm::machine::Machine;
use grouser_iscm::mechanism::{Body, GRAVITY, Joint, Mechanism};
use grouser_iscm::pressure::{Linear, PressureArray, PressureField, PressureLaw};
use grouser_iscm::route::Route;
use grouser_iscm::run::{RunSettings, RunState};
use grouser_iscm::shear::JanosiHanamoto;
use grouser_iscm::terrain::{Terrain, Unloading};
use grouser_iscm::wheel::{OperatingPoint, PressurePeak, SingleWheel, WheelSoil, closed_form};

const MASS: f64 = 200.0;
const WIDTH: f64 = 0.1;
const STIFFNESS: f64 = 1.5e6;

fn machine() -> Machine {
    let body = Body {
        name: "wheel".into(),
        parent: None,
        attachment: Vec3::zeros(),
        joint: Joint::Held { axis: Vec3::y() },
        mass: MASS,
        centre_of_mass: Vec3::new(0.0, 0.0, -0.4),
    };
    let foot = Foot { body: 0, wheels: vec![Wheel::cylinder(Vec3::zeros(), 0.5, WIDTH)], belts: Vec::new() };
    Machine::new(Mechanism::new(vec![body]).unwrap(), vec![foot]).unwrap()
}

/// Rut at x = 0 \[m\] and mean rolling resistance \[N\] from there on for 0.3 m.
fn pass(terrain: Terrain, intermediate_steps: usize) -> (Terrain, f64, f64) {
    let run_step = 1.5 * terrain.grid().spacing();
    let settings = RunSettings {
        route: Route { points: vec![[-0.6, 0.0], [0.6, 0.0]] },
        run_step,
        intermediate_steps,
        search: SearchSettings { position_tolerance: 1e-6, ..SearchSettings::default() },
    };
    let machine = machine();
    let mut state = RunState::start(&machine, terrain, &settings).unwrap();
    let mut forces = Vec::new();
    while state.can_go_on(&settings) {
        let step = state.step(&machine, &settings).unwrap();
        if (0.6..0.9).contains(&step.distance) {
            forces.push(step.total.force);
        }
    }
    let grid = state.terrain.grid();
    let n_x = grid.n_x();
    let middle = (grid.n_y() / 2) * n_x + (-grid.origin()[0] / grid.spacing()).round() as usize;
    let rut = state.terrain.sinkage()[middle];
    (state.terrain, rut, forces.iter().sum::<f64>() / forces.len() as f64)
}

fn ground(unloading: Unloading, spacing: f64) -> Terrain {
    let grid = HeightGrid::covering([-1.2, -0.1], [2.4, 0.2], spacing, |_, _| 0.0).unwrap();
    let law = PressureLaw::Linear(Linear { stiffness: STIFFNESS });
    let field = PressureField::uniform(PressureArray::new(&law, 0.005, 0.5).unwrap());
    Terrain::new(grid, field).unwrap().with_unloading(unloading).unwrap()
}

fn exact(rebound: Option<f64>) -> OperatingPoint {
    let wheel = SingleWheel { radius: 0.5, width: WIDTH, lugs: None, load: MASS * GRAVITY };
    let soil = WheelSoil {
        pressure: PressureLaw::Linear(Linear { stiffness: STIFFNESS }),
        shear: JanosiHanamoto { cohesion: 0.0, friction_angle: 0.0, shear_deformation_modulus: 0.01 },
        peak: PressurePeak::Bottom,
        rebound,
    };
    closed_form::operating_point(&wheel, &soil, 0.0, 0.0).unwrap()
}

/// Second pass over elastic ground that a first pass left with `rut` \[m\]: rut \[m\] and resistance \[N\] by quadrature in x.
fn second_pass(rut: f64, k_u: f64) -> (f64, f64) {
    let sums = |sinkage: f64| {
        let new_rut = sinkage * (1.0 - STIFFNESS / k_u);
        let (n, step) = (200_000, 1.0 / 200_000.0);
        let (mut lift, mut drag) = (0.0, 0.0);
        for k in 0..n {
            let x = (f64::from(k) + 0.5) * step - 0.5;
            let z = sinkage - (0.5 - (0.25 - x * x).sqrt());
            let residual = if x > 0.0 { rut } else { new_rut };
            let p = (STIFFNESS * z).min(k_u * (z - residual)).max(0.0);
            lift += WIDTH * p * step;
            drag += WIDTH * p * x / (0.25 - x * x).sqrt() * step;
        }
        (lift, drag)
    };
    let (mut low, mut high) = (0.0, 0.3);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if sums(middle).0 > MASS * GRAVITY { high = middle } else { low = middle }
    }
    (low * (1.0 - STIFFNESS / k_u), sums(low).1)
}

#[test]
fn two_passes_over_elastic_ground_leave_the_ruts_and_take_the_work_of_the_closed_form() {
    let stiffness = 6e6;
    let reference = exact(Some(stiffness));
    // Linear ground keeps 1 − k/k_u of the sinkage, and the work ∫ p dz less what springs back.
    assert!((reference.rut_depth / reference.sinkage - 0.75).abs() < 1e-12);
    let work = WIDTH * STIFFNESS * reference.sinkage.powi(2) / 2.0 * (1.0 - STIFFNESS / stiffness);
    assert!((reference.compaction_resistance / work - 1.0).abs() < 1e-9);
    let (terrain, rut, force) = pass(ground(Unloading::Elastic { stiffness }, 0.01), 0);
    assert!((rut / reference.rut_depth - 1.0).abs() < 0.03, "{rut} for {}", reference.rut_depth);
    assert!((force / work - 1.0).abs() < 0.05, "{force} N for {work} N");
    let (second_rut, second_force) = second_pass(reference.rut_depth, stiffness);
    let (_, rut, force) = pass(terrain, 0);
    assert!((rut / second_rut - 1.0).abs() < 0.03, "{rut} for {second_rut}");
    assert!((force - second_force).abs() < 0.05 * work, "{force} N for {second_force} N");
}

/// Sinkage \[m\] on plastic ground where contact lasts behind the lowest point until the wheel has risen by `contact` \[m\].
fn sinkage_with_contact(contact: f64) -> f64 {
    let lift = |sinkage: f64| {
        let (n, step) = (100_000, 1e-5);
        let at = |k: i32| {
            let x = (f64::from(k) + 0.5) * step - 0.5;
            let z = sinkage - (0.5 - (0.25 - x * x).sqrt());
            let depth = if x > 0.0 { z } else { z - (sinkage - contact) };
            WIDTH * STIFFNESS * z.max(0.0) * (depth / contact).clamp(0.0, 1.0) * step
        };
        (0..n).map(at).sum::<f64>()
    };
    let (mut low, mut high) = (0.0, 0.3);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if lift(middle) > MASS * GRAVITY { high = middle } else { low = middle }
    }
    low
}

#[test]
fn plastic_ground_resists_by_the_work_of_its_rut() {
    let contact = 1e-4;
    let soft = Unloading::Plastic { contact_distance: contact };
    let reference = sinkage_with_contact(contact) - contact;
    assert!(reference < exact(None).sinkage);
    let [coarse, fine] = [0.02, 0.01].map(|spacing| pass(ground(soft, spacing), 10));
    let error = |rut: f64| (rut / reference - 1.0).abs();
    assert!(error(fine.1) < 0.006, "{} for {reference}", fine.1);
    assert!(error(coarse.1) < 0.01, "{} for {reference}", coarse.1);
    let work = WIDTH * STIFFNESS * fine.1.powi(2) / 2.0;
    assert!((fine.2 / work - 1.0).abs() < 0.02, "{} N for {work} N", fine.2);
    let (_, second_rut, second_force) = pass(fine.0, 10);
    assert!(second_rut > fine.1 && second_rut < 1.5 * fine.1, "{second_rut} after {}", fine.1);
    assert!(second_force < fine.2, "{second_force} N after {} N", fine.2);
}
