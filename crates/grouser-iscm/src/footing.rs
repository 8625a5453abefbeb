//! What of an imprint can press on the ground: its points and triangles, found once a drawing.

mod facets;
#[cfg(test)]
mod tests;

use std::sync::OnceLock;

pub(crate) use facets::{Facet, Facets, Sites};

use facets::owner;

use crate::imprint::{ACROSS, AROUND, HARDLY_COVERED, Imprint, MOST_SAG};
use crate::levels::MOST_LEVELS;
use crate::polygon::{PartialLoad, Sag};
use crate::terrain::Terrain;

/// A point hardly covered, of whose depth `own` counts, and the neighbours that give the rest: a range of `Footing::seen`.
#[derive(Clone, Debug)]
struct Edge {
    site: u32,
    own: f64,
    seen: std::ops::Range<u32>,
}

/// Points and triangles under one layer of running gear, as far as it stands on one level of the ground in each cell.
#[derive(Clone, Debug, Default)]
pub(crate) struct Footing {
    /// The layer, counted from the lowest.
    pub layer: usize,
    /// The level, counted from the deepest.
    pub level: usize,
    /// The points.
    pub sites: Sites,
    /// The triangles that press once the gear has sunk by less than [`CLOSE`] since it was drawn.
    close: Facets,
    /// All triangles of which a part is covered, made when the gear sinks farther.
    all: OnceLock<Facets>,
    /// First row of the window that has triangles; for each node from there on the point there, and what is known of it.
    first_row: usize,
    site_of: Vec<u32>,
    flags: Vec<u8>,
    /// Those of corners of triangles that are close come first.
    edges: Vec<Edge>,
    n_close_edges: usize,
    /// Points and their weights, which add up to one for each edge.
    seen: Vec<(u32, f64)>,
}

/// What a layer covers of one level of its cells.
#[derive(Clone, Debug, Default)]
struct Parts {
    /// Share of each cell and height of the level there \[m\].
    cells: Vec<(f64, f64)>,
    /// [`NEAR`] where the ground is.
    flags: Vec<u8>,
    /// First and last row with gear near the ground.
    rows: [usize; 2],
}

/// Whether the ground may come to press at a node before the next drawing.
const NEAR: u8 = 1;
/// Whether it does once the gear has sunk by [`CLOSE`].
const IS_CLOSE: u8 = 2;
/// Whether the node belongs to a rigid object.
const FIXED: u8 = 4;
/// Whether it is the corner of a triangle.
const CORNER: u8 = 8;
const NONE: u32 = u32::MAX;

/// Sinkage since the drawing up to which only triangles close to the ground are looked at \[m\]; changes cost, not results.
const CLOSE: f64 = 4e-3;
/// Height above the ground up to which the gear may come to press on it before the next drawing \[m\].
pub(crate) const WITHIN_REACH: f64 = 0.12;

