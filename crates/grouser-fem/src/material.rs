//! What a solid is made of, and how its elements follow large motion.

use serde::{Deserialize, Serialize};

use crate::law::{Corotational, Law, MooneyRivlin, NeoHookean, SmallStrain, Yeoh};

/// How the elements of a solid follow rotation and strain; one choice per solid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Formulation {
    /// Small strains in a frame that moves with the body (the rim's frame of a tire): exact under the frame's rotation, cheapest.
    #[default]
    BodyAttached,
    /// Small strains in a frame that turns with each element: any rotation, moderate strain.
    Corotational,
    /// Hyperelastic law of the whole deformation gradient: any rotation, any strain.
    FiniteStrain,
}

/// Elastic law of a material.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Elasticity {
    /// Isotropic linear elasticity; with [`Formulation::FiniteStrain`] the compressible neo-Hookean law of the same constants.
    Hooke {
        /// Young's modulus E [Pa].
        young_modulus: f64,
        /// Poisson's ratio ν, −1 < ν < 0.5.
        poisson_ratio: f64,
    },
    /// Mooney–Rivlin rubber; small-strain formulations take its initial moduli.
    MooneyRivlin {
        /// Factor of Ī₁ − 3 [Pa].
        c10: f64,
        /// Factor of Ī₂ − 3 [Pa].
        c01: f64,
        /// Bulk modulus κ [Pa].
        bulk_modulus: f64,
    },
    /// Yeoh rubber; small-strain formulations take its initial moduli.
    Yeoh {
        /// Factor of Ī₁ − 3 [Pa].
        c10: f64,
        /// Factor of (Ī₁ − 3)² [Pa].
        c20: f64,
        /// Factor of (Ī₁ − 3)³ [Pa].
        c30: f64,
        /// Bulk modulus κ [Pa].
        bulk_modulus: f64,
    },
}

/// Material of one region of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Density ρ [kg/m³].
    pub density: f64,
    /// Elastic law.
    pub elasticity: Elasticity,
}

/// Why a material is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MaterialError {
    /// A constant that must be positive is not.
    #[error(
        "material '{region}': {name} is {value}, expected a positive finite number in SI units (Pa, kg/m³)"
    )]
    NotPositive {
        /// Region of the material.
        region: String,
        /// The constant.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// A higher constant of the Yeoh law is infinite or not a number.
    #[error(
        "material '{region}': c20 or c30 is not finite, expected numbers in Pa (0 where the law has fewer terms)"
    )]
    NotFinite {
        /// Region of the material.
        region: String,
    },
    /// Poisson's ratio outside −1 < ν < 0.5.
    #[error(
        "material '{region}': Poisson's ratio is {value}, expected −1 < ν < 0.5; at 0.5 the bulk modulus is infinite – take 0.499 with averaged nodal pressure or ten-node elements"
    )]
    PoissonRatio {
        /// Region of the material.
        region: String,
        /// Its value.
        value: f64,
    },
    /// Number of materials and of regions differ.
    #[error(
        "{found} materials for {expected} regions ({regions}): give one material for each region of the mesh, in that order"
    )]
    Count {
        /// Materials given.
        found: usize,
        /// Regions of the mesh.
        expected: usize,
        /// Their names.
        regions: String,
    },
}

