//! Ground as text: one `x y z` per line, on a regular grid in any order.

use std::io::{self, Read};

use thiserror::Error;

use crate::height_grid::{GridError, HeightGrid};

/// Why XYZ text could not be read.
#[derive(Debug, Error)]
pub enum XyzError {
    /// The source itself failed, or is not text.
    #[error("the XYZ text could not be read: {0}")]
    Io(#[from] io::Error),
    /// A line is not three numbers.
    #[error("line {line}: expected three numbers x y z [m], found `{found}`")]
    Syntax {
        /// Line, counted from 1.
        line: usize,
        /// What stands there.
        found: String,
    },
    /// The points do not lie on a regular grid.
    #[error(
        "line {line}: the point ({x}, {y}) does not lie on the grid of spacing {spacing} m that the other points make; \
         usual cause: scattered points; remedy: resample them on a grid first"
    )]
    OffGrid {
        /// Line, counted from 1.
        line: usize,
        /// Position \[m\].
        x: f64,
        /// Position \[m\].
        y: f64,
        /// Spacing found \[m\].
        spacing: f64,
    },
    /// The same position twice.
    #[error("line {line}: the position of line {first} is given a second time")]
    Twice {
        /// Line, counted from 1.
        line: usize,
        /// Line of the first point at that position.
        first: usize,
    },
    /// A node without a point.
    #[error(
        "no point at ({x}, {y}): the grid has a hole; remedy: fill holes or cut the data before importing"
    )]
    Hole {
        /// Position of the hole \[m\].
        x: f64,
        /// Position of the hole \[m\].
        y: f64,
    },
    /// Too few points.
    #[error(transparent)]
    Grid(#[from] GridError),
}

/// Reads `x y z` lines (blanks, tabs, commas or semicolons between the numbers, `#` starts a comment).
pub fn read_xyz(mut source: impl Read) -> Result<HeightGrid, XyzError> {
    let mut text = String::new();
    source.read_to_string(&mut text)?;
    let mut points: Vec<(usize, [f64; 3])> = Vec::new();
    for (number, content) in text.lines().enumerate() {
        let content = content.split('#').next().unwrap_or("").trim();
        if content.is_empty() {
            continue;
        }
        let words = content.split([' ', '\t', ',', ';']).filter(|w| !w.is_empty());
        let numbers: Vec<f64> = words.map_while(|w| w.parse().ok()).filter(|v: &f64| v.is_finite()).collect();
        match numbers[..] {
            [x, y, z] => points.push((number + 1, [x, y, z])),
            _ => return Err(XyzError::Syntax { line: number + 1, found: content.into() }),
        }
    }
    let axis = |k: usize| {
        let mut values: Vec<f64> = points.iter().map(|p| p.1[k]).collect();
        values.sort_by(f64::total_cmp);
        let extent = values.last().unwrap_or(&0.0) - values.first().unwrap_or(&0.0);
        let gap = values
            .windows(2)
            .map(|w| w[1] - w[0])
            .filter(|g| *g > 1e-6 * extent)
            .fold(f64::INFINITY, f64::min);
        (values.first().copied().unwrap_or(0.0), extent, gap)
    };
    let ((x_0, x_extent, x_gap), (y_0, y_extent, y_gap)) = (axis(0), axis(1));
    let spacing = x_gap.min(y_gap);
    if !spacing.is_finite() {
        return Err(GridError::TooSmall { n_x: 1, n_y: 1 }.into());
    }
    let (n_x, n_y) = ((x_extent / spacing).round() as usize + 1, (y_extent / spacing).round() as usize + 1);
    if n_x.saturating_mul(n_y) > 16 * points.len() + 16 {
        let (line, [x, y, _]) = points[points.len() - 1];
        return Err(XyzError::OffGrid { line, x, y, spacing });
    }
    let mut source_line = vec![0usize; n_x * n_y];
    let mut heights = vec![0.0; n_x * n_y];
    for &(line, [x, y, z]) in &points {
        let (u, v) = ((x - x_0) / spacing, (y - y_0) / spacing);
        if (u - u.round()).abs() > 1e-3 || (v - v.round()).abs() > 1e-3 {
            return Err(XyzError::OffGrid { line, x, y, spacing });
        }
        let node = v.round() as usize * n_x + u.round() as usize;
        if source_line[node] != 0 {
            return Err(XyzError::Twice { line, first: source_line[node] });
        }
        source_line[node] = line;
        heights[node] = z;
    }
    if let Some(node) = source_line.iter().position(|&line| line == 0) {
        let (x, y) = (x_0 + spacing * (node % n_x) as f64, y_0 + spacing * (node / n_x) as f64);
        return Err(XyzError::Hole { x, y });
    }
    Ok(HeightGrid::new(n_x, n_y, spacing, [x_0, y_0], heights)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_in_any_order_make_a_grid() {
        let grid =
            read_xyz("# x y z\n1.0 0 3\n0 0 1\n0.5;0;2\n0 0.5 4\n0.5,0.5,5\n1 0.5 6\n".as_bytes()).unwrap();
        assert_eq!((grid.n_x(), grid.n_y(), grid.spacing()), (3, 2, 0.5));
        assert_eq!(grid.heights(), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    }

    #[test]
    fn holes_doubles_and_scattered_points_are_refused() {
        let read = |text: &str| read_xyz(text.as_bytes()).unwrap_err();
        assert!(matches!(read("0 0 1\n1 0 1\n0 1 1\n"), XyzError::Hole { .. }));
        assert!(matches!(read("0 0 1\n1 0 1\n0 1 1\n1 1 1\n0 0 2\n"), XyzError::Twice { line: 5, first: 1 }));
        assert!(matches!(read("0 0 1\n1 0 1\n0 1 1\n1.4 1 1\n"), XyzError::OffGrid { .. }));
        assert!(matches!(read("0 0\n"), XyzError::Syntax { line: 1, .. }));
    }
}
