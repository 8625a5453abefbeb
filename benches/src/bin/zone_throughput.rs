//! What the active zone saves, and the error it makes on a plate's force: `cargo xtask bench zone`.
//!
//! A plate of 60 mm is pressed 10 mm into a bed of 80,000 grains, 0.4 m wide and 0.22 m deep, at 0.1 m/s: with every grain computed, with
//! every grain computed but one of them moved by a nanometre (what the force differs by for no reason at all), and with active
//! zones of several reaches. Force and work are compared over the second half of the way.

use benches::beds::{BedOf, Law};
use benches::figures::Figures;
use clap::Parser;
use grouser_contact::HertzMindlin;
use grouser_coupling::{Step, SurfaceContacts};
use grouser_dem::{ActiveZone, Bed, Failure, Grains, RadiusDistribution};
use grouser_geometry::generate::disc_plate;
use grouser_geometry::{RigidMotion, Vec3};
use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;

/// Cost and error of the active zone.
#[derive(Parser)]
struct Arguments {
    /// Copies of the bed of 20,000 grains along x and y
    #[arg(long, default_value_t = 2)]
    tiles: usize,
    /// Zones: reach around the plate [m], and out-of-balance force at which sleepers wake [-]
    #[arg(long, value_delimiter = ',', default_value = "0.06:0.1,0.06:0.3", value_parser = zone)]
    zones: Vec<(f64, f64)>,
    /// Speed below which grains are at rest, over the plate's speed [-]
    #[arg(long, default_value_t = 0.02)]
    calm: f64,
    /// Leave out the run with one grain moved by a nanometre
    #[arg(long)]
    without_nudge: bool,
    /// How far the plate goes [m]
    #[arg(long, default_value_t = 0.01)]
    depth: f64,
    /// Threads
    #[arg(long, default_value_t = 1)]
    threads: usize,
    /// Write the figures as JSON
    #[arg(long)]
    json: Option<PathBuf>,
}

fn zone(text: &str) -> Result<(f64, f64), String> {
    let parts =
        text.split_once(':').and_then(|(reach, limit)| Some((reach.parse().ok()?, limit.parse().ok()?)));
    parts.ok_or_else(|| format!("`{text}` is not `reach:imbalance`"))
}

const SPEED: f64 = 0.1;
const RADIUS: f64 = 0.03;
const STEPS_PER_SAMPLE: u64 = 25;

/// Upward force on the plate [N] by sample, time taken [s], and the mean share of grains awake.
struct Press {
    forces: Vec<f64>,
    seconds: f64,
    awake: f64,
    imbalance: f64,
}

fn press(
    mut bed: Bed<Law>,
    zone: Option<(f64, f64)>,
    of: &Arguments,
    dt: f64,
) -> Result<Press, Box<dyn Error>> {
    let upper = bed.settings().domain.upper;
    let centre = Vec3::new(upper.x / 2.0, upper.y / 2.0, 0.0);
    let is_below = |s: &grouser_contact::Sphere| {
        (s.position.x - centre.x).hypot(s.position.y - centre.y) < RADIUS + s.radius
    };
    let top = bed
        .grains()
        .spheres
        .iter()
        .filter(|s| is_below(s))
        .fold(0.0_f64, |t, s| t.max(s.position.z + s.radius));
    let mut motion = RigidMotion::at_rest(centre + Vec3::z() * top);
    motion.velocity = Vec3::z() * -SPEED;
    let mut plate = SurfaceContacts::new(disc_plate(RADIUS, 0.01, 64)?, 0);
    let (law, table): (Law, _) = (HertzMindlin, bed.pair_table().clone());
    if let Some((_, imbalance)) = zone {
        let zone = ActiveZone { block_m: 0.024, calm_speed: of.calm * SPEED, calm_time_s: 4e-3, imbalance };
        bed.set_active_zone(Some(zone))?;
    }
    let n_samples = (of.depth / SPEED / dt / STEPS_PER_SAMPLE as f64).ceil() as usize;
    let (mut forces, mut awake, mut imbalance) = (Vec::new(), 0.0, 0.0_f64);
    let begun = Instant::now();
    for _ in 0..n_samples {
        if let Some((reach, _)) = zone {
            let around = Vec3::new(RADIUS, RADIUS, 0.0) + Vec3::repeat(reach);
            bed.keep_awake(vec![[motion.position - around, motion.position + around]]);
        }
        let mut sum = 0.0;
        bed.run(STEPS_PER_SAMPLE, dt, |grains| {
            motion.position += motion.velocity * dt;
            let step = Step { law: &law, table: &table, time_step: dt, fastest: grains.fastest() };
            let Grains { spheres, ids, loads, .. } = grains;
            sum += plate.forces(&motion, (spheres, ids), loads, &step).force.z;
            Ok::<(), Failure>(())
        })?;
        forces.push(sum / STEPS_PER_SAMPLE as f64);
        awake += bed.zone().map_or(1.0, |zone| zone.n_awake as f64 / bed.grains().len() as f64);
        imbalance = imbalance.max(bed.zone().map_or(0.0, |zone| zone.imbalance));
    }
    let seconds = begun.elapsed().as_secs_f64();
    if let Some(zone) = bed.zone() {
        println!("    {zone:?}, lists made {} times", bed.n_rebuilds());
    }
    Ok(Press { forces, seconds, awake: awake / n_samples as f64, imbalance })
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    rayon::ThreadPoolBuilder::new().num_threads(arguments.threads).build_global()?;
    let radii = RadiusDistribution::Uniform { from_m: 0.0038, to_m: 0.0042 };
    let bed_of = BedOf { radii, n_grains: 20_000, width: [0.2, 0.2] };
    let bed = bed_of.tiled(arguments.tiles)?;
    let dt = bed_of.time_step();
    println!("  {} grains", bed.grains().len());
    let full = press(bed.clone(), None, &arguments, dt)?;
    let half = full.forces.len() / 2;
    let mean = |forces: &[f64]| forces[half..].iter().sum::<f64>() / (forces.len() - half) as f64;
    let mut figures = Figures::new("zone", arguments.threads);
    let mut report = |case: &str, press: &Press| {
        let error = (mean(&press.forces) / mean(&full.forces) - 1.0).abs();
        let square = |(a, b): (&f64, &f64)| (a - b).powi(2);
        let pairs = || press.forces[half..].iter().zip(&full.forces[half..]);
        let rms = (pairs().map(square).sum::<f64>() / (full.forces.len() - half) as f64).sqrt();
        figures.push(case, "time", press.seconds, "s");
        figures.push(case, "time of every grain over time", full.seconds / press.seconds, "-");
        figures.push(case, "grains awake, mean share", press.awake, "-");
        figures.push(case, "mean force", mean(&press.forces), "N");
        figures.push(case, "error of the mean force", error, "-");
        figures.push(case, "difference of the force, rms over mean", rms / mean(&full.forces), "-");
        figures.push(
            case,
            "largest sum of border imbalances over mean force",
            press.imbalance / mean(&full.forces),
            "-",
        );
    };
    report("every grain", &full);
    if !arguments.without_nudge {
        let mut nudged = bed.clone();
        nudged.grains_mut().spheres[0].position.x += 1e-9;
        report("every grain, one moved by 1 nm", &press(nudged, None, &arguments, dt)?);
    }
    for &(reach, imbalance) in &arguments.zones {
        let press = press(bed.clone(), Some((reach, imbalance)), &arguments, dt)?;
        report(&format!("zone reaching {:.0} mm, imbalance {imbalance}", 1e3 * reach), &press);
    }
    figures.write(arguments.json.as_deref())
}
