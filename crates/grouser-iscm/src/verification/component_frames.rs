//! Vehicles of components: their axes, where they drive, and how they stand on a slope.

use super::plane::{Plane, WheelAt, newton};
use super::{Row, component_vehicle_with, flat_ground, sloped_ground};
use crate::equilibrium::{Frozen, SearchSettings, equilibrium, start_position};
use crate::mechanism::GRAVITY;
use crate::route::Route;
use crate::run::{RunSettings, RunState};
use grouser_geometry::Vec3;
use std::f64::consts::TAU;

/// Body axes after heading ψ, pitch θ and roll φ against the product of the three matrices written out.
pub fn axes_and_angles() -> Vec<Row> {
    let case = "P2 test 7: axes and angles";
    let machine = component_vehicle_with(30_000.0, false, Vec3::new(0.0, 0.0, 0.3));
    let (mut axes, mut angles, mut bogie) = (0.0_f64, 0.0_f64, 0.0_f64);
    for k in 0..64 {
        let part = |n: f64| (f64::from(k) * n).sin();
        let (heading, pitch, roll) = (TAU / 2.0 * part(0.7), 0.9 * part(1.3), 0.9 * part(2.1));
        let mut at = machine.mechanism.at([1.0, -2.0], heading, 0.4);
        (at.pitch, at.roll) = (pitch, roll);
        at.joints[1] = 0.4 * part(3.3);
        let poses = machine.mechanism.poses(&at);
        let ((s_h, c_h), (s_p, c_p), (s_r, c_r)) = (heading.sin_cos(), pitch.sin_cos(), roll.sin_cos());
        let exact = [
            Vec3::new(c_h * c_p, s_h * c_p, -s_p),
            Vec3::new(c_h * s_p * s_r - s_h * c_r, s_h * s_p * s_r + c_h * c_r, c_p * s_r),
            Vec3::new(c_h * s_p * c_r + s_h * s_r, s_h * s_p * c_r - c_h * s_r, c_p * c_r),
        ];
        for (axis, exact) in [Vec3::x(), Vec3::y(), Vec3::z()].iter().zip(&exact) {
            axes = axes.max((poses[0].rotation * axis - exact).norm());
        }
        let x = poses[0].rotation * Vec3::x();
        let y = poses[0].rotation * Vec3::y();
        let z = poses[0].rotation * Vec3::z();
        let back = [x.y.atan2(x.x) - heading, (-x.z).asin() - pitch, y.z.atan2(z.z) - roll];
        angles = angles.max(back.iter().fold(0.0, |a, b| a.max(b.abs())));
        // A bogie turns about the frame's y axis.
        let turned = exact[0] * at.joints[1].cos() - exact[2] * at.joints[1].sin();
        bogie = bogie.max((poses[1].rotation * Vec3::x() - turned).norm());
    }
    let source = "rotation matrices written out";
    vec![
        Row::new(case, "largest difference of a body axis", axes, 0.0, 1e-13, "-", source),
        Row::new(case, "largest difference of an angle", angles, 0.0, 1e-12, "rad", source),
        Row::new(case, "largest difference of a bogie's axis", bogie, 0.0, 1e-13, "-", source),
    ]
}

/// Where wheels move when the machine drives in 16 headings.
pub fn drive_direction() -> Vec<Row> {
    let case = "P2 test 8: drive direction";
    let machine = component_vehicle_with(30_000.0, false, Vec3::new(0.0, 0.0, 0.3));
    let search = SearchSettings { position_tolerance: 1e-5, ..SearchSettings::default() };
    let mut largest = 0.0_f64;
    for k in 0..16 {
        let heading = TAU * f64::from(k) / 16.0;
        let along = |s: f64| [s * heading.cos(), s * heading.sin()];
        let settings = RunSettings {
            route: Route { points: vec![along(2.0), along(3.0)] },
            run_step: 0.3,
            intermediate_steps: 0,
            search,
        };
        let centres = |state: &RunState| state.wheel_centres.concat();
        let driven = RunState::start(&machine, flat_square(0.2), &settings).and_then(|mut state| {
            let before = centres(&state);
            state.step(&machine, &settings)?;
            Ok((before, centres(&state)))
        });
        let Ok((before, after)) = driven else {
            largest = f64::NAN;
            break;
        };
        for (a, b) in before.iter().zip(&after) {
            let off = (b.y - a.y).atan2(b.x - a.x) - heading;
            largest = largest.max(off.sin().atan2(off.cos()).abs());
        }
    }
    vec![Row::new(
        case,
        "largest deviation in 16 headings",
        largest,
        0.0,
        1e-5,
        "rad",
        "heading of the route",
    )]
}

fn flat_square(spacing: f64) -> crate::terrain::Terrain {
    super::ground(spacing, [-6.0, -6.0], [12.0, 12.0], |_, _| 0.0)
}

