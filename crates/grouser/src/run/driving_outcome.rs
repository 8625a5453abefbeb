//! What has come of driving: ruts, rolling resistance, maps, and how both depend on the numerical settings.

use super::drive::{Drive, parts};
use super::driving::Driven;
use super::experiment::{Outcome, Picture, Section, Verdict};
use super::report::number;
use crate::output::chart::{Chart, Mark, Series};
use crate::output::heat_map::heat_map;
use crate::output::summary::Metric;
use crate::scene::Scenario;
use grouser_geometry::esri_ascii::write_esri_ascii;
use std::collections::BTreeMap;

/// Everything that follows from the drives that have come to their end.
pub fn outcome(scenario: &Scenario, done: &[Driven]) -> Outcome {
    let section = parts(scenario).and_then(|parts| parts.route.rolling_section_m);
    let drives: Vec<Evaluated> = done.iter().map(|driven| Evaluated::new(driven, section)).collect();
    let own: Vec<&Evaluated> = drives.iter().filter(|d| d.driven.drive.varied.is_none()).collect();
    let mut outcome = Outcome {
        conventions: conventions(),
        metrics: drives.iter().flat_map(Evaluated::metrics).collect(),
        tables: own.iter().map(|d| (d.driven.drive.file_name(), d.driven.table.clone())).collect(),
        charts: charts(&own),
        sections: vec![section_of(&drives)],
        verdict: verdict(&own),
        ..Outcome::default()
    };
    outcome.charts.extend(box_charts(&drives));
    let largest = own.iter().filter_map(|d| d.driven.sinkage.as_ref()).flat_map(|grid| grid.heights());
    let largest = largest.fold(0.0_f64, |a, b| a.max(*b));
    for drive in &own {
        let Some(grid) = &drive.driven.sinkage else { continue };
        let name = format!("ruts_{}", drive.driven.drive.file_name());
        outcome.files.push((format!("{name}.asc"), write_esri_ascii(grid).into_bytes()));
        if let Ok(png) = heat_map(grid, largest) {
            let caption = format!("Sinkage, {}: white 0, dark {largest:.3} m", drive.driven.drive.label());
            outcome.pictures.push(Picture { name, caption, png });
        }
    }
    outcome
}

/// A drive and what was measured on it.
struct Evaluated<'a> {
    driven: &'a Driven,
    ruts: Vec<f64>,
    coefficients: Vec<f64>,
}

impl<'a> Evaluated<'a> {
    fn new(driven: &'a Driven, section: Option<(f64, f64)>) -> Self {
        let (distance, coefficient) =
            (driven.table.column("distance"), driven.table.column("rolling_resistance"));
        let (from, to) = section.unwrap_or((0.0, f64::INFINITY));
        let within = distance.iter().zip(coefficient).filter(|(s, _)| (from..=to + 1e-9).contains(*s));
        Self { driven, ruts: driven.rut_depths.concat(), coefficients: within.map(|(_, c)| c).collect() }
    }

    fn metrics(&self) -> Vec<Metric> {
        let label = self.driven.drive.label();
        let name = |what: &str| format!("{label}: {what}");
        let mut metrics = vec![
            Metric::new(name("median rut depth"), quantile(&self.ruts, 0.5), "m"),
            Metric::new(
                name("median rolling resistance coefficient"),
                quantile(&self.coefficients, 0.5),
                "-",
            ),
        ];
        if self.driven.drive.varied.is_none() {
            metrics.push(Metric::new(name("deepest rut"), quantile(&self.ruts, 1.0), "m"));
            metrics.push(Metric::new(name("mass of the machine"), self.driven.mass, "kg"));
            metrics.push(Metric::new(
                name("run steps limited by the grid"),
                self.driven.n_limited as f64,
                "-",
            ));
        }
        metrics
    }
}

/// Quantile of values, between the two nearest; not a number for none.
fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let place = share * last as f64;
    let k = place as usize;
    let next = sorted[(k + 1).min(last)];
    sorted[k] + (place - k as f64) * (next - sorted[k])
}

fn conventions() -> BTreeMap<&'static str, String> {
    BTreeMap::from([
        ("axes", "x and y horizontal, z up; positive pitch lowers the nose, positive roll leans to the right".into()),
        ("sinkage", "height of the undisturbed ground minus its present height, vertical".into()),
        ("rolling_force", "force at the wheel centres that keeps them rolling; positive when the ground resists (P2 Eq. 17)".into()),
        ("rolling_resistance", "sum of rolling forces over the sum of the norms of the wheels' total forces (P2 Eqs. 13, 14, 18)".into()),
        ("rolling_resistance_vertical", "the same over the vertical parts of the wheels' forces".into()),
        ("rut depth", "largest sinkage within a window along the track, one wheel wide".into()),
        ("time", "distance over a speed that is only shown; speed does not enter the model".into()),
    ])
}

fn verdict(own: &[&Evaluated]) -> Option<Verdict> {
    if own.is_empty() {
        return None;
    }
    let sentence = |d: &&Evaluated| {
        format!(
            "{}: ruts of {} m, rolling resistance {} of the load (medians).",
            d.driven.drive.label(),
            number(quantile(&d.ruts, 0.5)),
            number(quantile(&d.coefficients, 0.5))
        )
    };
    let text = own.iter().map(sentence).collect::<Vec<_>>().join(" ");
    Some(Verdict { heading: "Ruts and rolling resistance".into(), text, source: String::new() })
}

