//! Pairs of a level of large grains: with all smaller grains and among themselves.
//!
//! Every level has a grid with cells as wide as its own largest grains. A large grain looks for partners on the grid of its own
//! level and on those of all levels below, so nobody looks through small cells for large grains, nor through large cells for
//! small ones. The pairs of a level form slabs of their own, thick enough that again a pair ends in its slab or in the next one.

use crate::Domain;
use crate::cell_grid::{CellGrid, to_f64};
use crate::domain::Period;
use crate::leeway::{Leeways, nearest_on_the_way};
use crate::size_levels::SizeLevels;
use crate::slab::{Pair, Slab, layers_of_slabs};
use grouser_contact::{Memory, Precision, Real, Sphere};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Grains of a slab: pairs of large grains are few.
const GRAINS_PER_SLAB: usize = 2048;

/// The lists of one level above the lowest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "M: Memory<T>")]
pub(crate) struct LargeGrains<T: Real, M> {
    pub slabs: Vec<Slab<T, M>>,
    /// The last slab's pairs end in the first one.
    pub is_ring: bool,
}

/// Grains of one level, found by cell.
struct LevelGrid {
    grid: CellGrid,
    /// Grains (sorted order) cell by cell.
    members: Vec<u32>,
}

impl LevelGrid {
    fn new<P: Precision>(
        level: usize,
        levels: &SizeLevels,
        spheres: &[Sphere<P>],
        domain: &Domain,
        gap: f64,
    ) -> Self {
        let is_member = |&grain: &u32| levels.of(spheres[grain as usize].radius.to_f64()) == level;
        let members: Vec<u32> = (0..spheres.len() as u32).filter(is_member).collect();
        let bodies: Vec<Sphere<P>> = members.iter().map(|&grain| spheres[grain as usize]).collect();
        let mut grid = CellGrid::new(&bodies, domain, 2.0 * levels.largest(level) + gap);
        let cells: Vec<u32> = bodies.iter().map(|sphere| grid.cell_of(sphere)).collect();
        let order = grid.sort(&cells);
        Self { grid, members: order.into_iter().map(|place| members[place as usize]).collect() }
    }
}

/// Lists of all levels above the lowest, whose grid is `base`; pairs of two grains that sleep are left out.
pub(crate) fn lists_of_large_grains<P: Precision, M: Memory<P::Real>>(
    levels: &SizeLevels,
    base: &CellGrid,
    spheres: &[Sphere<P>],
    domain: &Domain,
    leeways: &Leeways<P::Coordinate>,
    is_asleep: &[bool],
) -> Vec<LargeGrains<P::Real, M>> {
    let grid = |level: usize| LevelGrid::new(level, levels, spheres, domain, leeways.widest_gap());
    let grids: Vec<LevelGrid> = (1..levels.n()).map(grid).collect();
    let period = domain.period();
    (1..levels.n())
        .map(|level| {
            let seek = Seek { level, levels, base, grids: &grids, spheres, period, leeways, is_asleep };
            seek.lists()
        })
        .collect()
}

/// What looking for the pairs of one level needs.
struct Seek<'a, P: Precision> {
    level: usize,
    levels: &'a SizeLevels,
    base: &'a CellGrid,
    grids: &'a [LevelGrid],
    spheres: &'a [Sphere<P>],
    period: Period<P::Coordinate>,
    leeways: &'a Leeways<P::Coordinate>,
    is_asleep: &'a [bool],
}

