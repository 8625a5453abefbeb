//! What each rotation law costs on one settled bed, alternately in one run: `cargo run --release -p benches --bin rotation_cost`.
//!
//! The bed of `dem_throughput`: radius 4 mm ± 5 %, 2600 kg/m³, E = 10 MPa, ν = 0.3, friction and restitution 0.5, time step 40 µs,
//! 0.2 m × 0.2 m periodic, floor at z = 0. It settles as spheres; then each law takes over from the same state.

use benches::scalar::Scalar;
use clap::Parser;
use grouser_contact::*;
use grouser_dem::*;
use grouser_geometry::Vec3;
use std::error::Error;
use std::io::Read;
use std::path::PathBuf;
use std::time::Instant;

/// Cost of the rotation laws.
#[derive(Parser)]
struct Arguments {
    /// Read the bed from a file (`type radius x y z` a line; .gz too) instead of settling one
    #[arg(long)]
    state: Option<PathBuf>,
    /// Grains of the bed that is settled here
    #[arg(long, default_value_t = 20_000)]
    grains: usize,
    /// Steps of a repeat
    #[arg(long, default_value_t = 5)]
    steps: u64,
    /// Steps before the clock starts: few, so that every law has the contacts of the settled spheres
    #[arg(long, default_value_t = 20)]
    warm: u64,
    /// Rounds, in each of which every law has its turn; the fastest of each law counts, in which lists are seldom made; the mean
    /// of all has them
    #[arg(long, default_value_t = 40)]
    repeats: u32,
    /// Dashpot on the lift of tilting bodies over that of the normal force; 1 in the shipped scenes
    #[arg(long, default_value_t = 1.0)]
    lift_damping: f64,
    /// Only the laws whose name contains one of these, separated by `|`; the first law stands for free rotation in the ratios
    #[arg(long, default_value = "")]
    only: String,
    /// Scalars of positions and of contact arithmetic
    #[arg(long, value_enum, default_value_t = Scalar::F64)]
    precision: Scalar,
}

const TIME_STEP: f64 = 4e-5;
const SAND: Material = Material { young_pa: 1e7, poisson: 0.3, density_kg_m3: 2600.0 };

/// A bed whatever its law.
trait Timed {
    fn run(&mut self, n_steps: u64) -> Result<(), Failure>;
    fn contacts_per_grain(&self) -> f64;
    fn listed_per_grain(&self) -> f64;
    fn n_rebuilds(&self) -> u64;
}