fn section_of(drives: &[Evaluated]) -> Section {
    let rows = drives.iter().map(|d| {
        let of = |values: &[f64]| [0.25, 0.5, 0.75].map(|share| number(quantile(values, share))).join(" · ");
        vec![d.driven.drive.label(), of(&d.ruts), d.ruts.len().to_string(), of(&d.coefficients)]
    });
    let heads = ["drive", "rut depth [m], quartiles", "windows", "rolling resistance [-], quartiles"];
    Section::new("Drives", &heads, rows.collect())
}

fn charts(own: &[&Evaluated]) -> Vec<(String, Chart)> {
    let series = |column: &str| -> Vec<Series> {
        own.iter()
            .enumerate()
            .map(|(colour, d)| {
                let (x, y) = (d.driven.table.column("distance"), d.driven.table.column(column));
                let points = x.into_iter().zip(y).collect();
                Series { name: d.driven.drive.label(), colour, mark: Mark::Line, points }
            })
            .collect()
    };
    if own.is_empty() {
        return Vec::new();
    }
    let chart = |title: &str, y_label: &str, series| Chart {
        title: title.into(),
        x_label: "distance driven [m]".into(),
        y_label: y_label.into(),
        series,
    };
    let resistance = chart("Rolling resistance", "F_R / N [-]", series("rolling_resistance"));
    vec![("rolling_resistance".into(), resistance)]
}

/// Box plots of ruts and rolling resistance over each varied setting.
fn box_charts(drives: &[Evaluated]) -> Vec<(String, Chart)> {
    let mut groups: Vec<(String, String)> = Vec::new();
    for drive in drives {
        if let Some((name, _)) = &drive.driven.drive.varied {
            let group = (name.clone(), drive.driven.drive.equipment.clone());
            if !groups.contains(&group) {
                groups.push(group);
            }
        }
    }
    let mut charts = Vec::new();
    for (name, equipment) in &groups {
        let of_group = |drive: &Drive| {
            drive.equipment == *equipment && drive.varied.as_ref().is_some_and(|(n, _)| n == name)
        };
        let members: Vec<(f64, &Evaluated)> = drives
            .iter()
            .filter(|d| of_group(&d.driven.drive))
            .filter_map(|d| Some((d.driven.drive.varied.as_ref()?.1, d)))
            .collect();
        let low = members.iter().map(|m| m.0).fold(f64::INFINITY, f64::min);
        let high = members.iter().map(|m| m.0).fold(f64::NEG_INFINITY, f64::max);
        let half = 0.3 * (high - low).max(1e-3) / members.len().max(1) as f64;
        for (what, y_label, values) in [
            ("ruts", "rut depth [m]", (|d| d.ruts.clone()) as fn(&Evaluated) -> Vec<f64>),
            ("rolling", "rolling resistance coefficient [-]", |d| d.coefficients.clone()),
        ] {
            let mut boxes = Vec::new();
            for (x, drive) in &members {
                boxes.extend(box_plot(*x, half, &values(drive)));
            }
            let medians = members.iter().map(|(x, drive)| (*x, quantile(&values(drive), 0.5))).collect();
            let mut series: Vec<Series> = boxes
                .split(|p| p.0.is_nan())
                .filter(|points| !points.is_empty())
                .map(|points| Series {
                    name: String::new(),
                    colour: 0,
                    mark: Mark::Line,
                    points: points.to_vec(),
                })
                .collect();
            series.push(Series { name: String::new(), colour: 1, mark: Mark::Ring, points: medians });
            let chart = Chart {
                title: format!("{equipment}: quartiles, whiskers within 1.5 times their distance"),
                x_label: name.clone(),
                y_label: y_label.into(),
                series,
            };
            let file = Drive::plain(&format!("{what}_{name}_{equipment}"));
            charts.push((file, chart));
        }
    }
    charts
}

/// A box with its median and whiskers: strokes, each followed by a point that is no number.
fn box_plot(x: f64, half: f64, values: &[f64]) -> Vec<(f64, f64)> {
    let [first, median, third] = [0.25, 0.5, 0.75].map(|share| quantile(values, share));
    let reach = 1.5 * (third - first);
    let inside = values.iter().copied().filter(|v| (first - reach..=third + reach).contains(v));
    let (low, high) = inside.fold((first, third), |(l, h), v| (l.min(v), h.max(v)));
    let (a, b) = (x - half, x + half);
    let across = |y: f64| vec![(a, y), (b, y)];
    let sides = vec![(a, first), (b, first), (b, third), (a, third), (a, first)];
    let strokes = [
        across(low),
        vec![(x, low), (x, first)],
        sides,
        across(median),
        vec![(x, third), (x, high)],
        across(high),
    ];
    strokes.into_iter().flat_map(|stroke| stroke.into_iter().chain([(f64::NAN, f64::NAN)])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_lie_between_their_neighbours() {
        let values = [4.0, 1.0, 3.0, 2.0];
        assert_eq!([0.0, 0.25, 0.5, 1.0].map(|s| quantile(&values, s)), [1.0, 1.75, 2.5, 4.0]);
        assert!(quantile(&[], 0.5).is_nan());
        let outline = box_plot(0.0, 1.0, &[1.0, 2.0, 3.0, 4.0, 100.0]);
        assert_eq!(outline.iter().map(|p| p.1).fold(0.0, f64::max), 4.0);
    }
}
