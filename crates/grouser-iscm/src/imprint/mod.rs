//! Grid model of running gear: the height of its underside at the points of the ground (P2 §2.3.1).
//!
//! An [`Imprint`] covers a window of the terrain grid. Cylinders, plates and triangle surfaces are drawn into it.

mod cylinder;
mod plate;
mod surface;

use grouser_geometry::{HeightGrid, Vec3};

pub use plate::Plate;

use crate::polygon::PartialLoad;

/// Underside of running gear at one point of the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImprintNode {
    /// Share of the point's cell that the gear covers (0…1).
    pub coverage: f64,
    /// Height of the underside \[m\].
    pub height: f64,
    /// Slope of the underside ∂h/∂x, ∂h/∂y \[-\].
    pub slope: [f64; 2],
    /// Which object of the gear lies here.
    pub owner: u16,
    /// Whether the point itself lies within the outline of the gear.
    pub is_inside: bool,
    /// Whether `height` is known: also just beyond the edge of the gear, where it is carried on.
    pub is_known: bool,
}

/// Most that an underside sags between points, per distance of the points.
pub(crate) const MOST_SAG: f64 = 0.125;

const EMPTY: ImprintNode = ImprintNode {
    coverage: 0.0,
    height: f64::INFINITY,
    slope: [0.0; 2],
    owner: 0,
    is_inside: false,
    is_known: false,
};

/// Grid model over a window of the terrain grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Imprint {
    /// First node of the window along x.
    pub i_0: usize,
    /// First node of the window along y.
    pub j_0: usize,
    /// Nodes of the window along x.
    pub n_x: usize,
    /// Nodes of the window along y.
    pub n_y: usize,
    /// Nodes of the window, x fastest.
    pub nodes: Vec<ImprintNode>,
    pub(crate) spacing: f64,
    origin: [f64; 2],
    ceiling: f64,
    partial: PartialLoad,
}

impl Imprint {
    /// An empty imprint over the nodes in and around the box from `min` to `max` \[m\]; undersides above `ceiling` \[m\] are left out.
    pub fn new(grid: &HeightGrid, min: [f64; 2], max: [f64; 2], ceiling: f64, partial: PartialLoad) -> Self {
        let d = grid.spacing();
        let [is, js] = Self::window(grid, min, max);
        let (i_0, n_x, j_0, n_y) = (is.start, is.len(), js.start, js.len());
        let origin = [grid.origin()[0] + d * i_0 as f64, grid.origin()[1] + d * j_0 as f64];
        Self { i_0, j_0, n_x, n_y, nodes: vec![EMPTY; n_x * n_y], spacing: d, origin, ceiling, partial }
    }

    /// Columns and rows of the grid in and around the box from `min` to `max` \[m\].
    pub(crate) fn window(grid: &HeightGrid, min: [f64; 2], max: [f64; 2]) -> [std::ops::Range<usize>; 2] {
        let d = grid.spacing();
        let n = [grid.n_x(), grid.n_y()];
        [0, 1].map(|k| {
            let (low, high) = ((min[k] - grid.origin()[k]) / d, (max[k] - grid.origin()[k]) / d);
            let first = (low.floor() - 1.0).clamp(0.0, n[k] as f64) as usize;
            let end = ((high.ceil() + 1.0).clamp(-1.0, (n[k] - 1) as f64) + 1.0) as usize;
            first..end.max(first)
        })
    }

    /// Whether the gear covers no node.
    pub fn is_empty(&self) -> bool {
        self.nodes.iter().all(|n| n.coverage == 0.0)
    }

    /// Position of node (`i`, `j`) of the window \[m\].
    #[inline(always)]
    pub fn position(&self, i: usize, j: usize) -> [f64; 2] {
        [self.origin[0] + self.spacing * i as f64, self.origin[1] + self.spacing * j as f64]
    }

    /// By how much the underside lies below the straight lines between three nodes, at most at the middle of each: four times that \[m\].
    ///
    /// Along a side whose slope changes by Δs over Δr a parabola sags by Δs·Δr/8; different objects are not joined by one.
    #[inline(always)]
    pub(crate) fn sag(&self, [p, q, r]: [(usize, usize); 3]) -> [f64; 3] {
        let along = |a: (usize, usize), b: (usize, usize)| {
            let (from, to) = (&self.nodes[a.1 * self.n_x + a.0], &self.nodes[b.1 * self.n_x + b.0]);
            if from.owner != to.owner || !from.is_known || !to.is_known {
                return 0.0;
            }
            let way = [b.0 as f64 - a.0 as f64, b.1 as f64 - a.1 as f64];
            let turn = [to.slope[0] - from.slope[0], to.slope[1] - from.slope[1]];
            let most = 4.0 * MOST_SAG * self.spacing;
            (0.5 * self.spacing * (turn[0] * way[0] + turn[1] * way[1])).clamp(-most, most)
        };
        [along(p, q), along(q, r), along(r, p)]
    }

    /// Window indices of the nodes within the box from `min` to `max` \[m\]: i and j ranges.
    fn range(&self, min: [f64; 2], max: [f64; 2]) -> [std::ops::Range<usize>; 2] {
        let along = |k: usize, n: usize| {
            let low = ((min[k] - self.origin[k]) / self.spacing).ceil().clamp(0.0, n as f64) as usize;
            let high =
                (((max[k] - self.origin[k]) / self.spacing).floor() + 1.0).clamp(0.0, n as f64) as usize;
            low..high.max(low)
        };
        [along(0, self.n_x), along(1, self.n_y)]
    }

