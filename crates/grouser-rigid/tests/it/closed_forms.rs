//! Free fall, springs, tops and driven bodies against their closed forms; observed orders of convergence.

use std::f64::consts::{PI, TAU};

use approx::assert_relative_eq;
use grouser_geometry::nalgebra::Matrix3;
use grouser_geometry::{Orientation, RigidMotion, Vec3, Wrench};
use grouser_rigid::{BodySpec, Connector, Degree, Freedom, RigidBody, VelocityProfile};

fn free_body(mass: f64, inertia: Vec3, motion: RigidMotion, gravity: Vec3) -> BodySpec {
    BodySpec {
        mass,
        inertia: Matrix3::from_diagonal(&inertia),
        motion,
        freedoms: std::array::from_fn(|_| Freedom::Free),
        connectors: vec![],
        gravity,
    }
}

fn run(spec: &BodySpec, n_steps: usize, dt: f64, load: impl Fn(&RigidMotion) -> Wrench) -> RigidBody {
    let mut body = RigidBody::new(spec.clone()).unwrap();
    body.begin(&load(body.motion()));
    for _ in 0..n_steps {
        body.predict(dt);
        let applied = load(body.motion());
        body.correct(&applied, dt);
    }
    body
}

fn unloaded(_: &RigidMotion) -> Wrench {
    Wrench::default()
}

/// Orders log₂(e_k / e_{k+1}) of errors measured with halved steps.
fn orders(errors: &[f64]) -> Vec<f64> {
    errors.windows(2).map(|e| (e[0] / e[1]).log2()).collect()
}

#[test]
fn falling_body_follows_the_parabola_exactly() {
    let motion =
        RigidMotion { velocity: Vec3::new(1.0, -2.0, 3.0), ..RigidMotion::at_rest(Vec3::new(0.1, 0.2, 5.0)) };
    let gravity = Vec3::new(0.3, 0.0, -9.81);
    let body = run(&free_body(4.0, Vec3::repeat(0.1), motion, gravity), 100, 0.01, unloaded);
    let exact = motion.position + motion.velocity + gravity / 2.0;
    assert_relative_eq!(body.motion().position, exact, epsilon = 1e-12);
    let gained = body.kinetic_energy() - 2.0 * motion.velocity.norm_squared();
    assert_relative_eq!(body.work().gravity, gained, max_relative = 1e-12);
    assert_relative_eq!(
        body.work().gravity,
        4.0 * gravity.dot(&(exact - motion.position)),
        max_relative = 1e-12
    );
}

#[test]
fn spring_oscillates_with_its_period_at_second_order() {
    let (mass, stiffness) = (3.0, 120.0f64);
    let omega = (stiffness / mass).sqrt();
    let mut spec = free_body(mass, Vec3::repeat(1.0), RigidMotion::at_rest(Vec3::zeros()), Vec3::zeros());
    spec.connectors = vec![Connector::Spring { degree: Degree::Y, stiffness, damping: 0.0, rest: 0.2 }];
    let errors: Vec<f64> = [200, 400, 800, 1600]
        .iter()
        .map(|&n| {
            let body = run(&spec, n, 2.3 / n as f64, unloaded);
            (body.motion().position.y - 0.2 * (1.0 - (omega * 2.3f64).cos())).abs()
        })
        .collect();
    assert!(orders(&errors).iter().all(|p| (p - 2.0).abs() < 0.05), "{errors:?}");
    let body = run(&spec, 1600, 2.3 / 1600.0, unloaded);
    let energy = body.kinetic_energy() + body.stored_energy();
    assert_relative_eq!(energy, stiffness * 0.04 / 2.0, max_relative = 1e-4);
}

#[test]
fn damped_spring_loses_exactly_what_the_ledger_says() {
    let mut spec =
        free_body(2.0, Vec3::repeat(1.0), RigidMotion::at_rest(Vec3::zeros()), Vec3::new(0.0, 0.0, -9.81));
    spec.connectors = vec![
        Connector::Spring { degree: Degree::Z, stiffness: 300.0, damping: 6.0, rest: 0.0 },
        Connector::LowerStop { degree: Degree::Z, limit: -0.08, stiffness: 5e3, damping: 20.0 },
    ];
    let residual = |n: usize| {
        let body = run(&spec, n, 1.0 / n as f64, unloaded);
        let work = body.work();
        assert!(work.connectors_dissipated > 0.1);
        (body.kinetic_energy() + body.stored_energy() - work.gravity + work.connectors_dissipated).abs()
    };
    let errors = [residual(2000), residual(8000)];
    assert!(errors[0] < 1e-3 && errors[1] < errors[0] / 6.0, "{errors:?}");
}

/// A symmetric top without torque: the spin precesses about the axis of symmetry with (I₃ − I₁)/I₁ ω₃ in the body frame
/// and about the angular momentum with |L|/I₁ in the world (L. D. Landau, E. M. Lifshitz, Mechanics, § 33).
#[test]
fn free_top_precesses_as_in_the_textbook_at_second_order() {
    let (i1, i3) = (0.02, 0.05);
    let spin = Vec3::new(1.0, 0.0, 4.0);
    let motion = RigidMotion { spin, ..RigidMotion::default() };
    let spec = free_body(1.0, Vec3::new(i1, i1, i3), motion, Vec3::zeros());
    let momentum = Vec3::new(i1 * spin.x, 0.0, i3 * spin.z);
    let t = 1.7;
    // Axis of symmetry: turned about L by |L| t / I₁.
    let axis = Orientation::from_scaled_axis(momentum / i1 * t) * Vec3::z();
    let (mut errors, mut drifts) = (vec![], vec![]);
    for n in [250, 500, 1000, 2000] {
        let body = run(&spec, n, t / n as f64, unloaded);
        errors.push((body.motion().orientation * Vec3::z() - axis).norm());
        drifts.push((body.angular_momentum() - momentum).norm() / momentum.norm());
    }
    assert!(orders(&errors).iter().all(|p| (p - 2.0).abs() < 0.1), "{errors:?}");
    assert!(drifts[3] < 1e-5 && orders(&drifts).iter().all(|&p| p > 1.9), "{drifts:?}");
    let body = run(&spec, 2000, t / 2000.0, unloaded);
    assert_relative_eq!(body.kinetic_energy(), (i1 + i3 * 16.0) / 2.0, max_relative = 1e-5);
}

