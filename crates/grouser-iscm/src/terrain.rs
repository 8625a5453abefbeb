//! Ground: heights, sinkage and load history on a grid, with the relationships that press back.

use grouser_geometry::HeightGrid;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::levels::{Level, Levels, Pressed};
use crate::pressure::PressureField;

/// How a point of ground behaves (P2 §2.2.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum GroundKind {
    /// Soil: sinks along its pressure–sinkage relationship.
    Normal,
    /// Rock, stump: presses back with [`Terrain::FIXED_STIFFNESS`] and keeps its height.
    Fixed,
}

/// What the soil does when the load goes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Unloading {
    /// The rut stays (P2), but for the distance over which contact is lost and builds up again.
    Plastic {
        /// Rise of the ground when the load goes, and way over which renewed contact takes up its full pressure \[m\].
        contact_distance: f64,
    },
    /// The soil springs back and is reloaded along a straight line of this stiffness \[Pa/m\].
    Elastic {
        /// Pressure per sinkage on unloading \[Pa/m\].
        stiffness: f64,
    },
}

impl Default for Unloading {
    fn default() -> Self {
        Self::Plastic { contact_distance: 2.5e-4 }
    }
}

/// Shape of a rigid object on the ground.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum RigidShape {
    /// Flat top, vertical walls.
    Stump,
    /// Half ellipsoid.
    Rock,
}

/// Ground as a grid of points with a history.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Terrain {
    grid: HeightGrid,
    field: PressureField,
    unloading: Unloading,
    kind: Vec<GroundKind>,
    sinkage: Vec<f64>,
    deepest: Vec<f64>,
    loadings: Vec<u32>,
    levels: Vec<Levels>,
}

/// What a cell becomes where it is pressed.
pub(crate) struct PressedCell {
    levels: Levels,
    deepest: f64,
}

/// Why a terrain cannot be used.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum TerrainError {
    /// The field of relationships was made for another grid.
    #[error(
        "the relationships were made for {field} nodes, the grid has {grid}; remedy: make both from the same grid"
    )]
    FieldSize {
        /// Nodes of the field.
        field: usize,
        /// Nodes of the grid.
        grid: usize,
    },
    /// A bad unloading parameter.
    #[error("unloading: {parameter} is {value}, expected a finite value above zero")]
    Unloading {
        /// The parameter.
        parameter: &'static str,
        /// Its value.
        value: f64,
    },
    /// A rigid object without a node.
    #[error(
        "the rigid object at ({x}, {y}) m of {diameter} m diameter covers no node of the grid; expected a place on the grid and a \
         diameter above the spacing of {spacing} m"
    )]
    ObjectWithoutNode {
        /// Position \[m\].
        x: f64,
        /// Position \[m\].
        y: f64,
        /// Diameter \[m\].
        diameter: f64,
        /// Spacing of the grid \[m\].
        spacing: f64,
    },
}

impl Terrain {
    /// Pressure per sinkage of fixed ground \[Pa/m\], P2 Eq. (4).
    pub const FIXED_STIFFNESS: f64 = 1e9;

    /// Undisturbed ground over `grid`.
    pub fn new(grid: HeightGrid, field: PressureField) -> Result<Self, TerrainError> {
        let n = grid.n_nodes();
        if let Some(nodes) = field.n_nodes().filter(|&nodes| nodes != n) {
            return Err(TerrainError::FieldSize { field: nodes, grid: n });
        }
        Ok(Self {
            grid,
            field,
            unloading: Unloading::default(),
            kind: vec![GroundKind::Normal; n],
            sinkage: vec![0.0; n],
            deepest: vec![0.0; n],
            loadings: vec![0; n],
            levels: vec![Levels::default(); n],
        })
    }

    /// The same ground with another behaviour on unloading.
    pub fn with_unloading(mut self, unloading: Unloading) -> Result<Self, TerrainError> {
        let (parameter, value) = match unloading {
            Unloading::Plastic { contact_distance } => ("contact_distance", contact_distance),
            Unloading::Elastic { stiffness } => ("stiffness", stiffness),
        };
        if !(value.is_finite() && value > 0.0) {
            return Err(TerrainError::Unloading { parameter, value });
        }
        self.unloading = unloading;
        Ok(self)
    }

