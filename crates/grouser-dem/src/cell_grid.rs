//! Cells of at least the interaction range: grains sorted by cell lie sorted in space.

use crate::Domain;
use grouser_contact::{Precision, Real, Sphere};
use grouser_geometry::Vec3;

/// Most cells per grain.
const CELLS_PER_GRAIN: usize = 8;

/// A regular grid over the bed. Cells are numbered slab by slab along the axis with the most cells, then row by row.
#[derive(Debug)]
pub(crate) struct CellGrid {
    origin: Vec3,
    inverse_edge: Vec3,
    /// World axis of each grid direction: slab, row, column.
    axes: [usize; 3],
    /// Number of cells along slab, row and column direction.
    pub counts: [usize; 3],
    is_periodic: [bool; 3],
    /// First grain of each cell; one more entry than cells.
    pub first: Vec<u32>,
}

impl CellGrid {
    /// Grid with cells of edge `range` or more [m] around the given grains, which must be finite. A few cells a grain at
    /// most: where grains are sparse, cells are larger.
    pub fn new<P: Precision>(spheres: &[Sphere<P>], domain: &Domain, mut range: f64) -> Self {
        let (mut lower, mut upper) = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
        for sphere in spheres {
            let place = to_f64(sphere);
            lower = lower.inf(&place);
            upper = upper.sup(&place);
        }
        for axis in 0..3 {
            if domain.is_periodic[axis] {
                (lower[axis], upper[axis]) = (domain.lower[axis], domain.upper[axis]);
            }
        }
        let extent = upper - lower;
        let most_cells = CELLS_PER_GRAIN * spheres.len() + 27;
        let count_at = |range: f64, axis: usize| ((extent[axis] / range).floor() as usize).clamp(1, 1 << 9);
        while (0..3).map(|axis| count_at(range, axis)).product::<usize>() > most_cells {
            range *= 1.25;
        }
        let count = |axis: usize| count_at(range, axis);
        let mut axes = [0, 1, 2];
        axes.sort_by_key(|&axis| std::cmp::Reverse(count(axis)));
        let counts = axes.map(count);
        let mut inverse_edge = Vec3::zeros();
        for direction in 0..3 {
            let axis = axes[direction];
            inverse_edge[axis] =
                if extent[axis] > 0.0 { counts[direction] as f64 / extent[axis] } else { 0.0 };
        }
        let is_periodic = axes.map(|axis| domain.is_periodic[axis]);
        Self { origin: lower, inverse_edge, axes, counts, is_periodic, first: Vec::new() }
    }

    /// World axis along which slabs follow each other, and the edge of a cell along it [m].
    pub fn slab_axis(&self) -> (usize, f64) {
        let axis = self.axes[0];
        (axis, if self.inverse_edge[axis] > 0.0 { 1.0 / self.inverse_edge[axis] } else { f64::INFINITY })
    }

    /// Number of the cell of a sphere.
    pub fn cell_of<P: Precision>(&self, sphere: &Sphere<P>) -> u32 {
        let place = (to_f64(sphere) - self.origin).component_mul(&self.inverse_edge);
        let index = |d: usize| (place[self.axes[d]].max(0.0) as usize).min(self.counts[d] - 1);
        ((index(0) * self.counts[1] + index(1)) * self.counts[2] + index(2)) as u32
    }

    /// Fills `first` and gives the order in which grains are sorted by cell; within a cell by their present order.
    pub fn sort(&mut self, cells: &[u32]) -> Vec<u32> {
        let n_cells = self.counts.iter().product::<usize>();
        self.first.clear();
        self.first.resize(n_cells + 1, 0);
        for &cell in cells {
            self.first[cell as usize + 1] += 1;
        }
        for cell in 0..n_cells {
            self.first[cell + 1] += self.first[cell];
        }
        let mut next = self.first.clone();
        let mut order = vec![0; cells.len()];
        for (grain, &cell) in cells.iter().enumerate() {
            let place = &mut next[cell as usize];
            order[*place as usize] = grain as u32;
            *place += 1;
        }
        order
    }

    /// The bed repeats along the direction in which slabs follow each other.
    pub fn is_slab_axis_periodic(&self) -> bool {
        self.is_periodic[0]
    }

    /// Index of the neighbour `offset` cells away along grid direction `direction`, if there is one.
    pub fn neighbour(&self, direction: usize, index: usize, offset: isize) -> Option<usize> {
        let count = self.counts[direction] as isize;
        let there = index as isize + offset;
        if self.is_periodic[direction] {
            Some(there.rem_euclid(count) as usize)
        } else {
            (0..count).contains(&there).then_some(there as usize)
        }
    }

