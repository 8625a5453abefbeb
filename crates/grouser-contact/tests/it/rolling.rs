//! Rolling resistance: limits, signs, and what a cycle costs.

use crate::*;

fn bodies(spins: [f64; 2]) -> [Body<f64, ()>; 2] {
    let body = |spin| Body { arm: 0.01, spin: Vector::new(0.3, spin, 0.0), inverse_moment: 1e6, frame: () };
    spins.map(body)
}

fn response(normal_force: f64) -> Response<f64> {
    Response { normal_force, tangential_force: Vector::ZERO, energy: ContactEnergy::default() }
}

#[test]
fn the_constant_torque_has_the_published_size_and_opposes_the_rolling() {
    let law = ConstantRolling::new(0.2).unwrap();
    let contact = touching(1e-5, Vector::ZERO, 1e-9);
    let (couples, ()) = law.couples(&contact, &sand_pair(0.5), &response(3.0), &bodies([5.0, -1.0]), ());
    // μ_r R* F_n; the common spin about the normal is no rolling.
    let expected = 0.2 * 5e-3 * 3.0;
    assert!((couples.torques[0] - Vector::new(0.0, -expected, 0.0)).norm() < 1e-15);
    assert!((couples.torques[1] + couples.torques[0]).norm() < 1e-18);
    assert!((couples.spent - expected * 6.0).abs() < 1e-15);
}

#[test]
fn the_constant_torque_never_turns_a_slow_pair_around() {
    let law = ConstantRolling::new(0.5).unwrap();
    let contact = touching(1e-5, Vector::ZERO, 1e-3);
    let (couples, ()) = law.couples(&contact, &sand_pair(0.5), &response(9.0), &bodies([1e-4, 0.0]), ());
    // J = 2/5 m r² each: the relative spin after the step keeps its sign.
    let change = couples.torques[0].y / (0.4 / 1e6) * 1e-3 * 2.0;
    assert!(change < 0.0 && change > -1e-4, "{change}");
    let still = law.couples(&contact, &sand_pair(0.5), &response(9.0), &bodies([0.0, 0.0]), ()).0;
    assert_eq!(still.torques[0].norm(), 0.0);
}

#[test]
fn the_spring_holds_up_to_its_limit_with_the_published_stiffness() {
    let law = ElasticPlasticRolling::new(0.3, 0.0).unwrap();
    let (dt, overlap) = (2e-5, 1e-5);
    let contact = touching(overlap, Vector::ZERO, dt);
    let pair = sand_pair(0.5);
    let normal_stiffness = pair.normal_modulus * (5e-3 * overlap).sqrt();
    let stiffness = 2.25 * normal_stiffness * (0.3 * 5e-3_f64).powi(2);
    let limit = 0.3 * 5e-3 * 0.2;
    let mut angle = Vector::ZERO;
    for step in 1..=3000 {
        let (couples, kept) = law.couples(&contact, &pair, &response(0.2), &bodies([1.0, 0.0]), angle);
        angle = kept;
        let expected = (stiffness * f64::from(step) * dt).min(limit);
        assert!((couples.torques[0].y + expected).abs() < 1e-9 * limit, "step {step}");
    }
    assert!((angle.y - limit / stiffness).abs() < 1e-9 * angle.y, "the limit must have been reached");
}

#[test]
fn no_cycle_of_rolling_and_loading_yields_energy() {
    for damping_ratio in [0.0, 0.3] {
        let law = ElasticPlasticRolling::new(0.3, damping_ratio).unwrap();
        let pair = sand_pair(0.5);
        let dt = 1e-5;
        for phase in 0..24 {
            let (mut angle, mut taken) = (Vector::ZERO, 0.0);
            // Load and rolling angle go round a loop, ten times.
            for step in 0..10_000 {
                let t = f64::from(step) / 1000.0 * std::f64::consts::TAU;
                let overlap = 1e-5 * (1.1 + t.cos());
                let frequency = std::f64::consts::TAU / (1000.0 * dt);
                let approach = 1e-5 * t.sin() * frequency;
                let rate = 0.05 * frequency * (t + f64::from(phase) * std::f64::consts::TAU / 24.0).cos();
                let contact = touching(overlap, Vector::new(-approach, 0.0, 0.0), dt);
                let normal_force = pair.normal_modulus * (5e-3 * overlap).sqrt() * overlap;
                let (couples, kept) =
                    law.couples(&contact, &pair, &response(normal_force), &bodies([rate, 0.0]), angle);
                angle = kept;
                taken += couples.spent * dt;
            }
            assert!(taken > 0.0, "phase {phase}: {taken} J");
        }
    }
}

#[test]
fn meaningless_coefficients_are_refused() {
    assert!(ConstantRolling::new(-0.1).is_err());
    assert!(ElasticPlasticRolling::new(0.1, 1.5).is_err());
    assert!(ElasticPlasticRolling::new(f64::NAN, 0.5).is_err());
}
