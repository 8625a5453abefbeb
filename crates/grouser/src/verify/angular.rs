//! Tilting grains: arms, toppling, limits, energy, rest.

use super::Row;
use super::bodies::{space, wall};
use grouser_contact::{
    GrainInertia, GrainShape, HertzMindlin, Interaction, Material, PairTable, PlaneShape, PlaneTilting,
    Quaternion, Rotating, RotationLaw, Sphere, Tail, Tilting, TiltingSettings, Vector,
};
use grouser_dem::{Bed, BedSettings, Failure, sphere};
use grouser_geometry::{Orientation, Vec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

const ARMS: (&str, &str) = ("tilting arms", "closed form of Lichtenheldt & Schäfer (2013), Fig. 4");
const TOPPLING: (&str, &str) = ("toppling", "arctan(1/A) on the long side, arctan(A) on the short side");
const LIMITS: (&str, &str) = ("tilting limits", "spheres; symmetry of a square");
const TURNS: (&str, &str) = ("tilting energy", "conservation");

pub(super) const SAND: Material = Material { young_pa: 1e7, poisson: 0.3, density_kg_m3: 2600.0 };
pub(super) const RADIUS: f64 = 0.01;

pub(super) fn tilting<const IS_ROUND: bool>(shape: GrainShape, smoothing_rad: f64) -> Tilting<IS_ROUND> {
    Tilting::new(&TiltingSettings { smoothing_rad, ..TiltingSettings::of(shape) }).expect("sound")
}

/// One grain 1 µm deep in the floor or above it, turned by `turn`.
pub(super) fn one<R: RotationLaw<f64>>(
    rotation: R,
    settings: BedSettings,
    friction: f64,
    turn: Orientation,
) -> Bed<Rotating<HertzMindlin, R>> {
    let between = Interaction { restitution: 0.1, friction };
    let table = PairTable::new(&[SAND], Tail::CutCorrected, |_, _| between).expect("sound");
    let bead: Sphere = sphere(Vec3::new(0.0, 0.0, RADIUS), RADIUS, SAND.density_kg_m3, 0);
    let law = Rotating { forces: HertzMindlin::new(Tail::CutCorrected), rotation };
    let mut bed = Bed::new(vec![bead], settings, table, law).expect("sound");
    bed.grains_mut().track_orientations();
    bed.grains_mut().orientations.as_mut().expect("tracked")[0] = turn;
    bed
}

pub(super) fn orientation<L: grouser_contact::ContactLaw<f64>>(bed: &Bed<L>) -> Orientation {
    bed.grains().orientations.as_ref().expect("tracked")[0]
}

/// l_N and l_T over r of plane `i` at `angle`, in a frame turned by `world`.
fn arms(law: &Tilting, i: usize, angle: f64, world: &Orientation) -> [f64; 2] {
    arms_of(|frame, normal, force| law.torque(frame, normal, force, 1.0), i, angle, world)
}

/// The same of a law that gives the torque of a force under a normal.
fn arms_of(
    torque: impl Fn(&Quaternion<f64>, Vector<f64>, Vector<f64>) -> Vector<f64>,
    i: usize,
    angle: f64,
    world: &Orientation,
) -> [f64; 2] {
    let [j, k] = [[1, 2], [0, 2], [0, 1]][i];
    let (along, up) = (Vec3::ith(j, 1.0), Vec3::ith(k, 1.0));
    let axis = along.cross(&up);
    let turned = world * Orientation::from_scaled_axis(axis * angle);
    let frame = Quaternion(turned.coords.into());
    let narrow = |v: Vec3| Vector::new(v.x, v.y, v.z);
    let (normal, along, axis) = (narrow(world * up), narrow(world * along), narrow(world * axis));
    let of = |force| torque(&frame, normal, force).dot(axis);
    [-of(normal), of(along)]
}

/// The closed form for d = r, written with angles.
fn closed_form(aspect_ratio: f64, angle: f64) -> [f64; 2] {
    let mut gamma = aspect_ratio.atan();
    let mut theta = angle - PI * (angle / PI).round();
    if theta.abs() > 45_f64.to_radians() {
        theta -= FRAC_PI_2 * theta.signum();
        gamma = FRAC_PI_2 - gamma;
    }
    [theta.signum() * (gamma + theta.abs()).cos(), (gamma + theta.abs()).sin()]
}

/// Arms over a full turn, in each plane and in rotated frames, and where the normal arm changes sign.
pub fn arms_and_sign_change() -> Vec<Row> {
    let mut rows = Vec::new();
    for aspect_ratio in [0.05, 0.1, 0.5, 1.0] {
        let shape = GrainShape::Angular { aspect_ratio };
        let law = tilting(shape, 1e-4);
        let half = law.half_sides();
        let mut worst = 0.0_f64;
        for (i, plane) in shape.planes().into_iter().enumerate() {
            let PlaneShape::Rectangle { aspect_ratio: a, .. } = plane else { continue };
            let [j, k] = [[1, 2], [0, 2], [0, 1]][i];
            let d = f64::hypot(half[j], half[k]);
            for step in 0..720 {
                let angle = f64::to_radians(0.25 + 0.5 * f64::from(step));
                let world =
                    Orientation::from_euler_angles(0.1 * f64::from(step), 1.3, 0.07 * f64::from(step));
                let (found, expected) = (arms(&law, i, angle, &world), closed_form(a, angle));
                worst = (0..2).map(|part| (found[part] - d * expected[part]).abs()).fold(worst, f64::max);
            }
        }
        let what = format!("largest deviation in three planes, A = {aspect_ratio}");
        rows.push(Row::absolute(ARMS, what, "r", worst, (0.0, 1e-6)));
        let (mut low, mut high) = (0.01, 1.56);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if arms(&law, 1, middle, &Orientation::identity())[0] > 0.0 {
                low = middle
            } else {
                high = middle
            }
        }
        let expected = (1.0 / aspect_ratio).atan().to_degrees();
        let what = format!("sign change of the normal arm, A = {aspect_ratio}");
        rows.push(Row::absolute(ARMS, what, "°", low.to_degrees(), (expected, 1e-4)));
    }
    for (aspect_ratio, scale) in [(0.05, 1.0), (0.05, 0.1), (1.0, 0.1)] {
        let shape = GrainShape::Planes([PlaneShape::Rectangle { aspect_ratio, scale }; 3]);
        let settings = TiltingSettings { smoothing_rad: 1e-4, ..TiltingSettings::of(shape) };
        let law = PlaneTilting::new(&settings).expect("sound");
        let mut worst = 0.0_f64;
        for i in 0..3 {
            for step in 0..720 {
                let angle = f64::to_radians(0.25 + 0.5 * f64::from(step));
                let world =
                    Orientation::from_euler_angles(0.1 * f64::from(step), 1.3, 0.07 * f64::from(step));
                let torque = |frame: &Quaternion<f64>, normal: Vector<f64>, force: Vector<f64>| {
                    law.torque(frame, normal, force.dot(normal), force, 1.0)
                };
                let (found, expected) = (arms_of(torque, i, angle, &world), closed_form(aspect_ratio, angle));
                worst = (0..2).map(|part| (found[part] - scale * expected[part]).abs()).fold(worst, f64::max);
            }
        }
        let what =
            format!("largest deviation, three rectangles for themselves, A = {aspect_ratio}, s = {scale}");
        rows.push(Row::absolute(ARMS, what, "r", worst, (0.0, 1e-6)));
    }
    // r cos(arctan A + θ), r sin(arctan A + θ) of an inscribed bar at A = 0.5 and 10°, from a table.
    let bar = tilting(GrainShape::Bar { aspect_ratio: 0.5 }, 1e-4);
    let [n, t] = arms(&bar, 2, 10_f64.to_radians(), &Orientation::from_euler_angles(0.3, 0.2, 0.1));
    rows.push(Row::absolute(ARMS, "normal arm of a bar, A = 0.5, 10°", "r", n, (0.803_180_976, 1e-6)));
    rows.push(Row::absolute(ARMS, "tangential arm of a bar, A = 0.5, 10°", "r", t, (0.595_735_068, 1e-6)));
    rows
}