impl<P: Precision, L: ContactLaw<P::Real>> Timed for Bed<L, P> {
    fn run(&mut self, n_steps: u64) -> Result<(), Failure> {
        Bed::run(self, n_steps, TIME_STEP, |_| Ok::<(), Failure>(()))
    }
    fn contacts_per_grain(&self) -> f64 {
        2.0 * self.n_contacts() as f64 / self.grains().len() as f64
    }
    fn listed_per_grain(&self) -> f64 {
        self.n_listed() as f64 / self.grains().len() as f64
    }
    fn n_rebuilds(&self) -> u64 {
        Bed::n_rebuilds(self)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global()?;
    match arguments.precision {
        Scalar::F64 => compare::<F64>(&arguments),
        Scalar::Mixed => compare::<Mixed>(&arguments),
        Scalar::F32 => compare::<F32>(&arguments),
    }
}

fn compare<P: Precision>(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let spheres: Vec<Sphere<P>> = match &arguments.state {
        Some(path) => read(path)?,
        None => settled(arguments.grains)?,
    };
    let n_grains = spheres.len() as f64;
    let of = |shape| TiltingSettings { lift_damping: arguments.lift_damping, ..TiltingSettings::of(shape) };
    let half = GrainShape::Angular { aspect_ratio: 0.5 };
    let mut beds: Vec<(&str, Box<dyn Timed>)> = vec![
        ("free", boxed(&spheres, Rotation::Free, HertzMindlin::new(Tail::CutCorrected))?),
        ("fixed", boxed(&spheres, Rotation::Fixed, HertzMindlin::new(Tail::CutCorrected))?),
        ("rolling, constant", rotating(&spheres, ConstantRolling::new(0.1)?)?),
        ("rolling, elastic-plastic", rotating(&spheres, ElasticPlasticRolling::new(0.1, 0.3)?)?),
        ("tilting, box", rotating(&spheres, Tilting::<false>::new(&of(half))?)?),
        ("tilting, disc", {
            rotating(&spheres, Tilting::<true>::new(&of(GrainShape::Disc { aspect_ratio: 0.5 }))?)?
        }),
        ("tilting, three rectangles", rotating(&spheres, PlaneTilting::new(&of(half))?)?),
    ];
    beds.retain(|(name, _)| arguments.only.split('|').any(|part| name.contains(part)));
    for (_, bed) in &mut beds {
        bed.run(arguments.warm)?;
    }
    let mut rounds = Vec::new();
    for _ in 0..arguments.repeats {
        let mut times = Vec::new();
        for (_, bed) in &mut beds {
            let begun = Instant::now();
            bed.run(arguments.steps)?;
            times.push(begun.elapsed().as_secs_f64());
        }
        rounds.push(times);
    }
    println!("{n_grains} grains, {:?}, one thread", arguments.precision);
    let grain_steps = n_grains * arguments.steps as f64 * 1e-6;
    let fastest = |law: usize| rounds.iter().map(|times| times[law]).fold(f64::INFINITY, f64::min);
    let total = |law: usize| rounds.iter().map(|times| times[law]).sum::<f64>();
    for (law, (name, bed)) in beds.iter().enumerate() {
        let (rate, mean) = (grain_steps / fastest(law), grain_steps * rounds.len() as f64 / total(law));
        let (contacts, listed) = (bed.contacts_per_grain(), bed.listed_per_grain());
        println!(
            "  {name:<26} {rate:6.2} M grain-steps/s  {:5.2} × free, {:5.2} × in the median round  mean {mean:6.2} {:5.2} ×  {contacts:.2} contacts a grain, {listed:.2} listed pairs, {} lists",
            fastest(law) / fastest(0),
            median(rounds.iter().map(|times| times[law] / times[0]).collect()),
            total(law) / total(0),
            bed.n_rebuilds()
        );
    }
    Ok(())
}

/// The value in the middle; of a round's ratios it hardly depends on a clock that others on the machine slow down.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

fn rotating<P: Precision, R: RotationLaw<P::Real>>(
    spheres: &[Sphere<P>],
    rotation: R,
) -> Result<Box<dyn Timed>, Box<dyn Error>> {
    let forces = HertzMindlin::new(Tail::CutCorrected);
    boxed(spheres, Rotation::Free, Rotating { forces, rotation })
}

fn boxed<P: Precision, L: ContactLaw<P::Real>>(
    spheres: &[Sphere<P>],
    rotation: Rotation,
    law: L,
) -> Result<Box<dyn Timed>, Box<dyn Error>> {
    Ok(Box::new(bed(spheres.to_vec(), rotation, law)?))
}

fn bed<P: Precision, L: ContactLaw<P::Real>>(
    spheres: Vec<Sphere<P>>,
    rotation: Rotation,
    law: L,
) -> Result<Bed<L, P>, Box<dyn Error>> {
    let top = spheres.iter().map(|sphere| sphere.position.z.to_f64()).fold(0.5, f64::max) + 0.01;
    let settings = BedSettings {
        domain: domain(top),
        planes: vec![Plane { point: Vec3::zeros(), normal: Vec3::z(), material: 0 }],
        gravity: Vec3::new(0.0, 0.0, -9.81),
        rotation,
        has_ledger: false,
    };
    let between = Interaction { restitution: 0.5, friction: 0.5 };
    let table = PairTable::new(&[SAND], Tail::CutCorrected, |_, _| between)?;
    let mut bed = Bed::new(spheres, settings, table, law)?;
    if bed.grains().orientations.is_some() {
        bed.grains_mut().turn_randomly(1);
    }
    Ok(bed)
}

fn domain(top: f64) -> Domain {
    Domain { lower: Vec3::zeros(), upper: Vec3::new(0.2, 0.2, top), is_periodic: [true, true, false] }
}

/// A random packing that has come to rest as spheres.
fn settled<P: Precision>(n_grains: usize) -> Result<Vec<Sphere<P>>, Box<dyn Error>> {
    let radii = RadiusDistribution::Uniform { from_m: 0.0038, to_m: 0.0042 };
    let layer = Layer { radii, n_grains, density: SAND.density_kg_m3, material: 0 };
    let packing = random_packing::<P>(&domain(0.5), &[layer], 1)?;
    let mut bed = bed(packing, Rotation::Free, HertzMindlin::new(Tail::CutCorrected))?;
    let mut settling = Settling::new(SettleCriterion { longest_s: 10.0, ..Default::default() }, TIME_STEP);
    while settling.advance(&mut bed)?.is_none() {}
    Ok(bed.grains().spheres.clone())
}

fn read<P: Precision>(path: &PathBuf) -> Result<Vec<Sphere<P>>, Box<dyn Error>> {
    let bytes = std::fs::read(path)?;
    let mut text = String::new();
    if path.extension().is_some_and(|end| end == "gz") {
        flate2::read::MultiGzDecoder::new(&bytes[..]).read_to_string(&mut text)?;
    } else {
        text = String::from_utf8(bytes)?;
    }
    let mut spheres = Vec::new();
    for line in text.lines().filter(|line| !line.starts_with('#')) {
        let values: Vec<f64> = line.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        if let [_, radius, x, y, z, ..] = values[..] {
            spheres.push(sphere(Vec3::new(x, y, z), radius, SAND.density_kg_m3, 0));
        }
    }
    Ok(spheres)
}
