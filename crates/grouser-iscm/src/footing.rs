//! What of an imprint can press on the ground: its points and triangles, found once a drawing.

mod facets;
mod span;
mod standing;
#[cfg(test)]
mod tests;

use std::sync::OnceLock;

pub(crate) use facets::{Facets, OnLevels, Pressing, Sites};
pub(crate) use span::Span;
pub(crate) use standing::{Edges, Standing};

use facets::Facet;

use crate::imprint::{Imprint, MOST_SAG, spread};
use crate::levels::MOST_LEVELS;
use crate::polygon::{PartialLoad, Sag};
use crate::terrain::Terrain;

/// Points and triangles under one layer of running gear.
#[derive(Clone, Debug, Default)]
pub(crate) struct Footing {
    /// The layer, counted from the lowest.
    pub layer: usize,
    /// The points.
    pub sites: Sites,
    /// What stands on each level of the ground, the deepest first.
    pub levels: Vec<Standing>,
    /// What presses once the gear has sunk by less than [`CLOSE`] since it was drawn.
    close: Ready,
    /// All of which a part is covered, made when the gear sinks farther.
    all: OnceLock<Ready>,
    /// First row of the window that has triangles; for each node from there on the point there, and what is known of it.
    first_row: usize,
    site_of: Vec<u32>,
    flags: Vec<u16>,
    /// The node of each point, counted from that row.
    nodes: Vec<u32>,
}

/// Triangles that may press, and for each level the points hardly covered at their corners.
#[derive(Clone, Debug, Default)]
pub(crate) struct Ready {
    pub facets: Facets,
    pub edges: Vec<Edges>,
}

/// How far above the ground gear is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Reach {
    /// As far as it may press before it has sunk by [`CLOSE`] since it was drawn.
    Close,
    /// [`WITHIN_REACH`].
    Far,
}

/// What a layer covers of each level of its cells.
#[derive(Clone, Debug, Default)]
struct Parts {
    /// Share of each cell and height of the level there \[m\]; empty for a level on which nothing stands.
    cells: [Vec<(f64, f64)>; MOST_LEVELS],
    /// One bit for each level: whether gear stands on it, is within reach of it, and presses on it once sunk by [`CLOSE`].
    stands: Vec<u8>,
    near: Vec<u8>,
    close: Vec<u8>,
    /// First and last row with gear near the ground.
    rows: [usize; 2],
}

/// One bit for each level: whether gear stands on it at a node that is within reach or at most two nodes beside what is.
const NEAR: u16 = (1 << MOST_LEVELS) - 1;
/// Where the bits begin that tell whether it does once the gear has sunk by [`CLOSE`].
const IS_CLOSE: usize = MOST_LEVELS;
/// Where the bits begin that tell whether the node may be the corner of a triangle or is seen from one.
const CORNER: usize = 2 * MOST_LEVELS;
/// Whether the node belongs to a rigid object.
const FIXED: u16 = 1 << (3 * MOST_LEVELS);
const NONE: u32 = u32::MAX;

/// Sinkage since the drawing up to which only gear close to the ground is looked at \[m\]; changes cost, not results.
pub(crate) const CLOSE: f64 = 4e-3;
/// Height above the ground up to which the gear may come to press on it before the next drawing \[m\].
pub(crate) const WITHIN_REACH: f64 = 0.12;

impl Footing {
    /// Of all `layers`, the lowest first, on the levels of `terrain`; what lower layers cover is gone for higher ones. Also gives what bounds
    /// how far any gear sinks.
    pub fn of(
        layers: &[Imprint],
        terrain: &Terrain,
        partial: PartialLoad,
        reach: Reach,
    ) -> (Vec<Self>, Span) {
        let (mut parts, mut span) = (Parts::default(), Span::default());
        let mut footings = Vec::with_capacity(layers.len());
        for k in 0..layers.len() {
            parts.find(layers, k, terrain, reach, &mut span);
            if parts.rows[0] <= parts.rows[1] {
                footings.push(Self::new(layers, k, &parts, terrain, partial));
            }
        }
        (footings, span)
    }

