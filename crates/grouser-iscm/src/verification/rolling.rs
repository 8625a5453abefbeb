//! Rolling resistance and runs.

use grouser_geometry::{Pose, Vec3};

use super::{Row, component_vehicle, flat_ground};
use crate::contact::FootImprint;
use crate::equilibrium::SearchSettings;
use crate::gear::{Foot, Wheel};
use crate::mechanism::GRAVITY;
use crate::rolling_resistance::{WheelResistance, foot_resistance};
use crate::route::Route;
use crate::run::{RunSettings, RunState};
use crate::terrain::Unloading;

/// A bogie turned 8° nose down on flat ground, rolling along itself: sin 8° for every wheel.
pub fn bogie_rolling_down() -> Vec<Row> {
    let case = "P2 test 19: rolling resistance of a bogie";
    let terrain = flat_ground(0.01, 5.0);
    let angle = 8.0_f64.to_radians();
    let wheels = [-0.75, 0.75].map(|x| Wheel::cylinder(Vec3::new(x, 0.0, 0.0), 0.5, 0.5)).to_vec();
    let foot = Foot { body: 0, wheels, belts: Vec::new() };
    let turn = grouser_geometry::Orientation::from_axis_angle(&Vec3::y_axis(), angle);
    let pose = Pose::from_parts(Vec3::new(0.0031, 0.002, 0.36).into(), turn);
    let settings = SearchSettings::default();
    let imprint: FootImprint = foot.imprint(&terrain, &pose, 0.0, settings.partial);
    let polygons = imprint.polygons(&terrain, &Pose::identity(), &settings.integration());
    let rolling = turn * Vec3::x();
    let wheels = foot_resistance(&foot, &pose, 0.0, rolling, &polygons, &imprint);
    let row = |(k, w): (usize, &WheelResistance)| Row {
        case,
        quantity: format!("coefficient of wheel {k}"),
        computed: w.coefficient(),
        reference: angle.sin(),
        tolerance: 1e-4,
        unit: "-",
        source: "closed form: −F·r_d/|F| on flat ground = sin 8°",
    };
    wheels.iter().enumerate().filter(|(_, w)| w.normal_force > 0.0).map(row).collect()
}

/// A bogie driven over flat soil against rolling of two wheels one after the other in closed form, and its variance.
pub fn bogie_on_the_run() -> Vec<Row> {
    let case = "P2 test 20: rolling resistance on the run";
    let (mass, k_w, r, lever) = (4_000.0, 1.5e6 * 0.5, 0.5_f64, 0.75);
    // Rolling on plastic soil: in front the ground is pressed from its level down, behind it follows over the contact distance.
    let contact = 1e-3;
    let forces = |z: f64, level: f64| -> [f64; 2] {
        let n = 20_000;
        let mut sum = [0.0; 2];
        for k in 0..n {
            let u = -r + 2.0 * r * (f64::from(k) + 0.5) / f64::from(n);
            let s = (r * r - u * u).sqrt();
            let depth = z - (r - s);
            let ground = if u > 0.0 { level } else { z - contact };
            let p = k_w * depth * ((depth - ground) / contact).clamp(0.0, 1.0) * 2.0 * r / f64::from(n);
            if depth > 0.0 {
                sum = [sum[0] + p * u / s, sum[1] + p];
            }
        }
        sum
    };
    let (front, rear) = (|z: f64| forces(z, 0.0), |z_1: f64, z_2: f64| forces(z_2, z_1 - contact));
    let balance = |[z_1, z_2]: [f64; 2]| {
        let ([r_1, w_1], [r_2, w_2]) = (front(z_1), rear(z_1, z_2));
        let sin = (z_1 - z_2) / (2.0 * lever);
        [w_1 + w_2 - mass * GRAVITY, sin * (r_1 - r_2) - (1.0 - sin * sin).sqrt() * (w_1 - w_2)]
    };
    let [z_1, z_2] = super::plane::newton(balance, [0.11, 0.13]);
    let coefficient = |[f, w]: [f64; 2]| f / f.hypot(w);
    let exact = [coefficient(rear(z_1, z_2)), coefficient(front(z_1))];
    let settings = RunSettings {
        route: Route { points: vec![[0.0, 0.0], [2.7, 0.0]] },
        run_step: 0.06,
        intermediate_steps: 15,
        search: SearchSettings { position_tolerance: 1e-6, ..SearchSettings::default() },
    };
    let machine = super::bogie(mass, None);
    let spacing = 0.25 / 12.5;
    let terrain =
        super::ground(spacing, [-80.0 * spacing, -20.0 * spacing], [6.0, 40.0 * spacing], |_, _| 0.0)
            .with_unloading(Unloading::Plastic { contact_distance: contact });
    let run = || -> Option<Vec<[f64; 3]>> {
        let mut state = RunState::start(&machine, terrain.ok()?, &settings).ok()?;
        let mut found = Vec::new();
        while state.can_go_on(&settings) {
            let step = state.step(&machine, &settings).ok()?;
            if step.distance > 2.2 {
                let wheels = &step.wheels[0];
                found.push([wheels[0].coefficient(), wheels[1].coefficient(), step.total.coefficient()]);
            }
        }
        Some(found)
    };
    let found = run().unwrap_or_else(|| vec![[f64::NAN; 3]]);
    let mean = |k: usize| found.iter().map(|f| f[k]).sum::<f64>() / found.len() as f64;
    let source = "pressure over the chords of two wheels in one rut, fine sums";
    let variance = found.iter().map(|f| (f[2] / mean(2) - 1.0).powi(2)).sum::<f64>() / found.len() as f64;
    vec![
        Row::new(case, "coefficient of the front wheel", mean(1), exact[1], 0.01 * exact[1], "-", source),
        Row::new(case, "coefficient of the rear wheel", mean(0), exact[0], 0.02 * exact[0], "-", source),
        Row::new(
            case,
            "standard deviation of the total per mean",
            variance.sqrt(),
            0.0,
            0.002,
            "-",
            "flat ground",
        ),
    ]
}

