//! Free fall, bar waves, energy, the stable step.

use grouser_fem::{DynamicsError, Formulation, MassKind, Material, Settings, Solid, VolumetricTreatment};
use grouser_geometry::{Vec3, box_mesh};

use crate::{FORMULATIONS, elements, irregular_box, solid};

#[test]
fn a_free_body_falls_at_g_to_1e_12_and_keeps_its_shape() {
    for (name, mesh, volumetric) in elements(&irregular_box([2, 2, 2])) {
        for mass in [MassKind::Lumped, MassKind::Consistent] {
            let settings =
                Settings { formulation: Formulation::Corotational, volumetric, mass, ..Default::default() };
            let mut solid =
                Solid::new(mesh.clone(), vec![Material::hooke(1000.0, 1e6, 0.3)], settings).unwrap();
            solid.loads.gravity = Vec3::new(0.0, 0.0, -9.81);
            let dt = 1e-4;
            (0..100).for_each(|_| solid.step(dt).unwrap());
            let fall = 0.5 * 9.81 * solid.state.time.powi(2);
            assert!(solid.state.displacement.iter().all(|u| (u.z + fall).abs() < 1e-12), "{name} {mass:?}");
        }
    }
}

#[test]
fn a_suddenly_loaded_bar_peaks_at_twice_the_static_displacement_after_two_wave_travels() {
    // Graff: E = 1 GPa, rho = 1000, L = 1 m: c = 1000 m/s; F = 100 N on 0.01 m2: peak 2e-5 m at 2 ms, end velocity 0.01 m/s.
    let mesh = box_mesh(Vec3::new(1.0, 0.1, 0.1), [40, 2, 2]);
    let mut bar = solid(mesh, Formulation::BodyAttached, VolumetricTreatment::PerElement, 0.0);
    bar.fix("x_min").unwrap();
    bar.add_pressure("x_max", -100.0 / 0.01).unwrap();
    let dt = 0.9 * bar.stable_time_step().dt;
    let tip = bar.mesh().nodes_of("x_max").unwrap();
    let mean = |solid: &Solid| {
        tip.iter().map(|&n| solid.state.displacement[n as usize].x).sum::<f64>() / tip.len() as f64
    };
    let (mut peak, mut time_of_peak, mut middle) = (0.0, 0.0, 0.0);
    while bar.state.time < 3e-3 {
        bar.step(dt).unwrap();
        if bar.state.time < 1e-3 {
            middle = mean(&bar) / bar.state.time;
        }
        if mean(&bar) > peak {
            (peak, time_of_peak) = (mean(&bar), bar.state.time);
        }
    }
    assert!((peak / 2e-5 - 1.0).abs() < 0.02, "{peak:e}");
    assert!((time_of_peak / 2e-3 - 1.0).abs() < 0.02, "{time_of_peak:e}");
    assert!((middle / 0.01 - 1.0).abs() < 0.02, "{middle}");
    let balance = bar.kinetic_energy() + bar.strain_energy() - bar.state.ledger.external_work;
    assert!(balance.abs() < 0.01 * bar.state.ledger.throughput, "{balance:e}");
}

#[test]
fn energy_stays_bounded_at_0_95_of_the_limit_and_a_step_beyond_the_true_limit_is_named() {
    for formulation in [Formulation::BodyAttached, Formulation::Corotational] {
        let build = || {
            let mut solid =
                solid(irregular_box([1, 1, 1]), formulation, VolumetricTreatment::PerElement, 0.3);
            for (i, v) in solid.state.velocity.iter_mut().enumerate() {
                *v = Vec3::new((i as f64).sin(), (2.0 * i as f64).cos(), 0.3) * 1e-3;
            }
            solid
        };
        let mut steady = build();
        let dt = 0.95 * steady.stable_time_step().dt;
        let start = steady.kinetic_energy();
        let mut largest = 0.0f64;
        for _ in 0..1_000_000 / if formulation == Formulation::BodyAttached { 5 } else { 50 } {
            steady.step(dt).unwrap();
            largest = largest.max(steady.kinetic_energy());
        }
        assert!(largest < 1.5 * start, "{largest:e} from {start:e}");
        let mut unstable = build();
        // The bound of the elements may lie below the true limit, never above: twice it must fail.
        let failure = (0..100_000).find_map(|_| unstable.step(2.0 * dt / 0.95).err());
        assert!(
            matches!(
                failure,
                Some(DynamicsError::UnstableStep { .. } | DynamicsError::InvertedElement { .. })
            ),
            "{failure:?}"
        );
    }
}

