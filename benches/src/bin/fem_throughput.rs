//! Time of an explicit step of linear tetrahedra against the bandwidth bound, and of the static solvers: `cargo xtask bench fem`.
//!
//! The bound is the bytes that a step must move (`Solid::bytes_per_step`) over the bandwidth of a triad a = b + s c that the same
//! run measures on the same threads. Elements of a cube; statics of a compact cube and of a tire tread under inflation.

use clap::Parser;
use grouser_fem::{Formulation, LinearSolver, Material, Settings, Solid, StaticOptions, VolumetricTreatment};
use grouser_geometry::{LugPattern, TetrahedralMesh, TireTread, Vec3, box_mesh};
use std::error::Error;
use std::time::Instant;

/// Explicit steps against the bandwidth bound, and static solvers against each other.
#[derive(Parser)]
struct Arguments {
    /// Cells along each side of the cube; six elements a cell
    #[arg(long, default_value_t = 40)]
    cells: usize,
    /// Threads
    #[arg(long, default_value_t = 2)]
    threads: usize,
    /// Largest cube of the static solvers, cells a side; 0 leaves them out
    #[arg(long, default_value_t = 24)]
    statics: usize,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    rayon::ThreadPoolBuilder::new().num_threads(arguments.threads).build_global()?;
    let before = triad(arguments.threads);
    let mut lines = Vec::new();
    for (name, formulation, volumetric) in [
        ("body-attached", Formulation::BodyAttached, VolumetricTreatment::PerElement),
        ("corotational", Formulation::Corotational, VolumetricTreatment::PerElement),
        ("finite strain", Formulation::FiniteStrain, VolumetricTreatment::PerElement),
        ("body-attached, averaged pressure", Formulation::BodyAttached, VolumetricTreatment::NodalAverage),
        ("corotational, averaged pressure", Formulation::Corotational, VolumetricTreatment::NodalAverage),
    ] {
        lines.push((name, explicit(arguments.cells, formulation, volumetric)?));
    }
    // The machine's pace may drift: the better of the two figures, which makes the bound the harder one.
    let bandwidth = before.max(triad(arguments.threads));
    println!("triad: {:.1} GB/s on {} threads", bandwidth / 1e9, arguments.threads);
    for (name, step) in lines {
        println!(
            "{name}: {:.0} elements, {:.2} ns and {:.0} bytes an element-step, {:.0} % of the bandwidth bound",
            step.elements,
            step.seconds / step.elements * 1e9,
            step.bytes / step.elements,
            100.0 * step.bytes / bandwidth / step.seconds
        );
    }
    if arguments.statics > 0 {
        let mut n = 6;
        while n <= arguments.statics {
            let cube = box_mesh(Vec3::repeat(1.0), [n; 3]);
            statics(&format!("cube, {n} cells a side"), cube, "z_min", None)?;
            n *= 2;
        }
        for n_elements in [6_000, 24_000, 72_000] {
            let pattern = LugPattern::Alternating { count: 20, land: 0.5 };
            let size = "165/65R13".to_owned();
            let tread = TireTread {
                size,
                rim_width: 0.127,
                wall_thickness: 0.016,
                groove_depth: 0.015,
                pattern,
                n_elements,
            };
            statics("tread under 0.14 MPa", tread.mesh()?, "rim", Some(("inner", 0.14e6)))?;
        }
    }
    Ok(())
}

struct Step {
    elements: f64,
    seconds: f64,
    bytes: f64,
}

/// Fastest of forty steps of a vibrating cube.
fn explicit(
    cells: usize,
    formulation: Formulation,
    volumetric: VolumetricTreatment,
) -> Result<Step, Box<dyn Error>> {
    let mesh = box_mesh(Vec3::repeat(1.0), [cells; 3]);
    let elements = mesh.n_elements() as f64;
    let settings = Settings { formulation, volumetric, ..Default::default() };
    let mut solid = Solid::new(mesh, vec![Material::hooke(1100.0, 20e6, 0.45)], settings)?;
    for (i, v) in solid.state.velocity.iter_mut().enumerate() {
        *v = 1e-3 * Vec3::new((i as f64).sin(), (i as f64).cos(), 0.0);
    }
    let dt = 1e-6;
    let mut seconds = f64::INFINITY;
    for step in 0..43 {
        let begun = Instant::now();
        solid.step(dt)?;
        if step >= 3 {
            seconds = seconds.min(begun.elapsed().as_secs_f64());
        }
    }
    Ok(Step { elements, seconds, bytes: solid.bytes_per_step() })
}

/// Time of one linear solution by each solver; both see the same matrix.
fn statics(
    name: &str,
    mesh: TetrahedralMesh,
    fixed: &str,
    inflated: Option<(&str, f64)>,
) -> Result<(), Box<dyn Error>> {
    for volumetric in [VolumetricTreatment::PerElement, VolumetricTreatment::NodalAverage] {
        let mut seconds = [0.0; 2];
        for (k, solver) in
            [LinearSolver::ConjugateGradients, LinearSolver::SparseCholesky].into_iter().enumerate()
        {
            let settings = Settings { volumetric, ..Default::default() };
            let materials = vec![Material::hooke(1100.0, 20e6, 0.45); mesh.region_names.len()];
            let mut solid = Solid::new(mesh.clone(), materials, settings)?;
            solid.fix(fixed)?;
            solid.loads.gravity = Vec3::new(0.0, 0.0, -9.81);
            if let Some((surface, pressure)) = inflated {
                solid.inflate(surface, pressure)?;
            }
            let begun = Instant::now();
            solid.solve_statics(&StaticOptions { solver, ..Default::default() })?;
            seconds[k] = begun.elapsed().as_secs_f64();
        }
        println!(
            "statics, {name}, {volumetric:?}: {} unknowns, conjugate gradients {:.2} s, sparse Cholesky {:.2} s",
            3 * mesh.nodes.len(),
            seconds[0],
            seconds[1]
        );
    }
    Ok(())
}

/// Bytes per second of a = b + s c over arrays beyond the caches, counting three streams.
fn triad(threads: usize) -> f64 {
    let n = 20_000_000;
    let (mut a, b, c) = (vec![0.0f64; n], vec![1.0f64; n], vec![2.0f64; n]);
    let mut best = 0.0f64;
    for _ in 0..7 {
        let begun = Instant::now();
        let chunk = n.div_ceil(threads);
        std::thread::scope(|scope| {
            for ((a, b), c) in a.chunks_mut(chunk).zip(b.chunks(chunk)).zip(c.chunks(chunk)) {
                scope.spawn(move || a.iter_mut().zip(b).zip(c).for_each(|((a, b), c)| *a = b + 3.0 * c));
            }
        });
        best = best.max(24.0 * n as f64 / begun.elapsed().as_secs_f64());
    }
    best
}
