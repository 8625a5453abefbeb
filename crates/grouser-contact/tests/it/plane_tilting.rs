//! Three rectangles for themselves: the printed tilting law against its closed form, `docs/theory/tilting.md`.

use crate::*;

fn law(shape: GrainShape, smoothing_rad: f64) -> PlaneTilting {
    PlaneTilting::new(&TiltingSettings { smoothing_rad, ..TiltingSettings::of(shape) }).unwrap()
}

/// The same rectangle in every plane.
fn alike(aspect_ratio: f64) -> GrainShape {
    GrainShape::Planes([PlaneShape::Rectangle { aspect_ratio, scale: 1.0 }; 3])
}

fn angular(aspect_ratio: f64) -> PlaneTilting {
    law(alike(aspect_ratio), 1e-9)
}

/// Rotation plane i: (direction of the long side, of the short side, of the turn that tilts long side towards short side).
fn plane(i: usize) -> [Vector<f64>; 3] {
    let e = [Vector::new(1.0, 0.0, 0.0), Vector::new(0.0, 1.0, 0.0), Vector::new(0.0, 0.0, 1.0)];
    let (j, k) = [(1, 2), (0, 2), (0, 1)][i];
    [e[j], e[k], e[j].cross(e[k])]
}

/// Arms l_N and l_T over the arm of the contact of a grain that rests on its long side in plane `i`, tilted by `angle`; everything
/// is looked at from a frame turned by `world`.
fn arms(law: &PlaneTilting, i: usize, angle: f64, world: &Quaternion<f64>) -> [f64; 2] {
    let [along, up, axis] = plane(i);
    let frame = product(world, &turn(axis, angle));
    let (normal, sideways, axis) = (turned(world, up), turned(world, along), turned(world, axis));
    let resting = law.torque(&frame, normal, 1.0, normal, 1.0);
    let pushed = law.torque(&frame, normal, 0.0, sideways, 1.0);
    // The normal force turns back, the sideways force along +b turns from b to a.
    [-resting.dot(axis), pushed.dot(axis)]
}

/// The closed form for any angle.
fn closed_form(aspect_ratio: f64, angle: f64) -> [f64; 2] {
    let mut gamma = aspect_ratio.atan();
    let mut theta = angle - std::f64::consts::PI * (angle / std::f64::consts::PI).round();
    // Beyond 90° the grain lies on its short side; the description from either side is the same one.
    if theta.abs() > 45_f64.to_radians() {
        theta -= std::f64::consts::FRAC_PI_2 * theta.signum();
        gamma = std::f64::consts::FRAC_PI_2 - gamma;
    }
    [theta.signum() * (gamma + theta.abs()).cos(), (gamma + theta.abs()).sin()]
}

#[test]
fn arms_equal_the_published_figure() {
    // P1 Fig. 4 as tabulated: A, angle [°], l_N/r, l_T/r.
    let table = [
        (0.1, 30.0, 0.811975625, 0.583691344),
        (0.1, 85.0, -0.012401872, 0.999923094),
        (0.25, 50.0, 0.437802511, 0.899071166),
        (0.5, 10.0, 0.803180976, 0.595735068),
        (0.5, 60.0, 0.059915261, 0.998203467),
        (0.5, 80.0, -0.285103764, 0.958496658),
        (0.75, 35.0, 0.311175774, 0.950352376),
        (1.0, 5.0, 0.642787610, 0.766044443),
        (1.0, 70.0, -0.422618262, 0.906307787),
    ];
    for (aspect_ratio, degrees, normal_arm, tangential_arm) in table {
        for i in 0..3 {
            for world in (0..20).map(some_quaternion) {
                for side in [1.0, -1.0] {
                    let [n, t] = arms(&angular(aspect_ratio), i, side * f64::to_radians(degrees), &world);
                    assert!((side * n - normal_arm).abs() < 1e-6, "A {aspect_ratio}, {degrees}°: l_N {n}");
                    assert!((t - tangential_arm).abs() < 1e-6, "A {aspect_ratio}, {degrees}°: l_T {t}");
                }
            }
        }
    }
}

#[test]
fn arms_equal_the_closed_form_over_a_full_turn() {
    for aspect_ratio in [0.05, 0.1, 0.3, 0.5, 0.8, 1.0] {
        let law = angular(aspect_ratio);
        for i in 0..3 {
            for step in 0..720 {
                let angle = f64::to_radians(0.25 + 0.5 * f64::from(step));
                let found = arms(&law, i, angle, &some_quaternion(step));
                let expected = closed_form(aspect_ratio, angle);
                for part in 0..2 {
                    assert!((found[part] - expected[part]).abs() < 1e-6, "{found:?} against {expected:?}");
                }
            }
        }
    }
}

