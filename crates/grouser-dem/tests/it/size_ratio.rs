//! Grains whose sizes differ by up to a factor of a hundred: every pair is found, whatever its sizes.

use crate::*;
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};

/// Grains with radii from 1 to `ratio` mm, small ones more often; half of them close to an earlier one.
fn cloud(n: usize, ratio: f64, is_periodic: [bool; 3], seed: u64) -> (Vec<Sphere>, BedSettings) {
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(seed);
    let mut share = || random.random::<f64>();
    let radii: Vec<f64> =
        (0..n).map(|k| 1e-3 * ratio.powf(if k == 0 { 1.0 } else { share().powi(2) })).collect();
    let size = Vec3::new(10.1, 12.3, 10.7) * (1e-3 * ratio);
    let mut spheres: Vec<Sphere> = Vec::new();
    for (k, &radius) in radii.iter().enumerate() {
        let anywhere = Vec3::new(share(), share(), share()).component_mul(&size);
        let mut place = anywhere;
        if k > 0 && share() < 0.6 {
            let other = spheres[(share() * k as f64) as usize];
            let away = Vec3::new(share() - 0.5, share() - 0.5, share() - 0.5).normalize();
            let distance = (radius + other.radius) * (0.9 + 0.2 * share());
            let [x, y, z] = other.position.to_array();
            place = Vec3::new(x, y, z) + away * distance;
        }
        for axis in 0..3 {
            if is_periodic[axis] {
                place[axis] = place[axis].rem_euclid(size[axis]);
            }
        }
        spheres.push(sphere(place, radius, SAND.density_kg_m3, 0));
    }
    let margin = Vec3::from_fn(|axis, _| if is_periodic[axis] { 0.0 } else { 1.0 });
    let domain = Domain { lower: -margin, upper: size + margin, is_periodic };
    (spheres, BedSettings { domain, has_ledger: false, ..empty_space() })
}

/// Pairs of permanent numbers that overlap, found by looking at all pairs.
fn all_pairs(spheres: &[Sphere], domain: &Domain) -> Vec<[u32; 2]> {
    let size = domain.size();
    let mut pairs = Vec::new();
    for (i, a) in spheres.iter().enumerate() {
        for (j, b) in spheres.iter().enumerate().take(i) {
            let mut d = (a.position - b.position).to_array();
            for axis in 0..3 {
                if domain.is_periodic[axis] {
                    d[axis] -= size[axis] * (d[axis] / size[axis]).round();
                }
            }
            if Vector::from(d).norm() < a.radius + b.radius {
                pairs.push([j as u32, i as u32]);
            }
        }
    }
    pairs.sort_unstable();
    pairs
}

fn listed_pairs<L: ContactLaw<f64>>(bed: &Bed<L>) -> Vec<[u32; 2]> {
    let ids = &bed.grains().ids;
    let named = |[i, j]: [u32; 2]| [ids[i as usize], ids[j as usize]];
    let mut pairs: Vec<[u32; 2]> = bed.contacts().map(named).map(|[i, j]| [i.min(j), i.max(j)]).collect();
    pairs.sort_unstable();
    pairs
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn every_touching_pair_is_found_once(
        seed in any::<u64>(),
        n in 1_usize..500,
        exponent in 0.0_f64..=2.0,
        is_periodic in any::<[bool; 3]>(),
    ) {
        let (spheres, settings) = cloud(n, 10_f64.powf(exponent), is_periodic, seed);
        let expected = all_pairs(&spheres, &settings.domain);
        let mut bed = Bed::new(spheres, settings, table(0.5, 0.5, Tail::Keep), HertzMindlin::new(Tail::Keep)).unwrap();
        bed.renew_lists().unwrap();
        bed.contact_forces(0.0);
        prop_assert_eq!(listed_pairs(&bed), expected);
    }
}

type Law = HertzMindlin;

