//! Running gear on one level of the ground.

use super::{CORNER, Footing, NONE};
use crate::imprint::{ACROSS, AROUND, HARDLY_COVERED};
use crate::terrain::Terrain;

/// A point hardly covered, of whose depth `own` counts, and the neighbours that give the rest: a range of `Edges::seen`.
#[derive(Clone, Debug)]
struct Edge {
    site: u32,
    own: f64,
    seen: std::ops::Range<u32>,
}

/// What of a layer stands on one level of the ground, point by point.
#[derive(Clone, Debug, Default)]
pub(crate) struct Standing {
    /// Share of the point's cell in which it does.
    pub share: Vec<f64>,
    /// Height of the level \[m\]; −∞ where no triangle is near it.
    pub ground: Vec<f64>,
}

/// Points hardly covered.
#[derive(Clone, Debug, Default)]
pub(crate) struct Edges {
    edges: Vec<Edge>,
    /// Points and their weights, which with the edge's own add up to one.
    seen: Vec<(u32, f64)>,
}

impl Footing {
    /// What stands on a `level`: the share of each cell of the window and the height there \[m\].
    pub(super) fn standing(&self, level: usize, cells: &[(f64, f64)], terrain: &Terrain) -> Standing {
        let corner = 1 << (CORNER + level);
        let n = self.nodes.len();
        let mut standing = Standing { share: Vec::with_capacity(n), ground: Vec::with_capacity(n) };
        for (&n, &on_grid) in self.nodes.iter().zip(&self.sites.on_grid) {
            let (share, ground) = match cells.get(n as usize) {
                Some(&cell) if self.flags[n as usize] & corner != 0 => match cell {
                    (share, ground) if share > 0.0 => (share, ground),
                    _ => (0.0, terrain.level_height(on_grid as usize, level)),
                },
                _ => (0.0, f64::NEG_INFINITY),
            };
            standing.share.push(share);
            standing.ground.push(ground);
        }
        standing
    }

    /// The corners of triangles on a `level` that have a `flag` and are hardly covered, which take their depth from their neighbours; rows of
    /// the window have `n_x` nodes.
    pub(super) fn edges(&self, level: usize, flag: u16, n_x: usize) -> Edges {
        let flag = flag | 1 << (CORNER + level);
        let (site_of, share) = (&self.site_of, &self.levels[level].share);
        let mut sites = vec![0; self.nodes.len()];
        let mut n_edges = 0;
        // Without a branch: which points are hardly covered is not to be foreseen.
        for (site, (&n, &share)) in self.nodes.iter().zip(share).enumerate() {
            sites[n_edges] = site as u32;
            n_edges += usize::from(self.flags[n as usize] & flag == flag && share < HARDLY_COVERED);
        }
        let mut edges =
            Edges { edges: Vec::with_capacity(n_edges), seen: Vec::with_capacity(AROUND.len() * n_edges) };
        let ways = AROUND.map(|(di, dj)| dj * n_x as isize + di);
        let weights = AROUND.map(|(di, dj)| if di == 0 || dj == 0 { 1.0 } else { ACROSS });
        let n_rows = site_of.len() / n_x;
        for &site in &sites[..n_edges] {
            let (n, own) = (self.nodes[site as usize] as usize, share[site as usize] / HARDLY_COVERED);
            let (i, j) = (n % n_x, n / n_x);
            let around = if i > 0 && j > 0 && i + 1 < n_x && j + 1 < n_rows {
                ways.map(|way| site_of[n.wrapping_add_signed(way)])
            } else {
                AROUND.map(|(di, dj)| match (i.wrapping_add_signed(di), j.wrapping_add_signed(dj)) {
                    (a, b) if a < n_x && b < n_rows => site_of[b * n_x + a],
                    _ => NONE,
                })
            };
            let (mut seen, mut n_seen, mut sum) = ([(0, 0.0); AROUND.len()], 0, 0.0);
            for k in 0..AROUND.len() {
                let weight = share.get(around[k] as usize).map_or(0.0, |share| share * weights[k]);
                // Never more than there are; so no bound is checked.
                seen[n_seen % AROUND.len()] = (around[k], weight);
                n_seen += usize::from(weight > 0.0);
                sum += weight;
            }
            if sum > 0.0 {
                let (first, rest) = (edges.seen.len(), (1.0 - own) / sum);
                edges.seen.extend(seen.map(|(near, weight)| (near, weight * rest)));
                edges.seen.truncate(first + n_seen);
                edges.edges.push(Edge { site, own, seen: first as u32..(first + n_seen) as u32 });
            }
        }
        edges
    }
}

impl Standing {
    /// Depth below the level of gear at `heights` \[m\], each point for itself.
    #[inline(always)]
    pub fn depths(&self, heights: &[f64], depths: &mut Vec<f64>) {
        depths.clear();
        depths.extend(self.ground.iter().zip(heights).map(|(ground, height)| ground - height));
    }
}

impl Edges {
    /// Changes the depth below the ground \[m\] of points that are hardly covered from their own to what they see; `changed` is working space.
    #[inline(always)]
    pub fn see(&self, depths: &mut [f64], changed: &mut Vec<f64>) {
        changed.clear();
        changed.extend(self.edges.iter().map(|edge| {
            let seen = &self.seen[edge.seen.start as usize..edge.seen.end as usize];
            let seen = seen.iter().map(|&(site, weight)| weight * depths[site as usize]);
            edge.own * depths[edge.site as usize] + seen.sum::<f64>()
        }));
        for (edge, &depth) in self.edges.iter().zip(&*changed) {
            depths[edge.site as usize] = depth;
        }
    }
}
