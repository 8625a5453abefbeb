//! The tilting law of one body against its closed form, `docs/theory/tilting.md`.

use crate::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

fn settings(shape: GrainShape, smoothing_rad: f64) -> TiltingSettings {
    TiltingSettings { smoothing_rad, ..TiltingSettings::of(shape) }
}

/// The round law has the same formula for boxes; both are tested.
fn law(shape: GrainShape, smoothing_rad: f64) -> Tilting<true> {
    Tilting::new(&settings(shape, smoothing_rad)).unwrap()
}

fn rectangle(aspect_ratio: f64, scale: f64) -> PlaneShape {
    PlaneShape::Rectangle { aspect_ratio, scale }
}

/// Arms l_N and l_T of a grain that rests on the higher of the two other axes of plane `i`, tilted by `angle`; everything is
/// looked at from a frame turned by `world`.
fn arms<const IS_ROUND: bool>(
    law: &Tilting<IS_ROUND>,
    i: usize,
    angle: f64,
    world: &Quaternion<f64>,
) -> [f64; 2] {
    let e = [Vector::new(1.0, 0.0, 0.0), Vector::new(0.0, 1.0, 0.0), Vector::new(0.0, 0.0, 1.0)];
    let [j, k] = [[1, 2], [0, 2], [0, 1]][i];
    let axis = e[j].cross(e[k]);
    let frame = product(world, &turn(axis, angle));
    let (normal, along, axis) = (turned(world, e[k]), turned(world, e[j]), turned(world, axis));
    let resting = law.torque(&frame, normal, normal, 1.0);
    let pushed = law.torque(&frame, normal, along, 1.0);
    for torque in [resting, pushed] {
        assert!((torque - axis * torque.dot(axis)).norm() < 1e-9, "{torque:?} leaves the plane");
    }
    [-resting.dot(axis), pushed.dot(axis)]
}

/// P1 Fig. 4 for a half diagonal d = r and any angle.
fn closed_form(aspect_ratio: f64, angle: f64) -> [f64; 2] {
    let mut gamma = aspect_ratio.atan();
    let mut theta = angle - PI * (angle / PI).round();
    // Beyond 90° the grain lies on its short side; the description from either side is the same one.
    if theta.abs() > 45_f64.to_radians() {
        theta -= FRAC_PI_2 * theta.signum();
        gamma = FRAC_PI_2 - gamma;
    }
    [theta.signum() * (gamma + theta.abs()).cos(), (gamma + theta.abs()).sin()]
}

#[test]
fn each_plane_has_the_published_arms_of_its_rectangle_over_a_full_turn() {
    for a in [0.05, 0.1, 0.3, 0.5, 0.8, 1.0] {
        for shape in [
            GrainShape::Angular { aspect_ratio: a },
            GrainShape::Bar { aspect_ratio: a },
            GrainShape::Plate { aspect_ratio: a },
            GrainShape::Cube,
        ] {
            let (round, plain) = (law(shape, 1e-4), Tilting::<false>::new(&settings(shape, 1e-4)).unwrap());
            let long = TiltingSettings { arms: ArmNormalisation::LongSide, ..settings(shape, 1e-4) };
            let long = Tilting::<false>::new(&long).unwrap();
            // The longest half diagonal is r.
            let d = |plane| match plane {
                PlaneShape::Rectangle { aspect_ratio, scale } => scale * 1_f64.hypot(aspect_ratio),
                PlaneShape::Circle { scale } => scale,
            };
            let longest = shape.planes().map(d).into_iter().fold(0.0, f64::max);
            for (i, plane) in shape.planes().into_iter().enumerate() {
                let PlaneShape::Rectangle { aspect_ratio, scale } = plane else { unreachable!() };
                for step in 0..360 {
                    let angle = f64::to_radians(0.25 + f64::from(step));
                    let world = some_quaternion(step as u32);
                    let expected = closed_form(aspect_ratio, angle);
                    for part in 0..2 {
                        let inscribed = expected[part] * d(plane) / longest;
                        assert!((arms(&round, i, angle, &world)[part] - inscribed).abs() < 1e-6);
                        assert!((arms(&plain, i, angle, &world)[part] - inscribed).abs() < 1e-6);
                        let with_long_side = expected[part] * scale / aspect_ratio.atan().cos();
                        assert!((arms(&long, i, angle, &world)[part] - with_long_side).abs() < 1e-6);
                    }
                }
            }
        }
    }
}

