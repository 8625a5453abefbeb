//! What running gear leaves in the ground: G2 in `docs/theory/iscm.md`.

use grouser_geometry::Pose;

use super::{FootImprint, Nodes};
use crate::footing::Footing;
use crate::levels::Pressed;
use crate::polygon::PartialLoad;
use crate::terrain::{PressedCell, Terrain};

/// What gear presses, cell by cell in the order of the nodes.
#[derive(Default)]
pub(crate) struct Footprint {
    cells: Vec<PrintedCell>,
    parts: Vec<Pressed>,
}

/// A cell of the terrain, the parts of the gear in it, and what becomes of it if nothing presses it before.
struct PrintedCell {
    node: usize,
    /// Footprints that had deepened it then.
    n_before: u32,
    parts: std::ops::Range<usize>,
    after: Option<PressedCell>,
}

impl Footprint {
    /// Presses.
    pub fn leave(&self, terrain: &mut Terrain) {
        for PrintedCell { node, n_before, parts, after } in &self.cells {
            if terrain.loadings()[*node] == *n_before {
                after.iter().for_each(|after| terrain.set_pressed(*node, after));
            } else {
                terrain.press(*node, &self.parts[parts.clone()]); // Another foot stands here too.
            }
        }
    }
}

impl FootImprint {
    /// G2: leaves the footprint; each part of the gear presses the levels that it stands on down to its underside.
    pub fn stamp(&self, terrain: &mut Terrain, motion: &Pose) {
        self.print(terrain, motion).leave(terrain);
    }

    /// The footprint: what it presses, as it stands on the ground on which it was drawn.
    pub(crate) fn print(&self, terrain: &Terrain, motion: &Pose) -> Footprint {
        let followed = self.followed(terrain, motion);
        let footings = self.footings_after(motion, terrain);
        let mut nodes = Nodes::default();
        let stand = |footing| {
            self.stand(footing, motion, &followed, PartialLoad::Proportional, &mut nodes);
            std::mem::take(&mut nodes.height)
        };
        let heights: Vec<Vec<f64>> = footings.iter().map(stand).collect();
        // Points of each footing come in the order of the nodes.
        let mut next = vec![0; footings.len()];
        let mut print = Footprint::default();
        let mut space = Vec::new();
        let node_at = |footing: &Footing, n: usize| footing.sites.on_grid.get(n).copied();
        while let Some(node) = footings.iter().zip(&next).filter_map(|(of, &n)| node_at(of, n)).min() {
            let (first, mut presses) = (print.parts.len(), false);
            for ((footing, heights), n) in footings.iter().zip(&heights).zip(&mut next) {
                if node_at(footing, *n) != Some(node) {
                    continue;
                }
                for (level, standing) in footing.levels.iter().enumerate() {
                    if standing.share[*n] > 0.0 {
                        presses |= heights[*n] < standing.ground[*n];
                        print.parts.push(Pressed { level, share: standing.share[*n], height: heights[*n] });
                    }
                }
                *n += 1;
            }
            if presses {
                let (node, parts) = (node as usize, first..print.parts.len());
                let after = terrain.pressed(node, &print.parts[parts.clone()], &mut space);
                print.cells.push(PrintedCell { node, n_before: terrain.loadings()[node], parts, after });
            } else {
                print.parts.truncate(first);
            }
        }
        print
    }
}
