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

    /// Blocks within `reach` [m] of a box, which may reach beyond a period; by rising number.
    pub fn within(&self, [lower, upper]: &[Vec3; 2], reach: f64) -> Vec<usize> {
        // Along each axis the blocks in question, and their distance from the box [m].
        let spans = [0, 1, 2].map(|axis| {
            let (from, to) = (self.index(axis, lower[axis] - reach), self.index(axis, upper[axis] + reach));
            let edge = 1.0 / self.inverse_edge[axis];
            (from.max(to - 2 * MOST_BLOCKS as isize)..=to)
                .map(|index| {
                    let low = self.lower[axis] + index as f64 * edge;
                    let gap = (lower[axis] - (low + edge)).max(low - upper[axis]).max(0.0);
                    (self.inside(axis, index), gap)
                })
                .collect::<Vec<_>>()
        });
        let mut found = Vec::new();
        for &(z, gap_z) in &spans[2] {
            for &(y, gap_y) in &spans[1] {
                let near = |&&(_, gap_x): &&(usize, f64)| Vec3::new(gap_x, gap_y, gap_z).norm() <= reach;
                found.extend(spans[0].iter().filter(near).map(|&(x, _)| self.number([x, y, z])));
            }
        }
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Blocks that a box of half the width `reach` [m] around `centre` meets; some of them twice where the box is small.
    pub fn around(&self, centre: Vec3, reach: f64) -> impl Iterator<Item = usize> {
        let span = move |axis: usize| {
            self.index(axis, centre[axis] - reach)..=self.index(axis, centre[axis] + reach)
        };
        let inside = move |axis: usize| move |index| self.inside(axis, index);
        span(2).map(inside(2)).flat_map(move |z| {
            span(1)
                .map(inside(1))
                .flat_map(move |y| span(0).map(inside(0)).map(move |x| self.number([x, y, z])))
        })
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
        let across = blocks.within(&[Vec3::new(3.5, 0.5, 0.5), Vec3::new(4.5, 0.6, 0.6)], 0.0);
        assert_eq!(across, [blocks.of(Vec3::new(0.5, 0.5, 0.5)), blocks.of(Vec3::new(3.5, 0.5, 0.5))]);
    }

    #[test]
    fn what_is_within_reach_of_a_box_has_round_corners() {
        let blocks = blocks();
        let middle = [Vec3::new(1.5, 2.5, 1.5); 2];
        // The own block, its six sides at 0.5, its twelve edges at 0.71, its eight corners at 0.87.
        let counts = [0.4, 0.6, 0.8, 0.9].map(|reach| blocks.within(&middle, reach).len());
        assert_eq!(counts, [1, 7, 19, 27]);
    }

    #[test]
    fn around_a_place_are_its_own_block_and_those_within_reach() {
        let blocks = blocks();
        let count = |centre, reach| {
            let mut found: Vec<usize> = blocks.around(centre, reach).collect();
            found.sort_unstable();
            found.dedup();
            found.len()
        };
        assert_eq!(count(Vec3::new(1.5, 1.5, 1.5), 0.4), 1);
        assert_eq!(count(Vec3::new(1.5, 1.5, 1.9), 0.4), 2);
        assert_eq!(count(Vec3::new(1.9, 1.9, 1.9), 0.4), 8);
        // Around the period of x, and cut off at the open faces of y and z.
        assert_eq!(count(Vec3::new(0.1, 0.1, 0.1), 0.4), 2);
        assert_eq!(count(Vec3::new(1.5, 2.5, 1.5), 1.0), 27);
    }
}