    /// Calls `visit` with every cell around `cell`, some of them more than once where there are few.
    pub fn visit_cells_around(&self, cell: usize, mut visit: impl FnMut(usize)) {
        let [_, n_rows, n_columns] = self.counts;
        let place = [cell / (n_rows * n_columns), cell / n_columns % n_rows, cell % n_columns];
        for offset in 0..27 {
            let there = |direction: usize, digit: isize| {
                self.neighbour(direction, place[direction], offset / digit % 3 - 1)
            };
            if let (Some(slab), Some(row), Some(column)) = (there(0, 9), there(1, 3), there(2, 1)) {
                visit((slab * n_rows + row) * n_columns + column);
            }
        }
    }

    /// Calls `visit` with ranges of grains (in sorted order) that hold every grain whose centre lies within `reach` [m] of
    /// `centre` along each axis.
    pub fn ranges_around(&self, centre: Vec3, reach: f64, mut visit: impl FnMut(std::ops::Range<u32>)) {
        // First and last cell of each direction; along a period they may lie outside the counts.
        let mut spans = [(0, 0); 3];
        for direction in 0..3 {
            let axis = self.axes[direction];
            let count = self.counts[direction] as isize;
            let cell = |place: f64| ((place - self.origin[axis]) * self.inverse_edge[axis]).floor() as isize;
            let (from, to) = (cell(centre[axis] - reach), cell(centre[axis] + reach));
            spans[direction] = match self.is_periodic[direction] {
                true if to - from + 1 >= count => (0, count - 1),
                true => (from, to),
                // What lies outside the grid is sorted into its outermost cells.
                false => (from.clamp(0, count - 1), to.clamp(0, count - 1)),
            };
        }
        let wrapped =
            |direction: usize, index: isize| index.rem_euclid(self.counts[direction] as isize) as usize;
        let [slabs, rows, (from, to)] = spans;
        for slab in slabs.0..=slabs.1 {
            for row in rows.0..=rows.1 {
                let base = (wrapped(0, slab) * self.counts[1] + wrapped(1, row)) * self.counts[2];
                let mut columns = |from: usize, to: usize| {
                    let range = self.first[base + from]..self.first[base + to + 1];
                    if !range.is_empty() {
                        visit(range);
                    }
                };
                let (first, last) = (wrapped(2, from), wrapped(2, to));
                if first <= last {
                    columns(first, last);
                } else {
                    columns(first, self.counts[2] - 1);
                    columns(0, last);
                }
            }
        }
    }

    /// Calls `visit` with ranges of grains (in sorted order) that hold every possible partner of grains in the cell
    /// (`slab`, `row`, `column`), each pair of cells once; the cell itself is not among them.
    pub fn forward_ranges(
        &self,
        [slab, row, column]: [usize; 3],
        mut visit: impl FnMut(std::ops::Range<u32>),
    ) {
        let mut columns = |slab: usize, row: usize, offsets: std::ops::RangeInclusive<isize>| {
            let base = (slab * self.counts[1] + row) * self.counts[2];
            // Neighbouring columns are neighbours in memory: joined into one range unless the period parts them.
            let mut joined: Option<(usize, usize)> = None;
            for offset in offsets {
                let Some(there) = self.neighbour(2, column, offset) else { continue };
                joined = match joined {
                    Some((from, to)) if to + 1 == there => Some((from, there)),
                    Some((from, to)) => {
                        visit(self.first[base + from]..self.first[base + to + 1]);
                        Some((there, there))
                    }
                    None => Some((there, there)),
                };
            }
            if let Some((from, to)) = joined {
                visit(self.first[base + from]..self.first[base + to + 1]);
            }
        };
        columns(slab, row, 1..=1);
        if let Some(next_row) = self.neighbour(1, row, 1) {
            columns(slab, next_row, -1..=1);
        }
        if let Some(next_slab) = self.neighbour(0, slab, 1) {
            for offset in -1..=1 {
                if let Some(there) = self.neighbour(1, row, offset) {
                    columns(next_slab, there, -1..=1);
                }
            }
        }
    }
}

/// The centre in double precision [m].
pub(crate) fn to_f64<P: Precision>(sphere: &Sphere<P>) -> Vec3 {
    let place = sphere.position;
    Vec3::new(place.x.to_f64(), place.y.to_f64(), place.z.to_f64())
}