    /// Of layer `k` of `layers`, which covers `parts`.
    fn new(layers: &[Imprint], k: usize, parts: &Parts, terrain: &Terrain, partial: PartialLoad) -> Self {
        let imprint = &layers[k];
        let n_x = imprint.n_x;
        let first_row = parts.rows[0].saturating_sub(2);
        let window = first_row * n_x..((parts.rows[1] + 2).min(imprint.n_y - 1) + 1) * n_x;
        let flags = parts.flags(window.clone(), n_x, partial);
        let mut footing = Self { layer: k, first_row, flags, ..Self::default() };
        footing.find_sites(imprint, terrain);
        let n_levels = parts.cells.iter().rposition(|cells| !cells.is_empty()).map_or(0, |last| last + 1);
        for (level, cells) in parts.cells[..n_levels].iter().enumerate() {
            let cells = cells.get(window.clone()).unwrap_or_default();
            footing.levels.push(footing.standing(level, cells, terrain));
        }
        footing.close = footing.find_close(layers, partial);
        footing
    }

    /// Makes the points at the marked corners, row by row.
    fn find_sites(&mut self, imprint: &Imprint, terrain: &Terrain) {
        let n_x = imprint.n_x;
        let is_corner = |n: &u32| self.flags[*n as usize] & (NEAR << CORNER) != 0;
        let nodes: Vec<u32> = (0..self.flags.len() as u32).filter(is_corner).collect();
        self.site_of = vec![NONE; self.flags.len()];
        let first = (imprint.j_0 + self.first_row) * terrain.grid().n_x() + imprint.i_0;
        let mut on_grid = Vec::with_capacity(nodes.len());
        let mut at: Vec<[f64; 2]> = Vec::with_capacity(nodes.len());
        for (site, &n) in nodes.iter().enumerate() {
            let (i, j) = (n as usize % n_x, n as usize / n_x);
            let node = first + j * terrain.grid().n_x() + i;
            self.site_of[n as usize] = site as u32;
            self.flags[n as usize] |= if terrain.is_fixed(node) { FIXED } else { 0 };
            on_grid.push(node as u32);
            at.push(imprint.position(i, self.first_row + j));
        }
        let gear = || nodes.iter().map(|&n| &imprint.nodes[self.first_row * n_x + n as usize]);
        let heights = terrain.grid().heights();
        self.sites = Sites {
            position: [
                at.iter().map(|at| at[0]).collect(),
                at.iter().map(|at| at[1]).collect(),
                gear().map(|gear| gear.height).collect(),
            ],
            slope: [0, 1].map(|k| gear().map(|gear| gear.slope[k]).collect()),
            undisturbed: on_grid.iter().map(|&node| heights[node as usize]).collect(),
            owner: gear().map(|gear| gear.owner).collect(),
            on_grid,
        };
        self.nodes = nodes;
    }

    /// Finds what presses once the gear has sunk by [`CLOSE`].
    fn find_close(&mut self, layers: &[Imprint], partial: PartialLoad) -> Ready {
        let (n_x, most) = (layers[self.layer].n_x, most_above(&layers[self.layer]));
        let mut edges = Vec::with_capacity(self.levels.len());
        if partial == PartialLoad::Proportional {
            let (mut depths, mut seen) = (Vec::new(), Vec::new());
            for level in 0..self.levels.len() {
                let is_close = 1 << (IS_CLOSE + level);
                edges.push(self.edges(level, is_close, n_x));
                self.levels[level].depths(&self.sites.position[2], &mut depths);
                edges[level].see(&mut depths, &mut seen);
                for (&n, &depth) in self.nodes.iter().zip(&depths) {
                    let is_far = u16::from(depth <= -most) << (IS_CLOSE + level);
                    self.flags[n as usize] &= !is_far;
                }
            }
        }
        Ready { facets: self.facets_where(layers, partial, IS_CLOSE), edges }
    }

