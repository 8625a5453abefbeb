//! Heights over a regular grid of points: ground that a machine drives on.

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Heights at the nodes of a regular grid, x fastest.
///
/// ```text
///   y ↑   n_x nodes along x, n_y along y
///     │ ·  ·  ·  ·      node (i, j) lies at origin + spacing (i, j)
///     │ ·  ·  ·  ·      its number is j · n_x + i
///     ·──·──·──·──→ x
///   origin = node (0, 0)
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HeightGrid {
    n_x: usize,
    n_y: usize,
    spacing: f64,
    origin: [f64; 2],
    heights: Vec<f64>,
}

/// Why heights do not make a grid.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum GridError {
    /// Fewer than two nodes in a direction.
    #[error("a height grid of {n_x} × {n_y} nodes has no cell; expected at least 2 × 2")]
    TooSmall {
        /// Nodes along x.
        n_x: usize,
        /// Nodes along y.
        n_y: usize,
    },
    /// The number of heights differs from the number of nodes.
    #[error("{heights} heights were given for {n_x} × {n_y} nodes; expected {}", n_x * n_y)]
    WrongCount {
        /// Heights given.
        heights: usize,
        /// Nodes along x.
        n_x: usize,
        /// Nodes along y.
        n_y: usize,
    },
    /// The spacing is not a length.
    #[error(
        "the spacing of the height grid is {spacing} m, expected a finite length above zero; usual cause: a wrong unit"
    )]
    BadSpacing {
        /// The spacing \[m\].
        spacing: f64,
    },
    /// A height that is not a number.
    #[error(
        "the height of node ({i}, {j}) is {height}, expected a finite number; usual cause: a hole in the source data; \
         remedy: fill it before importing"
    )]
    NotFinite {
        /// Node along x, counted from 0.
        i: usize,
        /// Node along y, counted from 0.
        j: usize,
        /// The height.
        height: f64,
    },
}

impl HeightGrid {
    /// A grid of `n_x` × `n_y` nodes, `spacing` \[m\] apart, from node (0, 0) at `origin` \[m\]; heights \[m\] with x fastest.
    pub fn new(
        n_x: usize,
        n_y: usize,
        spacing: f64,
        origin: [f64; 2],
        heights: Vec<f64>,
    ) -> Result<Self, GridError> {
        if n_x < 2 || n_y < 2 {
            return Err(GridError::TooSmall { n_x, n_y });
        }
        if heights.len() != n_x * n_y {
            return Err(GridError::WrongCount { heights: heights.len(), n_x, n_y });
        }
        if !(spacing.is_finite() && spacing > 0.0) {
            return Err(GridError::BadSpacing { spacing });
        }
        match heights.iter().position(|h| !h.is_finite()) {
            Some(n) => Err(GridError::NotFinite { i: n % n_x, j: n / n_x, height: heights[n] }),
            None => Ok(Self { n_x, n_y, spacing, origin, heights }),
        }
    }

    /// A grid whose heights are `height(x, y)` \[m\].
    pub fn from_fn(
        n_x: usize,
        n_y: usize,
        spacing: f64,
        origin: [f64; 2],
        mut height: impl FnMut(f64, f64) -> f64,
    ) -> Result<Self, GridError> {
        let mut heights = Vec::with_capacity(n_x * n_y);
        for j in 0..n_y {
            for i in 0..n_x {
                heights.push(height(origin[0] + spacing * i as f64, origin[1] + spacing * j as f64));
            }
        }
        Self::new(n_x, n_y, spacing, origin, heights)
    }

    /// A grid that covers the rectangle from `corner` to `corner + size` \[m\] with heights `height(x, y)` \[m\].
    ///
    /// The last nodes lie on or just beyond the far edges.
    pub fn covering(
        corner: [f64; 2],
        size: [f64; 2],
        spacing: f64,
        height: impl FnMut(f64, f64) -> f64,
    ) -> Result<Self, GridError> {
        if !(spacing.is_finite() && spacing > 0.0) {
            return Err(GridError::BadSpacing { spacing });
        }
        let count = |length: f64| (length / spacing - 1e-9).ceil().max(0.0) as usize + 1;
        Self::from_fn(count(size[0]), count(size[1]), spacing, corner, height)
    }

    /// Nodes along x.
    pub fn n_x(&self) -> usize {
        self.n_x
    }

    /// Nodes along y.
    pub fn n_y(&self) -> usize {
        self.n_y
    }

    /// Number of nodes.
    pub fn n_nodes(&self) -> usize {
        self.heights.len()
    }

    /// Distance between neighbouring nodes \[m\].
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Position of node (0, 0) \[m\].
    pub fn origin(&self) -> [f64; 2] {
        self.origin
    }

    /// Heights of all nodes \[m\], x fastest.
    pub fn heights(&self) -> &[f64] {
        &self.heights
    }

    /// Heights of all nodes \[m\], x fastest, to be changed in place.
    pub fn heights_mut(&mut self) -> &mut [f64] {
        &mut self.heights
    }

    /// Position of node (`i`, `j`) \[m\].
    #[inline]
    pub fn position(&self, i: usize, j: usize) -> [f64; 2] {
        [self.origin[0] + self.spacing * i as f64, self.origin[1] + self.spacing * j as f64]
    }

    /// Position of the node far from the origin \[m\].
    pub fn far_corner(&self) -> [f64; 2] {
        self.position(self.n_x - 1, self.n_y - 1)
    }

    /// Whether (`x`, `y`) lies on the grid.
    pub fn contains(&self, x: f64, y: f64) -> bool {
        let far = self.far_corner();
        x >= self.origin[0] && x <= far[0] && y >= self.origin[1] && y <= far[1]
    }

    /// Height at (`x`, `y`) \[m\], bilinear between the nodes; beyond the edge the height of the edge.
    pub fn height_at(&self, x: f64, y: f64) -> f64 {
        let along = |value: f64, origin: f64, n: usize| {
            let t = ((value - origin) / self.spacing).clamp(0.0, (n - 1) as f64);
            let i = (t as usize).min(n - 2);
            (i, t - i as f64)
        };
        let (i, u) = along(x, self.origin[0], self.n_x);
        let (j, v) = along(y, self.origin[1], self.n_y);
        let h = |i: usize, j: usize| self.heights[j * self.n_x + i];
        (1.0 - v) * ((1.0 - u) * h(i, j) + u * h(i + 1, j))
            + v * ((1.0 - u) * h(i, j + 1) + u * h(i + 1, j + 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn height_at_is_exact_on_a_plane() {
        let grid =
            HeightGrid::covering([-1.0, 2.0], [3.0, 2.0], 0.25, |x, y| 0.5 * x - 0.25 * y + 1.0).unwrap();
        assert_eq!((grid.n_x(), grid.n_y()), (13, 9));
        for (x, y) in [(-1.0, 2.0), (0.37, 3.11), (2.0, 4.0), (1.999, 2.0)] {
            assert!((grid.height_at(x, y) - (0.5 * x - 0.25 * y + 1.0)).abs() < 1e-12);
        }
    }

    #[test]
    fn a_hole_is_named_by_its_node() {
        let heights = vec![0.0, 0.0, 0.0, f64::NAN, 0.0, 0.0];
        assert!(matches!(
            HeightGrid::new(3, 2, 0.1, [0.0, 0.0], heights),
            Err(GridError::NotFinite { i: 0, j: 1, .. })
        ));
    }
}
