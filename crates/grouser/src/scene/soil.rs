//! The ground: grains in a box, a law known from plate tests, or a height grid whose pressure rises with sinkage.

use super::{PlateTested, SoftGround};
use serde::{Deserialize, Serialize};

/// Kinds of ground.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Soil {
    /// Spheres that fall into a box and come to rest.
    Grains(Grains),
    /// Flat ground known from plate tests alone.
    PlateTested(PlateTested),
    /// A height grid that presses back the harder the deeper something sinks.
    PressureSinkage(SoftGround),
}

impl Soil {
    /// The bed of grains, when the ground is one.
    pub fn grains(&self) -> Option<&Grains> {
        match self {
            Soil::Grains(grains) => Some(grains),
            Soil::PlateTested(_) | Soil::PressureSinkage(_) => None,
        }
    }
}

/// A bed of spheres, made by the tool itself: a random packing without overlap that settles under gravity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Grains {
    /// Where the grains lie.
    pub container: Container,
    /// From the bottom up; one layer is an ordinary bed.
    pub layers: Vec<Layer>,
    /// Seed of the random packing: another seed is another sample of the same soil.
    #[serde(default = "first_seed")]
    pub seed: u64,
    /// When the bed counts as settled.
    #[serde(default)]
    pub settle: Settle,
}

/// A box from the origin to `size_m`, open at the top.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Container {
    /// Inner size along x, y, z [m]; z is the room for the packing before it settles.
    pub size_m: [f64; 3],
    /// The two sides across x.
    #[serde(default)]
    pub x: Side,
    /// The two sides across y.
    #[serde(default)]
    pub y: Side,
    /// Name of the material of the bottom and of the walls.
    pub material: String,
}

/// What closes a box at two opposite sides.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Side {
    /// What leaves on one side enters on the other: no wall, an endless bed.
    #[default]
    Periodic,
    /// A plane wall.
    Walled,
}

/// Grains of one kind.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Layer {
    /// Name of the grains' material.
    pub material: String,
    /// How large the grains are.
    pub sizes: Sizes,
    /// Height of this layer once settled [m], estimated from a random packing of 0.60 solid by volume.
    pub depth_m: f64,
}

/// Distribution of grain radii.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Sizes {
    /// All alike.
    Monodisperse {
        /// Radius [m].
        radius_m: f64,
    },
    /// Every radius of a range equally likely.
    Uniform {
        /// Smallest and largest radius [m].
        radius_m: (f64, f64),
    },
    /// Mass spread evenly over the logarithm of size: a straight grading curve.
    Graded {
        /// Smallest and largest radius [m].
        radius_m: (f64, f64),
    },
}

impl Sizes {
    /// Smallest and largest radius [m].
    pub fn range(&self) -> (f64, f64) {
        match *self {
            Sizes::Monodisperse { radius_m } => (radius_m, radius_m),
            Sizes::Uniform { radius_m } | Sizes::Graded { radius_m } => radius_m,
        }
    }

    /// Mean volume of a grain [m³].
    pub fn mean_volume(&self) -> f64 {
        let (low, high) = self.range();
        if let Sizes::Graded { .. } = self
            && low < high
        {
            // mean of r³ where the number of grains falls like r⁻⁴: 3 ln(high/low)/(low⁻³ - high⁻³)
            return 4.0 * std::f64::consts::PI * (high / low).ln() / (low.powi(-3) - high.powi(-3));
        }
        // mean of r³ over a uniform range: (low + high)(low² + high²)/4
        std::f64::consts::PI / 3.0 * (low + high) * (low * low + high * high)
    }
}

/// The bed is settled when its kinetic energy is a small part of the energy that lifting every grain by its own
/// radius takes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Settle {
    /// Kinetic energy over Σ m g r [-].
    pub energy_ratio: f64,
    /// Give up after this time [s].
    pub longest_s: f64,
    /// Largest friction while the bed settles [-], of all pairs; afterwards every pair has its own. A small one packs the bed
    /// densely, as tamping does; without it the bed is as loose as it falls.
    pub friction: Option<f64>,
    /// Grains that `dials.rotation: Fixed` holds turn freely while the bed settles: it is then the bed of free rotation.
    pub is_turning: bool,
    /// Time step while the bed settles over that of the experiment [-]: what a bed loses on its way to rest needs no exact ledger.
    pub time_step_factor: f64,
}

impl Default for Settle {
    fn default() -> Self {
        Settle {
            energy_ratio: 1e-5,
            longest_s: 5.0,
            friction: None,
            is_turning: false,
            time_step_factor: 1.0,
        }
    }
}

fn first_seed() -> u64 {
    1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_volume_of_a_range_is_its_integral() {
        let (low, high) = (0.002, 0.005);
        let n = 10_000;
        let mean = (0..n)
            .map(|i| low + (high - low) * (i as f64 + 0.5) / n as f64)
            .map(|r: f64| 4.0 / 3.0 * std::f64::consts::PI * r.powi(3))
            .sum::<f64>()
            / n as f64;
        let exact = Sizes::Uniform { radius_m: (low, high) }.mean_volume();
        assert!((mean / exact - 1.0).abs() < 1e-7);
    }

    #[test]
    fn mean_volume_of_a_grading_curve_is_that_of_the_packing() {
        let of_packing = grouser_dem::RadiusDistribution::Graded { from_m: 0.002, to_m: 0.005 }.mean_volume();
        let of_scene = Sizes::Graded { radius_m: (0.002, 0.005) }.mean_volume();
        assert!((of_scene / of_packing - 1.0).abs() < 1e-12);
    }
}