    /// What may press once the gear has sunk by `sunk` \[m\] since it was drawn in `layers`.
    pub fn ready(&self, layers: &[Imprint], partial: PartialLoad, sunk: f64) -> &Ready {
        if sunk < CLOSE - 1e-9 {
            return &self.close;
        }
        self.all.get_or_init(|| {
            let n_x = layers[self.layer].n_x;
            let levels = if partial == PartialLoad::Proportional { self.levels.len() } else { 0 };
            let edges = (0..levels).map(|level| self.edges(level, 0, n_x));
            Ready { facets: self.facets_where(layers, partial, CORNER), edges: edges.collect() }
        })
    }

    /// All triangles between points with a corner that stands near the ground and one that has a flag, both on the same level; `flag` is where
    /// its bits begin.
    ///
    /// Wheels, the last layer of all, have a curved underside; shoes are flat.
    fn facets_where(&self, layers: &[Imprint], partial: PartialLoad, flag: usize) -> Facets {
        let (imprint, n_x) = (&layers[self.layer], layers[self.layer].n_x);
        let is_curved = self.layer + 1 == layers.len() && partial == PartialLoad::Proportional;
        let mut all = Facets::default();
        all.facets.reserve(2 * self.sites.len());
        all.sags.reserve(if is_curved { 2 * self.sites.len() } else { 0 });
        for j in 0..self.site_of.len() / n_x - 1 {
            let row = self.first_row + j;
            let (low, high) = self.site_of[j * n_x..(j + 2) * n_x].split_at(n_x);
            let (low_flags, high_flags) = self.flags[j * n_x..(j + 2) * n_x].split_at(n_x);
            for i in 0..n_x - 1 {
                let flags = [low_flags[i], low_flags[i + 1], high_flags[i], high_flags[i + 1]];
                let any = flags[0] | flags[1] | flags[2] | flags[3];
                if any & (any >> flag) & NEAR == 0 {
                    continue;
                }
                let sites = [low[i], low[i + 1], high[i], high[i + 1]];
                for half in halves(imprint, (i, row)) {
                    let [a, b, c] = half.map(|corner| flags[corner]);
                    let any = a | b | c;
                    let levels = (any & (any >> flag) & (a & b & c) >> CORNER & NEAR) as u8;
                    if levels == 0 {
                        continue;
                    }
                    let sites = half.map(|corner| sites[corner]);
                    all.facets.push(Facet { sites, levels, is_fixed: a & b & c & FIXED != 0 });
                    if is_curved {
                        let at = half.map(|corner| (i + corner % 2, row + corner / 2));
                        all.sags.push(Sag::new(imprint.sag(at)));
                    }
                }
            }
        }
        all
    }

    /// Object of the gear with the largest share of the corners of a triangle between `sites`.
    pub fn owner(&self, sites: [usize; 3]) -> u16 {
        let of = |site: usize| self.sites.owner[site];
        let [a, b, c] = sites.map(of);
        if a == b && a == c {
            return a;
        }
        let share = |site: usize| self.levels.iter().map(|level| level.share[site]).sum::<f64>();
        let held = |owner: u16| -> f64 {
            sites.iter().filter(|site| of(**site) == owner).map(|site| share(*site)).sum()
        };
        [b, c].into_iter().fold(a, |best, other| if held(other) > held(best) { other } else { best })
    }
}