#[test]
fn a_bar_has_the_tabulated_arms() {
    // A, angle [°], l_N/r, l_T/r for d = r.
    let table = [
        (0.1, 30.0, 0.811975625, 0.583691344),
        (0.1, 85.0, -0.012401872, 0.999923094),
        (0.25, 50.0, 0.437802511, 0.899071166),
        (0.5, 60.0, 0.059915261, 0.998203467),
        (0.75, 35.0, 0.311175774, 0.950352376),
        (1.0, 70.0, -0.422618262, 0.906307787),
    ];
    for (aspect_ratio, degrees, normal_arm, tangential_arm) in table {
        let law = law(GrainShape::Bar { aspect_ratio }, 1e-4);
        for plane in [1, 2] {
            let [n, t] = arms(&law, plane, f64::to_radians(degrees), &some_quaternion(9));
            assert!((n - normal_arm).abs() < 1e-6 && (t - tangential_arm).abs() < 1e-6, "{n} {t}");
        }
    }
}

#[test]
fn the_torque_of_a_normal_force_is_the_slope_of_the_height_in_every_orientation() {
    let shapes = [
        GrainShape::Cube,
        GrainShape::Angular { aspect_ratio: 0.3 },
        GrainShape::Disc { aspect_ratio: 0.2 },
        GrainShape::Planes([PlaneShape::Circle { scale: 0.8 }; 3]),
    ];
    for shape in shapes {
        for smoothing in [0.0, 5e-3, 0.2] {
            let law = law(shape, smoothing);
            for n in 0..200 {
                let (frame, axis) =
                    (some_quaternion(n), turned(&some_quaternion(n + 31), Vector::new(1.0, 0.0, 0.0)));
                let normal = turned(&some_quaternion(n + 77), Vector::new(0.0, 0.6, 0.8));
                // Potential of the smoothed height: Σ h (n²/w + w)/2 inside the passage; by quadrature of ℓ·n along the turn.
                let torque = |angle: f64| {
                    law.torque(&product(&turn(axis, angle), &frame), normal, normal, 1.0).dot(axis)
                };
                let height = |angle: f64| {
                    smoothed_height(&law, &product(&turn(axis, angle), &frame), normal, smoothing)
                };
                let slope = (height(1e-6) - height(-1e-6)) / 2e-6;
                let at_kink = (torque(1e-6) - torque(-1e-6)).abs() > 1e-3;
                assert!(at_kink || (slope + torque(0.0)).abs() < 1e-6, "{shape:?}: {slope} {}", torque(0.0));
            }
        }
    }
}

/// Σ h φ(q) over boxes' axes and circles, φ(q) = q beyond w, (q²/w + w)/2 within: written down a second time, from the sides alone.
fn smoothed_height(law: &Tilting<true>, frame: &Quaternion<f64>, normal: Vector<f64>, w: f64) -> f64 {
    let n = frame.axes().map(|axis| axis.dot(normal));
    let h = law.half_sides();
    let phi = |q: f64| if q >= w { q } else { 0.5 * (q * q / w + w) };
    let is_disc = h[0] == h[1] && h[0] != h[2];
    if h == [0.8; 3] || (h[0] == 1.0 && h == [1.0; 3]) {
        h[0]
    } else if is_disc {
        h[0] * phi(n[0].hypot(n[1])) + h[2] * phi(n[2].abs())
    } else {
        (0..3).map(|i| h[i] * phi(n[i].abs())).sum()
    }
}

