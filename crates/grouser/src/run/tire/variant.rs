//! Which of the tires of a scene: tread, model and slip.

use super::TreadSpec;
use crate::run::Materials;
use crate::scene::{Motion, Roll, Scenario, Tire, TireElements, TireModel, Tool, Tread};
use grouser_fem::{Formulation, Material, VolumetricTreatment};
use grouser_geometry::{LugPattern, TireTread};
use serde::{Deserialize, Serialize};

/// One run of a tire.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Variant {
    /// Pattern.
    pub tread: Tread,
    /// Model of the rubber.
    pub model: TireModel,
    /// Slip [-].
    pub slip: f64,
}

/// Tire and motion of a scene that has both.
pub fn parts(scenario: &Scenario) -> Option<(&Tire, &Roll)> {
    match (&scenario.tool, &scenario.motion) {
        (Some(Tool::Tire(tire)), Some(Motion::Roll(roll))) => Some((tire, roll)),
        _ => None,
    }
}

impl Variant {
    /// Every combination, treads outermost, slips innermost.
    pub fn all(tire: &Tire, roll: &Roll) -> Vec<Self> {
        let models = |&tread: &Tread| tire.models.iter().map(move |&model| (tread, model));
        let slips = |(tread, model)| roll.slips.iter().map(move |&slip| Self { tread, model, slip });
        tire.treads.iter().flat_map(models).flat_map(slips).collect()
    }

    /// In words.
    pub fn label(&self) -> String {
        let tread = match self.tread {
            Tread::Smooth => "smooth",
            Tread::Alternating { .. } => "lugged",
        };
        format!("{tread} tire, {}, slip {:.0} %", self.model.label(), 100.0 * self.slip)
    }

    /// For names of files.
    pub fn name(&self) -> String {
        let tread = match self.tread {
            Tread::Smooth => "smooth",
            Tread::Alternating { .. } => "lugged",
        };
        format!("{tread}_{}_{:.0}", self.model.label().replace([' ', '-'], "_"), 100.0 * self.slip)
    }

    /// Shape and mesh.
    pub fn shape(&self, tire: &Tire) -> TireTread {
        TireTread {
            size: tire.size.clone(),
            wall_thickness: tire.wall_thickness_m,
            groove_depth: tire.groove_depth_m,
            pattern: match self.tread {
                Tread::Smooth => LugPattern::Smooth,
                Tread::Alternating { lugs } => LugPattern::Alternating { count: lugs },
            },
            n_elements: tire.n_elements,
        }
    }

    /// What the tread is made from; `None` for a rigid one.
    pub fn spec(&self, tire: &Tire, materials: &Materials) -> Option<TreadSpec> {
        let formulation = match self.model {
            TireModel::Rigid => return None,
            TireModel::BodyAttached => Formulation::BodyAttached,
            TireModel::Corotational => Formulation::Corotational,
            TireModel::FiniteStrain => Formulation::FiniteStrain,
        };
        let rubber = materials.elastic(&tire.material);
        Some(TreadSpec {
            tread: self.shape(tire),
            rubber: Material::hooke(rubber.density_kg_m3, rubber.young_pa, rubber.poisson),
            formulation,
            volumetric: match tire.elements {
                TireElements::Linear => VolumetricTreatment::PerElement,
                TireElements::AveragedPressure => VolumetricTreatment::NodalAverage,
            },
            inflation: tire.inflation_pa,
        })
    }
}
