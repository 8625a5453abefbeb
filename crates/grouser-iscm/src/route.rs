//! The way that a machine is driven: straight lines between points.

use serde::{Deserialize, Serialize};

/// A route over the ground.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Route {
    /// Corner points \[m\], at least two.
    pub points: Vec<[f64; 2]>,
}

impl Route {
    /// Length \[m\].
    pub fn length(&self) -> f64 {
        self.points.windows(2).map(|p| (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1])).sum()
    }

    /// Position \[m\] and heading \[rad\] after `distance` \[m\]; before the start and beyond the end along the first and last line.
    pub fn at(&self, distance: f64) -> ([f64; 2], f64) {
        let mut left = distance;
        let last = self.points.len().saturating_sub(2);
        for (n, p) in self.points.windows(2).enumerate() {
            let (dx, dy) = (p[1][0] - p[0][0], p[1][1] - p[0][1]);
            let length = dx.hypot(dy);
            if left > length && n < last {
                left -= length;
                continue;
            }
            let t = if length > 0.0 { left / length } else { 0.0 };
            return ([p[0][0] + t * dx, p[0][1] + t * dy], dy.atan2(dx));
        }
        (self.points.first().copied().unwrap_or([0.0; 2]), 0.0)
    }
}
