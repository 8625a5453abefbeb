//! What the active zone saves, and the error it makes on a tool's force: `cargo xtask bench zone`.
//!
//! A plate of 60 mm is pressed 15 mm into a bed 0.6 m wide and 0.22 m deep (180,000 grains), or sunk by 10 mm and drawn along
//! a bed of 2.4 m (240,000 grains, 0.2 m wide). Each way is made with every grain computed and with active zones of several reaches. Packings
//! diverge from the least difference, so one pair of runs says little: the plate starts at several places, and the mean of the
//! differences and its standard error are given, beside those of a bed of which one half is shifted by 10 µm.

use benches::beds::{BedOf, LAW, Law};
use benches::figures::Figures;
use clap::{Parser, ValueEnum};
use grouser_coupling::{Step, SurfaceContacts};
use grouser_dem::{ActiveZone, Bed, Failure, Grains, RadiusDistribution, ZoneAccount};
use grouser_geometry::generate::disc_plate;
use grouser_geometry::{RigidMotion, Vec3};
use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;

/// Cost and error of the active zone.
#[derive(Parser)]
struct Arguments {
    /// Ways of the plate
    #[arg(long, value_enum, value_delimiter = ',', default_value = "press,draw")]
    ways: Vec<Way>,
    /// Reaches around the plate [m]
    #[arg(long, value_delimiter = ',', default_value = "0.12,0.15,0.18")]
    reaches: Vec<f64>,
    /// Places at which the plate starts
    #[arg(long, default_value_t = 1)]
    places: usize,
    /// Places passed over
    #[arg(long, default_value_t = 0)]
    from: usize,
    /// Change of the force on a sleeping block that wakes it [-]
    #[arg(long, default_value_t = f64::INFINITY)]
    wake: f64,
    /// Also a bed of which one half is shifted by 10 µm
    #[arg(long)]
    shifted: bool,
    /// Threads
    #[arg(long, default_value_t = 1)]
    threads: usize,
    /// Write the figures as JSON
    #[arg(long)]
    json: Option<PathBuf>,
}

/// How the plate goes.
#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Way {
    /// Down.
    Press,
    /// Down, in a bed of 0.4 m: cheaper, for many places.
    PressSmall,
    /// Down and along x.
    Draw,
}

impl Way {
    fn tiles(self) -> [usize; 2] {
        match self {
            Self::Press => [3, 3],
            Self::PressSmall => [2, 2],
            Self::Draw => [12, 1],
        }
    }

    /// Velocity [m/s] after `time` [s], the time that it takes [s], and from when on the force counts.
    fn velocity(self, time: f64) -> Vec3 {
        match self {
            Self::Press | Self::PressSmall => Vec3::z() * -0.1,
            Self::Draw if time < 0.05 => Vec3::z() * -0.2,
            Self::Draw => Vec3::x() * 0.4,
        }
    }

    fn times(self) -> [f64; 2] {
        if self == Self::Draw { [0.07, 0.20] } else { [0.075, 0.15] }
    }

    /// The force looked at.
    fn force(self, force: &Vec3) -> f64 {
        if self == Self::Draw { -force.x } else { force.z }
    }
}

const RADIUS: f64 = 0.03;
const THICKNESS: f64 = 0.01;
const STEPS_PER_SAMPLE: u64 = 25;

/// Mean force [N], time taken [s], mean share of grains awake, what the zone did.
struct Went {
    force: f64,
    seconds: f64,
    awake: f64,
    account: Option<ZoneAccount>,
}