#[test]
fn a_scale_shortens_both_arms() {
    for (aspect_ratio, scale) in [(0.05, 0.1), (0.5, 0.1), (1.0, 0.1), (0.3, 0.7)] {
        let law = law(GrainShape::Planes([PlaneShape::Rectangle { aspect_ratio, scale }; 3]), 1e-9);
        for step in 0..360 {
            let angle = f64::to_radians(0.25 + f64::from(step));
            for i in 0..3 {
                let found = arms(&law, i, angle, &some_quaternion(step));
                let expected = closed_form(aspect_ratio, angle).map(|arm| scale * arm);
                for part in 0..2 {
                    assert!((found[part] - expected[part]).abs() < 1e-9, "{found:?} against {expected:?}");
                }
            }
        }
    }
}

#[test]
fn the_normal_arm_changes_sign_at_the_tilting_angle() {
    for aspect_ratio in [0.05, 0.1, 0.25, 0.5, 0.75, 1.0] {
        let law = angular(aspect_ratio);
        let (mut low, mut high) = (0.01, 1.56);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if arms(&law, 1, middle, &some_quaternion(3))[0] > 0.0 { low = middle } else { high = middle }
        }
        assert!((low - (1.0 / aspect_ratio).atan()).abs() < 1e-6, "A {aspect_ratio}: {low}");
    }
}

#[test]
fn the_arm_of_the_long_side_is_the_alternative() {
    let settings = TiltingSettings { arms: ArmNormalisation::LongSide, ..TiltingSettings::of(alike(0.5)) };
    let [n, t] = arms(&PlaneTilting::new(&settings).unwrap(), 2, 0.4, &some_quaternion(1));
    // d = r/cos γ
    let expected = closed_form(0.5, 0.4).map(|arm| arm / 0.5_f64.atan().cos());
    assert!((n - expected[0]).abs() < 1e-9 && (t - expected[1]).abs() < 1e-9);
}

#[test]
fn the_normal_arm_is_the_slope_of_the_height() {
    // The work of a constant normal force is that of lifting the centre by l_T: no turn there and back yields energy.
    let law = law(alike(0.4), 0.0);
    let world = some_quaternion(5);
    for degrees in [10.0, 40.0, 68.0, 80.0] {
        let angle = f64::to_radians(degrees);
        let height = |angle| arms(&law, 0, angle, &world)[1];
        let slope = (height(angle + 1e-5) - height(angle - 1e-5)) / 2e-5;
        assert!((slope - arms(&law, 0, angle, &world)[0]).abs() < 1e-8);
    }
}

#[test]
fn circles_turn_as_spheres_do() {
    let circle = PlaneShape::Circle { scale: 1.0 };
    let law = law(GrainShape::Planes([circle; 3]), 5e-3);
    for n in 0..200 {
        let (frame, other) = (some_quaternion(n), some_quaternion(n + 1000));
        let normal = turned(&other, Vector::new(0.0, 0.0, 1.0));
        let tangential = turned(&other, Vector::new(1.3, -0.4, 0.0));
        let force = normal * 7.0 + tangential;
        let torque = law.torque(&frame, normal, 7.0, force, 0.01);
        let sphere = normal.cross(tangential) * -0.01;
        assert!((torque - sphere).norm() < 1e-15, "{torque:?} against {sphere:?}");
    }
    assert_eq!(RotationLaw::<f64>::inertia_ratios(&law), [0.4; 3]);
}

#[test]
fn the_three_planes_add_up_to_the_moment_of_the_force() {
    // Σ F_i × n_i = F × n with projections that are not normalised.
    for n in 0..100 {
        let axes = some_quaternion(n).axes();
        let normal = turned(&some_quaternion(n + 7), Vector::new(0.0, 1.0, 0.0));
        let force = turned(&some_quaternion(n + 9), Vector::new(2.0, 0.0, 0.0));
        let flat = |v: Vector<f64>, axis: Vector<f64>| v - axis * axis.dot(v);
        let sum = axes.iter().fold(Vector::ZERO, |sum, &axis| {
            sum + axis * axis.dot(flat(force, axis).cross(flat(normal, axis)))
        });
        assert!((sum - force.cross(normal)).norm() < 1e-14);
    }
}