    /// Puts a rigid object of `diameter` and `height` \[m\] on the ground; returns how many nodes it covers.
    pub fn add_rigid_object(
        &mut self,
        centre: [f64; 2],
        diameter: f64,
        height: f64,
        shape: RigidShape,
    ) -> Result<usize, TerrainError> {
        let (n_x, radius) = (self.grid.n_x(), diameter / 2.0);
        let mut covered = 0;
        for node in 0..self.grid.n_nodes() {
            let [x, y] = self.grid.position(node % n_x, node / n_x);
            let distance = (x - centre[0]).hypot(y - centre[1]);
            if distance <= radius {
                let rise = match shape {
                    RigidShape::Stump => height,
                    RigidShape::Rock => height * (1.0 - (distance / radius).powi(2)).sqrt(),
                };
                self.grid.heights_mut()[node] += rise;
                self.kind[node] = GroundKind::Fixed;
                covered += 1;
            }
        }
        if covered == 0 {
            let [x, y] = centre;
            return Err(TerrainError::ObjectWithoutNode { x, y, diameter, spacing: self.grid.spacing() });
        }
        Ok(covered)
    }

    /// Undisturbed heights and the grid's geometry.
    pub fn grid(&self) -> &HeightGrid {
        &self.grid
    }

    /// Pressure–sinkage relationships.
    pub fn field(&self) -> &PressureField {
        &self.field
    }

    /// Behaviour on unloading.
    pub fn unloading(&self) -> Unloading {
        self.unloading
    }

    /// Present mean height of the cell of a node \[m\].
    #[inline(always)]
    pub fn height(&self, node: usize) -> f64 {
        self.grid.heights()[node] - self.sinkage[node]
    }

    /// Levels of the ground in the cell of a node.
    #[inline(always)]
    pub(crate) fn levels(&self, node: usize) -> &Levels {
        &self.levels[node]
    }

    /// Present height of a level of the cell of a node \[m\].
    #[inline(always)]
    pub(crate) fn level_height(&self, node: usize, level: usize) -> f64 {
        self.grid.heights()[node] - self.levels[node].get(level).sinkage
    }

    /// Mean sinkage of the cell of each node below the undisturbed ground \[m\]: times the cell's area it is the volume of the rut.
    pub fn sinkage(&self) -> &[f64] {
        &self.sinkage
    }

    /// Sinkage of the deepest level in the cell of a node below the undisturbed ground \[m\]: the depth of a rut.
    pub fn deepest_level(&self, node: usize) -> f64 {
        self.levels[node].get(0).sinkage
    }

    /// Deepest sinkage that each node has seen under load \[m\].
    pub fn deepest(&self) -> &[f64] {
        &self.deepest
    }

    /// How many footprints have deepened each node.
    pub fn loadings(&self) -> &[u32] {
        &self.loadings
    }

    /// Whether a node belongs to a rigid object.
    #[inline(always)]
    pub fn is_fixed(&self, node: usize) -> bool {
        self.kind[node] == GroundKind::Fixed
    }

    /// Presses the whole cell of a node down to `height` \[m\] and lets it spring back where the ground is elastic.
    pub fn stamp(&mut self, node: usize, height: f64) {
        let overlaps = self.levels[node].overlaps(0.0, 1.0);
        let whole = overlaps.into_iter().enumerate().filter(|(_, share)| *share > 0.0);
        let parts: Vec<Pressed> = whole.map(|(level, share)| Pressed { level, share, height }).collect();
        self.press(node, &parts);
    }

    /// Presses parts of the cell of a node down and lets them spring back where the ground is elastic.
    pub(crate) fn press(&mut self, node: usize, parts: &[Pressed]) {
        if let Some(after) = self.pressed(node, parts, &mut Vec::new()) {
            self.set_pressed(node, &after);
        }
    }

    /// What the cell of a node becomes where it is pressed; nothing where it stays as it is. `space` is working space.
    pub(crate) fn pressed(
        &self,
        node: usize,
        parts: &[Pressed],
        space: &mut Vec<Level>,
    ) -> Option<PressedCell> {
        if self.is_fixed(node) {
            return None;
        }
        let z_0 = self.grid.heights()[node];
        let pressed = |level: &Level, height: f64| {
            let sinkage = z_0 - height;
            (sinkage > level.sinkage).then(|| {
                let deepest = level.deepest.max(sinkage);
                Level { deepest, sinkage: self.left(node, level.sinkage, deepest, sinkage), ..*level }
            })
        };
        let levels = self.levels[node].after(parts, pressed, space)?;
        let deepest = parts.iter().fold(self.deepest[node], |most, part| most.max(z_0 - part.height));
        Some(PressedCell { levels, deepest })
    }