/// A grain that rests on a plane topples where its shape says, while the incline grows by 4° a second.
pub fn toppling() -> Vec<Row> {
    let mut rows = Vec::new();
    for aspect_ratio in [1.0_f64, 0.75, 0.5] {
        for (is_long, side) in [(true, "long"), (false, "short")] {
            let expected = if is_long { (1.0 / aspect_ratio).atan() } else { aspect_ratio.atan() };
            let found = toppling_incline(aspect_ratio, is_long, expected);
            let what = format!("incline, A = {aspect_ratio}, {side} side down");
            rows.push(Row::absolute(TOPPLING, what, "°", found, (expected.to_degrees(), 0.5)));
        }
    }
    rows
}

fn toppling_incline(aspect_ratio: f64, is_long: bool, expected: f64) -> f64 {
    let start = Orientation::from_scaled_axis(Vec3::y() * if is_long { 0.0 } else { FRAC_PI_2 });
    let law = tilting::<false>(GrainShape::Plate { aspect_ratio }, 5e-3);
    let mut bed = one(law, wall(0), 9.0, start);
    let (first, rate, dt) = ((expected - 0.035).max(0.0), 4_f64.to_radians(), 2e-5);
    let mut time = 0.0_f64;
    let incline = |time: f64| first * (time / 0.5).min(1.0) + rate * (time - 0.5).max(0.0);
    while time < 2.5 {
        let went = bed.run(500, dt, |grains| {
            time += dt;
            let weight = grains.spheres[0].mass * 9.81 * (time / 0.1).min(1.0);
            let (sin, cos) = incline(time).sin_cos();
            grains.loads[0].force += Vector::new(sin, 0.0, -cos) * weight;
            Ok::<(), Failure>(())
        });
        if went.is_err() {
            return f64::NAN;
        }
        if orientation(&bed).angle_to(&start) > 0.1 {
            return incline(time).to_degrees();
        }
    }
    f64::NAN
}

