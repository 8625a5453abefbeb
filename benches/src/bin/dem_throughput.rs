//! Grain-steps per second of a settled bed of 20,000 grains: `cargo xtask bench dem`.
//!
//! Radius 4 mm ± 5 %, 2600 kg/m³, E = 10 MPa, ν = 0.3, friction and restitution 0.5, time step 40 µs (11 % of the Rayleigh
//! time), 0.2 m × 0.2 m periodic, floor at z = 0: the bed that other codes are compared on.

use clap::Parser;
use grouser_contact::{F64, HertzMindlin, Interaction, Material, PairTable, Sphere, Tail};
use grouser_dem::*;
use grouser_geometry::Vec3;
use std::error::Error;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Grain-steps per second of a settled bed.
#[derive(Parser)]
struct Arguments {
    /// Read the bed from a file (`type radius x y z` a line, `# box LX LY` before them; .gz too) instead of settling one
    #[arg(long)]
    state: Option<PathBuf>,
    /// Grains of the bed that is settled here
    #[arg(long, default_value_t = 20_000)]
    grains: usize,
    /// Steps of each of five repeats, of which the fastest counts
    #[arg(long, default_value_t = 500)]
    steps: u64,
    /// Threads
    #[arg(long, default_value_t = 1)]
    threads: usize,
    /// Keep the energy ledger at every step
    #[arg(long)]
    ledger: bool,
    /// Write the figures as JSON
    #[arg(long)]
    json: Option<PathBuf>,
}

const TIME_STEP: f64 = 4e-5;
const SAND: Material = Material { young_pa: 1e7, poisson: 0.3, density_kg_m3: 2600.0 };
type Law = HertzMindlin;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    rayon::ThreadPoolBuilder::new().num_threads(arguments.threads).build_global()?;
    let mut bed = match &arguments.state {
        Some(path) => bed(read_state(path)?, &arguments)?,
        None => settled(&arguments)?,
    };
    bed.keep_ledger(arguments.ledger);
    bed.run(200, TIME_STEP, |_| Ok::<(), Failure>(()))?;

    let n_grains = bed.grains().len();
    let mut rate = 0.0_f64;
    for _ in 0..5 {
        let begun = Instant::now();
        bed.run(arguments.steps, TIME_STEP, |_| Ok::<(), Failure>(()))?;
        rate = rate.max(n_grains as f64 * arguments.steps as f64 / begun.elapsed().as_secs_f64());
    }
    let energy = bed.energy();
    let weight: f64 = bed.grains().spheres.iter().map(|sphere| sphere.mass * 9.81).sum();
    let figures = [
        ("grain-steps per second", rate, "1/s"),
        ("grains", n_grains as f64, "-"),
        ("contacts per grain, both sides counted", 2.0 * bed.n_contacts() as f64 / n_grains as f64, "-"),
        ("memory per grain", bed.bytes() as f64 / n_grains as f64, "B"),
        ("kinetic energy", energy.kinetic + energy.rotational, "J"),
        ("force on the floor over the weight", -bed.plane_force(0).z / weight, "-"),
    ];
    println!("settled bed, Hertz–Mindlin with history, f64, {} thread(s)", arguments.threads);
    for (metric, value, unit) in figures {
        let number = if value.abs() < 1e-2 { format!("{value:.3e}") } else { format!("{value:.3}") };
        println!("  {metric:<40} {number:>16} {unit}");
    }
    if let Some(path) = &arguments.json {
        let rows: Vec<_> = figures
            .iter()
            .map(|(metric, value, unit)| {
                serde_json::json!({
                    "group": "dem", "case": "settled bed", "metric": metric, "value": value, "unit": unit,
                    "threads": arguments.threads,
                })
            })
            .collect();
        std::fs::write(path, serde_json::to_string_pretty(&rows)? + "\n")?;
    }
    Ok(())
}

fn bed(spheres: Vec<Sphere>, arguments: &Arguments) -> Result<Bed<Law>, Box<dyn Error>> {
    let between = Interaction { restitution: 0.5, friction: 0.5 };
    let settings = BedSettings {
        domain: domain(spheres.iter().map(|sphere| sphere.position.z).fold(0.5, f64::max) + 0.01),
        planes: vec![Plane { point: Vec3::zeros(), normal: Vec3::z(), material: 0 }],
        gravity: Vec3::new(0.0, 0.0, -9.81),
        rotation: Rotation::Free,
        has_ledger: arguments.ledger,
    };
    let table = PairTable::new(&[SAND], Tail::Keep, |_, _| between)?;
    Ok(Bed::new(spheres, settings, table, HertzMindlin::new(Tail::Keep))?)
}

fn domain(top: f64) -> Domain {
    Domain { lower: Vec3::zeros(), upper: Vec3::new(0.2, 0.2, top), is_periodic: [true, true, false] }
}

/// A random packing that has come to rest.
fn settled(arguments: &Arguments) -> Result<Bed<Law>, Box<dyn Error>> {
    let radii = RadiusDistribution::Uniform { from_m: 0.0038, to_m: 0.0042 };
    let layer = Layer { radii, n_grains: arguments.grains, density: SAND.density_kg_m3, material: 0 };
    let mut bed = bed(random_packing::<F64>(&domain(0.5), &[layer], 1)?, arguments)?;
    let mut settling = Settling::new(SettleCriterion { longest_s: 10.0, ..Default::default() }, TIME_STEP);
    println!("settling {} grains …", arguments.grains);
    loop {
        if let Some(end) = settling.advance(&mut bed)? {
            println!(
                "  at rest after {:.2} s: kinetic energy over Σ m g r {:.1e}",
                end.time_s, end.kinetic_energy_ratio
            );
            return Ok(bed);
        }
    }
}

fn read_state(path: &Path) -> Result<Vec<Sphere>, Box<dyn Error>> {
    let bytes = std::fs::read(path)?;
    let mut text = String::new();
    if path.extension().is_some_and(|end| end == "gz") {
        flate2::read::MultiGzDecoder::new(&bytes[..]).read_to_string(&mut text)?;
    } else {
        text = String::from_utf8(bytes)?;
    }
    let mut spheres = Vec::new();
    for (number, line) in text.lines().enumerate().filter(|(_, line)| !line.starts_with('#')) {
        let values = line.split_whitespace().map(str::parse).collect::<Result<Vec<f64>, _>>();
        match values.as_deref() {
            Ok([_, radius, x, y, z, ..]) => {
                spheres.push(sphere(Vec3::new(*x, *y, *z), *radius, SAND.density_kg_m3, 0));
            }
            Ok([]) | Ok([_]) if number < 2 => {}
            _ => {
                return Err(format!("{}:{}: expected `type radius x y z`", path.display(), number + 1).into());
            }
        }
    }
    Ok(spheres)
}
