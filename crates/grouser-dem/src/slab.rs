//! A slab of the sorted bed: the grains of some cell layers and the pairs that start there.
//!
//! A pair that starts in slab s ends in s or in s + 1, so a grain of slab s receives forces from the passes over s − 1
//! and over s alone. The order in which slabs are worked on is the matter of [`crate::sweep`].

use crate::candidates::{Candidates, Found};
use crate::cell_grid::CellGrid;
use crate::domain::Period;
use crate::plane::PlaneList;
use grouser_contact::{ContactLedger, Memory, Precision, Real, Sphere};
use serde::{Deserialize, Serialize};

/// Two grains that may touch: the first one, and the second one together with the periodic image that is near.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Pair {
    first: u32,
    second_and_image: u32,
}

/// Bits that number a grain; the other five number one of 27 images.
const GRAIN_BITS: u32 = 27;
/// One more than the largest number of a grain.
pub(crate) const MOST_GRAINS: usize = 1 << GRAIN_BITS;

impl Pair {
    pub fn new(first: u32, second: u32, image: u32) -> Self {
        Self { first, second_and_image: second | image << GRAIN_BITS }
    }

    /// The two grains (sorted order).
    #[inline(always)]
    pub fn grains(self) -> [u32; 2] {
        [self.first, self.second_and_image & (MOST_GRAINS as u32 - 1)]
    }

    /// Number of the image of the second grain that is near.
    #[inline(always)]
    pub fn image(self) -> usize {
        (self.second_and_image >> GRAIN_BITS) as usize
    }

    /// No image of a second grain is nearer than the grain itself.
    #[inline(always)]
    pub fn are_within_the_box(pairs: &[Self]) -> bool {
        let differing =
            |bits, pair: &Self| bits | (pair.second_and_image ^ Period::<f64>::ITSELF << GRAIN_BITS);
        pairs.iter().fold(0, differing) >> GRAIN_BITS == 0
    }
}

/// Pairs of one slab, with the memory of each.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(bound = "M: Memory<T>")]
pub(crate) struct Slab<T: Real, M> {
    /// First grain of the slab (sorted order).
    pub first_grain: u32,
    /// Number of grains of the slab.
    pub n_grains: u32,
    /// First pair of each grain of the slab, one more entry than grains; nothing where pairs are found by their order alone.
    pub rows: Vec<u32>,
    /// Grains that may touch before the next rebuild, by rising first grain.
    pub pairs: Vec<Pair>,
    /// What each pair remembers; zero where it does not touch.
    pub memory: Vec<M>,
    /// One bit a pair, 64 pairs a word: it touched at the last force pass.
    pub touched: Vec<u64>,
    /// Grains of the slab near each plane.
    pub planes: Vec<PlaneList<T, M>>,
    /// What the last force pass summed up.
    pub sums: SlabSums,
}

/// Sums of one force pass over one slab.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct SlabSums {
    /// Energies of the slab's contacts.
    pub ledger: ContactLedger,
    /// Some overlap is larger than [`crate::LARGEST_OVERLAP`] allows.
    pub is_too_deep: bool,
}

impl<T: Real, M: Memory<T>> Slab<T, M> {
    /// Pairs of `candidates`, grains up to `largest` [m] that may come to touch, of the cell layers `layers`. Pairs of two
    /// grains that sleep are left out; `is_asleep` is empty where nobody does.
    pub fn build<P: Precision<Real = T>>(
        grid: &CellGrid,
        layers: std::ops::Range<usize>,
        spheres: &[Sphere<P>],
        candidates: &Candidates<P::Coordinate>,
        largest: P::Coordinate,
        is_asleep: &[bool],
    ) -> Self {
        let [_, n_rows, n_columns] = grid.counts;
        let layer = n_rows * n_columns;
        let first_grain = grid.first[layers.start * layer];
        let mut rows = vec![0];
        let mut found = Found::none();
        let mut ranges: Vec<std::ops::Range<u32>> = Vec::new();
        for cell in layers.start * layer..layers.end * layer {
            ranges.clear();
            let place = [cell / layer, cell / n_columns % n_rows, cell % n_columns];
            grid.forward_ranges(place, |range| ranges.push(range));
            for i in grid.first[cell]..grid.first[cell + 1] {
                let sphere = &spheres[i as usize];
                let first = found.pairs().len();
                if sphere.radius > largest {
                    rows.push(first as u32);
                    continue;
                }
                let seeker = candidates.seeker(i);
                let own = i + 1..grid.first[cell + 1];
                for range in std::iter::once(own).chain(ranges.iter().cloned()) {
                    candidates.look(&seeker, range, &mut found);
                }
                let pairs = found.pairs();
                if is_asleep.get(i as usize) == Some(&true) {
                    let mut kept = first;
                    for place in first..pairs.len() {
                        if !is_asleep[pairs[place].grains()[1] as usize] {
                            pairs[kept] = pairs[place];
                            kept += 1;
                        }
                    }
                    pairs.truncate(kept);
                }
                rows.push(pairs.len() as u32);
            }
        }
        let n_grains = rows.len() as u32 - 1;
        Self::of_pairs(first_grain, n_grains, rows, std::mem::take(found.pairs()))
    }