#[test]
fn a_cube_is_symmetric() {
    let law = law(GrainShape::Cube, 0.0);
    for degrees in 1..45 {
        let angle = f64::to_radians(f64::from(degrees));
        for i in 0..3 {
            let here = arms(&law, i, angle, &some_quaternion(2));
            let there = arms(&law, i, std::f64::consts::FRAC_PI_2 - angle, &some_quaternion(2));
            assert!((here[0] + there[0]).abs() < 1e-12 && (here[1] - there[1]).abs() < 1e-12);
        }
    }
}

#[test]
fn a_normal_force_never_twists_about_its_own_line() {
    for shape in
        [GrainShape::Cube, GrainShape::Bar { aspect_ratio: 0.3 }, GrainShape::Disc { aspect_ratio: 0.2 }]
    {
        let law = law(shape, 5e-3);
        for n in 0..300 {
            let normal = turned(&some_quaternion(n), Vector::new(0.0, 0.6, 0.8));
            let torque = law.torque(&some_quaternion(n + 50), normal, 3.0, normal * 3.0, 1.0);
            assert!(torque.dot(normal).abs() < 1e-14, "{torque:?}");
        }
    }
}

#[test]
fn full_turns_under_a_constant_normal_force_cost_nothing() {
    let shapes = [
        GrainShape::Cube,
        alike(0.1),
        GrainShape::Bar { aspect_ratio: 0.3 },
        GrainShape::Plate { aspect_ratio: 0.3 },
        GrainShape::Disc { aspect_ratio: 0.3 },
    ];
    for shape in shapes {
        for smoothing in [0.0, 5e-3, 0.1] {
            let law = law(shape, smoothing);
            for i in 0..3 {
                let n_steps = 20_000;
                let step = std::f64::consts::TAU / f64::from(n_steps);
                let work: f64 = (0..n_steps)
                    .map(|n| arms(&law, i, (f64::from(n) + 0.5) * step, &some_quaternion(1))[0] * step)
                    .sum();
                assert!(work.abs() < 1e-9, "{shape:?}, plane {i}, smoothing {smoothing}: {work}");
            }
        }
    }
}

#[test]
fn a_resting_grain_topples_on_an_incline_at_the_angle_of_its_shape() {
    for aspect_ratio in [0.1_f64, 0.25, 0.5, 0.75, 1.0] {
        let law = law(alike(aspect_ratio), 5e-3);
        for (is_long_side_down, expected) in
            [(true, (1.0 / aspect_ratio).atan()), (false, aspect_ratio.atan())]
        {
            let rest = if is_long_side_down { 0.0 } else { std::f64::consts::FRAC_PI_2 };
            // Leans by twice the smoothing, downhill; friction holds the contact.
            let topples = |incline: f64| {
                let [n, t] = arms(&law, 2, rest + 0.0055, &some_quaternion(4));
                incline.sin() * t - incline.cos() * n > 0.0
            };
            let (mut low, mut high) = (0.0, 1.57);
            for _ in 0..50 {
                let middle = 0.5 * (low + high);
                if topples(middle) { high = middle } else { low = middle }
            }
            assert!(
                (low - expected).abs() < f64::to_radians(0.5),
                "A {aspect_ratio}: {low} against {expected}"
            );
        }
    }
}

#[test]
fn both_inertias_have_the_tabulated_values() {
    // Eq. (15) over m r² at A = 0.1, 0.25, 0.5, 0.75, 1.
    for (aspect_ratio, thin_rod) in
        [(0.1, 8.333333), (0.25, 1.333333), (0.5, 0.333333), (0.75, 0.148148), (1.0, 0.083333)]
    {
        let of = |inertia| {
            let shape = alike(aspect_ratio);
            let law = PlaneTilting::new(&TiltingSettings { inertia, ..TiltingSettings::of(shape) }).unwrap();
            RotationLaw::<f64>::inertia_ratios(&law)[0]
        };
        assert!((of(GrainInertia::ThinRod) - thin_rod).abs() < 1e-6);
        assert!((of(GrainInertia::Inscribed) - 1.0 / 3.0).abs() < 1e-15);
    }
}

#[test]
fn single_precision_follows_double_precision() {
    let law = law(alike(0.5), 0.05);
    for n in 0..100 {
        let frame = some_quaternion(n);
        let normal = turned(&some_quaternion(n + 3), Vector::new(0.0, 0.0, 1.0));
        let force = normal * 2.0 + turned(&some_quaternion(n + 3), Vector::new(0.5, 0.0, 0.0));
        let double = law.torque(&frame, normal, 2.0, force, 1.0);
        let single =
            law.torque(&Quaternion(frame.0.map(|c| c as f32)), normal.cast(), 2.0, force.cast(), 1.0);
        assert!((double - single.cast()).norm() < 1e-4);
    }
}
