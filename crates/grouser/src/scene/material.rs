//! Materials of grains, walls and tools, and of the contact between two of them.

use serde::{Deserialize, Serialize};

/// An elastic material and how it meets itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Young's modulus E [Pa].
    pub young_pa: f64,
    /// Poisson's ratio ν [-], in (-1, 0.5].
    pub poisson: f64,
    /// Density of the solid, pores not counted [kg/m³].
    pub density_kg_m3: f64,
    /// Coefficient of restitution of like on like [-], in (0, 1].
    pub restitution: f64,
    /// Coulomb's coefficient of friction of like on like [-].
    pub friction: f64,
}

/// What two different materials do to each other.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pair {
    /// Names of the two materials, in any order.
    pub between: (String, String),
    /// Coefficient of restitution [-], in (0, 1].
    pub restitution: f64,
    /// Coulomb's coefficient of friction [-].
    pub friction: f64,
}