#[test]
fn a_closed_way_through_three_planes_yields_nothing_with_one_body_and_much_with_the_same_rectangle_in_each() {
    // The normal goes from E₂ over E₃ and E₁ back to E₂ under a constant force.
    let shape = GrainShape::Angular { aspect_ratio: 0.5 };
    let one_body = law(shape, 1e-4);
    let alike = settings(GrainShape::Planes([rectangle(0.5, 1.0); 3]), 1e-4);
    let printed = PlaneTilting::new(&alike).unwrap();
    let e = [Vector::new(1.0, 0.0, 0.0), Vector::new(0.0, 1.0, 0.0), Vector::new(0.0, 0.0, 1.0)];
    let upright = Quaternion::default();
    let (mut of_body, mut of_rectangles) = (0.0, 0.0);
    let n_steps = 100_000;
    for (from, to) in [(1, 2), (2, 0), (0, 1)] {
        for step in 0..n_steps {
            let (sin, cos) = (FRAC_PI_2 * (step as f64 + 0.5) / f64::from(n_steps)).sin_cos();
            let normal = e[from] * cos + e[to] * sin;
            // The body turns against the normal.
            let turn = e[from].cross(e[to]) * (-FRAC_PI_2 / f64::from(n_steps));
            of_body += one_body.torque(&upright, normal, normal, 1.0).dot(turn);
            of_rectangles += printed.torque(&upright, normal, 1.0, normal, 1.0).dot(turn);
        }
    }
    assert!(of_body.abs() < 1e-6, "{of_body}");
    // d (cos γ − sin γ)
    let gamma = 0.5_f64.atan();
    assert!((of_rectangles.abs() - (gamma.cos() - gamma.sin())).abs() < 1e-4, "{of_rectangles}");
}

#[test]
fn force_times_velocity_is_what_the_motion_and_the_ledger_account_for() {
    let pair = sand_pair(0.6);
    for n in 0..100 {
        let normal = turned(&some_quaternion(n + 3), Vector::new(1.0, 0.0, 0.0));
        let any = |k| turned(&some_quaternion(n + k), Vector::new(3.0, 1.0, -2.0));
        let law = law(GrainShape::Disc { aspect_ratio: 0.4 }, 5e-3);
        let body =
            |k: u32, arm| Body { arm, spin: any(k), inverse_moment: 1.0, frame: some_quaternion(n + k) };
        let (centres, bodies) = (any(1), [body(5, 0.01), body(6, 0.02)]);
        let velocity = law.velocity_at_contact(normal, centres, &bodies);
        let parts = law.velocity_in_parts(normal, centres, &bodies);
        assert!(
            (parts.normal - centres.dot(normal)).abs() < 1e-15 && parts.tangential.dot(normal).abs() < 1e-14
        );
        let contact = Contact { normal, velocity: parts, ..touching(1e-5, velocity, 1e-6) };
        let (response, _) = HertzMindlin::new(Tail::CutCorrected).respond(&contact, &pair, Vector::ZERO);
        let half = 0.5 * response.normal_force;
        let (couples, built_up) = law.couples(&contact, &pair, &response, &bodies, half);
        assert!(built_up > half && built_up < response.normal_force, "{built_up}");
        let force = normal * response.normal_force + response.tangential_force;
        let power = force.dot(centres)
            + couples.torques[0].dot(bodies[0].spin)
            + couples.torques[1].dot(bodies[1].spin);
        let accounted = response.normal_force * centres.dot(normal) + response.tangential_force.dot(velocity)
            - couples.spent;
        assert!((power - accounted).abs() < 1e-9 * force.norm(), "{power} against {accounted}");
    }
}

#[test]
fn the_torque_of_a_normal_force_builds_up_over_impact_times_and_falls_at_once() {
    let pair = sand_pair(0.6);
    let normal = Vector::new(0.0, 0.0, 1.0);
    let contact = Contact { normal, ..touching(1e-5, Vector::ZERO, 1e-6) };
    // τ = 10 π √(m*/k), k = F/δ.
    let k = pair.normal_modulus * (contact.effective_radius * contact.overlap).sqrt();
    let tau = 10.0 * PI * (contact.effective_mass / k).sqrt();
    let response =
        |normal_force| Response { normal_force, tangential_force: Vector::ZERO, energy: Default::default() };
    let body = Body { arm: 0.01, spin: Vector::ZERO, inverse_moment: 1.0, frame: some_quaternion(4) };
    let bodies = [body, Body::at_rest(body.frame)];
    let share = |law: &Tilting<true>, force: f64, before: f64| {
        let (couples, kept) = law.couples(&contact, &pair, &response(force), &bodies, before);
        let full = law.torque(&body.frame, normal, normal * force, 0.01);
        let expected = full * (kept / force);
        assert!((couples.torques[0] - expected).norm() < 1e-12 * full.norm(), "{couples:?}");
        kept
    };
    let cube = law(GrainShape::Cube, 5e-3);
    let n_steps = (tau / contact.time_step) as usize;
    let built_up = (0..n_steps).fold(0.0, |before, _| share(&cube, 3.0, before));
    assert!((built_up / 3.0 - (1.0 - (-1.0_f64).exp())).abs() < 1e-3, "{built_up}");
    assert_eq!(share(&cube, 1.0, built_up), 1.0);
    let at_once =
        Tilting::new(&TiltingSettings { build_up: 0.0, ..settings(GrainShape::Cube, 5e-3) }).unwrap();
    assert!((share(&at_once, 3.0, 0.0) - 3.0).abs() < 1e-12);
}

