//! Beds of grains against closed forms, a slow reference, and themselves.

mod active_zone;
mod conservation;
mod determinism;
mod failures;
mod impact;
mod integrators;
mod reference_kernel;
mod rotation;
mod size_ratio;
mod stability;

use grouser_contact::*;
use grouser_dem::*;
use grouser_geometry::Vec3;

/// Soft sand: E = 10 MPa, ν = 0.3, 2600 kg/m³.
const SAND: Material = Material { young_pa: 1e7, poisson: 0.3, density_kg_m3: 2600.0 };

fn table<T: Real>(restitution: f64, friction: f64, tail: Tail) -> PairTable<T> {
    PairTable::new(&[SAND], tail, |_, _| Interaction { restitution, friction }).expect("sound constants")
}

/// An open box without planes and gravity.
fn empty_space() -> BedSettings {
    BedSettings {
        domain: Domain { lower: Vec3::repeat(-1.0), upper: Vec3::repeat(1.0), is_periodic: [false; 3] },
        planes: Vec::new(),
        gravity: Vec3::zeros(),
        rotation: Rotation::Free,
        has_ledger: true,
    }
}

/// A column of `n` grains falling onto a floor, periodic in x and y.
fn falling_column<P: Precision>(n: usize, seed: u64) -> (Vec<Sphere<P>>, BedSettings) {
    let domain =
        Domain { lower: Vec3::zeros(), upper: Vec3::new(0.06, 0.06, 2.0), is_periodic: [true, true, false] };
    let radii = RadiusDistribution::Uniform { from_m: 3.8e-3, to_m: 4.2e-3 };
    let layer = Layer { radii, n_grains: n, density: SAND.density_kg_m3, material: 0 };
    let spheres = random_packing(&domain, &[layer], seed).expect("it fits");
    let settings = BedSettings {
        domain,
        planes: vec![Plane { point: Vec3::zeros(), normal: Vec3::z(), material: 0 }],
        gravity: Vec3::new(0.0, 0.0, -9.81),
        rotation: Rotation::Free,
        has_ledger: true,
    };
    (spheres, settings)
}

/// Two equal spheres that meet along x, off centre by `offset` in y, each at `speed`.
fn head_on(offset: f64, speed: f64) -> Vec<Sphere> {
    let mut spheres: Vec<Sphere> = [-1.0, 1.0]
        .map(|side| sphere(Vec3::new(side * 0.0101, side * offset / 2.0, 0.0), 0.01, SAND.density_kg_m3, 0))
        .to_vec();
    spheres[0].velocity.x = speed;
    spheres[1].velocity.x = -speed;
    spheres
}
