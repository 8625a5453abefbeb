//! The same answers in mixed and in single precision, each with its own tolerance.

use super::Row;
use super::bodies::{space, wall};
use grouser_contact::{F32, HertzMindlin, Interaction, Material, Mixed, PairTable, Precision, Real, Tail};
use grouser_dem::{Bed, BedSettings, Failure, sphere};
use grouser_geometry::Vec3;

type Law = HertzMindlin;

const SAND: Material = Material { young_pa: 1e7, poisson: 0.3, density_kg_m3: 2600.0 };
const RADIUS: f64 = 4e-3;

/// Differences are taken in double precision; a thousand steps of single-precision arithmetic stay below the law's own 1e-3.
pub fn mixed() -> Vec<Row> {
    rows::<Mixed>("mixed precision", [1e-3, 1e-3])
}

/// An overlap of 1.5 µm at 7 cm from the origin is the difference of numbers rounded to 7 nm: 5e-3 of a stack's compression.
pub fn single() -> Vec<Row> {
    rows::<F32>("single precision", [1e-3, 1e-2])
}

fn rows<P: Precision>(name: &str, [of_impact, of_stack]: [f64; 2]) -> Vec<Row> {
    let mut rows = impact::<P>(name, of_impact);
    rows.extend(stack::<P>(name, of_stack));
    rows
}

fn table<P: Precision>(restitution: f64) -> PairTable<P::Real> {
    PairTable::new(&[SAND], Tail::CutCorrected, |_, _| Interaction { restitution, friction: 0.5 })
        .expect("sound")
}

/// Two grains that meet head on, elastically and with loss.
fn impact<P: Precision>(name: &str, tolerance: f64) -> Vec<Row> {
    let case =
        (name, "Hertz: F = k δ^1.5, δ = (5 m* v²/4k)^0.4, t = 2.943275 δ/v; the restitution asked for");
    let speed = 0.5;
    let impact = |restitution: f64| {
        let grains = [-1.0, 1.0].map(|side| {
            let mut grain = sphere::<P>(Vec3::new(0.0, 0.0, side * RADIUS), RADIUS, SAND.density_kg_m3, 0);
            grain.velocity.z = P::Real::from_f64(-0.5 * side * speed);
            grain
        });
        let mut bed = Bed::<Law, P>::new(grains.to_vec(), space(), table::<P>(restitution), Law::default())
            .expect("sound");
        let modulus = bed.pair_table().pair(0, 0).normal_modulus.to_f64() * (RADIUS / 2.0).sqrt();
        let mass = bed.grains().spheres[0].mass.to_f64() / 2.0;
        let overlap = (1.25 * mass * speed * speed / modulus).powf(0.4);
        let (time, force) = (2.943_275 * overlap / speed, modulus * overlap.powf(1.5));
        let (mut largest, dt) = (0.0_f64, time / 1000.0);
        let mut n_touching = 0;
        for step in 0..4000 {
            bed.step(dt).expect("an impact of two grains is well behaved");
            let pushed = bed.grains().loads[0].force.z.to_f64().abs();
            largest = largest.max(pushed);
            if pushed > 0.0 {
                n_touching = step + 1;
            }
        }
        let [below, above] = [0, 1].map(|id| {
            let place = bed.grains().ids.iter().position(|&known| known == id).expect("two grains");
            bed.grains().spheres[place].velocity.z.to_f64()
        });
        (largest / force, f64::from(n_touching) * dt / time, (above - below).abs() / speed)
    };
    let (force, time, _) = impact(1.0);
    let (_, _, restitution) = impact(0.5);
    vec![
        Row::absolute(case, "largest force of an elastic impact over Hertz's", "-", force, (1.0, tolerance)),
        Row::absolute(case, "its contact time over Hertz's", "-", time, (1.0, 2.0 * tolerance)),
        Row::absolute(case, "restitution, 0.5 asked for", "-", restitution, (0.5, tolerance)),
    ]
}

/// Ten grains on top of each other come to rest.
fn stack<P: Precision>(name: &str, tolerance: f64) -> Vec<Row> {
    let case = (name, "Hertz: overlap of contact k = (weight above/k)^(2/3); the floor carries all");
    let (n, gravity) = (10, 9.81);
    let height = |k: usize| RADIUS * (2 * k + 1) as f64;
    let grains: Vec<_> =
        (0..n).map(|k| sphere::<P>(Vec3::new(0.0, 0.0, height(k)), RADIUS, SAND.density_kg_m3, 0)).collect();
    let weight = grains[0].mass.to_f64() * gravity;
    let settings = BedSettings { gravity: Vec3::new(0.0, 0.0, -gravity), ..wall(0) };
    let mut bed = Bed::<Law, P>::new(grains, settings, table::<P>(0.3), Law::default()).expect("sound");
    bed.run(60_000, 2e-5, |_| Ok::<(), Failure>(())).expect("well behaved");
    let modulus = bed.pair_table().pair(0, 0).normal_modulus.to_f64();
    let overlap = |load: f64, radius: f64| (load / (modulus * radius.sqrt())).powf(2.0 / 3.0);
    let sum: f64 = (1..n).map(|above| overlap(above as f64 * weight, RADIUS / 2.0)).sum();
    let compression = sum + overlap(n as f64 * weight, RADIUS);
    let top = bed.grains().spheres.iter().map(|grain| grain.position.z.to_f64()).fold(0.0, f64::max);
    let mean_force = -bed.plane_force(0).z;
    vec![
        Row::relative(case, "force on the floor", "N", mean_force, (n as f64 * weight, tolerance)),
        Row::relative(case, "compression of a stack", "m", height(n - 1) - top, (compression, tolerance)),
    ]
}