/// Graded grains of `ratio` to one in a periodic column, on their way down.
fn graded_column(n: usize, ratio: f64, speed: f64) -> Bed<Law> {
    let (_, settings) = falling_column::<F64>(1, 1);
    let radii = RadiusDistribution::Graded { from_m: 5.9e-3 / ratio, to_m: 5.9e-3 };
    let layer = Layer { radii, n_grains: n, density: SAND.density_kg_m3, material: 0 };
    let mut spheres = random_packing::<F64>(&settings.domain, &[layer], 3).unwrap();
    for sphere in &mut spheres {
        sphere.velocity.z = -speed;
    }
    Bed::new(spheres, settings, table(0.5, 0.5, Tail::CutCorrected), HertzMindlin::new(Tail::CutCorrected))
        .unwrap()
}

#[test]
fn a_graded_bed_gives_the_same_bytes_on_any_threads_and_after_any_restart() {
    let go_on = |bed: &mut Bed<Law>, n_steps| bed.run(n_steps, 2e-5, |_| Ok::<(), Failure>(())).unwrap();
    let results = [1, 2, 3].map(|n_threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().unwrap();
        pool.install(|| {
            let mut bed = graded_column(1500, 8.0, 0.6);
            go_on(&mut bed, 3000);
            assert!(bed.n_contacts() > 300 && bed.n_rebuilds() > 2, "{}", bed.n_contacts());
            postcard::to_allocvec(&bed).unwrap()
        })
    });
    let mut split = graded_column(1500, 8.0, 0.6);
    for n_steps in [1, 699, 2300] {
        go_on(&mut split, n_steps);
        split = postcard::from_bytes(&postcard::to_allocvec(&split).unwrap()).unwrap();
    }
    assert!(results[0] == results[1] && results[0] == results[2], "threads");
    assert!(results[0] == postcard::to_allocvec(&split).unwrap(), "restart");
}

#[test]
fn a_graded_bed_carries_its_weight_and_keeps_its_energy_accounted_for() {
    let mut bed = graded_column(400, 6.0, 0.0);
    let weight: f64 = bed.grains().spheres.iter().map(|sphere| sphere.mass * 9.81).sum();
    let before = bed.energy().stored();
    let mut carried = 0.0;
    for step in 0..20_000 {
        bed.step(2e-5).unwrap();
        // Over the last 0.2 s the bed still breathes: its mean weight counts.
        carried -= if step < 10_000 { 0.0 } else { bed.plane_force(0).z / 10_000.0 };
    }
    assert!((carried / weight - 1.0).abs() < 0.02, "{}", carried / weight);
    let energy = bed.energy();
    let lost = energy.contacts.dissipated();
    assert!(((before - energy.stored() - lost) / lost).abs() < 1e-2, "{before} {energy:?}");
}

#[test]
fn the_radii_of_a_graded_bed_spread_its_mass_evenly_over_the_logarithm_of_size() {
    let radii = RadiusDistribution::Graded { from_m: 1e-3, to_m: 8e-3 };
    let domain = Domain { lower: Vec3::zeros(), upper: Vec3::repeat(0.4), is_periodic: [true, true, false] };
    let layer = Layer { radii, n_grains: 20_000, density: 1.0, material: 0 };
    let spheres = random_packing::<F64>(&domain, &[layer], 2).unwrap();
    let mut mass = [0.0; 3];
    for sphere in &spheres {
        mass[((sphere.radius / 1e-3).log2() as usize).min(2)] += sphere.mass;
    }
    let total: f64 = mass.iter().sum();
    // A third in each octave; the largest octave holds some 250 grains: four standard errors are 0.06.
    assert!(mass.iter().all(|of_octave| (of_octave / total - 1.0 / 3.0).abs() < 0.06), "{mass:?}");
    let expected = radii.mean_volume() * 20_000.0;
    assert!((total / expected - 1.0).abs() < 0.1, "{total} {expected}");
    let (fewer, n_overlapping) = (&spheres[..3000], all_pairs(&spheres[..3000], &domain).len());
    assert_eq!((fewer.len(), n_overlapping), (3000, 0));
}