/// A tracked bogie turned 8° nose down: arcs, a flat span and the weight of the shoes, summed apart from any grid.
pub fn bogie_with_a_track() -> Vec<Row> {
    let case = "P2 test 21: rolling resistance of a tracked bogie";
    let angle = 8.0_f64.to_radians();
    let (height, width, stiffness) = (0.45, 0.6, 1.5e6);
    let terrain = flat_ground(0.01, 5.0);
    let turn = grouser_geometry::Orientation::from_axis_angle(&Vec3::y_axis(), angle);
    let pose = Pose::from_parts(Vec3::new(0.0031, 0.002, height).into(), turn);
    let rolling = turn * Vec3::x();
    let settings = SearchSettings::default();
    let mut rows = Vec::new();
    let mut totals = Vec::new();
    for mass in [0.0, 10.0, 40.0] {
        let machine = super::bogie(4_000.0, Some(mass));
        let foot = &machine.feet[0];
        let imprint = foot.imprint(&terrain, &pose, 0.0, settings.partial);
        let polygons = imprint.polygons(&terrain, &Pose::identity(), &settings.integration());
        let wheels = foot_resistance(foot, &pose, 0.0, rolling, &polygons, &imprint);
        let exact = tracked_reference(angle, height, width, stiffness, mass);
        for (k, wheel) in wheels.iter().enumerate() {
            let [force, normal, vertical] = exact[k];
            let name = ["rear", "front"][k];
            let source = "arcs and span by fine sums, shoes one by one";
            let quantity = |what: &str| format!("{what}, {name} wheel, shoes of {mass} kg");
            if normal < 1_000.0 {
                continue;
            }
            rows.push(Row::new(
                case,
                quantity("F_R/N"),
                wheel.coefficient(),
                force / normal,
                1e-3,
                "-",
                source,
            ));
            rows.push(Row::new(
                case,
                quantity("F_R per vertical force"),
                wheel.coefficient_of_vertical(),
                force / vertical,
                1e-3,
                "-",
                source,
            ));
        }
        totals.push(WheelResistance::total(&wheels));
    }
    let rising = totals.windows(2).all(|t| t[1].force > t[0].force);
    let source = "heavier shoes push along the descent";
    rows.push(Row::new(
        case,
        "F_R grows with the shoes' mass (1 = yes)",
        f64::from(u8::from(!rising)),
        1.0,
        0.0,
        "-",
        source,
    ));
    rows
}

