//! Two bodies: restitution, energy, convergence.

use crate::*;

/// Relative velocity along x after an impact divided by the one before.
fn restitution(tail: Tail, asked: f64, mass_ratio: f64) -> f64 {
    let mut spheres = head_on(0.0, 0.1);
    spheres[1].mass *= mass_ratio;
    let law = HertzMindlin::new(tail);
    let mut bed = Bed::new(spheres, empty_space(), table(asked, 0.0, tail), law).unwrap();
    let has_parted = |bed: &Bed<_>| bed.n_contacts() == 0 && bed.grains().spheres[0].velocity.x <= 0.0999;
    for _ in 0..2_000_000 {
        bed.step(2e-7).unwrap();
        if has_parted(&bed) {
            break;
        }
    }
    let by_id = |id: u32| bed.grains().ids.iter().position(|&i| i == id).unwrap();
    let speed = |id| bed.grains().spheres[by_id(id)].velocity.x;
    (speed(1) - speed(0)) / 0.2
}

#[test]
fn restitution_obtained_is_the_one_asked_for_with_both_tails() {
    for asked in [0.05, 0.3, 0.6, 0.9, 1.0] {
        let (kept, cut) = (restitution(Tail::Keep, asked, 1.0), restitution(Tail::CutCorrected, asked, 1.0));
        assert!((kept - asked).abs() < 1e-3, "tail kept: asked {asked}, obtained {kept}");
        assert!((cut - asked).abs() < 1e-3, "tail cut: asked {asked}, obtained {cut}");
    }
}

#[test]
fn restitution_does_not_depend_on_the_mass_ratio() {
    for mass_ratio in [1e-2, 1e2, 1e4, 1e6] {
        let obtained = restitution(Tail::CutCorrected, 0.5, mass_ratio);
        assert!((obtained - 0.5).abs() < 1e-3, "mass ratio {mass_ratio}: {obtained}");
    }
}

/// Kinetic energy after an oblique impact without damping over the one before.
fn energy_after_oblique_impact<const TOTAL: bool>(angle_deg: f64, friction: f64, poisson: f64) -> f64 {
    let mut bead: Sphere = sphere(Vec3::new(0.0, 0.0, 0.010001), 0.01, SAND.density_kg_m3, 0);
    let (sin, cos) = angle_deg.to_radians().sin_cos();
    bead.velocity = Vector::new(sin, 0.0, -cos);
    let mut settings = empty_space();
    settings.domain = Domain { lower: Vec3::repeat(-9.0), upper: Vec3::repeat(9.0), is_periodic: [false; 3] };
    settings.planes = vec![Plane { point: Vec3::zeros(), normal: Vec3::z(), material: 0 }];
    let law = HertzMindlin::<TOTAL> { tail: Tail::Keep };
    let material = Material { poisson, young_pa: 1e9, ..SAND };
    let between = Interaction { restitution: 1.0, friction };
    let table = PairTable::new(&[material], Tail::Keep, |_, _| between).unwrap();
    let mut bed = Bed::new(vec![bead], settings, table, law).unwrap();
    let before: f64 = bed.grains().kinetic_energy().iter().sum();
    // The contact time grows as cos^(-1/5); the approach of 1e-6 m as 1/cos.
    let dt = 6.4e-8 / cos.powf(0.2);
    let flight = (1e-6 / cos / dt) as u64;
    bed.run(flight + 9000, dt, |_| Ok::<(), Failure>(())).unwrap();
    assert!(bed.grains().spheres[0].velocity.z > 0.0, "it must have bounced");
    bed.grains().kinetic_energy().iter().sum::<f64>() / before
}

#[test]
fn oblique_impacts_never_gain_energy() {
    for (friction, poisson) in [(0.1, 0.3), (0.5, 0.2), (1.0, 0.0), (3.0, 0.23), (10.0, 0.45)] {
        for angle in (1..=88).step_by(3) {
            let ratio = energy_after_oblique_impact::<false>(f64::from(angle), friction, poisson);
            assert!(
                ratio < 1.0 + 1e-6,
                "angle {angle}°, friction {friction}, ν {poisson}: energy ratio {ratio}"
            );
        }
    }
}

#[test]
fn the_spring_of_total_displacement_gains_energy_as_documented() {
    // At ν = 0.1 the ratio of the two stiffnesses suits a gain; at ν = 0.3 there is none.
    let most = (1..=88)
        .step_by(3)
        .map(|angle| energy_after_oblique_impact::<true>(f64::from(angle), 1.0, 0.1))
        .fold(0.0, f64::max);
    assert!(most > 1.002 && most < 1.05, "{most}");
}

#[test]
fn a_bouncing_sphere_converges_at_second_order() {
    // Undamped normal impact: the state at a fixed time while the contact lasts, against a hundredfold finer step.
    let overlap_at = |n_steps: u64| {
        let mut bed = Bed::new(
            head_on(0.0, 0.1),
            empty_space(),
            table(1.0, 0.0, Tail::Keep),
            HertzMindlin::new(Tail::Keep),
        )
        .unwrap();
        let time = 2.2e-3;
        bed.run(n_steps, time / n_steps as f64, |_| Ok::<(), Failure>(())).unwrap();
        assert_eq!(bed.n_contacts(), 1, "the contact must last");
        bed.grains().spheres[0].position.x
    };
    let exact = overlap_at(40_000);
    let errors = [200, 400, 800].map(|n| (overlap_at(n) - exact).abs());
    let order = (errors[0] / errors[2]).log2() / 2.0;
    // Hertz's force is not smooth at first touch: the order lies a little below that of the scheme.
    assert!(order > 1.8, "order {order}, errors {errors:?}");
}