/// Two frames on four bogies, centre of mass raised, facing up a slope of 10°.
pub fn component_vehicle_on_a_slope() -> Vec<Row> {
    let case = "P2 test 14: component vehicle on a slope";
    let (mass, raised) = (30_000.0, 0.9);
    let slope = 10.0_f64.to_radians();
    let machine = component_vehicle_with(mass, false, Vec3::new(0.0, 0.0, raised));
    let plane = Plane { slope: slope.tan(), stiffness: 1.5e6 };
    // Unknown: height and pitch of the frames, angles of the front and rear bogies. Frames 1.5 m either side of nothing: the
    // front axle at 0, the rear one 4 m behind; bogies of 600 kg with their mass on the pivot.
    let (bogie_mass, lever) = (600.0, 0.75);
    let frames = mass / 2.0 - 2.0 * bogie_mass;
    let residual = |[height, pitch, front, rear]: [f64; 4]| {
        let place =
            |x: f64, z: f64| [x * pitch.cos() + z * pitch.sin(), height - x * pitch.sin() + z * pitch.cos()];
        let mut sum = [0.0; 4];
        for (k, (along, bogie)) in [(0.0, front), (-4.0, rear)].into_iter().enumerate() {
            let centre = place(along, raised);
            let pivot = place(along, 0.0);
            sum[0] -= (frames + 2.0 * bogie_mass) * GRAVITY;
            sum[1] += GRAVITY * (frames * centre[0] + 2.0 * bogie_mass * pivot[0]);
            for side in [lever, -lever] {
                let angle = pitch + bogie;
                let arm = [side * angle.cos(), -side * angle.sin()];
                let wheel = WheelAt { x: pivot[0] + arm[0], z: pivot[1] + arm[1], radius: 0.5, width: 0.5 };
                let [f_x, f_z] = plane.force(&wheel).map(|f| 2.0 * f);
                sum[0] += f_z;
                sum[1] += (wheel.z - height) * f_x - wheel.x * f_z;
                sum[2 + k] += arm[1] * f_x - arm[0] * f_z;
            }
        }
        sum
    };
    let exact = newton(residual, [0.38, -slope, 0.0, 0.0]);
    let settings = SearchSettings::default();
    let terrain = sloped_ground(0.02, slope.tan());
    let x = 2.0031;
    let mut from = machine.mechanism.at([x, 0.0021], 0.0, 1.0);
    from.pitch = -slope;
    let rest = start_position(&machine, &terrain, &from, 0.0, &settings)
        .and_then(|start| equilibrium(&machine, &terrain, &start, 0.0, &settings));
    let q =
        rest.map_or(vec![f64::NAN; machine.mechanism.n_dofs()], |r| machine.mechanism.dofs(&r.configuration));
    let source = "cylinders on an inclined plane in closed form, balance by Newton's method";
    let height = q[0] - x * slope.tan();
    let joint = |name: &str| {
        (3..machine.mechanism.n_dofs())
            .find(|&k| machine.mechanism.dof_name(k) == name)
            .map_or(f64::NAN, |k| q[k])
    };
    let depth = |height: f64, pitch: f64, along: f64| {
        0.5 - (height - along * pitch.sin() - along * pitch.cos() * slope.tan()) * slope.cos()
    };
    vec![
        Row::new(
            case,
            "depth of the front bogies",
            depth(height, q[1], 0.0),
            depth(exact[0], exact[1], 0.0),
            1e-4,
            "m",
            source,
        ),
        Row::new(
            case,
            "depth of the rear bogies",
            depth(height, q[1], -4.0),
            depth(exact[0], exact[1], -4.0),
            1e-4,
            "m",
            source,
        ),
        Row::new(case, "pitch", q[1], exact[1], 1e-4, "rad", source),
        Row::new(case, "angle of a front bogie", joint("front axle 1 left"), exact[2], 2e-4, "rad", source),
        Row::new(case, "angle of a rear bogie", joint("rear axle 1 right"), exact[3], 2e-4, "rad", source),
    ]
}

/// The loose search of the intermediate steps, one step ahead of a rest, against the full one.
pub fn intermediate_step() -> Vec<Row> {
    let case = "P2 test 17: search at intermediate steps";
    let machine = component_vehicle_with(30_000.0, false, Vec3::new(0.05, 0.02, 0.3));
    let terrain = flat_ground(0.04, 9.0);
    let settings = SearchSettings::default();
    let from = machine.mechanism.at([2.003, 0.0021], 0.0, 0.39);
    let source = "full equilibrium search";
    let solved = equilibrium(&machine, &terrain, &from, 0.0, &settings).and_then(|rest| {
        let mut ahead = rest.configuration;
        ahead.position[0] += 0.003;
        let exact = equilibrium(&machine, &terrain, &ahead, 0.003, &settings)?;
        let frozen = Frozen::new(&machine, &terrain, &ahead, 0.003, settings.integration())?;
        let (loose, _) = frozen.settle_and_lift(&machine, &terrain, 1e-4);
        let again = Frozen::new(&machine, &terrain, &loose, 0.003, settings.integration())?;
        let carried: f64 = again.loads.iter().map(|l| l.wrench.force.z).sum();
        Ok((exact.configuration, loose, carried))
    });
    let Ok((exact, loose, carried)) = solved else {
        return vec![Row::new(case, "equilibrium", f64::NAN, 0.0, 0.0, "-", "must exist")];
    };
    let weight = machine.mechanism.mass() * GRAVITY;
    vec![
        Row::new(case, "height", loose.height, exact.height, 2e-4, "m", source),
        Row::new(case, "pitch", loose.pitch, exact.pitch, 2e-4, "rad", source),
        Row::new(case, "roll", loose.roll, exact.roll, 2e-4, "rad", source),
        Row::new(
            case,
            "load that the ground does not carry, per weight",
            1.0 - carried / weight,
            1.5e-3,
            1.5e-3,
            "-",
            "P2 §2.4: less than the weight",
        ),
    ]
}
