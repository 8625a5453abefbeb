//! One bed that other codes run too: grain-steps per second and the state it ends in. `cargo xtask peers` calls this program.
//!
//! Grains of 4 mm ± 5 %, 2600 kg/m³, E = 10 MPa, ν = 0.3, friction and restitution 0.5, time step 40 µs, periodic in x and y,
//! floor at z = 0. A grain of type 2 belongs to a frozen rough base: it has a mass that nothing moves, and its weight is borne.

use benches::scalar::Scalar;
use clap::{Parser, Subcommand, ValueEnum};
use grouser_contact::{
    F32, F64, HertzMindlin, Interaction, Material, Mixed, PairTable, Precision, Real, Tail,
};
use grouser_dem::*;
use grouser_geometry::Vec3;
use std::error::Error;
use std::fmt::Write as _;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// A bed that other codes run too.
#[derive(Parser)]
struct Arguments {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Subcommand)]
enum Verb {
    /// Runs a bed and prints what it cost and how it ends, as one line of JSON
    Run(Run),
    /// Writes a bed as other codes read it: DATA.data (LAMMPS, LIGGGHTS) and DATA.txt (Yade)
    Export {
        /// `type radius x y z [vx vy vz wx wy wz]` a line, `# box LX LY` before them; .gz too
        #[arg(long)]
        state: PathBuf,
        /// Path without its ending
        #[arg(long)]
        to: PathBuf,
        /// Drop the velocities
        #[arg(long)]
        still: bool,
    },
    /// Prints contacts, overlap and energy of the state that a code ended in, as one line of JSON
    Measure {
        /// Lines of `type radius x y z vx vy vz wx wy wz`, headers being skipped
        #[arg(long)]
        state: PathBuf,
        /// Edge of the periodic square [m]
        #[arg(long, default_value_t = 0.2)]
        edge: f64,
    },
}