/// Power [W] that a cube's lift takes while a grain of 10 g turns with `rate` [rad/s] about y, tilted by `angle`, under 3 N that have
/// lasted, and the couple about y [N·m].
fn taken_while_turning(lift_damping: f64, angle: f64, rate: f64, time_step: f64) -> (f64, f64) {
    let cube = TiltingSettings { lift_damping, ..settings(GrainShape::Cube, 1e-3) };
    let law = Tilting::<false>::new(&cube).unwrap();
    let pair = PairProperties { damping: 0.7, ..sand_pair(0.6) };
    let normal = Vector::new(0.0, 0.0, 1.0);
    let contact = Contact { normal, ..touching(1e-5, Vector::ZERO, time_step) };
    let axis = Vector::new(0.0, 1.0, 0.0);
    let body = Body { arm: 0.01, spin: axis * rate, inverse_moment: 1.0, frame: turn(axis, angle) };
    let response = Response { normal_force: 3.0, tangential_force: Vector::ZERO, energy: Default::default() };
    let bodies = [body, Body::at_rest(body.frame)];
    let (couples, _) = law.couples(&contact, &pair, &response, &bodies, 3.0);
    (couples.spent, couples.torques[0].y)
}

#[test]
fn the_dashpot_on_the_lift_takes_a_share_of_the_rate_in_a_closed_cycle_and_nothing_without_it() {
    // Over a full turn at a constant rate under a constant force: ∫ c (dL/dt)² dt, so that half the rate takes half the energy.
    let over_a_turn = |damping: f64, rate: f64| {
        let n_steps = 7200;
        let step = TAU / f64::from(n_steps);
        let spent =
            |n: i32| taken_while_turning(damping, (f64::from(n) + 0.5) * step, rate, 1e-7).0 * step / rate;
        (0..n_steps).map(spent).sum::<f64>()
    };
    assert!(over_a_turn(0.0, 1.0).abs() < 1e-9);
    let (slow, fast) = (over_a_turn(1.0, 0.5), over_a_turn(1.0, 1.0));
    assert!(slow > 0.0 && (fast / slow - 2.0).abs() < 1e-6, "{slow} J, {fast} J");
    assert!((over_a_turn(0.5, 1.0) / fast - 0.5).abs() < 1e-6);
    // The lift's rate is rate × l_N, l_N² averages to h²(1 − 2/π) over a turn: c by hand, as in `HertzMindlin`.
    let pair = PairProperties { damping: 0.7, ..sand_pair(0.6) };
    let k = pair.normal_modulus * (5e-3_f64 * 1e-5).sqrt();
    let half_side = 0.01 / 2_f64.sqrt();
    let expected = pair.damping * (5e-3 * k).sqrt() * half_side.powi(2) * TAU * (1.0 - 2.0 / PI);
    // The passage between corners, 0.001 rad wide, takes 0.2 % of it away.
    assert!((fast / expected - 1.0).abs() < 5e-3, "{fast} against {expected}");
}

#[test]
fn the_dashpot_on_the_lift_never_pulls_and_never_drives() {
    for n in 0..200 {
        let angle = 0.03 * f64::from(n);
        for rate in [-1e4, -30.0, -1.0, 1.0, 30.0, 1e4] {
            let (plain, torque) = taken_while_turning(0.0, angle, rate, 1e-7);
            let (damped, damped_torque) = taken_while_turning(1.0, angle, rate, 1e-7);
            assert!(damped >= plain, "angle {angle}, rate {rate}: {damped} W against {plain} W");
            // A cube that falls too fast is let go; it is never drawn back.
            assert!(damped_torque * torque >= 0.0, "{damped_torque} N·m against {torque} N·m");
            // c is 2 N·s/m here: 1.5 m/s let go of 3 N.
            if plain < -10.0 {
                assert_eq!(damped_torque, 0.0);
            }
        }
    }
}