impl Elasticity {
    /// Lamé parameters (λ, μ) at small strain [Pa].
    pub fn lame(&self) -> (f64, f64) {
        match *self {
            Self::Hooke { young_modulus: e, poisson_ratio: nu } => {
                (e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), e / (2.0 * (1.0 + nu)))
            }
            Self::MooneyRivlin { c10, c01, bulk_modulus } => lame_of_bulk(bulk_modulus, 2.0 * (c10 + c01)),
            Self::Yeoh { c10, bulk_modulus, .. } => lame_of_bulk(bulk_modulus, 2.0 * c10),
        }
    }

    /// Law that the elements of a formulation use.
    pub fn law(&self, formulation: Formulation) -> Law {
        let (lambda, mu) = self.lame();
        match (formulation, *self) {
            (Formulation::BodyAttached, _) => Law::SmallStrain(SmallStrain { lambda, mu }),
            (Formulation::Corotational, _) => Law::Corotational(Corotational { lambda, mu }),
            (Formulation::FiniteStrain, Self::Hooke { .. }) => Law::NeoHookean(NeoHookean { lambda, mu }),
            (Formulation::FiniteStrain, Self::MooneyRivlin { c10, c01, bulk_modulus }) => {
                Law::MooneyRivlin(MooneyRivlin { c10, c01, bulk_modulus })
            }
            (Formulation::FiniteStrain, Self::Yeoh { c10, c20, c30, bulk_modulus }) => {
                Law::Yeoh(Yeoh { c10, c20, c30, bulk_modulus })
            }
        }
    }
}

impl Material {
    /// Linear elastic material of density ρ [kg/m³], Young's modulus E [Pa] and Poisson's ratio ν.
    pub fn hooke(density: f64, young_modulus: f64, poisson_ratio: f64) -> Self {
        Self { density, elasticity: Elasticity::Hooke { young_modulus, poisson_ratio } }
    }

    /// Checks the constants of the material of a region.
    ///
    /// # Errors
    /// [`MaterialError::NotPositive`], [`MaterialError::PoissonRatio`].
    pub fn validate(&self, region: &str) -> Result<(), MaterialError> {
        let positive = |name, value: f64| {
            let region = region.to_owned();
            let is_good = value > 0.0 && value.is_finite();
            if is_good { Ok(()) } else { Err(MaterialError::NotPositive { region, name, value }) }
        };
        positive("density", self.density)?;
        match self.elasticity {
            Elasticity::Hooke { young_modulus, poisson_ratio } => {
                positive("young_modulus", young_modulus)?;
                if !(poisson_ratio > -1.0 && poisson_ratio < 0.5) {
                    return Err(MaterialError::PoissonRatio {
                        region: region.to_owned(),
                        value: poisson_ratio,
                    });
                }
                Ok(())
            }
            Elasticity::MooneyRivlin { c10, c01, bulk_modulus } => {
                positive("c10 + c01", c10 + c01)?;
                positive("bulk_modulus", bulk_modulus)
            }
            Elasticity::Yeoh { c10, c20, c30, bulk_modulus } => {
                positive("c10", c10)?;
                if !(c20.is_finite() && c30.is_finite()) {
                    return Err(MaterialError::NotFinite { region: region.to_owned() });
                }
                positive("bulk_modulus", bulk_modulus)
            }
        }
    }

    /// Speed of pressure waves √((λ + 2μ)/ρ) at small strain [m/s].
    pub fn wave_speed(&self) -> f64 {
        let (lambda, mu) = self.elasticity.lame();
        ((lambda + 2.0 * mu) / self.density).sqrt()
    }
}

/// Lamé parameters (λ, μ) of bulk modulus and shear modulus [Pa].
pub(crate) fn lame_of_bulk(bulk_modulus: f64, mu: f64) -> (f64, f64) {
    (bulk_modulus - 2.0 / 3.0 * mu, mu)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pressure_wave_in_tread_rubber_has_the_speed_of_the_textbook() {
        // (lambda + 2 mu) / rho for E = 20 MPa, nu = 0.45, rho = 1100 kg/m3 (Graff, Wave Motion in Elastic Solids).
        assert!((Material::hooke(1100.0, 20e6, 0.45).wave_speed() - 262.613).abs() < 1e-3);
    }

    #[test]
    fn incompressible_and_negative_constants_are_refused_by_name() {
        let message = Material::hooke(1100.0, 20e6, 0.5).validate("tread").unwrap_err().to_string();
        assert!(message.contains("tread") && message.contains("0.499"));
        assert!(Material::hooke(-1.0, 20e6, 0.3).validate("tread").is_err());
        assert!(Material::hooke(1000.0, f64::NAN, 0.3).validate("tread").is_err());
    }
}