    /// A slab of given pairs, by rising first grain, none of which has touched yet.
    pub fn of_pairs(first_grain: u32, n_grains: u32, rows: Vec<u32>, mut pairs: Vec<Pair>) -> Self {
        pairs.shrink_to_fit();
        let memory = vec![M::default(); pairs.len()];
        let touched = vec![0; pairs.len().div_ceil(64)];
        let sums = SlabSums::default();
        Self { first_grain, n_grains, rows, pairs, memory, touched, planes: Vec::new(), sums }
    }

    /// The slab's grains (sorted order).
    pub fn grains(&self) -> std::ops::Range<u32> {
        self.first_grain..self.first_grain + self.n_grains
    }

    /// Places of the pairs whose first grain is `i`; with rows, `i` must be a grain of this slab.
    pub fn row(&self, i: u32) -> std::ops::Range<usize> {
        if self.rows.is_empty() {
            let place_of = |i| self.pairs.partition_point(|pair| pair.grains()[0] < i);
            return place_of(i)..place_of(i + 1);
        }
        let row = (i - self.first_grain) as usize;
        self.rows[row] as usize..self.rows[row + 1] as usize
    }

    /// Place of the pair (i, j), as [`Slab::row`].
    pub fn find(&self, i: u32, j: u32) -> Option<usize> {
        self.row(i).find(|&place| self.pairs[place].grains()[1] == j)
    }

    /// What the pair (i, j) remembers, as [`Slab::row`]; `None` when it did not touch.
    pub fn recall(&self, i: u32, j: u32) -> Option<M> {
        let place = self.find(i, j)?;
        self.has_touched(place).then(|| self.memory[place])
    }

    /// The pair at `place` touches and remembers `memory`.
    pub fn remember(&mut self, place: usize, memory: M) {
        self.memory[place] = memory;
        self.touched[place / 64] |= 1 << (place % 64);
    }

    /// The pair at `place` touched at the last force pass.
    pub fn has_touched(&self, place: usize) -> bool {
        self.touched[place / 64] >> (place % 64) & 1 == 1
    }

    /// Number of pairs that touched at the last force pass.
    pub fn n_touching(&self) -> usize {
        self.touched.iter().map(|word| word.count_ones() as usize).sum()
    }

    /// Memory held by this slab [bytes].
    pub fn bytes(&self) -> usize {
        4 * self.rows.capacity()
            + 8 * self.pairs.capacity()
            + size_of::<M>() * self.memory.capacity()
            + 8 * self.touched.capacity()
    }
}

/// Splits the cell layers into slabs of about `wanted` grains and at least `thickness` layers each; an even number of them
/// (or one) along a period.
pub(crate) fn layers_of_slabs(
    grid: &CellGrid,
    wanted: usize,
    thickness: usize,
) -> Vec<std::ops::Range<usize>> {
    let (n_layers, layer) = (grid.counts[0], grid.counts[1] * grid.counts[2]);
    let n_grains = *grid.first.last().unwrap_or(&0) as usize;
    let mut n_slabs = (n_grains / wanted).clamp(1, (n_layers / thickness).max(1));
    if grid.is_slab_axis_periodic() && n_slabs > 1 {
        n_slabs -= n_slabs % 2;
    }
    let mut bounds = vec![0];
    for slab in 1..n_slabs {
        // The first layer before which this share of the grains lies, with room for the slabs on both sides.
        let share = slab * n_grains / n_slabs;
        let (mut from, mut to) = (bounds[slab - 1] + thickness, n_layers - (n_slabs - slab) * thickness);
        while from < to {
            let middle = (from + to) / 2;
            if (grid.first[middle * layer] as usize) < share { from = middle + 1 } else { to = middle }
        }
        bounds.push(from);
    }
    bounds.push(n_layers);
    bounds.windows(2).map(|pair| pair[0]..pair[1]).collect()
}