#[test]
fn tennis_racket_tumbles_about_the_middle_axis_and_keeps_its_momentum() {
    let spin = Vec3::new(0.01, 5.0, 0.0);
    let inertia = Vec3::new(1.0, 2.0, 3.0);
    let motion = RigidMotion { spin, ..RigidMotion::default() };
    let spec = free_body(1.0, inertia, motion, Vec3::zeros());
    let mut has_flipped = false;
    let mut body = RigidBody::new(spec).unwrap();
    let momentum = body.angular_momentum();
    for _ in 0..20_000 {
        body.predict(5e-4);
        body.correct(&Wrench::default(), 5e-4);
        has_flipped |= (body.motion().orientation * Vec3::y()).y < -0.9;
    }
    assert!(has_flipped);
    assert_relative_eq!(body.angular_momentum(), momentum, epsilon = 1e-3 * momentum.norm());
}

#[test]
fn driven_body_is_exactly_where_its_profile_says_and_the_drive_pays() {
    let spec = BodySpec { mass: 5.0, ..BodySpec::driven(Vec3::new(0.0, 0.0, 1.0)) }
        .with(Degree::Z, Freedom::Prescribed(VelocityProfile::Constant { start: 0.25, velocity: -0.4 }))
        .with(
            Degree::X,
            Freedom::Prescribed(VelocityProfile::Sine {
                start: 0.0,
                amplitude: 0.1,
                frequency: 2.0,
                phase: 0.0,
            }),
        )
        .with(Degree::AboutY, Freedom::Prescribed(VelocityProfile::constant(3.0)));
    // Resistance against the downward motion, acting 0.2 m beside the centre.
    let load = |m: &RigidMotion| {
        Wrench::of_force_at(Vec3::new(0.0, 0.0, 7.0), &(m.position + Vec3::new(0.2, 0.0, 0.0)), &m.position)
    };
    let (n, dt) = (1000, 1e-3);
    let body = run(&spec, n, dt, load);
    let t = body.time();
    assert_relative_eq!(body.motion().position.z, 1.0 - 0.4 * (t - 0.25), epsilon = 1e-15);
    assert_relative_eq!(body.motion().position.x, 0.1 * (TAU * 2.0 * t).sin(), epsilon = 1e-15);
    assert_relative_eq!(
        body.motion().orientation * Vec3::x(),
        Vec3::new(3f64.cos(), 0.0, -3f64.sin()),
        epsilon = 1e-12
    );
    assert_relative_eq!(body.reaction_about(&body.motion().position).force.z, -7.0, epsilon = 1e-12);
    // The load turns about +y·(−1.4): power −7·0.4 along z, −1.4·3 about y.
    assert_relative_eq!(body.applied_power(), -7.0 * 0.4 - 1.4 * 3.0, epsilon = 1e-12);
    let kinetic = body.kinetic_energy() - 2.5 * (0.1 * 4.0 * PI).powi(2);
    assert_relative_eq!(body.work().drive + body.work().applied, kinetic, epsilon = 0.01);
    assert_relative_eq!(body.work().applied, -7.0 * 0.4 * 0.75 - 1.4 * 3.0, epsilon = 2e-3);
}

/// A wheel held on its axle: only the rotation about y is free, and a torque about y must not leak into other axes although
/// the body's inertia is not symmetric about the axle.
#[test]
fn body_on_an_axle_turns_only_about_it_and_the_bearing_takes_the_rest() {
    let mut spec = free_body(3.0, Vec3::new(0.2, 0.3, 0.4), RigidMotion::default(), Vec3::zeros());
    spec.inertia[(0, 1)] = 0.05;
    spec.inertia[(1, 0)] = 0.05;
    spec.freedoms = Default::default();
    spec.freedoms[Degree::AboutY as usize] = Freedom::Free;
    let torque = 0.6;
    let body =
        run(&spec, 1000, 1e-3, |_| Wrench { force: Vec3::zeros(), moment: Vec3::new(0.0, torque, 0.0) });
    assert_relative_eq!(body.motion().spin, Vec3::new(0.0, torque / 0.3, 0.0), epsilon = 1e-9);
    assert_relative_eq!(body.displacement(Degree::AboutY), torque / 0.3 / 2.0, epsilon = 1e-9);
    // Euler's equations with ω ∥ y: reaction torques I_xy ω̇ and I_xy ω² in the turning frame.
    let (alpha, omega) = (torque / 0.3, torque / 0.3);
    let in_body = body.motion().orientation.inverse() * body.reaction_about(&Vec3::zeros()).moment;
    assert_relative_eq!(in_body, Vec3::new(0.05 * alpha, 0.0, -0.05 * omega * omega), epsilon = 1e-6);
}
