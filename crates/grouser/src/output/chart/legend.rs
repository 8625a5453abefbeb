//! Where the names of series stand: in a corner of the plot that none of them passes through, or above all of them.

use super::{Chart, Mark};

/// Width and height of the plot inside its axes, about [px].
const PLOT: (f64, f64) = (762.0, 410.0);
/// Width of a letter, about [px].
const LETTER: f64 = 7.4;
/// From the edge of the plot to the legend, and from its left edge to the names [px].
pub(super) const MARGIN: f64 = 14.0;
pub(super) const INDENT: f64 = 33.0;
/// From name to name [px].
pub(super) const ROW: f64 = 19.0;
/// The legend never takes more of the plot's height than this [-].
const MOST: f64 = 0.4;

/// A corner of the plot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Corner {
    pub is_right: bool,
    pub is_low: bool,
}

const CORNERS: [Corner; 4] = [
    Corner { is_right: false, is_low: false },
    Corner { is_right: true, is_low: false },
    Corner { is_right: true, is_low: true },
    Corner { is_right: false, is_low: true },
];

impl Chart {
    /// Width and height of the legend [px].
    pub(super) fn legend_size(&self) -> (f64, f64) {
        let names = || self.series.iter().map(|series| series.name.chars().count()).filter(|&n| n > 0);
        let widest = names().max().unwrap_or(0) as f64;
        (INDENT + LETTER * widest, ROW * names().count() as f64)
    }

    /// The legend's corner, and the range of the vertical axis: higher than `y` where no corner is free.
    pub(super) fn legend_place(&self, x: (f64, f64), y: (f64, f64)) -> (Corner, (f64, f64)) {
        let (width, height) = self.legend_size();
        let share = ((width + 2.0 * MARGIN) / PLOT.0, (height + MARGIN) / PLOT.1);
        let crossings = |corner: &Corner| {
            let is_in_it = |&(u, v): &(f64, f64)| {
                let (across, down) =
                    (if corner.is_right { 1.0 - u } else { u }, if corner.is_low { v } else { 1.0 - v });
                across < share.0 && down < share.1
            };
            self.series.iter().map(|series| traced(series, x, y).filter(is_in_it).count()).sum::<usize>()
        };
        let emptiest = CORNERS.into_iter().min_by_key(crossings).unwrap_or(CORNERS[0]);
        if crossings(&emptiest) == 0 || share.1 > MOST {
            return (emptiest, y);
        }
        (CORNERS[0], (y.0, y.0 + (y.1 - y.0) / (1.0 - share.1)))
    }
}

/// Places on what is drawn of a series, from (0, 0) at the lower left corner of the plot to (1, 1).
fn traced(series: &super::Series, x: (f64, f64), y: (f64, f64)) -> impl Iterator<Item = (f64, f64)> {
    /// Places a stroke.
    const FINENESS: usize = 16;
    let unit = move |&(a, b): &(f64, f64)| ((a - x.0) / (x.1 - x.0), (b - y.0) / (y.1 - y.0));
    let points: Vec<_> =
        series.points.iter().filter(|(a, b)| a.is_finite() && b.is_finite()).map(unit).collect();
    let fineness = if series.mark == Mark::Ring { 1 } else { FINENESS };
    (0..points.len()).flat_map(move |n| {
        let (from, to) = (points[n], points[(n + 1).min(points.len() - 1)]);
        (0..fineness).map(move |k| {
            let t = k as f64 / FINENESS as f64;
            (from.0 + t * (to.0 - from.0), from.1 + t * (to.1 - from.1))
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::chart::Series;

    fn line(points: Vec<(f64, f64)>) -> Chart {
        let series = Series { name: "a name".into(), colour: 0, mark: Mark::Line, points };
        Chart { series: vec![series], ..Chart::default() }
    }

    #[test]
    fn curves_keep_clear_of_the_names() {
        let unit = (0.0, 1.0);
        let place = |points| line(points).legend_place(unit, unit);
        let (left, right) =
            (Corner { is_right: false, is_low: false }, Corner { is_right: true, is_low: false });
        assert_eq!(place(vec![(0.0, 0.0), (1.0, 1.0)]), (left, unit));
        assert_eq!(place(vec![(0.0, 1.0), (1.0, 0.0)]), (right, unit));
        // No point of this stroke lies in the corner that it passes through.
        assert_eq!(place(vec![(0.0, 0.9), (0.3, 1.0), (1.0, 0.0)]).0, right);
        let (corner, (low, high)) = place(vec![(0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (0.0, 0.0)]);
        assert!(corner == left && low == 0.0 && high > 1.05 && high < 1.2, "{high}");
        assert_eq!(Chart::default().legend_place(unit, unit), (left, unit));
    }
}
