//! The stable time step: the smallest of several criteria, over every pair including walls and tools.

use grouser_contact::{Material, PairProperties};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// One bound on the time step, and where it binds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Criterion {
    /// What the bound is: `Rayleigh wave`, `Hertz collision`, `travel per step`, …
    pub name: String,
    /// The characteristic time or the bound itself [s].
    pub time_s: f64,
    /// Fraction of `time_s` that is allowed [-].
    pub fraction: f64,
    /// The bodies that set it.
    pub place: String,
}

impl Criterion {
    /// Name of [`Criterion::rayleigh`].
    pub const RAYLEIGH: &'static str = "Rayleigh wave";

    /// Largest step that this criterion allows [s].
    pub fn step_s(&self) -> f64 {
        self.time_s * self.fraction
    }

    /// Rayleigh wave over the smallest grain of a material.
    pub fn rayleigh(material: &Material, radius: f64, fraction: f64, place: impl Into<String>) -> Self {
        Self {
            name: Self::RAYLEIGH.into(),
            time_s: rayleigh_time(material, radius),
            fraction,
            place: place.into(),
        }
    }

    /// Hertz collision of a pair at `speed`.
    pub fn hertz(
        pair: &PairProperties,
        effective_radius: f64,
        effective_mass: f64,
        speed: f64,
        fraction: f64,
        place: impl Into<String>,
    ) -> Self {
        let time_s = hertz_collision_time(pair, effective_radius, effective_mass, speed);
        Self { name: "Hertz collision".into(), time_s, fraction, place: place.into() }
    }

    /// Travel per step: no body moves further than `fraction` of `radius` in a step at `speed`.
    pub fn travel(radius: f64, speed: f64, fraction: f64, place: impl Into<String>) -> Self {
        Self { name: "travel per step".into(), time_s: radius / speed, fraction, place: place.into() }
    }
}

/// Time in which a Rayleigh wave crosses a sphere: π r √(ρ/G) / (0.1631 ν + 0.8766) [s].
///
/// A quartz grain of 4 mm with E = 10 MPa, ν = 0.3, ρ = 2600 kg/m³: 0.35 ms.
/// ```
/// # use grouser_dem::rayleigh_time;
/// # use grouser_contact::Material;
/// let soft = Material { young_pa: 1e7, poisson: 0.3, density_kg_m3: 2600.0 };
/// assert!((rayleigh_time(&soft, 4e-3) - 0.35e-3).abs() < 0.01e-3);
/// ```
pub fn rayleigh_time(material: &Material, radius: f64) -> f64 {
    PI * radius * (material.density_kg_m3 / material.shear_modulus()).sqrt()
        / (0.1631 * material.poisson + 0.8766)
}

/// Duration of an undamped Hertz collision, 2.943275 δ_max/v with δ_max = (5 m* v²/(4 k))^(2/5) [s].
///
/// Chung & Ooi (2011), test 1: 40.339 µs.
/// ```
/// # use grouser_dem::hertz_collision_time;
/// # use grouser_contact::*;
/// let glass = Material { young_pa: 48e9, poisson: 0.2, density_kg_m3: 2800.0 };
/// let pair = PairProperties::new(&glass, &glass, &Interaction { restitution: 1.0, friction: 0.35 }, Tail::Keep)?;
/// let mass = 2800.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-6;
/// assert!((hertz_collision_time(&pair, 5e-3, mass / 2.0, 20.0) - 40.339456e-6).abs() < 1e-11);
/// # Ok::<(), ParameterError>(())
/// ```
pub fn hertz_collision_time(
    pair: &PairProperties,
    effective_radius: f64,
    effective_mass: f64,
    speed: f64,
) -> f64 {
    // k = 4/3 E* √R*
    let k = pair.normal_modulus * effective_radius.sqrt();
    let largest_overlap = (1.25 * effective_mass * speed * speed / k).powf(0.4);
    2.943_275_184 * largest_overlap / speed
}

/// A step and the criteria that it was chosen from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TimeStep {
    /// The step [s].
    pub step_s: f64,
    /// Place of the binding criterion in `criteria`.
    pub binding: usize,
    /// All criteria.
    pub criteria: Vec<Criterion>,
}

impl TimeStep {
    /// The smallest of the steps that `criteria` allow; `None` without a criterion.
    pub fn smallest(criteria: Vec<Criterion>) -> Option<Self> {
        let (binding, step_s) =
            criteria.iter().map(Criterion::step_s).enumerate().min_by(|(_, a), (_, b)| a.total_cmp(b))?;
        Some(Self { step_s, binding, criteria })
    }

    /// The criterion that binds.
    pub fn binding(&self) -> &Criterion {
        &self.criteria[self.binding]
    }
}
