//! A tool whose surface is in a file: read, scaled, looked over, and put with its lowest point at the origin.

use crate::diagnostic::Diagnostic;
use grouser_geometry::mesh_doctor::{Closedness, examine};
use grouser_geometry::{TriangleSurface, Vec3, obj, stl};
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::path::Path;

/// A rigid body with a surface of triangles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mesh {
    /// STL or OBJ file, its path from the scenario's folder or else from the current one.
    pub file: String,
    /// Metres for one unit of the file: 0.001 for a file in millimetres.
    #[serde(default = "metres")]
    pub scale: f64,
    /// Name of the body's material.
    pub material: String,
}

fn metres() -> f64 {
    1.0
}

impl Mesh {
    /// The surface, the middle of its outline on the vertical axis and its lowest point at z = 0 [m].
    ///
    /// # Errors
    /// When the file cannot be read, is no mesh, or its triangles do not enclose a body.
    pub fn surface(&self) -> Result<TriangleSurface, Diagnostic> {
        let path = Path::new(&self.file);
        let file = File::open(path).map_err(|error| {
            Diagnostic::new(format!("{}: {error}", self.file))
                .expected("an STL or OBJ file beside the scenario or below the current folder")
                .usual_cause("a misspelt path")
        })?;
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let refused = |error: &dyn std::error::Error| {
            Diagnostic::new(format!("{}: {error}", self.file))
                .expected("a triangle mesh")
                .usual_cause("a file of another kind, or one that was cut off")
        };
        let surface = match extension.as_str() {
            "stl" => stl::read_stl(file).map_err(|error| refused(&error))?,
            "obj" => obj::read_obj(file).map_err(|error| refused(&error))?,
            other => {
                return Err(Diagnostic::new(format!(
                    "{}: there is no reader for `.{other}` files",
                    self.file
                ))
                .expected("`.stl` or `.obj`")
                .usual_cause("a mesh in the format of another program")
                .remedy("export it as STL"));
            }
        };
        let scaled = surface.scaled(self.scale);
        let extent = scaled.bounding_box().extent().norm();
        let surface = scaled.welded(1e-9 * extent);
        // Triangles without area are named before welding would take them away.
        let mut findings = examine(&scaled, Closedness::Optional);
        if findings.is_empty() {
            findings = examine(&surface, Closedness::Required);
        }
        if let Some(first) = findings.first() {
            let more = if findings.len() > 1 {
                format!(" (and {} more findings)", findings.len() - 1)
            } else {
                String::new()
            };
            return Err(Diagnostic::new(format!("{}: {first}{more}", self.file))
                .expected("a closed surface of triangles with area, their normals outwards"));
        }
        Ok(lowered(surface))
    }
}

/// The surface with the middle of its outline on the vertical axis and its lowest point at z = 0.
fn lowered(mut surface: TriangleSurface) -> TriangleSurface {
    let bounds = surface.bounding_box();
    let middle = bounds.center();
    let shift = Vec3::new(middle.x, middle.y, middle.z - bounds.extent().z / 2.0);
    surface.vertices.iter_mut().for_each(|vertex| *vertex -= shift);
    surface
}
