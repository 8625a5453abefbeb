//! Beds at rest of soft sand on a floor, periodic to the sides: settled once, then kept in the build folder.

use grouser_contact::{
    ContactLaw, F64, HertzMindlin, Interaction, Material, PairTable, Precision, Real, Sphere, Tail,
};
use grouser_dem::*;
use grouser_geometry::Vec3;
use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;

/// 2600 kg/m³, E = 10 MPa, ν = 0.3.
pub const SAND: Material = Material { young_pa: 1e7, poisson: 0.3, density_kg_m3: 2600.0 };
/// Hertz–Mindlin with history.
pub type Law = HertzMindlin;
/// The dashpot may attract.
pub const LAW: Law = HertzMindlin::new(Tail::Keep);

/// Drag over mass while a bed settles [1/s]: grains fall with 0.5 m/s.
const VISCOSITY: f64 = 20.0;
/// Time for which a bed settles [s].
const LONGEST: f64 = 1.5;

/// What a bed is made of.
#[derive(Clone, Copy, Debug)]
pub struct BedOf {
    /// Radii.
    pub radii: RadiusDistribution,
    /// Number of grains.
    pub n_grains: usize,
    /// Length of the box along x and y [m].
    pub width: [f64; 2],
}

impl BedOf {
    /// 11 % of the Rayleigh time of the smallest grain [s]: 40 µs for grains of 4 mm.
    pub fn time_step(&self) -> f64 {
        0.1155 * rayleigh_time(&SAND, self.radii.range().0)
    }

    /// The bed at rest.
    ///
    /// # Errors
    /// When the bed cannot be made or does not come to rest.
    pub fn settled(&self) -> Result<Bed<Law>, Box<dyn Error>> {
        let path = self.path(".json");
        if let Ok(text) = std::fs::read(&path) {
            let rows: Vec<[f64; 4]> = serde_json::from_slice(&text)?;
            let mut bed = self.of(rows.iter().map(|&[x, y, z, r]| grain(Vec3::new(x, y, z), r)).collect())?;
            // Springs come back within some steps.
            bed.run(500, self.time_step(), |_| Ok::<(), Failure>(()))?;
            return Ok(bed);
        }
        let layer =
            Layer { radii: self.radii, n_grains: self.n_grains, density: SAND.density_kg_m3, material: 0 };
        let mut bed = self.of(random_packing::<F64>(&self.domain(0.5), &[layer], 1)?)?;
        let begun = Instant::now();
        let time = self.settle(&mut bed)?;
        println!(
            "  settled {} grains within {time:.2} s of simulated time ({:.0} s)",
            self.n_grains,
            begun.elapsed().as_secs_f64()
        );
        let row = |s: &Sphere| {
            let [x, y, z] = s.position.to_array();
            [x, y, z, s.radius]
        };
        let mut rows: Vec<(u32, [f64; 4])> =
            bed.grains().ids.iter().copied().zip(bed.grains().spheres.iter().map(row)).collect();
        rows.sort_by_key(|&(id, _)| id);
        let rows: Vec<_> = rows.into_iter().map(|(_, row)| row).collect();
        std::fs::create_dir_all(path.parent().unwrap_or(&path))?;
        std::fs::write(path, serde_json::to_vec(&rows)?)?;
        Ok(bed)
    }

    /// Lets the bed sink through something viscous, so that large grains do not crush small ones; gives the time it took [s].
    fn settle(&self, bed: &mut Bed<Law>) -> Result<f64, Failure> {
        self.calm(bed, VISCOSITY, 1e-6, LONGEST)
    }

    /// Drag over mass `viscosity` [1/s] until the kinetic energy of a grain is below `ratio` of m g r, for `longest` [s]; gives the
    /// time it took [s].
    ///
    /// # Errors
    /// When the motion has become meaningless.
    pub fn calm(&self, bed: &mut Bed<Law>, viscosity: f64, ratio: f64, longest: f64) -> Result<f64, Failure> {
        let scale: f64 = bed.grains().spheres.iter().map(|s| s.mass * 9.81 * s.radius).sum();
        let mut time = 0.0;
        while time < longest {
            bed.run(200, self.time_step(), |grains| {
                for (sphere, load) in grains.spheres.iter().zip(&mut grains.loads) {
                    load.force -= sphere.velocity * (sphere.mass * viscosity);
                }
                Ok::<(), Failure>(())
            })?;
            time += 200.0 * self.time_step();
            let is_down = bed.n_contacts() > 2 * bed.grains().len();
            if is_down && bed.grains().kinetic_energy().iter().sum::<f64>() < ratio * scale {
                break;
            }
        }
        Ok(time)
    }

