//! How a slack belt lies around its wheels: which of its links are held, which hang, which are free.

use std::f64::consts::{FRAC_PI_2, PI};

use serde::{Deserialize, Serialize};

use super::Catenary;
use crate::gear::{Hull, Piece};

/// The way of a slack belt, counted in links from the point behind the rear wheel at the height of its axle.
#[derive(Clone, Debug, PartialEq)]
pub struct Lay {
    /// Pieces of the tightest way and how many links each takes, forwards below and back above.
    pieces: Vec<(Piece, f64)>,
    /// Links below the axles.
    n_lower: f64,
    n_shoes: usize,
    pitch: f64,
    /// Pitch with which the same links would lie tight \[m\].
    tight_pitch: f64,
}

/// The section of a slack belt below the axles, as it rests.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrackShape {
    /// Links from its rear end to the first joint; further joints follow a link apart.
    pub first: f64,
    /// Rear end, joints, front end (x, z) in the body's frame \[m\].
    pub points: Vec<[f64; 2]>,
}

/// Pitch with which `n_shoes` stiff links lie tight around circles (x, z, radius) \[m\]: chords on the wheels, straight between them.
pub fn tight_pitch(circles: &[[f64; 3]], n_shoes: usize) -> f64 {
    let hull = Hull::around(circles);
    let n = n_shoes.max(3) as f64;
    // A chord is at most 2/π of its arc: n = 2 on one circle.
    let (mut low, mut high) = (0.5 * hull.length() / n, hull.length() / n);
    for _ in 0..60 {
        let pitch = 0.5 * (low + high);
        if hull.pieces().iter().map(|p| n_links(p, pitch)).sum::<f64>() > n {
            low = pitch;
        } else {
            high = pitch;
        }
    }
    0.5 * (low + high)
}

/// Links of a pitch along a piece.
fn n_links(piece: &Piece, pitch: f64) -> f64 {
    match *piece {
        Piece::Line { length, .. } => length / pitch,
        Piece::Arc { radius, angle, .. } => angle / (2.0 * (pitch / (2.0 * radius)).min(1.0).asin()),
    }
}

/// Whether a direction of travel belongs to the part above the axles.
fn is_above(direction: f64) -> bool {
    (FRAC_PI_2..3.0 * FRAC_PI_2).contains(&direction)
}

impl Lay {
    /// `n_shoes` links of `pitch` \[m\] around circles (x, z, radius) \[m\].
    pub fn new(circles: &[[f64; 3]], n_shoes: usize, pitch: f64) -> Self {
        let tight_pitch = tight_pitch(circles, n_shoes);
        let (mut behind, mut before, mut above) = (Vec::new(), Vec::new(), Vec::new());
        for piece in Hull::around(circles).pieces().iter().flat_map(|piece| split(*piece)) {
            let middle = match piece {
                Piece::Line { direction, .. } => direction,
                Piece::Arc { from, angle, .. } => from + angle / 2.0,
            };
            let links = n_links(&piece, tight_pitch);
            let part = match is_above(middle) {
                true => &mut above,
                false if middle < PI => &mut before,
                false => &mut behind,
            };
            part.push((piece, links));
        }
        let lower = behind.into_iter().chain(before);
        let mut pieces: Vec<(Piece, f64)> = lower.collect();
        let n_lower = pieces.iter().map(|p| p.1).sum();
        pieces.extend(above);
        Self { pieces, n_lower, n_shoes, pitch, tight_pitch }
    }

    /// Length of the free section below the axles \[m\].
    pub fn lower_length(&self) -> f64 {
        self.n_lower * self.pitch
    }

    /// Links by which joint `k` lies ahead of the point behind the rear wheel after the belt has run by `travel` \[m\].
    fn place(&self, k: usize, travel: f64) -> f64 {
        let place = (k as f64 - travel / self.tight_pitch).rem_euclid(self.n_shoes as f64);
        if place >= self.n_shoes as f64 { 0.0 } else { place }
    }

    /// Free joints, rear first, with their places in links.
    pub fn free_joints(&self, travel: f64) -> Vec<(usize, f64)> {
        const NEXT_TO_THE_END: f64 = 1e-6; // such a joint is one with the end
        let is_free = |&(_, m): &(usize, f64)| m > NEXT_TO_THE_END && m < self.n_lower - NEXT_TO_THE_END;
        let mut free: Vec<(usize, f64)> =
            (0..self.n_shoes).map(|k| (k, self.place(k, travel))).filter(is_free).collect();
        free.sort_by(|a, b| a.1.total_cmp(&b.1));
        free
    }

    /// Lengths of the links between the ends and the free joints \[m\].
    pub fn lengths(&self, free: &[(usize, f64)]) -> Vec<f64> {
        let places = std::iter::once(0.0).chain(free.iter().map(|f| f.1)).chain([self.n_lower]);
        let places: Vec<f64> = places.collect();
        places.windows(2).map(|m| (m[1] - m[0]) * self.pitch).collect()
    }