impl<P: Precision> Seek<'_, P> {
    fn lists<M: Memory<P::Real>>(&self) -> LargeGrains<P::Real, M> {
        let reach = 2.0 * self.levels.largest(self.level) + self.leeways.widest_gap();
        let thickness = (reach / self.base.slab_axis().1).ceil().max(1.0) as usize;
        let layer = self.base.counts[1] * self.base.counts[2];
        let ranges: Vec<std::ops::Range<u32>> = layers_of_slabs(self.base, GRAINS_PER_SLAB, thickness)
            .into_iter()
            .map(|layers| self.base.first[layers.start * layer]..self.base.first[layers.end * layer])
            .collect();
        let is_ring = self.base.is_slab_axis_periodic() && ranges.len() > 1;
        let mut members = self.grids[self.level - 1].members.clone();
        members.sort_unstable();
        // Pairs of each slab's large grains: those that stay or go on to the next slab, and those that the slab before owns.
        let found: Vec<[Vec<Pair>; 2]> = ranges
            .par_iter()
            .enumerate()
            .map(|(slab, range)| {
                let own = |grain: u32| members.partition_point(|&member| member < grain);
                let mut pairs = [Vec::new(), Vec::new()];
                for &grain in &members[own(range.start)..own(range.end)] {
                    self.pairs_of(grain, |pair| {
                        let there = ranges.partition_point(|range| range.end <= pair.grains()[1]);
                        pairs[owner(slab, there, ranges.len(), is_ring)].push(pair);
                    });
                }
                pairs
            })
            .collect();
        let slabs = ranges
            .par_iter()
            .enumerate()
            .map(|(slab, range)| {
                let mut pairs = found[slab][0].clone();
                pairs.extend_from_slice(&found[(slab + 1) % ranges.len()][1]);
                pairs.sort_by_key(|pair| pair.grains()[0]);
                Slab::of_pairs(range.start, range.end - range.start, Vec::new(), pairs)
            })
            .collect();
        LargeGrains { slabs, is_ring }
    }

    /// Pairs of one large grain: with every smaller one, and with those of its level that come after it.
    fn pairs_of(&self, grain: u32, mut take: impl FnMut(Pair)) {
        let sphere = &self.spheres[grain as usize];
        let (leeway, drift) = (self.leeways.of(grain as usize), self.leeways.drift_of(grain as usize));
        let sleeps = |grain: u32| self.is_asleep.get(grain as usize) == Some(&true);
        let mut look_at = |other_grain: u32| {
            if sleeps(grain) && sleeps(other_grain) {
                return;
            }
            let other = &self.spheres[other_grain as usize];
            let reach = sphere.radius + other.radius + leeway + self.leeways.of(other_grain as usize);
            let (difference, image) = self.period.nearest(sphere.position - other.position);
            let parting = drift - self.leeways.drift_of(other_grain as usize);
            if nearest_on_the_way(difference, parting) < reach * reach {
                take(Pair::new(grain, other_grain, image));
            }
        };
        let centre = to_f64(sphere);
        let widest =
            |level: usize| sphere.radius.to_f64() + self.levels.largest(level) + self.leeways.widest_gap();
        let of_base = P::Coordinate::from_f64(self.levels.largest(0));
        self.base.ranges_around(centre, widest(0), |range| {
            range.filter(|&other| self.spheres[other as usize].radius <= of_base).for_each(&mut look_at);
        });
        for level in 1..=self.level {
            let LevelGrid { grid, members } = &self.grids[level - 1];
            grid.ranges_around(centre, widest(level), |range| {
                for &other in &members[range.start as usize..range.end as usize] {
                    if level < self.level || other > grain {
                        look_at(other);
                    }
                }
            });
        }
    }
}

/// 0 where a pair between slabs `here` and `there` belongs to `here`, 1 where it belongs to the slab before.
fn owner(here: usize, there: usize, n_slabs: usize, is_ring: bool) -> usize {
    let next = if is_ring { (here + 1) % n_slabs } else { here + 1 };
    usize::from(there != here && there != next)
}

impl<T: Real, M: Memory<T>> LargeGrains<T, M> {
    /// What the pair of a grain `i` of this level and `j` remembers; `None` when it did not touch.
    pub fn recall(&self, i: u32, j: u32) -> Option<M> {
        // The pair lies in the slab of one of the two.
        [i, j].into_iter().find_map(|grain| {
            let slab = self.slabs.partition_point(|slab| slab.grains().end <= grain);
            let slab = self.slabs.get(slab)?;
            slab.recall(i, j).or_else(|| slab.recall(j, i).map(M::seen_from_the_other))
        })
    }
}
