//! One scenario file: what a scene is made of, read from RON, checked, and written back with every default.
//!
//! Adding a kind of soil, tool, motion or reference is one file here and one variant of its enum.

mod collapse;
mod dials;
mod height_file;
mod locate;
mod material;
mod mesh;
mod motion;
mod outputs;
mod plate_tested;
mod read;
mod reference;
mod rigid_wheel;
mod route;
mod shoe;
mod soft_ground;
mod soil;
mod source;
mod study;
mod tire;
mod tool;
mod validate;
mod vehicle;

pub use collapse::Collapse;
pub use dials::{
    ActiveZone, Dials, Dlr, Figures, Forces, Precision, RestitutionTail, Rolling, Rotation, Tilting,
};
pub use height_file::{HeightFile, ImageScale};
pub use locate::{Found, Path, locate};
pub use material::{Material, Pair};
pub use mesh::Mesh;
pub use motion::{Motion, Press};
pub use outputs::Outputs;
pub use plate_tested::{ContactSize, PlateTested};
pub use read::{dialect, read, read_with_advice, resolved, variant};
pub use reference::{PlateCurve, PressureSinkage, Reference, WheelMeasured, WheelPoint};
pub use rigid_wheel::{RigidWheel, SlipPoint, Slips};
pub use route::{Route, Vary};
pub use shoe::{BeltShoe, FileAxis, PlateShoe, ShoeFile};
pub use soft_ground::{GroundProblem, MeasuredLaws, Pressure, Relief, RigidObject, SoftGround};
pub use soil::{Container, Grains, Layer, Settle, Side, Sizes, Soil};
pub use source::Source;
pub use study::{Axis, Choice, Curves, Study, Trend, Variant};
pub use tire::{Roll, SubSteps, Tire, TireElements, TireModel, Tread, Vertical};
pub use tool::{Plates, Tool};
pub use validate::{Problem, advice, validate};
pub use vehicle::{AxlePair, BeltSet, Frame, FrameJoint, Load, Vehicle};

use ron::value::RawValue;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A whole scene. SI units and radians; what is not carries its unit in the name. `z` points up.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// One line for the head of tables and reports.
    pub title: String,
    /// What the scene shows, for whom, and which of its numbers are assumptions.
    #[serde(default)]
    pub description: String,
    /// Acceleration of free fall [m/s²].
    #[serde(default = "standard_gravity")]
    pub gravity_m_s2: [f64; 3],
    /// Materials of grains, walls and tools by name; soil and tools refer to these names.
    #[serde(default)]
    pub materials: BTreeMap<String, Material>,
    /// Contacts between two different materials. Pairs left out take the smaller friction and the smaller
    /// restitution of the two, and stand in the resolved scenario.
    #[serde(default)]
    pub pairs: Vec<Pair>,
    /// The ground.
    pub soil: Soil,
    /// What is pressed into the ground or rolls over it.
    #[serde(default)]
    pub tool: Option<Tool>,
    /// How the tool moves.
    #[serde(default)]
    pub motion: Option<Motion>,
    /// Choices between speed and accuracy.
    #[serde(default)]
    pub dials: Dials,
    /// Measurements that the results are compared with.
    #[serde(default)]
    pub reference: Vec<Reference>,
    /// What is written, and how often.
    #[serde(default)]
    pub outputs: Outputs,
    /// The same scene over several values, and what is compared.
    #[serde(default)]
    pub study: Option<Study>,
    /// What `--quick` replaces: path of a value → the value written there.
    #[serde(default)]
    pub quick: BTreeMap<String, Box<RawValue>>,
    /// They have been replaced.
    #[serde(skip)]
    pub is_quick: bool,
}

fn standard_gravity() -> [f64; 3] {
    [0.0, 0.0, -9.81]
}

/// Takes a file beside the scenario, where there is one; its path then counts from the current folder.
fn beside(scenario: &str, file: &mut String) {
    let beside = std::path::Path::new(scenario).parent().unwrap_or(std::path::Path::new("")).join(&*file);
    if beside.is_file() {
        *file = beside.display().to_string();
    }
}

impl Scenario {
    /// Strength of gravity [m/s²].
    pub fn gravity(&self) -> f64 {
        self.gravity_m_s2.iter().map(|g| g * g).sum::<f64>().sqrt()
    }

    /// Takes files beside the scenario, where there are any.
    fn find_beside(&mut self, scenario: &str) {
        if let Soil::PressureSinkage(ground) = &mut self.soil {
            ground.find_beside(scenario);
        }
        match &mut self.tool {
            Some(Tool::Mesh(mesh)) => beside(scenario, &mut mesh.file),
            Some(Tool::Vehicle(vehicle)) => vehicle.find_beside(scenario),
            _ => {}
        }
    }
}