fn go(
    mut bed: Bed<Law>,
    way: Way,
    at: [f64; 2],
    zone: Option<(f64, f64)>,
    dt: f64,
) -> Result<Went, Box<dyn Error>> {
    let width = bed.settings().domain.upper;
    let near = |there: f64, axis: usize| {
        let apart = there - at[axis];
        apart - width[axis] * (apart / width[axis]).round()
    };
    let is_below =
        |s: &grouser_contact::Sphere| near(s.position.x, 0).hypot(near(s.position.y, 1)) < RADIUS + s.radius;
    let tops = bed.grains().spheres.iter().filter(|s| is_below(s)).map(|s| s.position.z + s.radius);
    let mut motion = RigidMotion::at_rest(Vec3::new(at[0], at[1], tops.fold(0.0, f64::max)));
    let mut plate = SurfaceContacts::new(disc_plate(RADIUS, THICKNESS, 64)?, 0);
    let (law, table): (Law, _) = (LAW, bed.pair_table().clone());
    if let Some((_, wake)) = zone {
        let zone = ActiveZone { block_m: 0.024, rest_speed: 1e-3, rest_time_s: 8e-3, wake };
        bed.set_active_zone(Some(zone))?;
    }
    let [from, until] = way.times();
    let (mut time, mut sum, mut n_summed, mut awake, mut n_samples) = (0.0, 0.0, 0.0, 0.0, 0.0);
    let begun = Instant::now();
    while time < until {
        if let Some((reach, _)) = zone {
            let half = Vec3::new(RADIUS, RADIUS, 0.0);
            let top = Vec3::z() * THICKNESS;
            bed.keep_awake(vec![[motion.position - half, motion.position + half + top]], reach);
        }
        bed.run(STEPS_PER_SAMPLE, dt, |grains| {
            motion.velocity = way.velocity(time);
            motion.position += motion.velocity * dt;
            time += dt;
            let step = Step { law: &law, table: &table, time_step: dt, fastest: grains.fastest() };
            let Grains { spheres, ids, loads, .. } = grains;
            let force = plate.forces(&motion, (spheres, ids), loads, &step).force;
            if time >= from {
                sum += way.force(&force);
                n_summed += 1.0;
            }
            Ok::<(), Failure>(())
        })?;
        awake += bed.zone().map_or(1.0, |zone| zone.n_awake as f64 / bed.grains().len() as f64);
        n_samples += 1.0;
    }
    let seconds = begun.elapsed().as_secs_f64();
    Ok(Went { force: sum / n_summed, seconds, awake: awake / n_samples, account: bed.zone().copied() })
}

/// Mean and its standard error (not a number for one value).
fn mean(values: &[f64]) -> [f64; 2] {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>();
    [mean, (squares / (n - 1.0) / n).sqrt()]
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    rayon::ThreadPoolBuilder::new().num_threads(arguments.threads).build_global()?;
    let radii = RadiusDistribution::Uniform { from_m: 0.0038, to_m: 0.0042 };
    let bed_of = BedOf { radii, n_grains: 20_000, width: [0.2, 0.2] };
    let dt = bed_of.time_step();
    let mut figures = Figures::new("zone", arguments.threads);
    for &way in &arguments.ways {
        let bed = bed_of.tiled_at_rest(way.tiles())?;
        let name = match way {
            Way::Press => "press",
            Way::PressSmall => "press, small bed",
            Way::Draw => "draw",
        };
        println!("  {name}: {} grains", bed.grains().len());
        let mut cases: Vec<Option<f64>> = arguments.reaches.iter().copied().map(Some).collect();
        if arguments.shifted {
            cases.push(None);
        }
        // For each case: difference of force, gain in time, share awake.
        let mut rows = vec![[const { Vec::new() }; 3]; cases.len()];
        for place in arguments.from..arguments.from + arguments.places {
            let share = |step: f64| (place as f64 * step).fract();
            let at = [0.05 + bed_of.width[0] * share(0.7549), 0.05 + bed_of.width[1] * share(0.5698)];
            let full = go(bed.clone(), way, at, None, dt)?;
            println!("    at {at:.3?}: {:.3} N, {:.1} s", full.force, full.seconds);
            for (case, row) in cases.iter().zip(&mut rows) {
                let went = match case {
                    Some(reach) => go(bed.clone(), way, at, Some((*reach, arguments.wake)), dt)?,
                    None => {
                        let mut shifted = bed.clone();
                        let right = shifted.grains_mut().spheres.iter_mut();
                        right.filter(|s| s.position.x > 0.2).for_each(|s| s.position.x += 1e-5);
                        go(shifted, way, at, None, dt)?
                    }
                };
                let values = [went.force / full.force - 1.0, full.seconds / went.seconds, went.awake];
                println!("      {case:?}: {values:.4?} {:?}", went.account);
                row.iter_mut().zip(values).for_each(|(column, value)| column.push(value));
            }
        }
        for (case, [errors, gains, awake]) in cases.iter().zip(&rows) {
            let case = case.map_or("shifted".to_owned(), |reach| format!("{:.0} mm", 1e3 * reach));
            let case = format!("{name}, {case}");
            figures.push(&case, "time of every grain over time", mean(gains)[0], "-");
            figures.push(&case, "grains awake, mean share", mean(awake)[0], "-");
            let [error, uncertainty] = mean(errors);
            figures.push(&case, "difference of the mean force", error, "-");
            if arguments.places > 1 {
                figures.push(&case, "its standard error", uncertainty, "-");
            }
        }
    }
    figures.write(arguments.json.as_deref())
}