/// \[F_R, norm, vertical part\] of the rear and front wheel of the test's tracked bogie at rest on level soil.
fn tracked_reference(angle: f64, height: f64, width: f64, stiffness: f64, mass: f64) -> [[f64; 3]; 2] {
    let (r, depth, lever, n_shoes) = (0.5, 0.02, 0.75, 60_usize);
    // In the bogie's frame (forward, up); the world is turned by the angle, nose down.
    let world = |[x, z]: [f64; 2]| [x * angle.cos() + z * angle.sin(), -x * angle.sin() + z * angle.cos()];
    let pressed = |p: [f64; 2]| stiffness * width * (-(height + world(p)[1])).max(0.0);
    let mut forces: [Vec<([f64; 2], [f64; 2])>; 2] = [Vec::new(), Vec::new()];
    // Along the links, anticlockwise from the lowest point of the front wheel: point, outward normal, radius of curvature.
    let length = std::f64::consts::TAU * r + 4.0 * lever;
    let half_turn = std::f64::consts::PI * r;
    let place = |s: f64| {
        let arc = |side: f64, phi: f64| {
            let normal = [side * phi.sin(), -phi.cos()];
            ([side * lever + r * normal[0], r * normal[1]], normal, r)
        };
        if s < half_turn {
            arc(1.0, s / r)
        } else if s < half_turn + 2.0 * lever {
            ([lever - (s - half_turn), r], [0.0, 1.0], f64::INFINITY)
        } else if s < 2.0 * half_turn + 2.0 * lever {
            arc(-1.0, std::f64::consts::PI - (s - half_turn - 2.0 * lever) / r)
        } else {
            ([-lever + s - 2.0 * half_turn - 2.0 * lever, -r], [0.0, -1.0], f64::INFINITY)
        }
    };
    let pitch = length / n_shoes as f64;
    let n = 4_000;
    for shoe in 0..n_shoes {
        let mut force = [0.0, -mass * GRAVITY];
        for i in 0..n {
            let ([x, z], normal, radius) = place((shoe as f64 + (i as f64 + 0.5) / n as f64) * pitch);
            let p = pressed([x + depth * normal[0], z + depth * normal[1]]);
            let push = p * pitch / n as f64 * (1.0 + depth / radius);
            let pushed = world([-normal[0] * push, -normal[1] * push]);
            if world(normal)[1] < 0.0 {
                force = [force[0] + pushed[0], force[1] + pushed[1]];
            }
        }
        let (middle, _, radius) = place((shoe as f64 + 0.5) * pitch);
        if radius.is_finite() {
            forces[usize::from(middle[0] > 0.0)].push((force, world(middle)));
        } else {
            let half = [force[0] / 2.0, force[1] / 2.0];
            for (wheel, side) in [(0, -1.0), (1, 1.0)] {
                forces[wheel].push((half, world([side * lever, middle[1]])));
            }
        }
    }
    let direction = world([1.0, 0.0]);
    let down = world([0.0, -1.0]);
    std::array::from_fn(|k| {
        let centre = world([[-1.0, 1.0][k] * lever, 0.0]);
        let pivot = [centre[0] + r * down[0], centre[1] + r * down[1]];
        // Moments about y (left), forces × arms as in P2 Eq. (17).
        let moment: f64 =
            forces[k].iter().map(|(f, p)| f[1] * (p[0] - pivot[0]) - f[0] * (p[1] - pivot[1])).sum();
        let total = forces[k].iter().fold([0.0; 2], |t, (f, _)| [t[0] + f[0], t[1] + f[1]]);
        debug_assert!(direction[0] > 0.0);
        [moment / r, total[0].hypot(total[1]), total[1]]
    })
}

/// A run cut in the middle and taken up again ends with the same state, bit by bit.
pub fn restart() -> Vec<Row> {
    let case = "P2 test 25: restart";
    let machine = component_vehicle(32_400.0, true, 0.05);
    let settings = RunSettings {
        route: Route { points: vec![[2.0, 0.0], [3.0, 0.0]] },
        run_step: 0.12,
        intermediate_steps: 2,
        search: SearchSettings { position_tolerance: 1e-6, ..SearchSettings::default() },
    };
    let run = || -> Option<(RunState, RunState)> {
        let mut straight = RunState::start(&machine, flat_ground(0.08, 9.0), &settings).ok()?;
        straight.step(&machine, &settings).ok()?;
        let mut resumed = straight.clone();
        straight.step(&machine, &settings).ok()?;
        resumed.step(&machine, &settings).ok()?;
        Some((straight, resumed))
    };
    let computed = run().map_or(f64::NAN, |(a, b)| f64::from(u8::from(a != b)));
    vec![Row {
        case,
        quantity: "states that differ".into(),
        computed,
        reference: 0.0,
        tolerance: 0.0,
        unit: "-",
        source: "the uninterrupted run",
    }]
}
