//! Time of an explicit step of linear tetrahedra against the bandwidth bound: `cargo run --release -p grouser-fem --example explicit_step`.

use std::time::Instant;

use grouser_fem::{Formulation, Material, Settings, Solid, VolumetricTreatment};
use grouser_geometry::{Vec3, box_mesh};

fn main() {
    let cells: usize = std::env::args().nth(1).and_then(|a| a.parse().ok()).unwrap_or(40);
    let threads: usize = std::env::args().nth(2).and_then(|a| a.parse().ok()).unwrap_or(1);
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().expect("the first pool");
    let bandwidth = triad(threads);
    println!("triad {:.1} GB/s on {threads} threads", bandwidth / 1e9);
    for (name, formulation, volumetric) in [
        ("body-attached", Formulation::BodyAttached, VolumetricTreatment::PerElement),
        ("corotational", Formulation::Corotational, VolumetricTreatment::PerElement),
        ("finite strain", Formulation::FiniteStrain, VolumetricTreatment::PerElement),
        ("body-attached, averaged pressure", Formulation::BodyAttached, VolumetricTreatment::NodalAverage),
    ] {
        let mesh = box_mesh(Vec3::repeat(1.0), [cells; 3]);
        let n = mesh.n_elements() as f64;
        let settings = Settings { formulation, volumetric, ..Default::default() };
        let mut solid =
            Solid::new(mesh, vec![Material::hooke(1100.0, 20e6, 0.45)], settings).expect("a sound mesh");
        let bytes = solid.bytes_per_step();
        for (i, v) in solid.state.velocity.iter_mut().enumerate() {
            *v = 1e-3 * Vec3::new((i as f64).sin(), (i as f64).cos(), 0.0);
        }
        let dt = 1e-6;
        (0..3).for_each(|_| solid.step(dt).expect("a stable step"));
        let best = (0..40)
            .map(|_| {
                let start = Instant::now();
                solid.step(dt).expect("a stable step");
                start.elapsed().as_secs_f64()
            })
            .fold(f64::INFINITY, f64::min);
        println!(
            "{name}: {n} elements, {:.2} ns per element, {:.0} bytes per element, {:.0} % of the bandwidth bound",
            best / n * 1e9,
            bytes / n,
            100.0 * bytes / bandwidth / best
        );
    }
}

/// Bytes per second of a = b + s c over arrays beyond the caches, counting three streams.
fn triad(threads: usize) -> f64 {
    let n = 20_000_000;
    let (mut a, b, c) = (vec![0.0f64; n], vec![1.0f64; n], vec![2.0f64; n]);
    (0..5)
        .map(|_| {
            let start = Instant::now();
            let chunk = n.div_ceil(threads);
            std::thread::scope(|scope| {
                for ((a, b), c) in a.chunks_mut(chunk).zip(b.chunks(chunk)).zip(c.chunks(chunk)) {
                    scope.spawn(move || a.iter_mut().zip(b).zip(c).for_each(|((a, b), c)| *a = b + 3.0 * c));
                }
            });
            24.0 * n as f64 / start.elapsed().as_secs_f64()
        })
        .fold(0.0, f64::max)
}
