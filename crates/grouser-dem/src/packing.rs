//! Random packings without overlap, to be settled under gravity.

use crate::{Domain, sphere};
use grouser_contact::{Precision, Sphere};
use grouser_geometry::Vec3;
use rand::{RngExt, SeedableRng};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// How radii are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum RadiusDistribution {
    /// Every grain has this radius [m].
    Monodisperse(f64),
    /// Uniform between two radii [m].
    Uniform {
        /// Smallest radius [m].
        from_m: f64,
        /// Largest radius [m].
        to_m: f64,
    },
    /// Mass spread evenly over the logarithm of the radius: a straight grading curve. The number of grains grows like r⁻⁴
    /// towards small ones.
    Graded {
        /// Smallest radius [m].
        from_m: f64,
        /// Largest radius [m], above the smallest.
        to_m: f64,
    },
}

impl RadiusDistribution {
    /// Smallest and largest radius [m].
    pub fn range(&self) -> (f64, f64) {
        match *self {
            Self::Monodisperse(radius) => (radius, radius),
            Self::Uniform { from_m, to_m } | Self::Graded { from_m, to_m } => (from_m, to_m),
        }
    }

    /// Mean volume of a grain [m³].
    pub fn mean_volume(&self) -> f64 {
        let (a, b) = self.range();
        let mean_cube = match self {
            // Mean of r³ over [a, b] is (a + b)(a² + b²)/4.
            Self::Monodisperse(_) | Self::Uniform { .. } => (a + b) * (a * a + b * b) / 4.0,
            // Density 3 r⁻⁴/(a⁻³ − b⁻³).
            Self::Graded { .. } if a == b => a.powi(3),
            Self::Graded { .. } => 3.0 * (b / a).ln() / (a.powi(-3) - b.powi(-3)),
        };
        4.0 / 3.0 * std::f64::consts::PI * mean_cube
    }

    /// The radius below which `share` of the grains lie [m].
    pub fn quantile(&self, share: f64) -> f64 {
        let (a, b) = self.range();
        match self {
            Self::Monodisperse(_) | Self::Uniform { .. } => a + (b - a) * share,
            Self::Graded { .. } => {
                // From (r/a)⁻³ = 1 − share (1 − (b/a)⁻³), within bounds whatever the rounding.
                let cube = 1.0 - share * (1.0 - (b / a).powi(-3));
                (a / cube.cbrt()).clamp(a, b)
            }
        }
    }
}

/// Grains of one kind, filled in as one layer.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Layer {
    /// Radii of the grains.
    pub radii: RadiusDistribution,
    /// Number of grains.
    pub n_grains: usize,
    /// Density of the solid [kg/m³].
    pub density: f64,
    /// Row of the material table.
    pub material: u32,
}

/// Why a packing cannot be made.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PackingError {
    /// A radius makes no sense.
    #[error(
        "a layer has radii from {from} m to {to} m; expected finite numbers above zero, the smaller one first"
    )]
    Radii {
        /// Smallest radius [m].
        from: f64,
        /// Largest radius [m].
        to: f64,
    },
    /// A grain is wider than the box.
    #[error(
        "a grain of radius {radius} m does not fit into a box {width} m wide; take smaller grains or a wider box"
    )]
    TooNarrow {
        /// Largest radius [m].
        radius: f64,
        /// Narrowest width of the box [m].
        width: f64,
    },
}

/// Share of the volume that a random sequential packing fills without long searches.
const SOLID_FRACTION: f64 = 0.28;