#[test]
fn the_stable_step_is_never_above_the_true_limit_and_close_to_it() {
    for (name, mesh, volumetric) in elements(&irregular_box([2, 2, 2])) {
        for mass in [MassKind::Lumped, MassKind::Consistent] {
            let settings = Settings { volumetric, mass, ..Default::default() };
            let mut solid =
                Solid::new(mesh.clone(), vec![Material::hooke(1000.0, 1e9, 0.3)], settings).unwrap();
            let bound = solid.stable_time_step();
            // Largest frequency by power iteration on M^-1 K: accelerations of a displacement.
            let n = mesh.nodes.len();
            let mut u: Vec<Vec3> = (0..n)
                .map(|i| Vec3::new((7.0 * i as f64).sin(), (3.0 * i as f64).cos(), (i as f64).sin()) * 1e-4)
                .collect();
            let mut lambda = 0.0;
            for _ in 0..3000 {
                solid.state.displacement.clone_from(&u);
                // A new support-free start recomputes the accelerations.
                solid.state.velocity.fill(Vec3::zeros());
                solid.step(0.0).unwrap();
                let norm = solid.state.acceleration.iter().map(Vec3::norm_squared).sum::<f64>().sqrt();
                lambda = norm / u.iter().map(Vec3::norm_squared).sum::<f64>().sqrt();
                // Small enough that no element folds.
                u = solid.state.acceleration.iter().map(|a| -a / norm * 1e-4).collect();
            }
            let limit = 2.0 / lambda.sqrt();
            let ratio = bound.dt / limit;
            assert!(ratio <= 1.0 + 1e-9 && ratio > 0.4, "{name} {mass:?}: {ratio}");
        }
    }
}

#[test]
fn a_spinning_free_body_keeps_energy_and_angular_momentum() {
    for formulation in [Formulation::Corotational, Formulation::FiniteStrain] {
        for (name, mesh, volumetric) in elements(&irregular_box([2, 2, 2])) {
            let mut solid = solid(mesh.clone(), formulation, volumetric, 0.45);
            let center = Vec3::repeat(0.5);
            let omega = Vec3::new(3.0, 10.0, 30.0);
            for (v, x) in solid.state.velocity.iter_mut().zip(&mesh.nodes) {
                *v = omega.cross(&(x - center));
            }
            let momentum = |s: &Solid| -> Vec3 {
                (0..s.mesh().nodes.len())
                    .map(|n| s.position(n as u32).cross(&s.state.velocity[n]) * s.nodal_mass()[n])
                    .sum()
            };
            let (start, energy) = (momentum(&solid), solid.kinetic_energy());
            let dt = 0.5 * solid.stable_time_step().dt;
            (0..500).for_each(|_| solid.step(dt).unwrap());
            assert!((momentum(&solid) - start).norm() < 1e-11 * start.norm(), "{name} {formulation:?}");
            let total = solid.kinetic_energy() + solid.strain_energy();
            assert!((total / energy - 1.0).abs() < 1e-3, "{name} {formulation:?} {total} {energy}");
        }
    }
}

#[test]
fn stiffness_damping_brings_a_held_solid_to_rest() {
    for formulation in FORMULATIONS {
        let settings = Settings { formulation, stiffness_damping: 1e-4, ..Default::default() };
        let mesh = irregular_box([2, 2, 2]);
        let mut solid = Solid::new(mesh.clone(), vec![Material::hooke(1000.0, 1e9, 0.3)], settings).unwrap();
        solid.fix("x_min").unwrap();
        for (v, x) in solid.state.velocity.iter_mut().zip(&mesh.nodes) {
            *v = Vec3::new(x.x, 0.0, 0.0);
        }
        let (dt, start) = (0.9 * solid.stable_time_step().dt, solid.kinetic_energy());
        (0..4000).for_each(|_| solid.step(dt).unwrap());
        let left = solid.kinetic_energy() + solid.strain_energy();
        assert!(left < 1e-3 * start, "{formulation:?} {left} {start}");
    }
}

#[test]
fn the_bytes_are_the_same_for_one_and_two_threads_and_after_a_restart() {
    let build = || {
        let mesh = box_mesh(Vec3::new(4.0, 1.0, 1.0), [40, 10, 10]);
        let mut solid = solid(mesh, Formulation::Corotational, VolumetricTreatment::NodalAverage, 0.45);
        solid.fix("x_min").unwrap();
        solid.loads.gravity = Vec3::new(0.0, 0.0, -9.81);
        solid
    };
    let run = |threads: usize, steps: usize, mut solid: Solid| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| (0..steps).for_each(|_| solid.step(1e-5).unwrap()));
        solid.state
    };
    let one = run(1, 20, build());
    assert_eq!(postcard::to_stdvec(&one).unwrap(), postcard::to_stdvec(&run(2, 20, build())).unwrap());
    let half = postcard::to_stdvec(&run(2, 10, build())).unwrap();
    let mut resumed = build();
    resumed.resume(postcard::from_bytes(&half).unwrap()).unwrap();
    assert_eq!(postcard::to_stdvec(&run(1, 10, resumed)).unwrap(), postcard::to_stdvec(&one).unwrap());
}