impl Parts {
    /// Finds what layer `k` of `layers` covers of the levels of `terrain`.
    fn find(&mut self, layers: &[Imprint], k: usize, terrain: &Terrain, reach: Reach, span: &mut Span) {
        let layer = &layers[k];
        let heights = terrain.grid().heights();
        let most = most_above(layer);
        let limit = if reach == Reach::Close { most } else { WITHIN_REACH };
        self.cells.iter_mut().for_each(Vec::clear);
        for bits in [&mut self.stands, &mut self.near, &mut self.close] {
            bits.clear();
            bits.resize(layer.nodes.len(), 0);
        }
        self.rows = [usize::MAX, 0];
        span.add_window(layer);
        for j in 0..layer.n_y {
            let first = (layer.j_0 + j) * terrain.grid().n_x() + layer.i_0;
            let row = &layer.nodes[j * layer.n_x..(j + 1) * layer.n_x];
            for (i, node) in row.iter().enumerate().filter(|(_, node)| node.coverage > 0.0) {
                let [low, high] = match k {
                    0 => [0.0, node.coverage],
                    _ => covered(layers, k, layer.i_0 + i, layer.j_0 + j),
                };
                let levels = terrain.levels(first + i);
                let overlaps = levels.overlaps(low, high);
                let n_levels = if levels.is_one() { 1 } else { MOST_LEVELS };
                for level in (0..n_levels).filter(|&level| overlaps[level] > 0.0) {
                    let cells = &mut self.cells[level];
                    if cells.is_empty() {
                        cells.resize(layer.nodes.len(), (0.0, 0.0));
                    }
                    let ground = heights[first + i] - levels.get(level).sinkage;
                    let (n, above) = (j * layer.n_x + i, node.height - ground);
                    self.stands[n] |= 1 << level;
                    self.near[n] |= u8::from(above < limit) << level;
                    self.close[n] |= u8::from(above < most) << level;
                    if above < WITHIN_REACH {
                        span.add(node);
                    }
                    cells[n] = (overlaps[level], ground);
                }
                if self.near[j * layer.n_x + i] != 0 {
                    self.rows = [self.rows[0].min(j), j];
                }
            }
        }
    }

    /// Flags of the nodes of a `window` with rows of `n_x`. A point hardly covered sees its neighbours: it may be close because one of them
    /// is, and so may the triangles at it; they and what they see are points.
    fn flags(&self, window: std::ops::Range<usize>, n_x: usize, partial: PartialLoad) -> Vec<u16> {
        let near = spread(&spread(&self.near[window.clone()], n_x), n_x);
        let close = match partial {
            PartialLoad::Proportional => spread(&self.close[window.clone()], n_x),
            PartialLoad::Step => self.close[window.clone()].to_vec(),
        };
        let of = near.iter().zip(&self.stands[window]).zip(close);
        let flags = |((&near, &stands), close): ((&u8, &u8), u8)| {
            u16::from(near & stands) | u16::from(close) << IS_CLOSE | u16::from(near) << CORNER
        };
        of.map(flags).collect()
    }
}

/// Height above the ground below which gear may press once it has sunk by [`CLOSE`] \[m\]: no underside sags more below the corners of a
/// triangle.
fn most_above(layer: &Imprint) -> f64 {
    CLOSE + 4.0 / 3.0 * MOST_SAG * layer.spacing
}

/// The two triangles in the cell of the window of `imprint` with node (`i`, `j`) at its lower left. Corners of the cell: 0 there, 1 to the
/// right, 2 above, 3 across.
#[inline(always)]
fn halves(imprint: &Imprint, (i, j): (usize, usize)) -> [[usize; 3]; 2] {
    // Diagonals alternate so that no direction is preferred.
    if (imprint.i_0 + i + imprint.j_0 + j).is_multiple_of(2) {
        [[0, 1, 3], [0, 3, 2]]
    } else {
        [[0, 1, 2], [1, 3, 2]]
    }
}

/// Range of the cell of node (`i`, `j`) of the terrain, sorted from the lowest gear up, that layer `k` covers and lower ones leave to it.
///
/// Parts of a shoe lie one on the other, so that a higher one has what it covers more than a lower one. Wheels lie across shoes.
fn covered(layers: &[Imprint], k: usize, i: usize, j: usize) -> [f64; 2] {
    let coverage = |layer: &Imprint| {
        let (a, b) = (i.wrapping_sub(layer.i_0), j.wrapping_sub(layer.j_0));
        if a < layer.n_x && b < layer.n_y { layer.nodes[b * layer.n_x + a].coverage } else { 0.0 }
    };
    let (own, lower) = (coverage(&layers[k]), layers[..k].iter().map(coverage).fold(0.0, f64::max));
    [lower, if k + 1 == layers.len() { lower + own * (1.0 - lower) } else { f64::max(own, lower) }]
}
