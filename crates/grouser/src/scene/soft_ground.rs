//! Ground as a grid of heights whose pressure rises with sinkage: for machines on wheels and tracks.

use super::{HeightFile, beside};
use crate::diagnostic::Diagnostic;
use grouser_geometry::{HeightGrid, HeightShape};
use grouser_iscm::pressure::{
    PressureArray, PressureError, PressureField, PressureLaw, SpatialLaws, read_located_laws,
};
use grouser_iscm::terrain::{RigidShape, Terrain, Unloading};
use serde::{Deserialize, Serialize};
use std::error::Error;
use std::fs::File;

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
    /// Heights from a file, to which the shapes are added.
    #[serde(default)]
    pub file: Option<HeightFile>,
}

/// One relationship, or several at places.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Pressure {
    /// The same everywhere.
    Uniform(PressureLaw),
    /// Several at positions, blended with Gaussian weights; pressures in Pa, lengths in m.
    Located(SpatialLaws),
    /// The same, measured points in a file.
    Measured(MeasuredLaws),
}

/// Relationships from a file of measured points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeasuredLaws {
    /// Text with a line `name x y sinkage pressure` [m, m, m, Pa] for each point, points of one name together, `#` for comments; its
    /// path from the scenario's folder or else from the current one. A single relationship holds everywhere.
    pub file: String,
    /// Standard deviation of the Gaussian weights [m]; beyond five times it is zero.
    pub standard_deviation: f64,
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
pub type GroundProblem = (String, Diagnostic);

/// A part that is refused, with what its own message says.
fn refused(path: impl Into<String>, error: &dyn Error) -> GroundProblem {
    let message = Diagnostic::new(error.to_string())
        .expected("ground that can be made")
        .usual_cause("a value in another unit, or two parts at one place");
    (path.into(), message)
}

impl SoftGround {
    /// Takes files beside the scenario, where there are any.
    pub fn find_beside(&mut self, scenario: &str) {
        if let Some(heights) = &mut self.relief.file {
            beside(scenario, &mut heights.file);
        }
        if let Pressure::Measured(laws) = &mut self.pressure {
            beside(scenario, &mut laws.file);
        }
    }

    /// The ground with points `spacing` [m] apart.
    ///
    /// # Errors
    /// The part of the description that is refused, and why.
    pub fn terrain(&self, spacing: f64) -> Result<Terrain, GroundProblem> {
        let grid = self.relief.grid(spacing)?;
        let field = self.pressure.field(&grid, self.sinkage_resolution_m, self.max_sinkage_m)?;
        let mut terrain = Terrain::new(grid, field)
            .and_then(|terrain| terrain.with_unloading(self.unloading))
            .map_err(|error| refused("unloading", &error))?;
        for (n, object) in self.objects.iter().enumerate() {
            terrain
                .add_rigid_object(object.centre_m, object.diameter_m, object.height_m, object.shape)
                .map_err(|error| refused(format!("objects[{n}]"), &error))?;
        }
        Ok(terrain)
    }
}

impl Relief {
    /// Heights of the undisturbed ground with points `spacing` [m] apart.
    fn grid(&self, spacing: f64) -> Result<HeightGrid, GroundProblem> {
        let from_file = self
            .file
            .as_ref()
            .map(|file| {
                file.grid().and_then(|grid| file.covers(&grid, self.corner_m, self.size_m).map(|()| grid))
            })
            .transpose()
            .map_err(|message| ("relief.file.file".to_owned(), message))?;
        let height = |x: f64, y: f64| {
            HeightShape::sum(&self.shapes, x, y) + from_file.as_ref().map_or(0.0, |grid| grid.height_at(x, y))
        };
        HeightGrid::covering(self.corner_m, self.size_m, spacing, height)
            .map_err(|error| refused("relief", &error))
    }
}

impl Pressure {
    /// The relationships of every point of a grid, `resolution` [m] apart down to `deepest` [m].
    fn field(
        &self,
        grid: &HeightGrid,
        resolution: f64,
        deepest: f64,
    ) -> Result<PressureField, GroundProblem> {
        let laws = match self {
            Pressure::Uniform(law) => {
                known_down_to(law.max_sinkage(), deepest)?;
                let array = PressureArray::new(law, resolution, deepest);
                return array.map(PressureField::uniform).map_err(|error| refused("pressure", &error));
            }
            Pressure::Located(laws) => laws,
            Pressure::Measured(measured) => &measured.read()?,
        };
        known_down_to(laws.laws.iter().map(|l| l.law.max_sinkage()).fold(f64::INFINITY, f64::min), deepest)?;
        laws.field(grid, resolution, deepest).map_err(|error| match (&error, self) {
            (PressureError::Coincident { second, .. }, Pressure::Located(_)) => {
                refused(format!("pressure.laws[{}].position", second - 1), &error)
            }
            (PressureError::Coincident { .. }, Pressure::Measured(measured)) => measured.refused(&error),
            _ => refused("pressure", &error),
        })
    }
}

/// Refuses ground that may sink deeper than its relationships are known.
fn known_down_to(known: f64, deepest: f64) -> Result<(), GroundProblem> {
    if deepest <= known * (1.0 + 1e-9) {
        return Ok(());
    }
    let message =
        Diagnostic::new(format!("a sinkage of {deepest} m lies beyond the table, which ends at {known} m"))
            .expected(format!("at most {known} m"))
            .usual_cause("the default of 0.6 m with measurements that are not that deep")
            .remedy(format!("`max_sinkage_m: {known}`, or deeper measurements"));
    Err(("max_sinkage_m".into(), message))
}

impl MeasuredLaws {
    fn read(&self) -> Result<SpatialLaws, GroundProblem> {
        let file = File::open(&self.file).map_err(|error| self.refused(&error))?;
        let laws = read_located_laws(file).map_err(|error| self.refused(&error))?;
        Ok(SpatialLaws { laws, standard_deviation: self.standard_deviation })
    }

    fn refused(&self, error: &dyn Error) -> GroundProblem {
        let message = Diagnostic::new(format!("{}: {error}", self.file))
            .expected(
                "lines `name x y sinkage pressure` [m, m, m, Pa], each relationship at a place of its own",
            )
            .usual_cause("a misspelt path, a column left out, or a relationship in two parts of the file");
        ("pressure.file".to_owned(), message)
    }
}
