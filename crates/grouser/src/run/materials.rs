//! Materials of a scenario as the contact laws want them: numbered, with the interaction of every pair.

use crate::scene::{RestitutionTail, Scenario};
use grouser_contact::{Interaction, Material, PairTable, ParameterError, Real, Tail};

/// The materials of a scenario, numbered by name in alphabetical order.
pub struct Materials<'a> {
    scenario: &'a Scenario,
    names: Vec<&'a str>,
}

impl<'a> Materials<'a> {
    /// The materials of `scenario`.
    pub fn of(scenario: &'a Scenario) -> Self {
        Self { scenario, names: scenario.materials.keys().map(String::as_str).collect() }
    }

    /// Number of the material called `name`; names are checked when a scenario is read.
    pub fn number(&self, name: &str) -> u32 {
        self.names.binary_search(&name).expect("names are checked when a scenario is read") as u32
    }

    /// Elastic constants of the material called `name`.
    pub fn elastic(&self, name: &str) -> Material {
        let crate::scene::Material { young_pa, poisson, density_kg_m3, .. } = self.scenario.materials[name];
        Material { young_pa, poisson, density_kg_m3 }
    }

    /// How two materials meet: as listed, or as like meets like.
    pub fn interaction(&self, a: &str, b: &str) -> Interaction {
        let of = |name: &str| {
            let material = &self.scenario.materials[name];
            Interaction { restitution: material.restitution, friction: material.friction }
        };
        if a == b {
            return of(a);
        }
        let is_ours = |(c, d): &(String, String)| (c == a && d == b) || (c == b && d == a);
        match self.scenario.pairs.iter().find(|pair| is_ours(&pair.between)) {
            Some(pair) => Interaction { restitution: pair.restitution, friction: pair.friction },
            // Pairs that never meet in this scene.
            None => of(a),
        }
    }

    /// Constants of every pair.
    ///
    /// # Errors
    /// When a constant is out of range, which a checked scenario excludes.
    pub fn table<T: Real>(&self) -> Result<PairTable<T>, ParameterError> {
        self.table_with_friction_up_to(f64::INFINITY)
    }

    /// [`Self::table`] with no friction above `most` [-].
    ///
    /// # Errors
    /// As [`Self::table`].
    pub fn table_with_friction_up_to<T: Real>(&self, most: f64) -> Result<PairTable<T>, ParameterError> {
        let elastic: Vec<Material> = self.names.iter().map(|name| self.elastic(name)).collect();
        PairTable::new(&elastic, self.tail(), |i, j| {
            let Interaction { restitution, friction } = self.interaction(self.names[i], self.names[j]);
            Interaction { restitution, friction: friction.min(most) }
        })
    }

    /// What becomes of the dashpot's attraction.
    pub fn tail(&self) -> Tail {
        match self.scenario.dials.restitution_tail {
            RestitutionTail::Keep => Tail::Keep,
            RestitutionTail::CutCorrected => Tail::CutCorrected,
        }
    }
}