#[test]
fn no_step_lets_one_dashpot_on_the_lift_stop_more_than_a_quarter_of_the_turning() {
    for time_step in [1e-6, 1e-5, 1e-4, 1e-3, 1e-2] {
        for n in 0..40 {
            let (angle, rate) = (0.157 * f64::from(n), 1e-3);
            let (_, plain) = taken_while_turning(0.0, angle, rate, time_step);
            let (_, damped) = taken_while_turning(1.0, angle, rate, time_step);
            // J = m r²/3, m = 2 m*.
            let change = (damped - plain).abs() / (0.01 * 1e-4 / 3.0) * time_step;
            assert!(change <= 0.25 * rate, "step {time_step}: {change} of {rate} rad/s");
        }
    }
}

#[test]
fn circles_turn_as_spheres_do() {
    let law = law(GrainShape::Planes([PlaneShape::Circle { scale: 1.0 }; 3]), 5e-3);
    for n in 0..200 {
        let (frame, other) = (some_quaternion(n), some_quaternion(n + 1000));
        let normal = turned(&other, Vector::new(0.0, 0.0, 1.0));
        let tangential = turned(&other, Vector::new(1.3, -0.4, 0.0));
        let torque = law.torque(&frame, normal, normal * 7.0 + tangential, 0.01);
        assert!((torque - normal.cross(tangential) * -0.01).norm() < 1e-15, "{torque:?}");
        let body = Body { arm: 0.01, spin: tangential, inverse_moment: 1.0, frame };
        let found = law.velocity_at_contact(normal, tangential, &[body, body]);
        let sphere = tangential - (tangential * 0.02).cross(normal);
        assert!((found - sphere).norm() < 1e-14, "{found:?} against {sphere:?}");
    }
    assert_eq!(RotationLaw::<f64>::inertia_ratios(&law), [0.4; 3]);
}

#[test]
fn a_cube_is_symmetric() {
    let law = law(GrainShape::Cube, 1e-4);
    for degrees in 1..45 {
        let angle = f64::to_radians(f64::from(degrees));
        for i in 0..3 {
            let here = arms(&law, i, angle, &some_quaternion(2));
            let there = arms(&law, i, FRAC_PI_2 - angle, &some_quaternion(2));
            assert!((here[0] + there[0]).abs() < 1e-12 && (here[1] - there[1]).abs() < 1e-12);
        }
    }
}

#[test]
fn the_normal_arm_changes_sign_at_the_tilting_angle() {
    for aspect_ratio in [0.05, 0.1, 0.25, 0.5, 0.75, 1.0] {
        let law = law(GrainShape::Plate { aspect_ratio }, 1e-4);
        let (mut low, mut high) = (0.01, 1.56);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if arms(&law, 1, middle, &some_quaternion(3))[0] > 0.0 { low = middle } else { high = middle }
        }
        assert!((low - (1.0 / aspect_ratio).atan()).abs() < 1e-6, "A {aspect_ratio}: {low}");
    }
}

#[test]
fn full_turns_under_a_constant_normal_force_cost_nothing() {
    for shape in
        [GrainShape::Cube, GrainShape::Bar { aspect_ratio: 0.3 }, GrainShape::Disc { aspect_ratio: 0.3 }]
    {
        for smoothing in [1e-4, 5e-3, 0.1] {
            let law = law(shape, smoothing);
            for i in 0..3 {
                let n_steps = 20_000;
                let step = TAU / f64::from(n_steps);
                let work: f64 = (0..n_steps)
                    .map(|n| arms(&law, i, (f64::from(n) + 0.5) * step, &some_quaternion(1))[0] * step)
                    .sum();
                assert!(work.abs() < 1e-9, "{shape:?}, plane {i}, smoothing {smoothing}: {work}");
            }
        }
    }
}