#[derive(clap::Args)]
struct Run {
    #[arg(long)]
    state: PathBuf,
    #[arg(long)]
    still: bool,
    /// Steps before the clock starts
    #[arg(long, default_value_t = 200)]
    warm: u64,
    /// Steps of each timed repeat
    #[arg(long, default_value_t = 500)]
    steps: u64,
    /// Timed repeats, of which the fastest counts
    #[arg(long, default_value_t = 5)]
    repeats: u32,
    /// Gravity turned about y by this angle [°]
    #[arg(long, default_value_t = 0.0)]
    slope_deg: f64,
    #[arg(long, default_value_t = 1)]
    threads: usize,
    #[arg(long, value_enum, default_value_t = Scalar::F64)]
    precision: Scalar,
    /// Instruction set: the widest of this machine unless named
    #[arg(long, value_enum)]
    set: Option<Set>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Set {
    Baseline,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

const TIME_STEP: f64 = 4e-5;
const GRAVITY: f64 = 9.81;
const SAND: Material = Material { young_pa: 1e7, poisson: 0.3, density_kg_m3: 2600.0 };
/// Mass of a frozen grain over its real mass: m* and accelerations differ from those of a fixed body by less than rounding.
const FROZEN: f64 = 1e9;
/// The peers' law: the dashpot may attract, and the spring is the displacement since first touch.
type Law = HertzMindlin<true>;

/// A grain as files hold it.
struct Row {
    is_frozen: bool,
    radius: f64,
    position: Vec3,
    velocity: Vec3,
    spin: Vec3,
}

fn main() -> Result<(), Box<dyn Error>> {
    match Arguments::parse().verb {
        Verb::Export { state, to, still } => {
            let (edge, rows) = read_state(&state, still)?;
            export(edge.unwrap_or(0.2), &rows, &to)
        }
        Verb::Measure { state, edge } => {
            let (_, rows) = read_state(&state, false)?;
            let mut bed = bed::<F64>(&rows, edge, 0.0)?;
            bed.renew_lists()?;
            bed.contact_forces(0.0);
            println!("{}", state_of(&bed));
            Ok(())
        }
        Verb::Run(run) => match run.precision {
            Scalar::F64 => time::<F64>(&run),
            Scalar::Mixed => time::<Mixed>(&run),
            Scalar::F32 => time::<F32>(&run),
        },
    }
}

fn time<P: Precision>(run: &Run) -> Result<(), Box<dyn Error>> {
    rayon::ThreadPoolBuilder::new().num_threads(run.threads).build_global()?;
    let (edge, rows) = read_state(&run.state, run.still)?;
    let mut bed = bed::<P>(&rows, edge.unwrap_or(0.2), run.slope_deg)?;
    if let Some(set) = run.set {
        bed.use_instruction_set(match set {
            Set::Baseline => InstructionSet::Baseline,
            #[cfg(target_arch = "x86_64")]
            Set::Avx2 => InstructionSet::Avx2,
            #[cfg(target_arch = "x86_64")]
            Set::Avx512 => InstructionSet::Avx512,
        });
    }
    let has_base = rows.iter().any(|row| row.is_frozen);
    let gravity = bed.settings().gravity;
    let bear = |grains: &mut Grains<P>| {
        if has_base {
            for (sphere, load) in grains.spheres.iter().zip(&mut grains.loads) {
                if is_frozen(sphere.mass) {
                    let mass = sphere.mass.to_f64();
                    load.force.x -= P::Real::from_f64(mass * gravity.x);
                    load.force.z -= P::Real::from_f64(mass * gravity.z);
                }
            }
        }
        Ok::<(), Failure>(())
    };
    bed.run(run.warm, TIME_STEP, bear)?;
    let rebuilds_before = bed.n_rebuilds();
    let mut rate = 0.0_f64;
    for _ in 0..run.repeats {
        let begun = Instant::now();
        bed.run(run.steps, TIME_STEP, bear)?;
        rate = rate.max(rows.len() as f64 * run.steps as f64 / begun.elapsed().as_secs_f64());
    }
    let mut figures = state_of(&bed);
    figures["grain_steps_per_second"] = rate.into();
    figures["steps"] = (run.warm + run.steps * u64::from(run.repeats)).into();
    figures["rebuilds"] = (bed.n_rebuilds() - rebuilds_before).into();
    figures["bytes_per_grain"] = (bed.bytes() as f64 / rows.len() as f64).into();
    figures["listed_per_grain"] = (bed.n_listed() as f64 / rows.len() as f64).into();
    figures["checksum"] = format!("{:016x}", checksum(&bed)).into();
    println!("{figures}");
    Ok(())
}

fn is_frozen<T: Real>(mass: T) -> bool {
    mass.to_f64() > 1.0
}

fn bed<P: Precision>(rows: &[Row], edge: f64, slope_deg: f64) -> Result<Bed<Law, P>, Box<dyn Error>> {
    let between = Interaction { restitution: 0.5, friction: 0.5 };
    let top = rows.iter().map(|row| row.position.z).fold(0.0, f64::max) + 0.25;
    let slope = slope_deg.to_radians();
    let settings = BedSettings {
        domain: Domain {
            lower: Vec3::zeros(),
            upper: Vec3::new(edge, edge, top),
            is_periodic: [true, true, false],
        },
        planes: vec![Plane { point: Vec3::zeros(), normal: Vec3::z(), material: 0 }],
        gravity: Vec3::new(GRAVITY * slope.sin(), 0.0, -GRAVITY * slope.cos()),
        rotation: Rotation::Free,
        has_ledger: false,
    };
    let vector = |v: Vec3| grouser_contact::Vector::new(v.x, v.y, v.z).cast();
    let spheres = rows.iter().map(|row| {
        let mut grain = sphere::<P>(row.position, row.radius, SAND.density_kg_m3, 0);
        grain.velocity = vector(row.velocity);
        grain.spin = vector(row.spin);
        if row.is_frozen {
            grain.mass = P::Real::from_f64(grain.mass.to_f64() * FROZEN);
        }
        grain
    });
    let table = PairTable::new(&[SAND], Tail::Keep, |_, _| between)?;
    Ok(Bed::new(spheres.collect(), settings, table, Law { tail: Tail::Keep })?)
}

/// Contacts, overlap and motion of the grains that are not frozen; contacts within the base do not count.
fn state_of<P: Precision>(bed: &Bed<Law, P>) -> serde_json::Value {
    let spheres = &bed.grains().spheres;
    let size = bed.settings().domain.size();
    let (mut n_contacts, mut overlaps) = (0, 0.0);
    for [i, j] in bed.contacts() {
        let (a, b) = (&spheres[i as usize], &spheres[j as usize]);
        if is_frozen(a.mass) && is_frozen(b.mass) {
            continue;
        }
        let nearest = |difference: f64, period: f64| difference - period * (difference / period).round();
        let (p, q) = (a.position.cast::<f64>(), b.position.cast::<f64>());
        let (x, y) = (nearest(p.x - q.x, size.x), nearest(p.y - q.y, size.y));
        n_contacts += 1;
        overlaps += a.radius.to_f64() + b.radius.to_f64() - (x * x + y * y + (p.z - q.z).powi(2)).sqrt();
    }
    let (mut linear, mut angular, mut momentum, mut mass) = (0.0, 0.0, 0.0, 0.0);
    for sphere in spheres.iter().filter(|sphere| !is_frozen(sphere.mass)) {
        let m = sphere.mass.to_f64();
        linear += 0.5 * m * sphere.velocity.norm_squared().to_f64();
        angular += 0.5 * sphere.inertia().to_f64() * sphere.spin.norm_squared().to_f64();
        momentum += m * sphere.velocity.x.to_f64();
        mass += m;
    }
    serde_json::json!({
        "grains": spheres.len(),
        "coordination": 2.0 * f64::from(n_contacts) / spheres.len() as f64,
        "mean_overlap": overlaps / f64::from(n_contacts),
        "kinetic_energy": linear,
        "rotational_energy": angular,
        "mean_velocity": momentum / mass,
    })
}

/// The same number for the same bytes of every position and velocity, in permanent order.
fn checksum<P: Precision>(bed: &Bed<Law, P>) -> u64 {
    let grains = bed.grains();
    let mut by_id: Vec<usize> = (0..grains.len()).collect();
    by_id.sort_by_key(|&place| grains.ids[place]);
    let mut sum = 0xcbf2_9ce4_8422_2325_u64;
    for place in by_id {
        let sphere = &grains.spheres[place];
        let motion = sphere.velocity.to_array().into_iter().chain(sphere.spin.to_array()).map(Real::to_f64);
        for value in sphere.position.to_array().into_iter().map(Real::to_f64).chain(motion) {
            sum = (sum ^ value.to_bits()).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
    sum
}

fn read_state(path: &Path, still: bool) -> Result<(Option<f64>, Vec<Row>), Box<dyn Error>> {
    let bytes = std::fs::read(path).map_err(|error| format!("{}: {error}", path.display()))?;
    let mut text = String::new();
    if path.extension().is_some_and(|end| end == "gz") {
        flate2::read::MultiGzDecoder::new(&bytes[..]).read_to_string(&mut text)?;
    } else {
        text = String::from_utf8(bytes)?;
    }
    let (mut edge, mut rows) = (None, Vec::new());
    for line in text.lines() {
        if let Some(size) = line.strip_prefix("# box") {
            edge = size.split_whitespace().next().map(str::parse).transpose()?;
            continue;
        }
        let values: Vec<f64> = line.split_whitespace().map_while(|word| word.parse().ok()).collect();
        if values.len() != line.split_whitespace().count() || values.len() < 5 {
            continue;
        }
        let three = |from: usize| match values.get(from..from + 3) {
            Some(&[x, y, z]) if from == 2 || !still => Vec3::new(x, y, z),
            _ => Vec3::zeros(),
        };
        rows.push(Row {
            is_frozen: values[0] == 2.0,
            radius: values[1],
            position: three(2),
            velocity: three(5),
            spin: three(8),
        });
    }
    if rows.is_empty() {
        return Err(format!("{}: expected lines of `type radius x y z …`, found none", path.display()).into());
    }
    Ok((edge, rows))
}

fn export(edge: f64, rows: &[Row], to: &Path) -> Result<(), Box<dyn Error>> {
    let top = rows.iter().map(|row| row.position.z).fold(0.0, f64::max) + 0.05;
    let mut data = format!(
        "bed of spheres\n\n{} atoms\n2 atom types\n\n0 {edge} xlo xhi\n0 {edge} ylo yhi\n0 {top} zlo zhi\n\nAtoms\n\n",
        rows.len()
    );
    let mut plain = format!("# box {edge} {edge}\n");
    let mut motion = String::from("\nVelocities\n\n");
    for (index, row) in rows.iter().enumerate() {
        let (id, kind) = (index + 1, 1 + u8::from(row.is_frozen));
        let Row { radius, position: p, velocity: v, spin: w, .. } = row;
        writeln!(data, "{id} {kind} {} {} {} {} {}", 2.0 * radius, SAND.density_kg_m3, p.x, p.y, p.z)?;
        writeln!(motion, "{id} {} {} {} {} {} {}", v.x, v.y, v.z, w.x, w.y, w.z)?;
        writeln!(
            plain,
            "{kind} {radius} {} {} {} {} {} {} {} {} {}",
            p.x, p.y, p.z, v.x, v.y, v.z, w.x, w.y, w.z
        )?;
    }
    std::fs::write(to.with_extension("data"), data + &motion)?;
    std::fs::write(to.with_extension("txt"), plain)?;
    Ok(())
}
