//! Standing bogies and vehicles with stiff frames: sinkage, moments and slopes against closed forms of cylinders.

use super::plane::{Plane, WheelAt};
use super::{Row, flat_ground, sloped_ground};
use crate::equilibrium::{SearchSettings, equilibrium, start_position};
use crate::gear::{Foot, Wheel};
use crate::machine::Machine;
use crate::mechanism::{Body, GRAVITY, Joint, Mechanism};
use crate::terrain::Terrain;
use grouser_geometry::{Orientation, Pose, Vec3};

const SEGMENT: &str = "closed form: circular segment in linear soil";
const STIFFNESS: f64 = 1.5e6;

/// One stiff body on wheels r = w = 0.5 m at `wheels` \[m\], its centre of mass at `centre` \[m\].
fn stiff_machine(mass: f64, centre: Vec3, wheels: &[[f64; 2]]) -> Machine {
    let body = Body {
        name: "frame".into(),
        parent: None,
        attachment: Vec3::zeros(),
        joint: Joint::Held { axis: Vec3::y() },
        mass,
        centre_of_mass: centre,
    };
    let foot = |[x, y]: [f64; 2]| Foot {
        body: 0,
        wheels: vec![Wheel::cylinder(Vec3::new(x, y, 0.0), 0.5, 0.5)],
        belts: Vec::new(),
    };
    let mechanism = Mechanism::new(vec![body]).expect("one body");
    Machine::new(mechanism, wheels.iter().copied().map(foot).collect()).expect("sound wheels")
}

/// Height, pitch and roll at rest; not a number where there is none.
fn rest(machine: &Machine, terrain: &Terrain, from: [f64; 3]) -> [f64; 3] {
    let settings = SearchSettings::default();
    let mut at = machine.mechanism.at([0.0031, 0.0021], 0.0, from[0]);
    (at.pitch, at.roll) = (from[1], from[2]);
    let start = start_position(machine, terrain, &at, 0.0, &settings);
    let rest = start.and_then(|start| equilibrium(machine, terrain, &start, 0.0, &settings));
    rest.map_or([f64::NAN; 3], |r| [r.configuration.height, r.configuration.pitch, r.configuration.roll])
}

/// Sinkage at two spacings against the closed form, and the order between them.
fn rut_rows(case: &'static str, machine: &Machine, n_wheels: f64) -> Vec<Row> {
    let plane = Plane { slope: 0.0, stiffness: STIFFNESS };
    let exact = plane.sinkage(0.5, 0.5, machine.mechanism.mass() * GRAVITY / n_wheels);
    let [coarse, usual, fine] =
        [0.16, 0.04, 0.01].map(|spacing| 0.5 - rest(machine, &flat_ground(spacing, 5.0), [0.6, 0.0, 0.0])[0]);
    let order = ((coarse - exact).abs() / (usual - exact).abs()).log2() / 2.0;
    let source = "parabolas through heights and slopes of an arc";
    vec![
        Row::new(case, "sinkage at 1 cm terrain", fine, exact, 3e-5, "m", SEGMENT),
        Row::new(case, "sinkage at 4 cm terrain", usual, exact, 3e-5, "m", SEGMENT),
        Row::order_at_least(case, "16 cm to 4 cm", order, 2.0, source),
    ]
}

const BOGIE: [[f64; 2]; 2] = [[-0.75, 0.0], [0.75, 0.0]];
const FOUR_WHEELS: [[f64; 2]; 4] = [[-1.2, 0.9], [-1.2, -0.9], [1.2, 0.9], [1.2, -0.9]];

/// Moment about the pivot of a bogie turned by 5°: Σ of cylinder forces through the axles.
pub fn torque_of_a_bogie() -> Vec<Row> {
    let case = "P2 test 4: torque of a bogie";
    let angle = 5.0_f64.to_radians();
    let plane = Plane { slope: 0.0, stiffness: STIFFNESS };
    let wheels = BOGIE.map(|[x, _]| Wheel::cylinder(Vec3::new(x, 0.0, 0.0), 0.5, 0.5)).to_vec();
    let foot = Foot { body: 0, wheels, belts: Vec::new() };
    let turn = Orientation::from_axis_angle(&Vec3::y_axis(), angle);
    let settings = SearchSettings::default();
    let height = 0.38;
    let exact: f64 = BOGIE
        .iter()
        .map(|[x, _]| {
            let wheel = WheelAt { x: x * angle.cos(), z: height - x * angle.sin(), radius: 0.5, width: 0.5 };
            let [f_x, f_z] = plane.force(&wheel);
            (wheel.z - height) * f_x - wheel.x * f_z
        })
        .sum();
    let computed = |spacing| {
        let terrain = flat_ground(spacing, 5.0);
        let pose = Pose::from_parts(Vec3::new(0.0031, 0.002, height).into(), turn);
        let imprint = foot.imprint(&terrain, &pose, 0.0, settings.partial);
        imprint.load(&terrain, &Pose::identity(), &settings.integration()).wrench.moment.y
    };
    let (coarse, fine) = (computed(0.02), computed(0.01));
    let order = ((coarse - exact).abs() / (fine - exact).abs()).log2();
    vec![
        Row::new(case, "moment about the pivot at 1 cm", fine, exact, 1e-3 * exact.abs(), "N·m", SEGMENT),
        Row::new(case, "observed order, 2 cm to 1 cm", order, 2.0, 0.6, "-", "linear polygons under an arc"),
    ]
}