/// Circles are spheres, squares are symmetric.
pub fn limits() -> Vec<Row> {
    let ball = tilting::<true>(GrainShape::Planes([PlaneShape::Circle { scale: 1.0 }; 3]), 5e-3);
    let (mut of_ball, mut of_square) = (0.0_f64, 0.0_f64);
    let cube = tilting(GrainShape::Cube, 1e-4);
    for step in 0..200 {
        let k = f64::from(step);
        let frame = Quaternion(Orientation::from_euler_angles(k, 0.7 * k, 0.3 * k).coords.into());
        let turn = Orientation::from_euler_angles(0.9 * k, 0.2 * k, 0.5);
        let narrow = |v: Vec3| Vector::new(v.x, v.y, v.z);
        let (normal, tangential) = (narrow(turn * Vec3::z()), narrow(turn * Vec3::new(1.3, -0.4, 0.0)));
        let torque = ball.torque(&frame, normal, normal * 7.0 + tangential, 1.0);
        of_ball = of_ball.max((torque + normal.cross(tangential)).norm());
        let angle = FRAC_PI_2 * (k + 0.5) / 200.0;
        for plane in 0..3 {
            let here = arms(&cube, plane, angle, &turn);
            let there = arms(&cube, plane, FRAC_PI_2 - angle, &turn);
            of_square = of_square.max((here[0] + there[0]).abs()).max((here[1] - there[1]).abs());
        }
    }
    vec![
        Row::absolute(
            LIMITS,
            "three circles against a sphere, torque of a force of 7 N",
            "N·m/m",
            of_ball,
            (0.0, 1e-13),
        ),
        Row::absolute(LIMITS, "A = 1: arms at θ against 90° − θ", "r", of_square, (0.0, 1e-9)),
    ]
}

/// Nothing is gained over full turns under a grain's weight, nor in free rotation about the middle axis.
pub fn energy() -> Vec<Row> {
    let mut rows = Vec::new();
    for (name, shape) in [
        ("cube", GrainShape::Cube),
        ("A = 0.05", GrainShape::Angular { aspect_ratio: 0.05 }),
        ("A = 0.5", GrainShape::Angular { aspect_ratio: 0.5 }),
    ] {
        for smoothing in [5e-3, 0.1] {
            let settings = BedSettings { gravity: Vec3::new(0.0, 0.0, -9.81), ..wall(0) };
            let mut bed = one(tilting::<false>(shape, smoothing), settings, 0.0, Orientation::identity());
            let _ = bed.run(20_000, 2e-5, |_| Ok::<(), Failure>(()));
            let axis = orientation(&bed) * Vec3::y();
            bed.grains_mut().spheres[0].spin = Vector::new(axis.x, axis.y, axis.z) * 150.0;
            let begun = bed.grains().kinetic_energy()[1];
            let (mut turned, mut next, mut gained) = (0.0, TAU, f64::NEG_INFINITY);
            // A thousandth of a radian a step, twenty turns.
            while next < 20.5 * TAU {
                let _ = bed.step(7e-6);
                turned += bed.grains().spheres[0].spin.norm() * 7e-6;
                if turned >= next {
                    next += TAU;
                    gained = gained.max(bed.grains().kinetic_energy()[1] / begun - 1.0);
                }
            }
            let what = format!("largest gain over 20 turns, {name}, w = {smoothing}");
            rows.push(Row::absolute(TURNS, what, "-", gained.max(0.0), (0.0, smoothing.min(5e-3))));
        }
    }
    let planes = [1.0, 0.7, 0.4].map(|aspect_ratio| PlaneShape::Rectangle { aspect_ratio, scale: 1.0 });
    let shape = GrainShape::Planes(planes);
    let settings = TiltingSettings { inertia: GrainInertia::ThinRod, ..TiltingSettings::of(shape) };
    let mut bed = one(PlaneTilting::new(&settings).expect("sound"), space(), 0.5, Orientation::identity());
    bed.grains_mut().spheres[0].spin = Vector::new(1e-3, 500.0, 1e-3);
    let state = |bed: &Bed<_>| (bed.grains().kinetic_energy()[1], bed.grains().spin_momentum(0));
    let (begun, momentum) = state(&bed);
    let (mut of_energy, mut of_momentum) = (0.0_f64, 0.0_f64);
    for _ in 0..1000 {
        let _ = bed.run(100, 2e-5, |_| Ok::<(), Failure>(()));
        let now = state(&bed);
        of_energy = of_energy.max((now.0 / begun - 1.0).abs());
        of_momentum = of_momentum.max((now.1 - momentum).norm() / momentum.norm());
    }
    rows.push(Row::absolute(TURNS, "middle axis, 10⁵ steps: energy", "-", of_energy, (0.0, 1e-8)));
    rows.push(Row::absolute(
        TURNS,
        "middle axis, 10⁵ steps: angular momentum",
        "-",
        of_momentum,
        (0.0, 1e-8),
    ));
    rows
}
