//! Ground as a grid of heights whose pressure rises with sinkage: for machines on wheels and tracks.

use grouser_geometry::{HeightGrid, HeightShape};
use grouser_iscm::pressure::{PressureArray, PressureField, PressureLaw, SpatialLaws};
use grouser_iscm::terrain::{RigidShape, Terrain, Unloading};
use serde::{Deserialize, Serialize};

/// A height grid, its pressure–sinkage relationships, and what lies on it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SoftGround {
    /// Heights of the undisturbed ground.
    pub relief: Relief,
    /// How hard the ground presses back.
    pub pressure: Pressure,
    /// Distance of the values into which relationships are converted [m].
    #[serde(default = "five_millimetres")]
    pub sinkage_resolution_m: f64,
    /// Largest sinkage for which relationships are used [m].
    #[serde(default = "sixty_centimetres")]
    pub max_sinkage_m: f64,
    /// What the ground does when the load goes.
    #[serde(default)]
    pub unloading: Unloading,
    /// Stumps and rocks.
    #[serde(default)]
    pub objects: Vec<RigidObject>,
}

/// Heights over a rectangle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Relief {
    /// Lower left corner [m].
    pub corner_m: [f64; 2],
    /// Length along x and y [m].
    pub size_m: [f64; 2],
    /// Distance of the grid's points [m].
    pub spacing_m: f64,
    /// Shapes that add up; none for flat ground.
    #[serde(default)]
    pub shapes: Vec<HeightShape>,
}

/// One relationship, or several at places.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Pressure {
    /// The same everywhere.
    Uniform(PressureLaw),
    /// Several at positions, blended with Gaussian weights; pressures in Pa, lengths in m.
    Located(SpatialLaws),
}

/// Something stiff on the ground.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RigidObject {
    /// Middle [m].
    pub centre_m: [f64; 2],
    /// Diameter [m].
    pub diameter_m: f64,
    /// Height above the ground [m].
    pub height_m: f64,
    /// Stump or rock.
    pub shape: RigidShape,
}

fn five_millimetres() -> f64 {
    0.005
}

fn sixty_centimetres() -> f64 {
    0.6
}

/// Why ground cannot be made: path below the soil, and what is wrong.
pub type GroundProblem = (String, String);

impl SoftGround {
    /// The ground with points `spacing` [m] apart.
    ///
    /// # Errors
    /// The part of the description that is refused, and why.
    pub fn terrain(&self, spacing: f64) -> Result<Terrain, GroundProblem> {
        let at = |path: &str| {
            let path = path.to_owned();
            move |error: &dyn std::error::Error| (path, error.to_string())
        };
        let relief = &self.relief;
        let height = |x: f64, y: f64| HeightShape::sum(&relief.shapes, x, y);
        let grid = HeightGrid::covering(relief.corner_m, relief.size_m, spacing, height)
            .map_err(|error| at("relief")(&error))?;
        let (resolution, deepest) = (self.sinkage_resolution_m, self.max_sinkage_m);
        let field = match &self.pressure {
            Pressure::Uniform(law) => {
                PressureArray::new(law, resolution, deepest).map(PressureField::uniform)
            }
            Pressure::Located(laws) => laws.field(&grid, resolution, deepest),
        };
        let field = field.map_err(|error| at("pressure")(&error))?;
        let mut terrain = Terrain::new(grid, field)
            .and_then(|terrain| terrain.with_unloading(self.unloading))
            .map_err(|error| at("unloading")(&error))?;
        for (n, object) in self.objects.iter().enumerate() {
            terrain
                .add_rigid_object(object.centre_m, object.diameter_m, object.height_m, object.shape)
                .map_err(|error| at(&format!("objects[{n}]"))(&error))?;
        }
        Ok(terrain)
    }
}
