//! Polygons worked on together against the definition, and on every instruction set.

use super::*;
use crate::polygon::{PartialLoad, Sag, by_centres, integrate};
use crate::response::{NO_KINKS, OneArray, Response, Stiff};

/// Corners with kinks between them, partly covered, partly above the ground, curved.
fn corners() -> Vec<Corners> {
    let mut all = Vec::new();
    for (z, share, depth) in [
        ([0.01, 0.031, 0.022], [1.0; 3], [0.01, 0.02, 0.01]),
        ([0.01, 0.031, 0.022], [0.0, 1.0, 0.6], [-0.001, 0.003, 0.0005]),
        ([-0.002, 0.004, 0.009], [1.0; 3], [-0.002, 0.004, 0.0009]),
        ([0.13, 0.149, 0.16], [0.5, 1.0, 0.0], [4e-4, -1e-4, 2e-4]),
    ] {
        for sag in [[0.0; 3], [3e-4, -1e-4, 2e-4]] {
            all.push(Corners { z, share, depth, sag: Sag::new(sag) });
        }
    }
    all
}

fn agree<R: Response>(ground: R, contact: f64) {
    for resolution in [1, 2, 3, 4, 5] {
        let sub = SubTriangles::new(resolution);
        let mut batch = Batch::new();
        // What is deep in a rut is deeper still below the undisturbed ground.
        let sunk = corners().into_iter().filter(|corners| corners.z.iter().all(|z| *z > 0.0));
        let deep = sunk.map(|corners| Corners { depth: [f64::INFINITY; 3], ..corners });
        // Several times, as what an earlier batch held must not be seen.
        for corners in [corners(), deep.collect(), corners().split_off(1)] {
            for corners in &corners {
                let mut kinks = NO_KINKS;
                let answer = integrate(&sub, ground, corners, PartialLoad::Proportional, contact, &mut kinks);
                batch.push(&[[0.0; 3], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0]], corners, &answer, true);
            }
            batch.answer(&sub, 0.1);
            let (wrench, _) = batch.give();
            let mut expected = [0.0; 3];
            for (n, corners) in corners.iter().enumerate() {
                let exact = by_centres(&sub, ground, corners, PartialLoad::Proportional, contact);
                let near = |a: f64, b: f64, scale: f64| {
                    assert!((a - b).abs() <= 1e-9 * scale, "{a} {b} {corners:?} {resolution}");
                };
                let scale = exact.pressure.max(exact.stiffness * 1e-3);
                near(batch.pressure[n], exact.pressure, scale);
                (0..3).for_each(|k| near(batch.moment[k][n], exact.moment[k], scale));
                near(batch.stiffness[n], exact.stiffness, exact.stiffness);
                // Over a triangle of 0.1 m the moment about x is Σ p y, that about y −Σ p x.
                let sums = [exact.pressure, 0.1 * exact.moment[2], -0.1 * exact.moment[1]];
                (0..3).for_each(|k| expected[k] += 0.005 * sums[k]);
            }
            batch.clear();
            for (sum, expected) in [wrench.force.z, wrench.moment.x, wrench.moment.y].iter().zip(expected) {
                assert!((sum - expected).abs() <= 1e-9 * expected.abs(), "{sum} {expected}");
            }
        }
    }
}

#[test]
fn many_at_a_time_equal_centre_by_centre() {
    let pressures: Vec<f64> = (0..40).map(|k| 1e4 * f64::from(k) + 3e3 * f64::from(k * k % 7)).collect();
    agree(OneArray { pressures: &pressures, per_resolution: 200.0 }, 1e-3);
    agree(Stiff(1e9), 0.0);
}

/// One of the ways of [`Batch::answer`].
type Way = fn(&mut Batch, &SubTriangles, f64);

