//! What meets the ground.

use super::{Mesh, RigidWheel, Tire, Vehicle};
use serde::{Deserialize, Serialize};

/// Kinds of tools.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Tool {
    /// Circular plates, each pressed into its own copy of the same bed.
    Plates(Plates),
    /// A rigid body with a surface from a file.
    Mesh(Mesh),
    /// A single rigid wheel.
    RigidWheel(RigidWheel),
    /// A machine on wheels and tracks.
    Vehicle(Vehicle),
    /// A tread on a rim, elastic or rigid.
    Tire(Tire),
}

impl Tool {
    /// Name of the material that grains touch; empty for tools that meet none.
    pub fn material(&self) -> &str {
        match self {
            Tool::Plates(plates) => &plates.material,
            Tool::Mesh(mesh) => &mesh.material,
            Tool::Tire(tire) => &tire.material,
            Tool::RigidWheel(_) | Tool::Vehicle(_) => "",
        }
    }
}

/// A set of rigid circular plates.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plates {
    /// Diameter of each plate [m].
    pub diameters_m: Vec<f64>,
    /// Thickness [m].
    pub thickness_m: f64,
    /// Corners of the polygon that stands for the circle; it has the circle's area.
    #[serde(default = "many_segments")]
    pub segments: usize,
    /// Name of the plates' material.
    pub material: String,
}

fn many_segments() -> usize {
    64
}
