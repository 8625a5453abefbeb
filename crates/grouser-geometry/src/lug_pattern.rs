//! Lugs of a tread and where they lie around the tire.
//!
//! ```text
//!   left half  ▓▓▓▓▓______▓▓▓▓▓______     one pitch: a lug of `land` pitches and its groove;
//!   right half ______▓▓▓▓▓______▓▓▓▓▓     the other half of the tread is shifted by half a pitch
//! ```

use serde::{Deserialize, Serialize};

/// Pattern of the lugs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum LugPattern {
    /// No lugs: a closed crown of the same outer radius.
    Smooth,
    /// Lugs on the left and on the right half, shifted by half a pitch.
    Alternating {
        /// Lugs on each half around the tire.
        count: usize,
        /// Length of a lug around the tire over the pitch [-], in (0, 1): a road tire's is near 0.7, a field tire's near 0.3.
        land: f64,
    },
}

/// One lug and its groove around the tire, in cells of which two halves of a pitch have the same number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pitch {
    /// Cells of half a pitch.
    half: usize,
    /// Those of each half before the place where a lug ends.
    before_end: usize,
    /// The part of half a pitch that they cover.
    part: f64,
    /// Whether a lug covers a whole half and `part` of the other.
    is_long: bool,
}

impl Pitch {
    /// Half a pitch of `half` cells, at least two, under lugs of `land` times the pitch.
    pub fn new(half: usize, land: f64) -> Self {
        let is_long = land > 0.5;
        let part = if is_long { 2.0 * land - 1.0 } else { 2.0 * land };
        let before_end =
            if part < 1.0 { ((part * half as f64).round() as usize).clamp(1, half - 1) } else { half };
        Self { half, before_end, part, is_long }
    }

    /// Whether cell `a` around the tire lies under a lug of the half of the tread that begins with one, or of the other.
    pub fn is_lug(&self, a: usize, is_other: bool) -> bool {
        let first = (a / self.half + usize::from(is_other)).is_multiple_of(2);
        let before = a % self.half < self.before_end;
        if self.is_long { first || before } else { first && before }
    }

    /// Place of the edge before cell `a`, in cells of one width.
    pub fn place(&self, a: usize) -> f64 {
        let (start, cell) = (a - a % self.half, a % self.half);
        let (half, n) = (self.half as f64, self.before_end);
        let end = self.part * half;
        let within = if cell <= n {
            cell as f64 * (end / n as f64)
        } else {
            end + (cell - n) as f64 * (half - end) / (self.half - n) as f64
        };
        start as f64 + within
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lugs_of_both_halves_cover_their_land_and_end_at_edges_of_cells() {
        for land in [0.1, 0.25, 0.3, 0.5, 0.7, 0.9] {
            for half in [2, 3, 5] {
                let pitch = Pitch::new(half, land);
                for is_other in [false, true] {
                    let lug = |&a: &usize| pitch.is_lug(a, is_other);
                    let covered: f64 =
                        (0..2 * half).filter(lug).map(|a| pitch.place(a + 1) - pitch.place(a)).sum();
                    assert!((covered / (2 * half) as f64 - land).abs() < 1e-12, "{land} {half}: {covered}");
                    // One lug a pitch: covered cells follow one another.
                    let begins = (0..2 * half)
                        .filter(|&a| lug(&(a + 2 * half)) && !pitch.is_lug(a + 2 * half - 1, is_other));
                    assert_eq!(begins.count(), 1, "{land} {half}");
                }
                assert!((0..6 * half).all(|a| pitch.place(a) < pitch.place(a + 1)));
            }
        }
    }
}