/// A bogie loaded at its pivot stands parallel to the slope.
pub fn bogie_on_a_slope() -> Vec<Row> {
    let case = "P2 test 5: equilibrium of a bogie on a slope";
    let machine = stiff_machine(4_000.0, Vec3::zeros(), &BOGIE);
    [5.0_f64, 12.0, -20.0]
        .iter()
        .map(|degrees| {
            let slope = degrees.to_radians();
            let pitch = rest(&machine, &sloped_ground(0.02, slope.tan()), [0.6, -0.8 * slope, 0.0])[1];
            let quantity = format!("angle on a slope of {degrees}°");
            Row::new(case, quantity, -pitch, slope, 1e-4, "rad", "both wheels sink alike: the slope itself")
        })
        .collect()
}

/// A bogie under 8,000 kg on flat ground.
pub fn rut_of_a_bogie() -> Vec<Row> {
    rut_rows("P2 test 6: rut depth of a bogie", &stiff_machine(8_000.0, Vec3::zeros(), &BOGIE), 2.0)
}

/// A stiff frame on four wheels.
pub fn rut_of_a_stiff_frame() -> Vec<Row> {
    let machine = stiff_machine(14_000.0, Vec3::new(0.0, 0.0, 0.4), &FOUR_WHEELS);
    rut_rows("P2 test 10: rut depth, stiff frame on wheels", &machine, 4.0)
}

/// A stiff frame on four bogies.
pub fn rut_of_a_stiff_frame_on_bogies() -> Vec<Row> {
    let frame = Body {
        name: "frame".into(),
        parent: None,
        attachment: Vec3::zeros(),
        joint: Joint::Held { axis: Vec3::y() },
        mass: 24_000.0,
        centre_of_mass: Vec3::new(0.0, 0.0, 0.4),
    };
    let mut bodies = vec![frame];
    let mut feet = Vec::new();
    for [x, y] in [[1.3, 0.9], [1.3, -0.9], [-1.3, 0.9], [-1.3, -0.9]] {
        feet.push(Foot {
            body: bodies.len(),
            wheels: [-0.6, 0.6].map(|x| Wheel::cylinder(Vec3::new(x, 0.0, 0.0), 0.5, 0.5)).to_vec(),
            belts: Vec::new(),
        });
        bodies.push(Body {
            name: "bogie".into(),
            parent: Some(0),
            attachment: Vec3::new(x, y, 0.0),
            joint: Joint::Free { axis: Vec3::y(), limits: [-0.5, 0.5] },
            mass: 500.0,
            centre_of_mass: Vec3::zeros(),
        });
    }
    let machine = Machine::new(Mechanism::new(bodies).expect("five bodies"), feet).expect("sound wheels");
    rut_rows("P2 test 11: rut depth, stiff frame on bogies", &machine, 8.0)
}

/// A stiff frame with a raised centre of mass on a slope of 10°: lengthwise against cylinders on an inclined plane, sideways
/// against the lever rule's direction.
pub fn stiff_frame_on_a_slope() -> Vec<Row> {
    let case = "P2 test 15: stiff frame on a slope";
    let centre = Vec3::new(0.0, 0.0, 0.9);
    let machine = stiff_machine(14_000.0, centre, &FOUR_WHEELS);
    let slope = 10.0_f64.to_radians();
    let plane = Plane { slope: slope.tan(), stiffness: STIFFNESS };
    // Height above the origin's ground and pitch: two equations in two unknowns.
    let residual = |[height, pitch]: [f64; 2]| {
        let weight = 14_000.0 * GRAVITY;
        let mut sum = [-weight, weight * (centre.z * pitch.sin() + centre.x * pitch.cos())];
        for [x, _] in FOUR_WHEELS {
            let (dx, dz) = (x * pitch.cos(), -x * pitch.sin());
            let wheel = WheelAt { x: dx, z: height + dz, radius: 0.5, width: 0.5 };
            let [f_x, f_z] = plane.force(&wheel);
            sum = [sum[0] + f_z, sum[1] + dz * f_x - dx * f_z];
        }
        sum
    };
    let exact = super::plane::newton(residual, [0.4, -slope]);
    // The machine stands at x = 0.0031 m, where the ground is higher.
    let [height, pitch, _] = rest(&machine, &sloped_ground(0.02, slope.tan()), [0.6, -slope, 0.0]);
    let height = height - 0.0031 * slope.tan();
    let source = "cylinders on an inclined plane in closed form, balance by Newton's method";
    let sinkage = |height: f64, pitch: f64, x: f64| {
        // Below the ground, measured square to the slope.
        let wheel_z = height - x * pitch.sin() - x * pitch.cos() * slope.tan();
        0.5 - wheel_z * slope.cos()
    };
    let mut rows: Vec<Row> = [(1.2, "upper"), (-1.2, "lower")]
        .iter()
        .map(|&(x, name)| {
            let (computed, exact) = (sinkage(height, pitch, x), sinkage(exact[0], exact[1], x));
            Row::new(case, format!("depth of the {name} wheels"), computed, exact, 2e-4, "m", source)
        })
        .collect();
    rows.push(Row::new(case, "pitch", pitch, exact[1], 1e-4, "rad", source));
    rows
}