    /// Adds an object at a node: coverages add up, heights and slopes average by coverage.
    #[inline(always)]
    fn add(
        &mut self,
        node: usize,
        (coverage, is_inside): (f64, bool),
        height: f64,
        slope: [f64; 2],
        owner: u16,
    ) {
        let old = &mut self.nodes[node];
        if old.coverage == 0.0 {
            *old = ImprintNode { coverage, height, slope, owner, is_inside, is_known: true };
            return;
        }
        match self.partial {
            PartialLoad::Step => {
                if height < old.height {
                    *old = ImprintNode { coverage, height, slope, owner, is_inside, is_known: true };
                }
            }
            PartialLoad::Proportional => {
                let (a, b) = (old.coverage / (old.coverage + coverage), coverage / (old.coverage + coverage));
                let owner = if coverage > old.coverage { owner } else { old.owner };
                *old = ImprintNode {
                    coverage: (old.coverage + coverage).min(1.0),
                    height: a * old.height + b * height,
                    slope: [a * old.slope[0] + b * slope[0], a * old.slope[1] + b * slope[1]],
                    owner,
                    is_inside: old.is_inside || is_inside,
                    is_known: true,
                };
            }
        }
    }

    /// Carries the underside on by one node beyond the edge of the gear, parallel to the `ground`'s undisturbed heights.
    ///
    /// The soil under a vertical edge lies at full depth up to the edge; without this it would rise within one cell. Points that are hardly
    /// covered lie in between, and neighbours count by what is covered of them, so that no height jumps as the edge passes a point.
    pub fn carry_edges(&mut self, ground: &HeightGrid) {
        if self.partial == PartialLoad::Step {
            return;
        }
        let heights = ground.heights();
        let at = |i: usize, j: usize| heights[(self.j_0 + j) * ground.n_x() + self.i_0 + i];
        let mut carried = Vec::new();
        let covered: Vec<u8> = self.nodes.iter().map(|node| u8::from(node.coverage > 0.0)).collect();
        let is_near = spread(&covered, self.n_x);
        for j in 0..self.n_y {
            for i in 0..self.n_x {
                let own = self.nodes[j * self.n_x + i];
                if own.coverage >= HARDLY_COVERED || is_near[j * self.n_x + i] == 0 {
                    continue;
                }
                let (mut sum, mut depth, mut slope, mut largest) = (0.0, 0.0, [0.0; 2], (0.0, own.owner));
                for (di, dj) in AROUND {
                    let (a, b) = (i.wrapping_add_signed(di), j.wrapping_add_signed(dj));
                    if a >= self.n_x || b >= self.n_y {
                        continue;
                    }
                    let near = &self.nodes[b * self.n_x + a];
                    if near.coverage > 0.0 {
                        let weight = near.coverage * if di == 0 || dj == 0 { 1.0 } else { ACROSS };
                        sum += weight;
                        depth += weight * (near.height - at(a, b));
                        slope = [slope[0] + weight * near.slope[0], slope[1] + weight * near.slope[1]];
                        if weight > largest.0 {
                            largest = (weight, near.owner);
                        }
                    }
                }
                if sum > 0.0 {
                    let own_share = own.coverage / HARDLY_COVERED;
                    let blend = |own: f64, carried: f64| match own_share {
                        0.0 => carried,
                        share => share * own + (1.0 - share) * carried,
                    };
                    let node = ImprintNode {
                        coverage: own.coverage,
                        height: blend(own.height, at(i, j) + depth / sum),
                        slope: [0, 1].map(|k| blend(own.slope[k], slope[k] / sum)),
                        owner: if own.coverage > 0.0 { own.owner } else { largest.1 },
                        is_inside: own.is_inside,
                        is_known: true,
                    };
                    carried.push((j * self.n_x + i, node));
                }
            }
        }
        for (n, node) in carried {
            self.nodes[n] = node;
        }
    }
}

/// What each node of a window with rows of `n_x` or one of its neighbours has, bit by bit.
pub(crate) fn spread(bits: &[u8], n_x: usize) -> Vec<u8> {
    let or = |to: &mut [u8], from: &[u8]| to.iter_mut().zip(from).for_each(|(to, from)| *to |= from);
    let mut in_rows = bits.to_vec();
    for (row, of) in in_rows.chunks_mut(n_x.max(1)).zip(bits.chunks(n_x.max(1))) {
        or(&mut row[1..], of);
        or(row, &of[1..]);
    }
    let mut spread = in_rows.clone();
    or(&mut spread[n_x.min(bits.len())..], &in_rows);
    or(&mut spread, &in_rows[n_x.min(bits.len())..]);
    spread
}

/// Share of a cell below which the height of the gear there is partly carried on from its neighbours.
pub(crate) const HARDLY_COVERED: f64 = 0.25;
/// Weight of a neighbour across the corner, where one along the axes counts one.
pub(crate) const ACROSS: f64 = 0.05;
/// The neighbours of a point.
pub(crate) const AROUND: [(isize, isize); 8] =
    [(-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (1, -1), (-1, 1), (1, 1)];

/// Width of a cell of the grid along a horizontal direction, per spacing: 1 along the axes, √2 across.
///
/// With it, rows of points cover a strip by its exact width along the axes and across, and nearly so in between.
#[inline(always)]
fn cell_width(direction: &Vec3) -> f64 {
    let horizontal = direction.x.hypot(direction.y);
    (direction.x.abs() + direction.y.abs()) / (horizontal * horizontal).max(1e-12)
}

/// Share of the interval of `width` around `u` that lies within `low` to `high`.
#[inline(always)]
fn overlap(u: f64, width: f64, low: f64, high: f64) -> f64 {
    (((u + width / 2.0).min(high) - (u - width / 2.0).max(low)) / width).clamp(0.0, 1.0)
}
