//! Momentum and energy of whole beds.

use crate::*;

#[test]
fn forces_among_grains_leave_the_momentum_alone() {
    let (mut spheres, mut settings) = falling_column::<F64>(300, 1);
    settings.planes.clear();
    settings.gravity = Vec3::zeros();
    settings.domain.is_periodic = [true; 3];
    settings.domain.upper.z = spheres.iter().fold(0.0_f64, |top, s| top.max(s.position.z + s.radius));
    for (n, sphere) in spheres.iter_mut().enumerate() {
        sphere.velocity = Vector::new((n as f64).sin(), (2.0 * n as f64).sin(), (3.0 * n as f64).cos());
    }
    let mut bed = Bed::new(
        spheres,
        settings,
        table(0.7, 0.5, Tail::CutCorrected),
        HertzMindlin::new(Tail::CutCorrected),
    )
    .unwrap();
    let before = bed.grains().momentum();
    bed.run(2000, 2e-5, |_| Ok::<(), Failure>(())).unwrap();
    let lost = bed.energy().contacts.dissipated();
    assert!(lost > 0.1 * bed.energy().kinetic, "grains must meet, lost {lost} J");
    let scale: f64 = bed.grains().spheres.iter().map(|s| s.mass * s.velocity.norm()).sum();
    assert!((bed.grains().momentum() - before).norm() < 1e-12 * scale);
}

#[test]
fn angular_momentum_of_an_oblique_impact_is_kept() {
    let mut bed = Bed::new(
        head_on(0.008, 0.3),
        empty_space(),
        table(0.6, 0.4, Tail::Keep),
        HertzMindlin::new(Tail::Keep),
    )
    .unwrap();
    let angular_momentum = |bed: &Bed<HertzMindlin>| {
        let spheres = &bed.grains().spheres;
        spheres
            .iter()
            .fold(Vector::ZERO, |sum, s| sum + s.position.cross(s.velocity * s.mass) + s.spin * s.inertia())
    };
    let before = angular_momentum(&bed);
    bed.run(40_000, 2e-7, |_| Ok::<(), Failure>(())).unwrap();
    assert!(bed.grains().spheres[0].spin.norm() > 1.0, "they must have touched");
    // Semi-explicit stepping moves the grains between force and correction: equal to the order of the step.
    assert!((angular_momentum(&bed) - before).norm() < 1e-6 * before.norm());
}

#[test]
fn the_ledger_of_a_falling_bed_balances_and_the_error_falls_with_the_step() {
    let residual = |dt: f64| {
        let (spheres, settings) = falling_column::<F64>(200, 3);
        let law = HertzMindlin::new(Tail::CutCorrected);
        let mut bed = Bed::new(spheres, settings, table(0.5, 0.5, Tail::CutCorrected), law).unwrap();
        let before = bed.energy().stored();
        let n_steps = (0.25 / dt).round() as u64;
        bed.run(n_steps, dt, |_| Ok::<(), Failure>(())).unwrap();
        let energy = bed.energy();
        let lost = energy.contacts.dissipated();
        assert!(lost > 0.1 * before.abs(), "the fall must dissipate, lost {lost} of {before}");
        ((before - energy.stored() - lost) / lost).abs()
    };
    let (coarse, fine) = (residual(2e-5), residual(5e-6));
    assert!(coarse < 5e-3, "{coarse}");
    assert!(fine < 0.5 * coarse, "{fine} against {coarse}");
}

#[test]
fn a_settled_bed_weighs_what_its_grains_weigh() {
    let (spheres, mut settings) = falling_column::<F64>(300, 5);
    settings.has_ledger = false;
    let law = HertzMindlin::new(Tail::CutCorrected);
    let mut bed = Bed::new(spheres, settings, table(0.3, 0.5, Tail::CutCorrected), law).unwrap();
    let mut settling = Settling::new(SettleCriterion::default(), 4e-5);
    let settled = loop {
        if let Some(settled) = settling.advance(&mut bed).unwrap() {
            break settled;
        }
    };
    assert!(settled.is_settled, "{settled:?}");
    let weight: f64 = bed.grains().spheres.iter().map(|s| s.mass * 9.81).sum();
    assert!((bed.plane_force(0).z + weight).abs() < 0.01 * weight);
    assert!(bed.plane_force(0).x.abs() < 0.01 * weight);
}

#[test]
fn a_ledger_turned_on_late_begins_with_what_the_contacts_store() {
    let bed_after = |has_ledger: bool| {
        let (spheres, settings) = falling_column::<F64>(200, 3);
        let settings = BedSettings { has_ledger, ..settings };
        let law = HertzMindlin::new(Tail::CutCorrected);
        let mut bed = Bed::new(spheres, settings, table(0.5, 0.5, Tail::CutCorrected), law).unwrap();
        bed.run(15_000, 2e-5, |_| Ok::<(), Failure>(())).unwrap();
        bed
    };
    let (kept, mut late) = (bed_after(true), bed_after(false));
    assert_eq!(late.energy().contacts.elastic(), 0.0);
    late.keep_ledger(true);
    assert_eq!(late.grains(), kept.grains());
    let (kept, late) = (kept.energy().contacts, late.energy().contacts);
    assert!(late.normal_elastic > 0.0 && (late.normal_elastic / kept.normal_elastic - 1.0).abs() < 1e-12);
    assert!((late.tangential_elastic / kept.tangential_elastic - 1.0).abs() < 1e-3, "{late:?} {kept:?}");
    assert_eq!(late.dissipated(), 0.0);
}
