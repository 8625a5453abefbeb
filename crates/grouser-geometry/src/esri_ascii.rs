//! ESRI ASCII grids: the plain-text exchange format of digital elevation models.

use std::fmt::Write as _;
use std::io::{self, Read};

use thiserror::Error;

use crate::height_grid::{GridError, HeightGrid};

/// Why an ESRI ASCII grid could not be read.
#[derive(Debug, Error)]
pub enum EsriAsciiError {
    /// The source itself failed, or is not text.
    #[error("the ESRI ASCII grid could not be read: {0}")]
    Io(#[from] io::Error),
    /// A header line is wrong.
    #[error(
        "line {line}: expected a header line `ncols`, `nrows`, `xllcorner` or `xllcenter`, `yllcorner` or `yllcenter`, \
         `cellsize` or `nodata_value` with a number, found `{found}`"
    )]
    Header {
        /// Line, counted from 1.
        line: usize,
        /// What stands there.
        found: String,
    },
    /// A header entry is absent.
    #[error("the header has no `{key}`; usual cause: a file cut off, or another grid format")]
    Missing {
        /// The absent entry.
        key: &'static str,
    },
    /// A height is not a number.
    #[error("line {line}: expected a height, found `{found}`; usual cause: a decimal comma")]
    NotANumber {
        /// Line, counted from 1.
        line: usize,
        /// What stands there.
        found: String,
    },
    /// A node without a height.
    #[error(
        "line {line}, row {row}, column {column}: no data ({value}); a machine cannot drive over a hole; remedy: fill holes \
         or cut the grid before importing"
    )]
    Hole {
        /// Line, counted from 1.
        line: usize,
        /// Row, counted from 1 at the north.
        row: usize,
        /// Column, counted from 1.
        column: usize,
        /// The mark for no data.
        value: f64,
    },
    /// Too few or too many heights, or a bad spacing.
    #[error(transparent)]
    Grid(#[from] GridError),
}

/// Reads an ESRI ASCII grid; rows run from north to south, nodes lie at the cell centres.
pub fn read_esri_ascii(mut source: impl Read) -> Result<HeightGrid, EsriAsciiError> {
    let mut text = String::new();
    source.read_to_string(&mut text)?;
    let (mut n_x, mut n_y, mut spacing, mut no_data) = (None, None, None, None);
    let mut corner = [None, None];
    let mut is_centre = [false, false];
    let mut values: Vec<f64> = Vec::new();
    for (number, content) in text.lines().enumerate() {
        let line = number + 1;
        let mut words = content.split_whitespace().peekable();
        let Some(first) = words.peek() else { continue };
        if values.is_empty() && first.starts_with(|c: char| c.is_ascii_alphabetic()) {
            let key = first.to_ascii_lowercase();
            let bad = || EsriAsciiError::Header { line, found: content.trim().into() };
            let value: f64 = words.nth(1).and_then(|w| w.parse().ok()).ok_or_else(bad)?;
            match key.as_str() {
                "ncols" => n_x = Some(value as usize),
                "nrows" => n_y = Some(value as usize),
                "xllcorner" | "xllcenter" => {
                    corner[0] = Some(value);
                    is_centre[0] = key.ends_with("center");
                }
                "yllcorner" | "yllcenter" => {
                    corner[1] = Some(value);
                    is_centre[1] = key.ends_with("center");
                }
                "cellsize" => spacing = Some(value),
                "nodata_value" => no_data = Some(value),
                _ => return Err(bad()),
            }
            continue;
        }
        for word in words {
            let value: f64 =
                word.parse().map_err(|_| EsriAsciiError::NotANumber { line, found: word.into() })?;
            if Some(value) == no_data || !value.is_finite() {
                let n_x = n_x.unwrap_or(usize::MAX).max(1);
                let (row, column) = (values.len() / n_x + 1, values.len() % n_x + 1);
                return Err(EsriAsciiError::Hole { line, row, column, value });
            }
            values.push(value);
        }
    }
    let need = |value: Option<usize>, key| value.ok_or(EsriAsciiError::Missing { key });
    let (n_x, n_y) = (need(n_x, "ncols")?, need(n_y, "nrows")?);
    let spacing = spacing.ok_or(EsriAsciiError::Missing { key: "cellsize" })?;
    let mut origin = [0.0; 2];
    for (axis, key) in ["xllcorner", "yllcorner"].into_iter().enumerate() {
        let half_cell = if is_centre[axis] { 0.0 } else { spacing / 2.0 };
        origin[axis] = corner[axis].ok_or(EsriAsciiError::Missing { key })? + half_cell;
    }
    if values.len() != n_x.saturating_mul(n_y) {
        return Err(GridError::WrongCount { heights: values.len(), n_x, n_y }.into());
    }
    let rows_from_south = values.chunks(n_x.max(1)).rev().flatten().copied().collect();
    Ok(HeightGrid::new(n_x, n_y, spacing, origin, rows_from_south)?)
}

/// Text of the grid as ESRI ASCII: digits enough to read the same heights back.
pub fn write_esri_ascii(grid: &HeightGrid) -> String {
    let [x, y] = grid.origin();
    let half = grid.spacing() / 2.0;
    let mut text = format!(
        "ncols {}\nnrows {}\nxllcorner {}\nyllcorner {}\ncellsize {}\n",
        grid.n_x(),
        grid.n_y(),
        x - half,
        y - half,
        grid.spacing()
    );
    for row in grid.heights().chunks(grid.n_x()).rev() {
        for (i, height) in row.iter().enumerate() {
            let _ = write!(text, "{}{height}", if i == 0 { "" } else { " " });
        }
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_back() {
        let grid =
            HeightGrid::covering([0.5, -1.0], [1.0, 0.5], 0.25, |x, y| (3.0 * x).sin() + y / 3.0).unwrap();
        let read = read_esri_ascii(write_esri_ascii(&grid).as_bytes()).unwrap();
        assert_eq!(read.heights(), grid.heights());
        assert!((read.origin()[0] - 0.5).abs() < 1e-12 && (read.origin()[1] + 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_hole_is_named_with_line_row_and_column() {
        let text =
            "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n1 2\n3 -9999\n";
        let error = read_esri_ascii(text.as_bytes()).unwrap_err();
        assert!(matches!(error, EsriAsciiError::Hole { line: 8, row: 2, column: 2, .. }), "{error}");
    }

    #[test]
    fn a_decimal_comma_and_a_missing_row_are_refused() {
        let header = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
        assert!(matches!(
            read_esri_ascii(format!("{header}1,5 2\n3 4\n").as_bytes()),
            Err(EsriAsciiError::NotANumber { line: 6, .. })
        ));
        assert!(matches!(read_esri_ascii(format!("{header}1 2\n").as_bytes()), Err(EsriAsciiError::Grid(_))));
        assert!(matches!(read_esri_ascii("nrows 2\n1 2".as_bytes()), Err(EsriAsciiError::Missing { .. })));
    }
}
