//! The curve of a chain that hangs from both ends.

/// A uniform chain between two points of a plane, hanging along −z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Catenary {
    from: [f64; 2],
    to: [f64; 2],
    length: f64,
    /// Parameter of the curve z = a cosh(x/a) \[m\] and place of its lowest point; none where it is straight or upright.
    curve: Option<(f64, f64)>,
}

impl Catenary {
    /// A chain of `length` \[m\]; shorter ones than the straight line count as straight.
    pub fn new(from: [f64; 2], to: [f64; 2], length: f64) -> Self {
        let (h, v) = ((to[0] - from[0]).abs(), to[1] - from[1]);
        let straight = h.hypot(v);
        let mut curve = None;
        if length > straight * (1.0 + 1e-12) && h > 1e-9 * straight {
            // sinh(u)/u = √(L² − v²)/h with u = h/2a; from sinh(u)/u ≈ 1 + u²/6, Newton's method on the logarithm.
            let target = ((length * length - v * v).sqrt() / h).ln();
            let mut u = (6.0 * target).sqrt();
            for _ in 0..50 {
                let (f, slope) = ((u.sinh() / u).ln() - target, 1.0 / u.tanh() - 1.0 / u);
                let step = f / slope;
                u -= step;
                if step.abs() <= 1e-14 * u {
                    break;
                }
            }
            let a = h / (2.0 * u);
            // From the left end the lowest point lies at h/2 − a asinh(v_left→right / (2 a sinh u)).
            let rise = if to[0] > from[0] { v } else { -v };
            curve = Some((a, h / 2.0 - a * (rise / (2.0 * a * u.sinh())).asinh()));
        }
        Self { from, to, length, curve }
    }

    /// The point after a `share` (0…1) of the length.
    pub fn at(&self, share: f64) -> [f64; 2] {
        let (left, right, share) = if self.to[0] >= self.from[0] {
            (self.from, self.to, share)
        } else {
            (self.to, self.from, 1.0 - share)
        };
        let Some((a, lowest)) = self.curve else {
            return [0, 1].map(|k| left[k] + share * (right[k] - left[k]));
        };
        // Length from the lowest point is a sinh(x/a).
        let s = share * self.length - a * (lowest / a).sinh();
        let x = a * (s / a).asinh();
        [left[0] + lowest + x, left[1] + a * ((x / a).cosh() - (lowest / a).cosh())]
    }

    /// Horizontal pull per weight of a metre \[m\].
    pub fn parameter(&self) -> Option<f64> {
        self.curve.map(|(a, _)| a)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chain_ends_where_it_is_held_and_hangs_as_deep_as_known() {
        for to in [[1.5, 0.0], [1.5, 0.3], [-1.5, 0.2]] {
            let curve = Catenary::new([0.0, 0.0], to, 1.8);
            for (share, end) in [(0.0, [0.0, 0.0]), (1.0, to)] {
                let p = curve.at(share);
                assert!((p[0] - end[0]).hypot(p[1] - end[1]) < 1e-12, "{p:?} {end:?}");
            }
            let n = 4000;
            let point = |k: usize| curve.at(k as f64 / n as f64);
            let way: f64 =
                (0..n).map(|k| (point(k + 1)[0] - point(k)[0]).hypot(point(k + 1)[1] - point(k)[1])).sum();
            assert!((way - 1.8).abs() < 1e-6, "{way}");
        }
        // Little slack e hangs down f = L √(3 e / 8).
        let sag = -Catenary::new([0.0, 0.0], [1.0, 0.0], 1.0 + 1e-4).at(0.5)[1];
        assert!((sag / (3.0e-4_f64 / 8.0).sqrt() - 1.0).abs() < 1e-4, "{sag}");
    }
}
