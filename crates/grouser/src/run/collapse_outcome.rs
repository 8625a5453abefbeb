//! What has come of a collapse: the slope, its angle, and where the energy went.

use super::collapse::Collapsed;
use super::experiment::Outcome;
use super::tool_ledger::ToolLedger;
use crate::output::Table;
use crate::output::chart::{Chart, Mark, Series};
use crate::output::summary::Metric;
use std::collections::BTreeMap;

/// Everything that follows from a column that has come to rest.
pub fn outcome(done: &[Collapsed]) -> Outcome {
    let conventions = BTreeMap::from([
        ("axes", "x away from the wall that the column leans against, z up; the origin is a lower corner of the box".into()),
        ("surface", "mean, over cells two mean grain diameters wide and long, of the highest point of any grain".into()),
        ("angle", "of the line of least squares through the surface between 15 and 85 % of its height over the grains of the floor; ± is the standard error of the fit".into()),
    ]);
    let Some(heap) = done.first() else { return Outcome { conventions, ..Outcome::default() } };
    let slope = heap.slope();
    let last = |column: &str| heap.table.column(column).last().copied().unwrap_or(0.0);
    let angle = Metric {
        uncertainty: Some(slope.error_deg),
        ..Metric::new("angle of repose", slope.angle_deg, "deg")
    };
    let metrics = vec![
        angle,
        Metric::new("height of the slope at the wall", slope.height - heap.base, "m"),
        Metric::new("time until rest", heap.time, "s"),
        Metric::new("kinetic energy over Σ m g r at the end", last("kinetic_energy_ratio"), "-"),
        Metric::new("contacts per grain at the end", last("contacts_per_grain"), "-"),
        Metric::new("energy residual over the energy of the height", heap.residual(), "-"),
    ];
    let mut surface = Table::new(&[("x", "m"), ("height", "m")]);
    heap.profile.iter().for_each(|&(x, height)| surface.push(&[x, height]));
    Outcome {
        energy: Some(ToolLedger::energy(&[heap.ledger])),
        conventions,
        metrics,
        tables: vec![("collapse".into(), heap.table.clone()), ("surface".into(), surface)],
        charts: vec![("surface".into(), chart(heap))],
        ..Outcome::default()
    }
}

/// The surface and the line through it.
fn chart(heap: &Collapsed) -> Chart {
    let slope = heap.slope();
    let fall = slope.angle_deg.to_radians().tan();
    let toe = if fall > 0.0 { (slope.height - heap.base) / fall } else { f64::INFINITY };
    let end = heap.profile.last().map_or(0.0, |point| point.0).min(toe);
    let line = [0.0, end].map(|x| (x, slope.height - fall * x));
    let series = |name: String, colour, mark, points| Series { name, colour, mark, points };
    Chart {
        title: "Surface of the slope at rest".into(),
        x_label: "distance from the wall [m]".into(),
        y_label: "height [m]".into(),
        series: vec![
            series("surface".into(), 0, Mark::Line, heap.profile.clone()),
            series(
                format!("{:.1}° ± {:.1}°", slope.angle_deg, slope.error_deg),
                1,
                Mark::Dashes,
                line.to_vec(),
            ),
        ],
    }
}