/// Grains at random places without overlap, layer upon layer from the bottom of `domain`; as high as they need, also
/// beyond its top. The same `seed` gives the same packing on every machine.
///
/// # Errors
/// When a radius is not positive or a grain does not fit.
pub fn random_packing<P: Precision>(
    domain: &Domain,
    layers: &[Layer],
    seed: u64,
) -> Result<Vec<Sphere<P>>, PackingError> {
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(seed);
    let size = domain.size();
    let mut grains = Vec::new();
    let mut bottom = domain.lower.z;
    for layer in layers {
        let (from, to) = layer.radii.range();
        if !(from > 0.0 && to >= from && to.is_finite()) {
            return Err(PackingError::Radii { from, to });
        }
        let width = size.x.min(size.y);
        if 2.0 * to >= width {
            return Err(PackingError::TooNarrow { radius: to, width });
        }
        let inside = |axis: usize| if domain.is_periodic[axis] { 0.0 } else { to };
        let lower = Vec3::new(domain.lower.x + inside(0), domain.lower.y + inside(1), bottom + to);
        let upper = Vec3::new(domain.upper.x - inside(0), domain.upper.y - inside(1), 0.0);
        let area = (upper.x - lower.x) * (upper.y - lower.y);
        let mut height = layer.n_grains as f64 * layer.radii.mean_volume() / (SOLID_FRACTION * area);
        let mut cells = Cells::new(domain, bottom, 2.0 * to);
        let mut misses = 0;
        // Large grains find no place between many small ones: they come first.
        let mut graded = match layer.radii {
            RadiusDistribution::Graded { .. } => {
                (0..layer.n_grains).map(|_| layer.radii.quantile(random.random())).collect()
            }
            _ => Vec::new(),
        };
        graded.sort_unstable_by(f64::total_cmp);
        for _ in 0..layer.n_grains {
            let radius = graded.pop().unwrap_or_else(|| layer.radii.quantile(random.random()));
            loop {
                let share = Vec3::new(random.random(), random.random(), random.random());
                let place = Vec3::new(
                    lower.x + share.x * (upper.x - lower.x),
                    lower.y + share.y * (upper.y - lower.y),
                    lower.z + share.z * height,
                );
                if cells.insert_if_free(place, radius) {
                    grains.push(sphere(place, radius, layer.density, layer.material));
                    break;
                }
                // A crowded layer grows, so that the search always ends.
                misses += 1;
                if misses % (20 * layer.n_grains) == 0 {
                    height += 2.0 * to;
                }
            }
        }
        bottom = lower.z + height + to;
    }
    Ok(grains)
}

/// Cells as wide as the largest grain, which find the neighbours of a place.
struct Cells {
    origin: Vec3,
    size: Vec3,
    is_periodic: [bool; 3],
    edge: Vec3,
    counts: [i64; 2],
    grains: Vec<Vec<(Vec3, f64)>>,
}

impl Cells {
    fn new(domain: &Domain, bottom: f64, diameter: f64) -> Self {
        let size = domain.size();
        let counts = [0, 1].map(|axis| ((size[axis] / diameter).floor() as i64).max(1));
        let edge = Vec3::new(size.x / counts[0] as f64, size.y / counts[1] as f64, diameter);
        let origin = Vec3::new(domain.lower.x, domain.lower.y, bottom);
        Self { origin, size, is_periodic: domain.is_periodic, edge, counts, grains: Vec::new() }
    }

    fn insert_if_free(&mut self, place: Vec3, radius: f64) -> bool {
        let cell = (place - self.origin).component_div(&self.edge).map(|c| c.floor() as i64);
        for dz in -1..=1 {
            for dy in -1..=1 {
                for dx in -1..=1 {
                    let Some(near) = self.index(cell.x + dx, cell.y + dy, cell.z + dz) else { continue };
                    for &(other, its_radius) in self.grains.get(near).map_or(&[][..], Vec::as_slice) {
                        if self.nearest(place - other).norm_squared() < (radius + its_radius).powi(2) {
                            return false;
                        }
                    }
                }
            }
        }
        let Some(own) = self.index(cell.x, cell.y, cell.z) else { return false };
        if self.grains.len() <= own {
            self.grains.resize(own + 1, Vec::new());
        }
        self.grains[own].push((place, radius));
        true
    }

    fn index(&self, x: i64, y: i64, z: i64) -> Option<usize> {
        let along = |index: i64, axis: usize| {
            let count = self.counts[axis];
            if self.is_periodic[axis] {
                Some(index.rem_euclid(count))
            } else {
                (0..count).contains(&index).then_some(index)
            }
        };
        let (x, y) = (along(x, 0)?, along(y, 1)?);
        (z >= 0).then(|| ((z * self.counts[1] + y) * self.counts[0] + x) as usize)
    }

    fn nearest(&self, mut difference: Vec3) -> Vec3 {
        for axis in 0..2 {
            if self.is_periodic[axis] {
                difference[axis] -= self.size[axis] * (difference[axis] / self.size[axis]).round();
            }
        }
        difference
    }
}