/// The ways that this machine has, by name.
fn ways() -> Vec<(&'static str, Way)> {
    let mut ways: Vec<(&'static str, Way)> = vec![("portable", Batch::answer_portable)];
    #[cfg(target_arch = "x86_64")]
    {
        // SAFETY: in each, the instructions were just found on this machine.
        if has_avx2() {
            ways.push(("AVX2", |batch, sub, d| unsafe { batch.answer_avx2(sub, d) }));
        }
        if has_avx512() {
            ways.push(("AVX-512", |batch, sub, d| unsafe { batch.answer_avx512(sub, d) }));
        }
    }
    ways.push(("widest", Batch::answer));
    ways
}

/// Bits of all numbers that a batch of `polygons` answers with, summed and one by one.
fn bits(way: Way, sub: &SubTriangles, polygons: &[([[f64; 3]; 3], Corners, Answer, bool)]) -> Vec<u64> {
    let (mut batch, mut all) = (Batch::new(), Vec::new());
    for batch_of in polygons.chunks(LANES) {
        for (points, corners, answer, counts) in batch_of {
            batch.push(points, corners, answer, *counts);
        }
        way(&mut batch, sub, 0.04);
        for loaded in (0..batch_of.len()).filter_map(|n| batch.loaded(n)) {
            all.extend(loaded.arm.iter().chain(&loaded.normal));
            all.extend([loaded.lift, loaded.pressure, loaded.stiffness]);
        }
        batch.clear();
    }
    let (wrench, stiffness) = batch.give();
    all.extend(wrench.force.iter().chain(&wrench.moment).chain(&stiffness));
    all.into_iter().map(f64::to_bits).collect()
}

#[test]
fn every_instruction_set_gives_the_same_bytes() {
    let pressures: Vec<f64> = (0..60).map(|k| 1e4 * f64::from(k) + 3e3 * f64::from(k * k % 7)).collect();
    let ground = OneArray { pressures: &pressures, per_resolution: 200.0 };
    let mut k = 0;
    let mut random = |low: f64, high: f64| {
        k += 1;
        low + (high - low) * 0.5 * (1.0 + crate::pressure::noise::uniform(1, k))
    };
    let mut polygons = |sub: &SubTriangles| {
        let polygon = |n: usize| {
            let mut three = |low: f64, high: f64| [0; 3].map(|_| random(low, high));
            let [deep, ..] = three(-0.02, 0.2);
            let z = three(deep, deep + 0.03);
            // By turns full and deep, at the edge of the gear, at the edge of contact, and both; all of the second batch so deep that it no
            // longer matters.
            let share = if n % 4 < 2 { [1.0; 3] } else { three(-0.5, 1.5).map(|s| s.clamp(0.0, 1.0)) };
            let depth = if n.is_multiple_of(2) { z } else { three(-1e-3, 2e-3) };
            let depth = if n / LANES == 1 { [f64::INFINITY; 3] } else { depth };
            let sag = if n.is_multiple_of(3) { [0.0; 3] } else { three(-3e-4, 3e-4) };
            let points = [[0.0, 0.0], [0.04, 0.0], [0.04, 0.04]].map(|[x, y]| {
                let [a, b, c] = three(-1.0, 1.0);
                [x + a, y + b, c]
            });
            let corners = Corners { z, share, depth, sag: Sag::new(sag) };
            let kinks = Box::leak(Box::new(NO_KINKS));
            let answer = integrate(sub, ground, &corners, PartialLoad::Proportional, 2.5e-4, kinks);
            (points, corners, answer, !n.is_multiple_of(5))
        };
        (0..100).map(polygon).collect::<Vec<_>>()
    };
    for resolution in [1, 2, 4, 5] {
        let sub = SubTriangles::new(resolution);
        let polygons = polygons(&sub);
        let of_lines = polygons.iter().filter(|p| matches!(p.2, Answer::OnLines { .. })).count();
        assert_eq!(of_lines, 100, "polygons summed in lanes");
        let ways = ways();
        let expected = bits(ways[0].1, &sub, &polygons);
        assert!(expected.len() > 70 * 9, "{} numbers", expected.len());
        for (name, way) in &ways[1..] {
            assert!(bits(*way, &sub, &polygons) == expected, "{name} differs, resolution {resolution}");
        }
    }
}
