//! What a precision costs in accuracy: `cargo xtask bench precision`.
//!
//! One bed at rest, computed in double precision and handed over as positions and radii, calms down and is pressed by a plate of
//! 60 mm in each precision. Packings diverge from the least difference, so the plate starts at several places, and a bed of which
//! one half is shifted by 1 µm shows how far that alone goes. The differences of the mean forces are given.

use benches::beds::{BedOf, LAW, Law, SAND};
use benches::figures::Figures;
use clap::Parser;
use grouser_contact::*;
use grouser_coupling::{Step, SurfaceContacts};
use grouser_dem::*;
use grouser_geometry::generate::disc_plate;
use grouser_geometry::{RigidMotion, Vec3};
use std::error::Error;
use std::path::PathBuf;

/// Error of each precision on a plate's force.
#[derive(Parser)]
struct Arguments {
    /// Places at which the plate starts
    #[arg(long, default_value_t = 6)]
    places: usize,
    /// Threads
    #[arg(long, default_value_t = 2)]
    threads: usize,
    /// Write the figures as JSON
    #[arg(long)]
    json: Option<PathBuf>,
}

/// Place and radius of a grain [m].
type Row = (Vec3, f64);

const RADIUS: f64 = 0.03;
const SPEED: f64 = 0.1;
/// Depths between which forces are averaged [m]: before packings diverge, and after.
const SHALLOW: [f64; 2] = [0.0005, 0.002];
const DEEP: [f64; 2] = [0.005, 0.012];

/// Mean forces on the plate [N] over the shallow and the deep part of its way.
fn press<P: Precision>(bed_of: &BedOf, rows: &[Row], at: [f64; 2]) -> Result<[f64; 2], Box<dyn Error>>
where
    Law: ContactLaw<P::Real>,
    <Law as ContactLaw<P::Real>>::Memory: Memory<P::Real>,
{
    let dt = bed_of.time_step();
    let top = rows.iter().map(|(place, radius)| place.z + radius).fold(0.0, f64::max);
    let spheres = rows.iter().map(|&(place, radius)| sphere::<P>(place, radius, SAND.density_kg_m3, 0));
    let mut bed = bed_of.of::<P>(spheres.collect())?;
    let (law, table): (Law, _) = (LAW, bed.pair_table().clone());
    bed.run(500, dt, |_| Ok::<(), Failure>(()))?;
    let mut motion = RigidMotion::at_rest(Vec3::new(at[0], at[1], top));
    motion.velocity = Vec3::z() * -SPEED;
    let mut plate = SurfaceContacts::new(disc_plate(RADIUS, 0.01, 64)?, 0);
    let mut sums = [[0.0; 2]; 2];
    let n_steps = ((0.004 + DEEP[1]) / (SPEED * dt)) as u64;
    let mut touched = f64::NAN;
    bed.run(n_steps, dt, |grains| {
        motion.position += motion.velocity * dt;
        let step = Step { law: &law, table: &table, time_step: dt, fastest: grains.fastest() };
        let Grains { spheres, ids, loads, .. } = grains;
        let force = plate.forces(&motion, (spheres, ids), loads, &step).force.z;
        if touched.is_nan() && force > 0.0 {
            touched = motion.position.z;
        }
        let depth = touched - motion.position.z;
        for (sum, [from, until]) in sums.iter_mut().zip([SHALLOW, DEEP]) {
            if depth >= from && depth < until {
                *sum = [sum[0] + force, sum[1] + 1.0];
            }
        }
        Ok::<(), Failure>(())
    })?;
    Ok(sums.map(|[sum, n]| sum / n))
}

/// Mean, and the standard error of the mean.
fn mean(values: &[f64]) -> [f64; 2] {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>();
    [mean, (squares / (n - 1.0).max(1.0) / n).sqrt()]
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    rayon::ThreadPoolBuilder::new().num_threads(arguments.threads).build_global()?;
    let radii = RadiusDistribution::Uniform { from_m: 0.0038, to_m: 0.0042 };
    let bed_of = BedOf { radii, n_grains: 20_000, width: [0.2, 0.2] };
    let (bed, width) = (bed_of.tiled_at_rest([1, 1])?, bed_of.width[0]);
    let rows: Vec<Row> = bed
        .grains()
        .spheres
        .iter()
        .map(|s| (Vec3::new(s.position.x, s.position.y, s.position.z), s.radius))
        .collect();
    let moved = |&(place, radius): &Row| {
        (if place.x > 0.5 * width { place + Vec3::x() * 1e-6 } else { place }, radius)
    };
    let shifted: Vec<Row> = rows.iter().map(moved).collect();
    let mut differences = [const { [const { Vec::new() }; 2] }; 3];
    for place in 0..arguments.places {
        let at = [0.7549, 0.5698].map(|step| width * (0.25 + 0.5 * (step * place as f64).fract()));
        let exact = press::<F64>(&bed_of, &rows, at)?;
        let others = [
            press::<Mixed>(&bed_of, &rows, at)?,
            press::<F32>(&bed_of, &rows, at)?,
            press::<F64>(&bed_of, &shifted, at)?,
        ];
        println!("  at {at:.3?}: {exact:.3?} N, others {others:.3?} N");
        for (rows, other) in differences.iter_mut().zip(others) {
            (0..2).for_each(|part| rows[part].push(other[part] / exact[part] - 1.0));
        }
    }
    let mut figures = Figures::new("precision", arguments.threads);
    for (case, rows) in ["mixed", "f32", "f64, half of the bed shifted by 1 µm"].iter().zip(&differences) {
        for (part, values) in ["0.5 to 2 mm", "5 to 12 mm"].iter().zip(rows) {
            let case = format!("{case}, {part}");
            let [difference, uncertainty] = mean(values);
            figures.push(&case, "difference of the mean force from f64", difference, "-");
            figures.push(&case, "its standard error", uncertainty, "-");
        }
    }
    figures.write(arguments.json.as_deref())
}