    /// The bed at rest, laid out `tiles` times along x and along y.
    ///
    /// # Errors
    /// As [`BedOf::settled`].
    pub fn tiled(&self, tiles: [usize; 2]) -> Result<Bed<Law>, Box<dyn Error>> {
        let one = self.settled()?;
        let mut spheres = Vec::new();
        for tile in 0..tiles[0] * tiles[1] {
            let [column, row] = [tile % tiles[0], tile / tiles[0]].map(|index| index as f64);
            for sphere in &one.grains().spheres {
                let [x, y, z] = sphere.position.to_array();
                let place = Vec3::new(x + column * self.width[0], y + row * self.width[1], z);
                spheres.push(grain(place, sphere.radius));
            }
        }
        let width = [0, 1].map(|axis| self.width[axis] * tiles[axis] as f64);
        let n_grains = spheres.len();
        let mut bed = Self { width, n_grains, ..*self }.of(spheres)?;
        bed.run(500, self.time_step(), |_| Ok::<(), Failure>(()))?;
        Ok(bed)
    }

    /// [`BedOf::tiled`] and come to rest again, with all springs: kept in the build folder as well.
    ///
    /// # Errors
    /// As [`BedOf::settled`].
    pub fn tiled_at_rest(&self, tiles: [usize; 2]) -> Result<Bed<Law>, Box<dyn Error>> {
        let path = self.path(&format!("-{}x{}.bin", tiles[0], tiles[1]));
        if let Some(bed) = std::fs::read(&path).ok().and_then(|bytes| postcard::from_bytes(&bytes).ok()) {
            return Ok(bed);
        }
        let mut bed = self.tiled(tiles)?;
        self.calm(&mut bed, 100.0, 2e-7, 0.3)?;
        std::fs::write(path, postcard::to_allocvec(&bed)?)?;
        Ok(bed)
    }

    /// The file of the build folder that keeps this bed.
    fn path(&self, ending: &str) -> PathBuf {
        let (from, to) = self.radii.range();
        let [x, y] = self.width;
        let name = format!("{}-{:.2}-{:.2}-{x}-{y}{ending}", self.n_grains, 1e3 * from, 1e3 * to);
        PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../target/bench-beds").join(name)
    }

    fn domain(&self, top: f64) -> Domain {
        let [x, y] = self.width;
        Domain { lower: Vec3::zeros(), upper: Vec3::new(x, y, top), is_periodic: [true, true, false] }
    }

    /// The bed of these grains, in any precision.
    ///
    /// # Errors
    /// When grains or box are unusable.
    pub fn of<P: Precision>(&self, spheres: Vec<Sphere<P>>) -> Result<Bed<Law, P>, Box<dyn Error>>
    where
        Law: ContactLaw<P::Real>,
    {
        let tops = spheres.iter().map(|s| s.position.z.to_f64() + s.radius.to_f64());
        let settings = BedSettings {
            domain: self.domain(tops.fold(0.5, f64::max)),
            planes: vec![Plane { point: Vec3::zeros(), normal: Vec3::z(), material: 0 }],
            gravity: Vec3::new(0.0, 0.0, -9.81),
            rotation: Rotation::Free,
            has_ledger: false,
        };
        let between = Interaction { restitution: 0.5, friction: 0.5 };
        let table = PairTable::new(&[SAND], Tail::Keep, |_, _| between)?;
        Ok(Bed::new(spheres, settings, table, LAW)?)
    }
}

fn grain(place: Vec3, radius: f64) -> Sphere {
    sphere(place, radius, SAND.density_kg_m3, 0)
}

/// Seconds per grain-step: the fastest of `n_repeats` runs of `n_steps`.
///
/// # Errors
/// When the motion has become meaningless.
pub fn cost(bed: &mut Bed<Law>, time_step: f64, n_steps: u64, n_repeats: usize) -> Result<f64, Failure> {
    let mut fastest = f64::INFINITY;
    for _ in 0..n_repeats {
        let begun = Instant::now();
        bed.run(n_steps, time_step, |_| Ok::<(), Failure>(()))?;
        fastest = fastest.min(begun.elapsed().as_secs_f64());
    }
    Ok(fastest / (n_steps as f64 * bed.grains().len() as f64))
}