    /// Makes the cell of a node what it becomes where it is pressed.
    pub(crate) fn set_pressed(&mut self, node: usize, after: &PressedCell) {
        self.levels[node] = after.levels;
        self.sinkage[node] = after.levels.mean_sinkage();
        self.deepest[node] = after.deepest;
        self.loadings[node] += 1;
    }

    /// Sinkage that is left at a node after it was pressed down by `sinkage` \[m\].
    fn left(&self, node: usize, before: f64, deepest: f64, sinkage: f64) -> f64 {
        match self.unloading {
            // The ground follows the gear up again over the contact distance, so that a machine that stands still stays carried.
            Unloading::Plastic { contact_distance } => before.max(sinkage - contact_distance),
            Unloading::Elastic { stiffness } => {
                let resolution = self.field.resolution();
                let (pressure, _) =
                    crate::pressure::interpolate(self.field.of_node(node), deepest / resolution);
                // What was left before stays at least: reloading below the deepest point leaves no deeper rut.
                before.max(deepest - pressure / stiffness)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pressure::{Linear, PressureArray, PressureLaw};

    fn flat() -> Terrain {
        let grid = HeightGrid::covering([0.0, 0.0], [1.0, 1.0], 0.1, |_, _| 0.0).unwrap();
        let law = PressureLaw::Linear(Linear { stiffness: 1e6 });
        Terrain::new(grid, PressureField::uniform(PressureArray::new(&law, 0.005, 0.5).unwrap())).unwrap()
    }

    #[test]
    fn plastic_ground_keeps_its_rut_and_elastic_ground_springs_back() {
        let mut plastic = flat();
        plastic.stamp(12, -0.04);
        plastic.stamp(12, -0.02);
        assert!((plastic.sinkage()[12] - (0.04 - 2.5e-4)).abs() < 1e-12 && plastic.deepest()[12] == 0.04);
        assert_eq!(plastic.loadings()[12], 1);
        let mut elastic = flat().with_unloading(Unloading::Elastic { stiffness: 4e6 }).unwrap();
        elastic.stamp(12, -0.04);
        assert!((elastic.sinkage()[12] - 0.03).abs() < 1e-12 && elastic.deepest()[12] == 0.04);
        elastic.stamp(12, -0.035);
        assert!((elastic.sinkage()[12] - 0.03).abs() < 1e-12 && elastic.deepest()[12] == 0.04);
    }

    #[test]
    fn maps_hold_the_volume_of_all_levels_and_ruts_are_as_deep_as_the_deepest() {
        let mut terrain = flat();
        let node = 5 * 11 + 5;
        let press = |terrain: &mut Terrain, parts: [(usize, f64, f64); 2]| {
            let parts = parts.map(|(level, share, height)| Pressed { level, share, height });
            terrain.press(node, &parts);
        };
        press(&mut terrain, [(0, 0.3, -0.10), (0, 0.5, -0.04)]);
        // Half of what was left goes down as well, and the deepest level farther: of four levels two are joined.
        press(&mut terrain, [(0, 0.3, -0.12), (2, 0.1, -0.06)]);
        let left = 2.5e-4; // The contact distance.
        let levels = [(0.3, 0.12), (0.5, 0.04), (0.1, 0.06)];
        let volume = levels.iter().map(|(share, sinkage)| share * (sinkage - left)).sum::<f64>() * 0.1 * 0.1;
        let map = terrain.sinkage().iter().sum::<f64>() * 0.1 * 0.1;
        assert!((map - volume).abs() < 1e-12, "{map} and {volume} m³");
        assert!((terrain.height(node) + volume / 0.01).abs() < 1e-12);
        let rut = crate::rut::rut_depths(&terrain, [0.0, 0.5], [1.0, 0.5], 0.3, 1.0);
        assert!((rut[0] - (0.12 - left)).abs() < 1e-12, "{rut:?}");
    }

    #[test]
    fn a_stump_rises_and_does_not_yield() {
        let mut terrain = flat();
        let covered = terrain.add_rigid_object([0.5, 0.5], 0.35, 0.15, RigidShape::Stump).unwrap();
        assert!(covered == 9, "{covered}");
        let node = 5 * 11 + 5;
        terrain.stamp(node, -0.1);
        assert_eq!((terrain.height(node), terrain.sinkage()[node]), (0.15, 0.0));
        assert!(terrain.add_rigid_object([5.0, 0.5], 0.35, 0.15, RigidShape::Rock).is_err());
    }
}
