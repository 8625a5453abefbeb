//! What a shoe of a chain or track shows to the ground: plates by their sizes, or a surface from a file.

use super::beside;
use crate::diagnostic::Diagnostic;
use grouser_geometry::{TriangleSurface, Vec3, obj};
use grouser_iscm::gear::ShoeShape;
use grouser_iscm::gear::x3d::read_x3d;
use grouser_iscm::imprint::Plate;
use serde::{Deserialize, Serialize};
use std::error::Error;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// Kinds of shoes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum BeltShoe {
    /// A flat plate, and a grouser that reaches deeper.
    Plates(PlateShoe),
    /// Triangles from an X3D or OBJ file.
    Surface(ShoeFile),
}

/// A plate with a grouser across it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlateShoe {
    /// Width [m].
    pub width_m: f64,
    /// Length of the plate per pitch [-]: below 1 the wheel shows between the shoes.
    pub plate_share: f64,
    /// Depth of the plate's underside outside the wheel [m].
    pub plate_depth_m: f64,
    /// Length of the grouser along the track [m]; zero for none.
    #[serde(default)]
    pub grouser_length_m: f64,
    /// Depth of the grouser's edge outside the wheel [m].
    #[serde(default)]
    pub grouser_depth_m: f64,
}

/// A shoe in a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShoeFile {
    /// X3D or OBJ file, its path from the scenario's folder or else from the current one.
    pub file: String,
    /// Metres for one unit of the file: 0.001 for a file in millimetres.
    #[serde(default = "metres")]
    pub scale: f64,
    /// Direction of the file that points along the track.
    #[serde(default = "along_x")]
    pub along: FileAxis,
    /// Direction of the file that points from the ground to the wheel.
    #[serde(default = "up_z")]
    pub up: FileAxis,
    /// Point of the file, in its own units, that lies on the wheel in the middle of the shoe.
    #[serde(default)]
    pub on_wheel: [f64; 3],
}

/// A direction in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum FileAxis {
    /// Along x.
    X,
    /// Along y.
    Y,
    /// Along z.
    Z,
    /// Against x.
    MinusX,
    /// Against y.
    MinusY,
    /// Against z.
    MinusZ,
}

fn metres() -> f64 {
    1.0
}

fn along_x() -> FileAxis {
    FileAxis::X
}

fn up_z() -> FileAxis {
    FileAxis::Z
}

impl FileAxis {
    fn direction(self) -> Vec3 {
        match self {
            Self::X => Vec3::x(),
            Self::Y => Vec3::y(),
            Self::Z => Vec3::z(),
            Self::MinusX => -Vec3::x(),
            Self::MinusY => -Vec3::y(),
            Self::MinusZ => -Vec3::z(),
        }
    }
}

impl BeltShoe {
    /// Takes a file beside the scenario, where there is one.
    pub fn find_beside(&mut self, scenario: &str) {
        if let Self::Surface(shoe) = self {
            beside(scenario, &mut shoe.file);
        }
    }

    /// The shoe of a belt whose links are `pitch` \[m\] apart.
    ///
    /// # Errors
    /// When the file holds no shoe.
    pub fn shape(&self, pitch: f64) -> Result<ShoeShape, Diagnostic> {
        match self {
            Self::Plates(shoe) => Ok(shoe.shape(pitch)),
            Self::Surface(shoe) => shoe.surface().map(ShoeShape::Surface),
        }
    }
}

impl PlateShoe {
    fn shape(&self, pitch: f64) -> ShoeShape {
        let half_width = self.width_m / 2.0;
        let plate =
            |half: f64, depth| Plate { along: [-half, half], across: [-half_width, half_width], depth };
        let grousers = if self.grouser_length_m > 0.0 {
            vec![plate(self.grouser_length_m / 2.0, self.grouser_depth_m)]
        } else {
            Vec::new()
        };
        ShoeShape::Steel { plates: vec![plate(self.plate_share * pitch / 2.0, self.plate_depth_m)], grousers }
    }
}

impl ShoeFile {
    /// The surface in the frame of a shoe: x along the track, z to the wheel, the origin on the wheel in mid-shoe.
    fn surface(&self) -> Result<TriangleSurface, Diagnostic> {
        let path = Path::new(&self.file);
        let source = File::open(path).map(BufReader::new).map_err(|error| {
            Diagnostic::new(format!("{}: {error}", self.file))
                .expected("an X3D or OBJ file beside the scenario or below the current folder")
                .usual_cause("a misspelt path")
        })?;
        let refused = |error: &dyn Error| {
            Diagnostic::new(format!("{}: {error}", self.file))
                .expected("a mesh of triangles or of polygons that can be cut into triangles")
                .usual_cause("a file of another kind, or one made of primitive bodies")
                .remedy("export the shoe as a triangle mesh")
        };
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let surface = match extension.as_str() {
            "x3d" => read_x3d(source).map_err(|error| refused(&error))?,
            "obj" => obj::read_obj(source).map_err(|error| refused(&error))?,
            other => {
                return Err(Diagnostic::new(format!(
                    "{}: there is no reader for `.{other}` files",
                    self.file
                ))
                .expected("`.x3d` or `.obj`")
                .usual_cause("a mesh in the format of another program")
                .remedy("export it as OBJ"));
            }
        };
        let (along, up) = (self.along.direction(), self.up.direction());
        let across = up.cross(&along);
        if across.norm() < 0.5 {
            return Err(Diagnostic::new(format!(
                "{}: along the track and to the wheel lie on one line",
                self.file
            ))
            .expected("`along` and `up` across each other, such as X and Z")
            .usual_cause("one of the two left at its default, X and Z"));
        }
        let own = |v: &Vec3| {
            let d = (v - Vec3::from(self.on_wheel)) * self.scale;
            Vec3::new(d.dot(&along), d.dot(&across), d.dot(&up))
        };
        let vertices: Vec<Vec3> = surface.vertices.iter().map(own).collect();
        if !vertices.iter().all(|v| v.iter().all(|x| x.is_finite())) || vertices.iter().all(|v| v.z >= 0.0) {
            return Err(Diagnostic::new(format!(
                "{}: the shoe nowhere reaches outside the wheel",
                self.file
            ))
            .expected("vertices below `on_wheel`, seen along `up`")
            .usual_cause("`up` the wrong way round, or another unit than `scale` says"));
        }
        Ok(TriangleSurface { vertices, ..surface })
    }
}
