//! Blocks of the box: the pieces that fall asleep and wake as a whole.

use crate::Domain;
use grouser_geometry::Vec3;
use serde::{Deserialize, Serialize};

/// A regular grid over the whole box; what lies beyond an open face counts to the outermost block.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Blocks {
    lower: Vec3,
    inverse_edge: Vec3,
    counts: [usize; 3],
    is_periodic: [bool; 3],
}

/// Most blocks along one axis.
const MOST_BLOCKS: usize = 256;

impl Blocks {
    /// Blocks of about `edge` [m].
    pub fn new(domain: &Domain, edge: f64) -> Self {
        let size = domain.size();
        let counts = [0, 1, 2].map(|axis| ((size[axis] / edge) as usize).clamp(1, MOST_BLOCKS));
        let inverse_edge = Vec3::from_fn(|axis, _| counts[axis] as f64 / size[axis]);
        Self { lower: domain.lower, inverse_edge, counts, is_periodic: domain.is_periodic }
    }

    /// Number of blocks.
    pub fn n(&self) -> usize {
        self.counts.iter().product()
    }

    fn index(&self, axis: usize, place: f64) -> isize {
        ((place - self.lower[axis]) * self.inverse_edge[axis]).floor() as isize
    }

    fn inside(&self, axis: usize, index: isize) -> usize {
        let count = self.counts[axis] as isize;
        let inside = if self.is_periodic[axis] { index.rem_euclid(count) } else { index.clamp(0, count - 1) };
        inside as usize
    }

    fn number(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.counts[1] + y) * self.counts[0] + x
    }

    /// The block of a place.
    pub fn of(&self, place: Vec3) -> usize {
        self.number([0, 1, 2].map(|axis| self.inside(axis, self.index(axis, place[axis]))))
    }

    /// Blocks that a box meets, which may reach beyond a period.
    pub fn in_box(&self, [lower, upper]: &[Vec3; 2]) -> Vec<usize> {
        let spans = [0, 1, 2].map(|axis| {
            let (from, to) = (self.index(axis, lower[axis]), self.index(axis, upper[axis]));
            let mut span: Vec<usize> = (from.max(to - 2 * MOST_BLOCKS as isize)..=to)
                .map(|index| self.inside(axis, index))
                .collect();
            span.sort_unstable();
            span.dedup();
            span
        });
        let mut found = Vec::new();
        for &z in &spans[2] {
            for &y in &spans[1] {
                found.extend(spans[0].iter().map(|&x| self.number([x, y, z])));
            }
        }
        found
    }

    /// Flags whatever is flagged or lies within `reach` [m] of a flagged block.
    pub fn grown(&self, mut flags: Vec<bool>, reach: f64) -> Vec<bool> {
        for axis in 0..3 {
            let n = (reach * self.inverse_edge[axis]).ceil() as isize;
            let before = flags.clone();
            for block in (0..self.n()).filter(|&block| before[block]) {
                let mut place = self.place(block);
                let own = place[axis] as isize;
                let count = self.counts[axis] as isize;
                for offset in -n.min(count)..=n.min(count) {
                    let there = own + offset;
                    if self.is_periodic[axis] || (0..count).contains(&there) {
                        place[axis] = self.inside(axis, there);
                        flags[self.number(place)] = true;
                    }
                }
            }
        }
        flags
    }

    fn place(&self, block: usize) -> [usize; 3] {
        let [nx, ny, _] = self.counts;
        [block % nx, block / nx % ny, block / (nx * ny)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn blocks() -> Blocks {
        let upper = Vec3::new(4.0, 5.0, 3.0);
        Blocks::new(&Domain { lower: Vec3::zeros(), upper, is_periodic: [true, false, false] }, 1.0)
    }

    #[test]
    fn places_beyond_a_period_come_back_and_those_beyond_an_open_face_stay_at_it() {
        let blocks = blocks();
        assert_eq!(blocks.of(Vec3::new(4.5, 0.5, 0.5)), blocks.of(Vec3::new(0.5, -7.0, 0.5)));
        assert_eq!(blocks.of(Vec3::new(0.5, 4.5, 2.5)), blocks.of(Vec3::new(-3.5, 9.0, 9.0)));
        let across = blocks.in_box(&[Vec3::new(3.5, 0.5, 0.5), Vec3::new(4.5, 0.6, 0.6)]);
        assert_eq!(across, [blocks.of(Vec3::new(0.5, 0.5, 0.5)), blocks.of(Vec3::new(3.5, 0.5, 0.5))]);
    }

    #[test]
    fn growing_goes_around_a_period_and_ends_at_an_open_face() {
        let blocks = blocks();
        let mut flags = vec![false; blocks.n()];
        flags[blocks.of(Vec3::new(0.5, 0.5, 0.5))] = true;
        let grown = blocks.grown(flags, 0.9);
        // Three of four along x, two of five along y, two of three along z.
        assert_eq!(grown.iter().filter(|flag| **flag).count(), 12);
        assert!(grown[blocks.of(Vec3::new(3.5, 1.5, 1.5))] && !grown[blocks.of(Vec3::new(2.5, 0.5, 0.5))]);
    }
}