impl Footing {
    /// Of all `layers`, the lowest first, on the levels of `terrain`; what lower layers cover is gone for higher ones.
    pub fn of(layers: &[Imprint], terrain: &Terrain, partial: PartialLoad) -> Vec<Self> {
        let mut footings = Vec::with_capacity(2 * layers.len());
        let mut parts: [Parts; MOST_LEVELS] = Default::default();
        let heights = terrain.grid().heights();
        for (k, layer) in layers.iter().enumerate() {
            for parts in &mut parts {
                parts.cells.clear();
                parts.flags.clear();
                parts.rows = [usize::MAX, 0];
            }
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
                    for level in (0..MOST_LEVELS).filter(|&level| overlaps[level] > 0.0) {
                        let Parts { cells, flags, rows } = &mut parts[level];
                        if cells.is_empty() {
                            cells.resize(layer.nodes.len(), (0.0, 0.0));
                            flags.resize(layer.nodes.len(), 0);
                        }
                        let ground = heights[first + i] - levels.get(level).sinkage;
                        if node.height < ground + WITHIN_REACH {
                            *rows = [rows[0].min(j), j];
                            flags[j * layer.n_x + i] = NEAR;
                        }
                        cells[j * layer.n_x + i] = (overlaps[level], ground);
                    }
                }
            }
            let near = parts.iter().enumerate().filter(|(_, parts)| parts.rows[0] <= parts.rows[1]);
            footings.extend(near.map(|(level, parts)| Self::new(layers, k, level, parts, terrain, partial)));
        }
        footings
    }

    /// Of layer `k` of `layers` on one level, of which it covers `parts`.
    fn new(
        layers: &[Imprint],
        k: usize,
        level: usize,
        parts: &Parts,
        terrain: &Terrain,
        partial: PartialLoad,
    ) -> Self {
        let imprint = &layers[k];
        let n_x = imprint.n_x;
        let first_row = parts.rows[0].saturating_sub(1);
        let window = first_row * n_x..((parts.rows[1] + 1).min(imprint.n_y - 1) + 1) * n_x;
        let flags = parts.flags[window.clone()].to_vec();
        let mut footing = Self { layer: k, level, first_row, flags, ..Self::default() };
        footing.find_corners(imprint);
        let shares = footing.find_sites(imprint, &parts.cells[window], terrain);
        if partial == PartialLoad::Proportional {
            footing.see_neighbours(n_x, &shares);
        }
        footing.find_close(layers, partial);
        footing
    }

    /// Marks the corners of all triangles that have one where gear is near the ground.
    fn find_corners(&mut self, imprint: &Imprint) {
        let n_x = imprint.n_x;
        for j in 0..self.flags.len() / n_x - 1 {
            let (low, high) = self.flags[j * n_x..(j + 2) * n_x].split_at_mut(n_x);
            for i in 0..n_x - 1 {
                let near = [low[i], low[i + 1], high[i], high[i + 1]].map(|flags| flags & NEAR);
                let [a, b, c, d] = near;
                if a | b | c | d == 0 {
                    continue;
                }
                let mut is_corner = [0; 4];
                for half in halves(imprint, (i, self.first_row + j)) {
                    let any = half.iter().fold(0, |any, &corner| any | near[corner]);
                    half.iter().for_each(|&corner| is_corner[corner] |= any * CORNER);
                }
                low[i] |= is_corner[0];
                low[i + 1] |= is_corner[1];
                high[i] |= is_corner[2];
                high[i + 1] |= is_corner[3];
            }
        }
    }

    /// Makes the points at the marked corners, row by row; returns the share of each node of the window that is one.
    fn find_sites(&mut self, imprint: &Imprint, cells: &[(f64, f64)], terrain: &Terrain) -> Vec<f64> {
        let n_x = imprint.n_x;
        let is_corner = |n: &usize| self.flags[*n] & CORNER != 0;
        let nodes: Vec<usize> = (0..cells.len()).filter(is_corner).collect();
        self.site_of = vec![NONE; cells.len()];
        let mut shares = vec![0.0; cells.len()];
        let first = (imprint.j_0 + self.first_row) * terrain.grid().n_x() + imprint.i_0;
        let mut on_grid = Vec::with_capacity(nodes.len());
        let mut at: Vec<[f64; 2]> = Vec::with_capacity(nodes.len());
        for (site, &n) in nodes.iter().enumerate() {
            let (i, j) = (n % n_x, n / n_x);
            let node = first + j * terrain.grid().n_x() + i;
            self.site_of[n] = site as u32;
            shares[n] = cells[n].0;
            self.flags[n] |= if terrain.is_fixed(node) { FIXED } else { 0 };
            on_grid.push(node as u32);
            at.push(imprint.position(i, self.first_row + j));
        }
        let gear = || nodes.iter().map(|&n| &imprint.nodes[self.first_row * n_x + n]);
        let ground = nodes.iter().zip(&on_grid).map(|(&n, &node)| match cells[n] {
            (share, ground) if share > 0.0 => ground,
            _ => terrain.level_height(node as usize, self.level),
        });
        let heights = terrain.grid().heights();
        self.sites = Sites {
            position: [
                at.iter().map(|at| at[0]).collect(),
                at.iter().map(|at| at[1]).collect(),
                gear().map(|gear| gear.height).collect(),
            ],
            slope: [0, 1].map(|k| gear().map(|gear| gear.slope[k]).collect()),
            share: nodes.iter().map(|&n| cells[n].0).collect(),
            ground: ground.collect(),
            undisturbed: on_grid.iter().map(|&node| heights[node as usize]).collect(),
            owner: gear().map(|gear| gear.owner).collect(),
            on_grid,
        };
        shares
    }

    /// Finds the triangles that press once the gear has sunk by [`CLOSE`].
    fn find_close(&mut self, layers: &[Imprint], partial: PartialLoad) {
        let sites = self.sites.ground.iter().zip(&self.sites.position[2]);
        let mut depths: Vec<f64> = sites.map(|(ground, height)| ground - height).collect();
        self.see(self.edges.len(), &mut depths, &mut Vec::new());
        // No underside sags more below the corners of a triangle.
        let most = CLOSE + 4.0 / 3.0 * MOST_SAG * layers[self.layer].spacing;
        for (flags, &site) in self.flags.iter_mut().zip(&self.site_of).filter(|(_, site)| **site != NONE) {
            *flags |= if depths[site as usize] > -most { IS_CLOSE } else { 0 };
        }
        self.close = self.facets_where(layers, partial, IS_CLOSE);
        let mut is_close = vec![false; self.sites.len()];
        self.close
            .facets
            .iter()
            .flat_map(|facet| facet.sites)
            .for_each(|site| is_close[site as usize] = true);
        for k in 0..self.edges.len() {
            if is_close[self.edges[k].site as usize] {
                self.edges.swap(self.n_close_edges, k);
                self.n_close_edges += 1;
            }
        }
    }

    /// The triangles that may press once the gear has sunk by `sunk` \[m\] since it was drawn in `layers`, and the depths below the ground
    /// that their corners see, where `depths` \[m\] holds each point's own; `changed` is working space.
    pub fn facets(
        &self,
        layers: &[Imprint],
        partial: PartialLoad,
        sunk: f64,
        depths: &mut [f64],
        changed: &mut Vec<f64>,
    ) -> &Facets {
        if sunk < CLOSE - 1e-9 {
            self.see(self.n_close_edges, depths, changed);
            return &self.close;
        }
        self.see(self.edges.len(), depths, changed);
        self.all.get_or_init(|| self.facets_where(layers, partial, CORNER))
    }

    /// All triangles with a corner near the ground and one that has a flag.
    ///
    /// Wheels, the last layer of all, have a curved underside; shoes are flat.
    fn facets_where(&self, layers: &[Imprint], partial: PartialLoad, flag: u8) -> Facets {
        let (imprint, n_x) = (&layers[self.layer], layers[self.layer].n_x);
        let is_curved = self.layer + 1 == layers.len() && partial == PartialLoad::Proportional;
        let Sites { owner: owners, share: shares, .. } = &self.sites;
        let mut all = Facets::default();
        all.facets.reserve(2 * self.sites.len());
        all.sags.reserve(if is_curved { 2 * self.sites.len() } else { 0 });
        let wanted = NEAR | flag;
        for j in 0..self.site_of.len() / n_x - 1 {
            let row = self.first_row + j;
            let (low, high) = self.site_of[j * n_x..(j + 2) * n_x].split_at(n_x);
            let (low_flags, high_flags) = self.flags[j * n_x..(j + 2) * n_x].split_at(n_x);
            for i in 0..n_x - 1 {
                let flags = [low_flags[i], low_flags[i + 1], high_flags[i], high_flags[i + 1]];
                if (flags[0] | flags[1] | flags[2] | flags[3]) & wanted != wanted {
                    continue;
                }
                let sites = [low[i], low[i + 1], high[i], high[i + 1]];
                for half in halves(imprint, (i, row)) {
                    let [a, b, c] = half.map(|corner| flags[corner]);
                    if (a | b | c) & wanted != wanted {
                        continue;
                    }
                    let sites = half.map(|corner| sites[corner]);
                    let owner = owner(sites.map(|site| (owners[site as usize], shares[site as usize])));
                    all.facets.push(Facet { sites, owner, is_fixed: a & b & c & FIXED != 0 });
                    if is_curved {
                        let at = half.map(|corner| (i + corner % 2, row + corner / 2));
                        all.sags.push(Sag::new(imprint.sag(at)));
                    }
                }
            }
        }
        all
    }

    /// What is hardly covered takes its depth from its neighbours; `shares` are those of the nodes of the window with points, `n_x` in a row.
    fn see_neighbours(&mut self, n_x: usize, shares: &[f64]) {
        let n_rows = shares.len() / n_x;
        let site_of = &self.site_of;
        for (n, &site) in site_of.iter().enumerate().filter(|(_, site)| **site != NONE) {
            let own = shares[n] / HARDLY_COVERED;
            if own >= 1.0 {
                continue;
            }
            let (i, j) = (n % n_x, n / n_x);
            let (first, mut sum) = (self.seen.len(), 0.0);
            self.seen.resize(first + AROUND.len(), (0, 0.0));
            let (seen, mut n_seen) = (&mut self.seen[first..], 0);
            let mut see = |near: usize, weight: f64| {
                let weight = shares[near] * weight;
                seen[n_seen] = (site_of[near], weight);
                n_seen += usize::from(weight > 0.0);
                sum += weight;
            };
            let is_inside = i > 0 && j > 0 && i + 1 < n_x && j + 1 < n_rows;
            for (di, dj) in AROUND {
                let weight = if di == 0 || dj == 0 { 1.0 } else { ACROSS };
                let (a, b) = (i.wrapping_add_signed(di), j.wrapping_add_signed(dj));
                if is_inside || (a < n_x && b < n_rows) {
                    see(b * n_x + a, weight);
                }
            }
            let last = if sum > 0.0 { first + n_seen } else { first };
            self.seen.truncate(last);
            if sum > 0.0 {
                let rest = (1.0 - own) / sum;
                self.seen[first..].iter_mut().for_each(|seen| seen.1 *= rest);
                self.edges.push(Edge { site, own, seen: first as u32..last as u32 });
            }
        }
    }

    /// Changes the depth below the ground \[m\] of the points of the first `n` edges from their own to what they see.
    fn see(&self, n: usize, depths: &mut [f64], changed: &mut Vec<f64>) {
        changed.clear();
        changed.extend(self.edges[..n].iter().map(|edge| {
            let seen = &self.seen[edge.seen.start as usize..edge.seen.end as usize];
            let seen = seen.iter().map(|&(site, weight)| weight * depths[site as usize]);
            edge.own * depths[edge.site as usize] + seen.sum::<f64>()
        }));
        for (edge, &depth) in self.edges[..n].iter().zip(&*changed) {
            depths[edge.site as usize] = depth;
        }
    }
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
