//! Grains at three sizes of work: one law's answer, one pass over a bed's contacts, whole steps of a scene.
//!
//! `cargo xtask bench grains`, on one thread. Throughput is contacts per second for the law and the pass, grain-steps per second for the scene.

use benches::beds::{BedOf, Law, SAND};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use grouser_contact::*;
use grouser_dem::*;
use std::hint::black_box;

const N_CONTACTS: usize = 4096;
const N_STEPS: u64 = 20;

fn bed_of() -> BedOf {
    let radii = RadiusDistribution::Uniform { from_m: 0.0038, to_m: 0.0042 };
    BedOf { radii, n_grains: 5_000, width: [0.1, 0.1] }
}

/// Hertz–Mindlin's answer to one contact after the other.
fn law(criterion: &mut Criterion) {
    let between = Interaction { restitution: 0.5, friction: 0.5 };
    let table = PairTable::<f64>::new(&[SAND], Tail::Keep, |_, _| between).expect("sound materials");
    let pair = *table.pair(0, 0);
    let contacts: Vec<Contact<f64>> = (0..N_CONTACTS)
        .map(|k| {
            let phase = k as f64;
            let normal = Vector::new(phase.cos(), phase.sin(), 0.0);
            let velocity = Vector::new(0.01 * phase.sin(), 0.01, -0.01 * phase.cos());
            Contact {
                overlap: 2e-5 * (1.5 + phase.sin()),
                normal,
                velocity: ContactVelocity::of(velocity, normal),
                normal_spin: 0.1,
                effective_radius: 0.002,
                effective_mass: 3.5e-4,
                time_step: 4e-5,
            }
        })
        .collect();
    let mut springs = vec![Vector::<f64>::ZERO; N_CONTACTS];
    let mut group = criterion.benchmark_group("law");
    group.throughput(Throughput::Elements(N_CONTACTS as u64));
    group.bench_function("Hertz–Mindlin", |bencher| {
        bencher.iter(|| {
            let mut sum = Vector::<f64>::ZERO;
            for (contact, spring) in contacts.iter().zip(&mut springs) {
                let (response, remembered) = Law::default().respond(contact, &pair, *spring);
                *spring = remembered;
                sum += contact.normal * response.normal_force + response.tangential_force;
            }
            black_box(sum)
        });
    });
    group.finish();
}

/// One pass over all contacts of a bed at rest between predictor and corrector, no lists made anew.
fn pass(criterion: &mut Criterion) {
    let bed_of = bed_of();
    let (mut bed, dt) = (bed_of.settled().expect("a bed at rest"), bed_of.time_step());
    let n_contacts = bed.contacts().count() as u64;
    let mut group = criterion.benchmark_group("pass");
    group.throughput(Throughput::Elements(n_contacts));
    group.bench_function("5,000 grains at rest", |bencher| {
        bencher.iter(|| {
            bed.predict(dt).expect("sound motion");
            bed.contact_forces(dt);
            bed.correct(dt);
        });
    });
    group.finish();
}

/// Whole steps as a scene makes them: one sweep a step, lists and watch included.
fn scene(criterion: &mut Criterion) {
    let bed_of = bed_of();
    let (mut bed, dt) = (bed_of.settled().expect("a bed at rest"), bed_of.time_step());
    let mut group = criterion.benchmark_group("scene");
    group.throughput(Throughput::Elements(N_STEPS * bed.grains().len() as u64));
    group.bench_function("5,000 grains at rest, 20 steps", |bencher| {
        bencher.iter(|| bed.run(N_STEPS, dt, |_| Ok::<(), Failure>(())).expect("sound motion"));
    });
    group.finish();
}

fn one_thread(_: &mut Criterion) {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("nobody has asked for threads yet");
}

criterion_group!(grains, one_thread, law, pass, scene);
criterion_main!(grains);