#[test]
fn named_shapes_have_the_figures_of_the_table() {
    let rectangle = |aspect_ratio, scale| PlaneShape::Rectangle { aspect_ratio, scale };
    let bar = GrainShape::Bar { aspect_ratio: 0.3 }.planes();
    assert_eq!(bar, [rectangle(1.0, 0.3), rectangle(0.3, 1.0), rectangle(0.3, 1.0)]);
    let plate = GrainShape::Plate { aspect_ratio: 0.3 }.planes();
    assert_eq!(plate, [rectangle(0.3, 1.0), rectangle(0.3, 1.0), rectangle(1.0, 1.0)]);
    let disc = GrainShape::Disc { aspect_ratio: 0.3 }.planes();
    assert_eq!(disc[2], PlaneShape::Circle { scale: 1.0 });
    assert_eq!(GrainShape::Cube.planes(), [rectangle(1.0, 1.0); 3]);
}

#[test]
fn the_table_of_shapes_describes_one_body_each() {
    let half = |shape| {
        let long = TiltingSettings { arms: ArmNormalisation::LongSide, ..TiltingSettings::of(shape) };
        Tilting::<true>::new(&long).unwrap().half_sides()
    };
    let (a, root) = (0.36, 0.6);
    let close = |found: [f64; 3], expected: [f64; 3]| {
        (0..3)
            .for_each(|i| assert!((found[i] - expected[i]).abs() < 1e-12, "{found:?} against {expected:?}"));
    };
    close(half(GrainShape::Cube), [1.0; 3]);
    close(half(GrainShape::Bar { aspect_ratio: a }), [1.0, a, a]);
    close(half(GrainShape::Plate { aspect_ratio: a }), [1.0, 1.0, a]);
    close(half(GrainShape::Disc { aspect_ratio: a }), [1.0, 1.0, a]);
    close(half(GrainShape::Angular { aspect_ratio: a }), [1.0, root, a]);
}

#[test]
fn shapes_that_are_no_body_or_outside_the_tested_range_are_refused_with_the_reason() {
    let refused = |settings: TiltingSettings| Tilting::<true>::new(&settings).unwrap_err();
    let of = |aspect_ratio| TiltingSettings::of(GrainShape::Angular { aspect_ratio });
    assert_eq!(refused(of(0.04)).name, "aspect ratio");
    assert_eq!(refused(of(1.5)).value, 1.5);
    assert_eq!(refused(of(f64::NAN)).name, "aspect ratio");
    let planes = |planes| TiltingSettings::of(GrainShape::Planes(planes));
    let circle = |scale| PlaneShape::Circle { scale };
    assert_eq!(refused(planes([circle(0.05); 3])).name, "arm scale");
    assert_eq!(refused(TiltingSettings { smoothing_rad: 0.3, ..of(0.5) }).name, "smoothing width");
    assert_eq!(refused(TiltingSettings { lift_damping: -1.0, ..of(0.5) }).name, "damping of the lift");
    let error = refused(planes([rectangle(0.5, 1.0); 3]));
    assert!(error.name == "mismatch of the figures" && error.expected.contains("PlaneTilting"), "{error}");
    assert_eq!(refused(planes([circle(1.0), circle(1.0), rectangle(1.0, 1.0)])).name, "number of circles");
    let disc = TiltingSettings::of(GrainShape::Disc { aspect_ratio: 0.5 });
    assert_eq!(Tilting::<false>::new(&disc).unwrap_err().name, "roundness");
    for aspect_ratio in [0.05, 1.0] {
        assert!(Tilting::<false>::new(&of(aspect_ratio)).is_ok());
        assert!(Tilting::<true>::new(&TiltingSettings::of(GrainShape::Disc { aspect_ratio })).is_ok());
        assert!(Tilting::<false>::new(&TiltingSettings::of(GrainShape::Bar { aspect_ratio })).is_ok());
    }
}

#[test]
fn single_precision_follows_double_precision() {
    let law = law(GrainShape::Angular { aspect_ratio: 0.5 }, 0.05);
    for n in 0..100 {
        let frame = some_quaternion(n);
        let normal = turned(&some_quaternion(n + 3), Vector::new(0.0, 0.0, 1.0));
        let force = normal * 2.0 + turned(&some_quaternion(n + 3), Vector::new(0.5, 0.0, 0.0));
        let double = law.torque(&frame, normal, force, 1.0);
        let single = law.torque(&Quaternion(frame.0.map(|c| c as f32)), normal.cast(), force.cast(), 1.0);
        assert!((double - single.cast()).norm() < 1e-4);
    }
}
