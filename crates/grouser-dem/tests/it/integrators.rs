//! Newmark's scheme beside velocity Verlet.

use crate::*;
use grouser_dem::Integrator;

const MEAN_ACCELERATION: Integrator = Integrator::Newmark { beta: 0.25, gamma: 0.5 };

/// Root of the mean square error of the speed after an elastic bounce at 1 m/s on a wall, first touches spread over the step.
fn error_of_a_bounce(integrator: Integrator, time_step: f64) -> f64 {
    let of_phase = |phase: f64| {
        let mut bead: Sphere = sphere(Vec3::new(0.0, 0.0, 0.01 + phase * time_step), 0.01, 2600.0, 0);
        bead.velocity.z = -1.0;
        let mut settings = empty_space();
        settings.planes = vec![Plane { point: Vec3::zeros(), normal: Vec3::z(), material: 0 }];
        let law = HertzMindlin::new(Tail::CutCorrected);
        let mut bed = Bed::new(vec![bead], settings, table(1.0, 0.0, Tail::CutCorrected), law).unwrap();
        bed.set_integrator(integrator).unwrap();
        bed.run((6e-3 / time_step) as u64, time_step, |_| Ok::<(), Failure>(())).unwrap();
        let bead = bed.grains().spheres[0];
        assert!(bead.velocity.z > 0.0 && bead.position.z > 0.01, "{bead:?}");
        (bead.velocity.z - 1.0).powi(2)
    };
    ((0..8).map(|n| of_phase(f64::from(n) / 8.0)).sum::<f64>() / 8.0).sqrt()
}

#[test]
fn both_schemes_are_of_second_order_and_verlet_is_closer() {
    for integrator in [Integrator::VelocityVerlet, MEAN_ACCELERATION] {
        let (coarse, fine) = (error_of_a_bounce(integrator, 2e-4), error_of_a_bounce(integrator, 5e-5));
        let order = (coarse / fine).ln() / 4_f64.ln();
        assert!(order > 1.9, "{integrator:?}: {order}");
    }
    let ratio =
        error_of_a_bounce(MEAN_ACCELERATION, 1e-4) / error_of_a_bounce(Integrator::VelocityVerlet, 1e-4);
    assert!((3.0..10.0).contains(&ratio), "{ratio}");
}

#[test]
fn newmark_without_a_share_in_the_position_is_verlet() {
    let run = |integrator| {
        let (spheres, settings) = falling_column::<F64>(100, 7);
        let law = HertzMindlin::new(Tail::CutCorrected);
        let mut bed = Bed::new(spheres, settings, table(0.5, 0.5, Tail::CutCorrected), law).unwrap();
        bed.set_integrator(integrator).unwrap();
        bed.run(3000, 4e-5, |_| Ok::<(), Failure>(())).unwrap();
        assert!(bed.n_contacts() > 50);
        bed.grains().spheres.clone()
    };
    let verlet = run(Integrator::VelocityVerlet);
    assert!(verlet == run(Integrator::Newmark { beta: 0.0, gamma: 0.5 }));
    assert!(verlet != run(MEAN_ACCELERATION));
    let refused = Integrator::Newmark { beta: 0.25, gamma: 0.4 }.validate().unwrap_err();
    assert!(refused.name == "Newmark's gamma" && refused.expected.contains("yields energy"));
}