    /// The lower section with its ends: free joints along `shape`, an earlier one, or along the tightest way.
    pub fn lower(&self, free: &[(usize, f64)], shape: Option<&TrackShape>) -> Vec<[f64; 2]> {
        let places = std::iter::once(0.0).chain(free.iter().map(|f| f.1)).chain([self.n_lower]);
        match shape {
            None => places.map(|m| self.tight(m)).collect(),
            Some(TrackShape { first, points }) => {
                let last = points.len() - 1;
                let place = |n: usize| match n {
                    0 => 0.0,
                    n if n == last => self.n_lower,
                    n => first + (n - 1) as f64,
                };
                let mut n = 0;
                places
                    .map(|m| {
                        while n + 1 < last && place(n + 1) < m {
                            n += 1;
                        }
                        let t = ((m - place(n)) / (place(n + 1) - place(n)).max(1e-12)).clamp(0.0, 1.0);
                        [0, 1].map(|k| points[n][k] + t * (points[n + 1][k] - points[n][k]))
                    })
                    .collect()
            }
        }
    }

    /// All joints (x, z) \[m\], with free ones on the lower section `lower` as [`Self::lower`] gives it; `down` points along gravity.
    pub fn joints(&self, travel: f64, lower: &[[f64; 2]], down: [f64; 2]) -> Vec<[f64; 2]> {
        let free = self.free_joints(travel);
        let mut joints: Vec<[f64; 2]> =
            (0..self.n_shoes).map(|k| self.upper(self.place(k, travel), down)).collect();
        for ((k, _), point) in free.iter().zip(&lower[1..]) {
            joints[*k] = *point;
        }
        joints
    }

    /// The piece at a place and the share of its links that lie behind.
    fn piece(&self, place: f64) -> (&Piece, f64, f64) {
        let mut left = place;
        let last = self.pieces.len() - 1;
        for (n, (piece, links)) in self.pieces.iter().enumerate() {
            if left <= *links || n == last {
                return (piece, if *links > 0.0 { (left / links).clamp(0.0, 1.0) } else { 0.0 }, *links);
            }
            left -= links;
        }
        (&self.pieces[last].0, 1.0, 0.0)
    }

    fn tight(&self, place: f64) -> [f64; 2] {
        let (piece, share, _) = self.piece(place);
        piece.at(share * piece.length()).position
    }

    fn upper(&self, place: f64, down: [f64; 2]) -> [f64; 2] {
        let (piece, share, links) = self.piece(place);
        let Piece::Line { direction, .. } = piece else { return self.tight(place) };
        if !is_above(*direction) {
            return self.tight(place);
        }
        // Hanging freely in axes that stand upright.
        let into = |p: [f64; 2]| [-down[1] * p[0] + down[0] * p[1], -down[0] * p[0] - down[1] * p[1]];
        let back = |p: [f64; 2]| [-down[1] * p[0] - down[0] * p[1], down[0] * p[0] - down[1] * p[1]];
        let [from, to] = [0.0, piece.length()].map(|s| into(piece.at(s).position));
        back(Catenary::new(from, to, links * self.pitch).at(share))
    }
}

/// An arc cut where it passes the height of its axle.
fn split(piece: Piece) -> Vec<Piece> {
    let Piece::Arc { centre, radius, from, angle } = piece else { return vec![piece] };
    let mut cuts = vec![from];
    cuts.extend([FRAC_PI_2, 3.0 * FRAC_PI_2].into_iter().filter(|c| *c > from && *c < from + angle));
    cuts.push(from + angle);
    cuts.windows(2).map(|c| Piece::Arc { centre, radius, from: c[0], angle: c[1] - c[0] }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const CIRCLES: [[f64; 3]; 2] = [[-0.75, 0.0, 0.5], [0.75, 0.0, 0.5]];

    #[test]
    fn tight_links_are_chords() {
        // 2 · 1.5/p + 2π/(2 asin p) = 60
        let p = tight_pitch(&CIRCLES, 60);
        assert!((3.0 / p + PI / p.asin() - 60.0).abs() < 1e-9 && p < 0.102_360 && p > 0.1022, "{p}");
    }

    #[test]
    fn joints_stay_in_order_as_the_belt_runs_and_links_above_keep_their_length() {
        let pitch = tight_pitch(&CIRCLES, 60) * 1.003;
        let lay = Lay::new(&CIRCLES, 60, pitch);
        for travel in [0.0, 0.01, 0.07, 3.21] {
            let free = lay.free_joints(travel);
            let lengths = lay.lengths(&free);
            assert!((lengths.iter().sum::<f64>() - lay.lower_length()).abs() < 1e-12);
            assert!(lengths.iter().all(|l| *l > 0.0 && *l <= pitch * (1.0 + 1e-12)));
            let lower = lay.lower(&free, None);
            let joints = lay.joints(travel, &lower, [0.0, -1.0]);
            let link = |k: usize| {
                let (a, b): ([f64; 2], [f64; 2]) = (joints[k], joints[(k + 1) % 60]);
                (a[0] - b[0]).hypot(a[1] - b[1])
            };
            let is_free = |k: usize| free.iter().any(|f| f.0 == k);
            for k in (0..60).filter(|&k| !is_free(k) && !is_free((k + 1) % 60)) {
                assert!((link(k) / pitch - 1.0).abs() < 8e-3, "link {k}: {}", link(k));
            }
            let lowest = joints.iter().map(|j| j[1]).fold(f64::INFINITY, f64::min);
            assert!((lowest + 0.5).abs() < 1e-3);
        }
    }
}
