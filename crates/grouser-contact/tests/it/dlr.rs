//! P1's translational law.

use crate::*;

const ANGLES: SlipAngles = SlipAngles { stick_deg: 40.0, slip_deg: 30.0 };

fn law(normal_damping: f64) -> (Dlr, PairProperties) {
    (Dlr::new(2e4, normal_damping, &ANGLES).unwrap(), sand_pair(ANGLES.slip_friction().unwrap()))
}

#[test]
fn the_elastic_force_is_the_printed_one_with_the_reduced_radius() {
    // Eq. (3): 2E/(3(1−ν²)) √r₁₂ δ^1.5 with r₁₂ = r₁r₂/(r₁+r₂).
    let (law, pair) = law(0.0);
    let (response, _) = law.respond(&touching(2e-5, Vector::ZERO, 1e-6), &pair, Vector::ZERO);
    let expected = 2.0 * 1e7 / (3.0 * (1.0 - 0.09)) * 5e-3_f64.sqrt() * 2e-5_f64.powf(1.5);
    assert!((response.normal_force / expected - 1.0).abs() < 1e-12);
}

#[test]
fn the_dashpot_resists_the_approach_and_never_pulls() {
    let (law, pair) = law(0.5);
    let force =
        |v| law.respond(&touching(2e-5, Vector::new(v, 0.0, 0.0), 1e-6), &pair, Vector::ZERO).0.normal_force;
    assert!((force(-0.1) - force(0.0) - 0.05).abs() < 1e-12);
    assert_eq!(force(10.0), 0.0);
}

#[test]
fn the_contact_sticks_to_the_stick_angle_and_slides_at_the_slip_angle() {
    let (law, pair) = law(0.0);
    let dt = 1e-7;
    let contact = touching(2e-5, Vector::new(0.0, 0.01, 0.0), dt);
    let normal_force = law.respond(&contact, &pair, Vector::ZERO).0.normal_force;
    let (stick, slip) = (40_f64.to_radians().tan() * normal_force, 30_f64.to_radians().tan() * normal_force);
    let (mut spring, mut largest) = (Vector::ZERO, 0.0_f64);
    for _ in 0..200_000 {
        let (response, kept) = law.respond(&contact, &pair, spring);
        spring = kept;
        assert!(response.tangential_force.y < 0.0);
        largest = largest.max(response.tangential_force.norm());
    }
    assert!((largest / stick - 1.0).abs() < 1e-3, "{largest} against {stick}");
    let (sliding, _) = law.respond(&contact, &pair, spring);
    assert!((sliding.tangential_force.norm() / slip - 1.0).abs() < 1e-12);
    assert!((spring.norm() * 2e4 / stick - 1.0).abs() < 1e-12, "the spring keeps the stick length");
}

#[test]
fn an_impact_loses_what_the_ledger_says_and_no_cycle_of_sliding_yields_energy() {
    let (law, pair) = law(0.4);
    // Normal: one degree of freedom, reduced mass 5 g.
    let (mass, dt) = (5e-3, 2e-8);
    let (mut overlap, mut v, mut lost) = (0.0_f64, -0.3_f64, 0.0);
    while overlap >= 0.0 {
        overlap -= 0.5 * v * dt;
        let (response, _) =
            law.respond(&touching(overlap.max(0.0), Vector::new(v, 0.0, 0.0), dt), &pair, Vector::ZERO);
        if overlap > 0.0 {
            lost += response.energy.normal_damping * dt;
            v += response.normal_force / mass * dt;
        }
        overlap -= 0.5 * v * dt;
    }
    let expected = 0.5 * mass * (0.3 * 0.3 - v * v);
    assert!(expected > 1e-5 && (lost / expected - 1.0).abs() < 1e-3, "{lost} against {expected}");
    // Tangential: loops of load and sliding of any phase.
    for phase in 0..24 {
        let (mut spring, mut taken) = (Vector::ZERO, 0.0);
        for step in 0..20_000 {
            let t = f64::from(step) / 2000.0 * std::f64::consts::TAU;
            let rate = 0.05 * (t + f64::from(phase) * std::f64::consts::TAU / 24.0).cos();
            let contact = touching(1e-5 * (1.1 + t.cos()), Vector::new(0.0, rate, 0.0), 1e-6);
            let (response, kept) = law.respond(&contact, &pair, spring);
            spring = kept;
            taken += response.energy.tangential * 1e-6;
        }
        assert!(taken > 0.0, "phase {phase}: {taken}");
    }
}

#[test]
fn angles_without_meaning_are_refused() {
    assert!(SlipAngles { stick_deg: 61.0, slip_deg: 30.0 }.slip_friction().is_err());
    assert!(SlipAngles { stick_deg: 61.0, slip_deg: 60.5 }.slip_friction().is_err());
    assert!(SlipAngles { stick_deg: 0.0, slip_deg: 0.0 }.slip_friction().is_ok());
    assert!(Dlr::new(0.0, 0.1, &ANGLES).is_err() && Dlr::new(1e4, -0.1, &ANGLES).is_err());
}
