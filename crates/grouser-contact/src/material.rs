//! Materials, and what two of them make of a contact.

use crate::{ParameterError, Real, Tail, damping_coefficient};
use serde::{Deserialize, Serialize};

/// Elastic, dissipative and frictional constants of one material against itself.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Young's modulus E [Pa].
    pub young_pa: f64,
    /// Poisson's ratio ν, in (−1, 0.5].
    pub poisson: f64,
    /// Density of the solid ρ [kg/m³].
    pub density_kg_m3: f64,
}

impl Material {
    /// Shear modulus G = E / (2 (1 + ν)) [Pa].
    pub fn shear_modulus(&self) -> f64 {
        self.young_pa / (2.0 * (1.0 + self.poisson))
    }

    /// Refuses constants that no material has.
    ///
    /// # Errors
    /// Names the first constant outside its range.
    pub fn validate(&self) -> Result<(), ParameterError> {
        let positive = |name, value: f64| {
            ParameterError::check(name, value, value > 0.0 && value.is_finite(), "a positive number")
        };
        positive("Young's modulus", self.young_pa)?;
        positive("density", self.density_kg_m3)?;
        let poisson = self.poisson;
        ParameterError::check("Poisson's ratio", poisson, poisson > -1.0 && poisson <= 0.5, "in (-1, 0.5]")
    }
}

/// How two materials lose energy against each other.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Interaction {
    /// Coefficient of normal restitution e, in (0, 1].
    pub restitution: f64,
    /// Coefficient of sliding friction μ ≥ 0.
    pub friction: f64,
}

impl Interaction {
    /// Refuses e outside (0, 1] and negative friction.
    ///
    /// # Errors
    /// Names the constant outside its range.
    pub fn validate(&self) -> Result<(), ParameterError> {
        let (e, mu) = (self.restitution, self.friction);
        ParameterError::check("restitution", e, e > 0.0 && e <= 1.0, "in (0, 1]")?;
        ParameterError::check("friction", mu, mu >= 0.0 && mu.is_finite(), "zero or a positive number")
    }
}

/// Constants of a contact between two materials, ready for the kernels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct PairProperties<T: Real = f64> {
    /// Normal stiffness per contact radius, 4/3 E* [Pa]; 1/E* = (1−ν₁²)/E₁ + (1−ν₂²)/E₂, P0 Eq. (21).
    pub normal_modulus: T,
    /// Tangential stiffness per contact radius, 8 G* [Pa]; 1/G* = (2−ν₁)/G₁ + (2−ν₂)/G₂, P0 Eqs. (25), (26).
    pub tangential_modulus: T,
    /// Tsuji's damping coefficient α [-] of the restitution asked for, P0 Eq. (23).
    pub damping: T,
    /// Ratio of the tangential to the normal dashpot, √(2/3 · 8 G* / (4/3 E*)) [-], P0 Eqs. (23), (27).
    pub tangential_damping_ratio: T,
    /// Coefficient of sliding friction μ [-].
    pub friction: T,
}

impl PairProperties<f64> {
    /// Pair of two materials with their interaction.
    ///
    /// # Errors
    /// When a constant is outside its range.
    pub fn new(
        first: &Material,
        second: &Material,
        interaction: &Interaction,
        tail: Tail,
    ) -> Result<Self, ParameterError> {
        first.validate()?;
        second.validate()?;
        interaction.validate()?;
        let compliance = |m: &Material| (1.0 - m.poisson * m.poisson) / m.young_pa;
        let shear_compliance = |m: &Material| (2.0 - m.poisson) / m.shear_modulus();
        // E* and G*
        let effective_young = 1.0 / (compliance(first) + compliance(second));
        let effective_shear = 1.0 / (shear_compliance(first) + shear_compliance(second));
        let normal_modulus = 4.0 / 3.0 * effective_young;
        let tangential_modulus = 8.0 * effective_shear;
        Ok(Self {
            normal_modulus,
            tangential_modulus,
            damping: damping_coefficient(interaction.restitution, tail),
            tangential_damping_ratio: (2.0 / 3.0 * tangential_modulus / normal_modulus).sqrt(),
            friction: interaction.friction,
        })
    }

    /// The same constants in another precision.
    pub fn cast<T: Real>(&self) -> PairProperties<T> {
        PairProperties {
            normal_modulus: T::from_f64(self.normal_modulus),
            tangential_modulus: T::from_f64(self.tangential_modulus),
            damping: T::from_f64(self.damping),
            tangential_damping_ratio: T::from_f64(self.tangential_damping_ratio),
            friction: T::from_f64(self.friction),
        }
    }
}

/// The constants of every pair of materials in a scene, symmetric.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct PairTable<T: Real = f64> {
    n_materials: usize,
    pairs: Vec<PairProperties<T>>,
}

impl<T: Real> PairTable<T> {
    /// Table of `materials`, with the interaction of rows `i` and `j` given by `interaction(i, j)`, i ≤ j.
    ///
    /// # Errors
    /// When a constant is outside its range.
    pub fn new(
        materials: &[Material],
        tail: Tail,
        interaction: impl Fn(usize, usize) -> Interaction,
    ) -> Result<Self, ParameterError> {
        let n_materials = materials.len();
        let mut pairs = Vec::with_capacity(n_materials * n_materials);
        for i in 0..n_materials {
            for j in 0..n_materials {
                let between = interaction(i.min(j), i.max(j));
                pairs.push(PairProperties::new(&materials[i], &materials[j], &between, tail)?.cast());
            }
        }
        Ok(Self { n_materials, pairs })
    }

    /// Number of materials.
    pub fn n_materials(&self) -> usize {
        self.n_materials
    }

    /// Constants of materials `i` and `j`.
    #[inline(always)]
    pub fn pair(&self, i: u32, j: u32) -> &PairProperties<T> {
        &self.pairs[i as usize * self.n_materials + j as usize]
    }
}
