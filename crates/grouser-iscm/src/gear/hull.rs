//! The shortest way around circles: the line that the links of a tight belt follow.

use std::f64::consts::TAU;

/// A point of the way and its direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HullPoint {
    /// Position (x, z) in the bogie's plane \[m\].
    pub position: [f64; 2],
    /// Direction of travel \[rad\], anticlockwise from x in the x–z plane.
    pub direction: f64,
    /// Radius of curvature \[m\]; infinite on straight parts.
    pub radius: f64,
}

/// A piece of the way; directions as in [`HullPoint`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Piece {
    /// Around a wheel, from a direction on by an angle \[rad\].
    Arc {
        /// Centre (x, z) \[m\].
        centre: [f64; 2],
        /// Radius \[m\].
        radius: f64,
        /// Direction at its beginning \[rad\].
        from: f64,
        /// Angle \[rad\].
        angle: f64,
    },
    /// Between two wheels.
    Line {
        /// Beginning (x, z) \[m\].
        from: [f64; 2],
        /// Direction \[rad\].
        direction: f64,
        /// Length \[m\].
        length: f64,
    },
}

/// Closed convex way around circles, run anticlockwise: forwards below, backwards above.
#[derive(Clone, Debug, PartialEq)]
pub struct Hull {
    pieces: Vec<Piece>,
    length: f64,
}

impl Hull {
    /// The way around circles (x, z, radius) \[m\]; circles inside the way do not matter.
    pub fn around(circles: &[[f64; 3]]) -> Self {
        // A direction φ touches the circle whose support c·n + r is largest, n = (sin φ, −cos φ) the outward normal.
        let support = |c: &[f64; 3], direction: f64| c[0] * direction.sin() - c[1] * direction.cos() + c[2];
        let mut current = 0;
        for k in 1..circles.len() {
            if support(&circles[k], 0.0) > support(&circles[current], 0.0) + 1e-12
                || (support(&circles[k], 0.0) - support(&circles[current], 0.0)).abs() <= 1e-12
                    && circles[k][0] > circles[current][0]
            {
                current = k;
            }
        }
        let (mut pieces, mut direction, start) = (Vec::new(), 0.0, current);
        loop {
            let c = circles[current];
            // The next circle is the one whose outer tangent turns least.
            let mut next: Option<(f64, usize, f64)> = None;
            for (k, other) in circles.iter().enumerate() {
                let (dx, dz) = (other[0] - c[0], other[1] - c[1]);
                let distance = dx.hypot(dz);
                if k == current || distance <= (other[2] - c[2]).abs() + 1e-12 {
                    continue;
                }
                let tangent = dz.atan2(dx) + ((c[2] - other[2]) / distance).asin();
                let turn = (tangent - direction).rem_euclid(TAU);
                let turn = if turn > TAU - 1e-9 { 0.0 } else { turn };
                let straight = (distance * distance - (other[2] - c[2]).powi(2)).sqrt();
                let is_better = next.is_none_or(|(best, _, length)| {
                    turn < best - 1e-9 || (turn < best + 1e-9 && straight > length)
                });
                if is_better {
                    next = Some((turn, k, straight));
                }
            }
            let arc = |angle| Piece::Arc { centre: [c[0], c[1]], radius: c[2], from: direction, angle };
            let Some((turn, k, straight)) = next.filter(|n| direction + n.0 < TAU + 1e-9) else {
                pieces.push(arc(TAU - direction));
                break;
            };
            pieces.push(arc(turn));
            direction += turn;
            let from = [c[0] + c[2] * direction.sin(), c[1] - c[2] * direction.cos()];
            pieces.push(Piece::Line { from, direction, length: straight });
            current = k;
            if direction > TAU - 1e-9 {
                break; // back on the first circle
            }
            if pieces.len() > 8 * circles.len() + 8 {
                debug_assert!(current == start, "the way around circles did not close");
                break;
            }
        }
        let length = pieces.iter().map(Piece::length).sum();
        Self { pieces, length }
    }

    /// Length of the way \[m\].
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Its pieces, from s = 0 on.
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// The point at `s` \[m\] along the way; s = 0 lies lowest on the foremost of the lowest circles.
    pub fn at(&self, s: f64) -> HullPoint {
        let mut s = s.rem_euclid(self.length);
        let last = self.pieces.len() - 1;
        for (n, piece) in self.pieces.iter().enumerate() {
            if s > piece.length() && n < last {
                s -= piece.length();
                continue;
            }
            return piece.at(s);
        }
        HullPoint { position: [0.0; 2], direction: 0.0, radius: f64::INFINITY }
    }
}

impl Piece {
    /// The point at `s` \[m\] along the piece.
    pub fn at(&self, s: f64) -> HullPoint {
        match *self {
            Self::Arc { centre, radius, from, .. } => {
                let direction = from + s / radius;
                let (sin, cos) = direction.sin_cos();
                HullPoint {
                    position: [centre[0] + radius * sin, centre[1] - radius * cos],
                    direction,
                    radius,
                }
            }
            Self::Line { from, direction, .. } => HullPoint {
                position: [from[0] + s * direction.cos(), from[1] + s * direction.sin()],
                direction,
                radius: f64::INFINITY,
            },
        }
    }

    /// Length \[m\].
    pub fn length(&self) -> f64 {
        match *self {
            Self::Arc { radius, angle, .. } => radius * angle,
            Self::Line { length, .. } => length,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_around_one_and_two_wheels_has_the_known_length() {
        assert!((Hull::around(&[[0.3, 0.1, 0.5]]).length() - TAU * 0.5).abs() < 1e-12);
        let two = Hull::around(&[[-0.75, 0.0, 0.5], [0.75, 0.0, 0.5]]);
        assert!((two.length() - (TAU * 0.5 + 3.0)).abs() < 1e-12);
        let three = Hull::around(&[[-0.75, 0.0, 0.5], [0.0, 0.0, 0.5], [0.75, 0.0, 0.5]]);
        assert!((three.length() - two.length()).abs() < 1e-9);
        // Crossed belts are longer; for open belts L = 2 √(d² − Δr²) + π (r₁ + r₂) + 2 Δr asin(Δr/d).
        let (d, a, b) = (1.5_f64, 0.5, 0.3);
        let exact = 2.0 * (d * d - (a - b) * (a - b)).sqrt()
            + std::f64::consts::PI * (a + b)
            + 2.0 * (a - b) * ((a - b) / d).asin();
        assert!((Hull::around(&[[0.0, 0.0, a], [d, 0.0, b]]).length() - exact).abs() < 1e-12);
    }

    #[test]
    fn the_way_is_continuous_and_runs_forward_below() {
        let hull = Hull::around(&[[-0.75, 0.05, 0.5], [0.75, -0.02, 0.45]]);
        let n = 2000;
        for k in 0..n {
            let (a, b) = (
                hull.at(hull.length() * k as f64 / n as f64),
                hull.at(hull.length() * (k + 1) as f64 / n as f64),
            );
            let step = (b.position[0] - a.position[0]).hypot(b.position[1] - a.position[1]);
            assert!((step - hull.length() / n as f64).abs() < 1e-4 * step + 1e-9, "at {k}: {step}");
        }
        let lowest = (0..n)
            .map(|k| hull.at(hull.length() * k as f64 / n as f64))
            .min_by(|a, b| a.position[1].total_cmp(&b.position[1]));
        assert!(lowest.unwrap().direction.cos() > 0.99);
    }
}
