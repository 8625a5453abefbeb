//! What is pressed into the ground: its surface, and the area that its force is spread over.

use super::SetupError;
use crate::scene::{Scenario, Tool};
use grouser_geometry::TriangleSurface;
use grouser_geometry::generate::disc_plate;
use std::f64::consts::{PI, TAU};

/// A rigid body about to be pressed, its lowest point at the origin.
pub struct Indenter {
    /// What it is, in a few words.
    pub label: String,
    /// Name of its time series.
    pub name: String,
    /// Diameter of a plate, or of the circle of the same area [m].
    pub diameter: f64,
    /// Distance from the vertical through the origin within which it meets grains [m].
    pub reach: f64,
    /// Its surface.
    pub surface: TriangleSurface,
    /// Name of its material.
    pub material: String,
}

impl Indenter {
    /// Number of indenters of a scene.
    pub fn count(scenario: &Scenario) -> usize {
        match &scenario.tool {
            Some(Tool::Plates(plates)) => plates.diameters_m.len(),
            Some(Tool::Mesh(_)) => 1,
            Some(Tool::RigidWheel(_) | Tool::Vehicle(_) | Tool::Tire(_)) | None => 0,
        }
    }

    /// The indenter of this number.
    ///
    /// # Errors
    /// When the shape is refused or its file cannot be read.
    pub fn new(tool: &Tool, number: usize) -> Result<Self, SetupError> {
        match tool {
            Tool::Plates(plates) => {
                let diameter = plates.diameters_m[number];
                // The polygon has the circle's area: n/2 sin(2π/n) R² = π r².
                let n = plates.segments as f64;
                let corner_radius = diameter / 2.0 * (TAU / (n * (TAU / n).sin())).sqrt();
                Ok(Self {
                    label: format!("{:.0} mm plate", 1e3 * diameter),
                    name: format!("plate_{:.0}mm", 1e3 * diameter),
                    diameter,
                    reach: diameter / 2.0,
                    surface: disc_plate(corner_radius, plates.thickness_m, plates.segments)?,
                    material: plates.material.clone(),
                })
            }
            Tool::Mesh(mesh) => {
                let surface = mesh.surface().map_err(|message| SetupError::Mesh(message.to_string()))?;
                let reach = surface.vertices.iter().map(|v| v.x.hypot(v.y)).fold(0.0, f64::max);
                Ok(Self {
                    label: "tool".into(),
                    name: "tool".into(),
                    diameter: (4.0 / PI * area_from_below(&surface)).sqrt(),
                    reach,
                    surface,
                    material: mesh.material.clone(),
                })
            }
            Tool::RigidWheel(_) | Tool::Vehicle(_) | Tool::Tire(_) => {
                unreachable!("composed for a tool that is pressed")
            }
        }
    }
}

/// Area of a closed body as seen from below [m²]: exact where no part of it hides another.
fn area_from_below(surface: &TriangleSurface) -> f64 {
    (0..surface.triangles.len()).map(|t| (-surface.area_vector(t).z).max(0.0)).sum()
}
