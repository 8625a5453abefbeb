//! What has come of a study: all variants in a table, curves over each other, metrics over an axis.

use super::experiment::{Outcome, Picture, Section};
use super::report::number;
use crate::output::Table;
use crate::output::chart::{Chart, Mark, Series};
use crate::output::summary::Metric;
use crate::scene::{Curves, Study, Trend, Variant};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// What each variant's energy ledger misses, whatever columns a study asks for.
const ENERGY_RESIDUAL: &str = "energy residual over work or loss";

/// What a variant left.
pub struct VariantResult {
    labels: Vec<String>,
    folder: PathBuf,
    summary: Value,
}

impl VariantResult {
    /// Reads a variant's summary.
    pub fn read(folder: &Path, variant: &Variant) -> Option<Self> {
        let text = fs::read_to_string(folder.join("summary.json")).ok()?;
        let summary = serde_json::from_str(&text).ok()?;
        Some(Self { labels: variant.labels.clone(), folder: folder.to_owned(), summary })
    }

    /// A number of the summary's `time`.
    pub fn time(&self, key: &str) -> f64 {
        self.summary["time"][key].as_f64().unwrap_or(0.0)
    }

    fn metrics(&self) -> impl Iterator<Item = (&str, f64, &str)> {
        let list = self.summary["metrics"].as_array().map(Vec::as_slice).unwrap_or_default();
        list.iter().filter_map(|m| Some((m["name"].as_str()?, m["value"].as_f64()?, m["unit"].as_str()?)))
    }

    fn metric(&self, name: &str) -> Option<f64> {
        self.metrics().find(|(each, ..)| *each == name).map(|(_, value, _)| value)
    }

    /// What its energy ledger misses [-]; `None` where nothing moves.
    fn energy_residual(&self) -> Option<f64> {
        self.summary["energy"]["residual_fraction"].as_f64()
    }

    fn table(&self, name: &str) -> Option<Table> {
        Table::from_csv(&fs::read_to_string(self.folder.join(format!("{name}.csv"))).ok()?)
    }

    /// A picture that it left.
    fn picture(&self, study: &Study, name: &str) -> Option<Picture> {
        let png = fs::read(self.folder.join(format!("{name}.png"))).ok()?;
        let axes: Vec<String> = study.axes.iter().map(|axis| axis.name.clone()).collect();
        let folder = self.folder.file_name()?.to_string_lossy();
        Some(Picture {
            name: format!("{folder}_{name}"),
            caption: format!(
                "{}: {}",
                self.key(study, &axes),
                self.summary["pictures"][name].as_str().unwrap_or(name)
            ),
            png,
        })
    }

    /// Its labels on the axes called `by`, with the unit in the axis' name behind the number: `c [m]` gives `c 0.5 m`.
    fn key(&self, study: &Study, by: &[String]) -> String {
        let label = |name: &String| {
            let label = &self.labels[study.axis(name)?];
            Some(match name.strip_suffix(']').and_then(|name| name.split_once(" [")) {
                Some((name, unit)) => format!("{name} {label} {unit}"),
                None => format!("{name} {label}"),
            })
        };
        by.iter().filter_map(label).collect::<Vec<_>>().join(", ")
    }
}

/// Everything that a comparison of the variants gives.
pub fn outcome(study: &Study, results: &[VariantResult]) -> Outcome {
    let curves = study.curves.iter().enumerate();
    let trends = study.trends.iter().enumerate();
    let charts = curves
        .map(|(i, curves)| (format!("curves_{}", i + 1), curves_chart(study, curves, results)))
        .chain(trends.map(|(i, trend)| (format!("trend_{}", i + 1), trend_chart(study, trend, results))));
    let metrics = results.iter().flat_map(|result| {
        let label = result.labels.join(", ");
        let wanted = result.metrics().filter(|(name, ..)| is_column(study, name));
        wanted.map(move |(name, value, unit)| Metric::new(format!("{label}: {name}"), value, unit))
    });
    let residuals = results.iter().filter_map(|result| Some((result, result.energy_residual()?)));
    let residual_of = |(result, residual): (&VariantResult, f64)| {
        Metric::new(format!("{}: {ENERGY_RESIDUAL}", result.labels.join(", ")), residual, "-")
    };
    let largest = residuals.clone().map(|(_, residual)| residual).max_by(|a, b| a.abs().total_cmp(&b.abs()));
    let largest =
        largest.map(|it| Metric::new(format!("largest {ENERGY_RESIDUAL} of all variants"), it, "-"));
    let pictures = study.pictures.iter().flat_map(|name| results.iter().map(move |result| (result, name)));
    Outcome {
        charts: charts.collect(),
        pictures: pictures.filter_map(|(result, name)| result.picture(study, name)).collect(),
        sections: vec![table_of_variants(study, results)],
        metrics: metrics.chain(residuals.map(residual_of)).chain(largest).collect(),
        ..Outcome::default()
    }
}

/// What is wrong with the pictures asked for: each that no variant has left, beside those that it has.
pub fn missing_pictures(study: &Study, results: &[VariantResult]) -> Vec<String> {
    let Some(first) = results.first() else { return Vec::new() };
    let entries = fs::read_dir(&first.folder).into_iter().flatten().flatten();
    let files = entries.filter_map(|entry| entry.file_name().into_string().ok());
    let mut names: Vec<String> =
        files.filter_map(|file| file.strip_suffix(".png").map(str::to_owned)).collect();
    names.sort();
    let is_missing =
        |name: &&String| results.iter().all(|result| !result.folder.join(format!("{name}.png")).is_file());
    let missing = study.pictures.iter().filter(is_missing);
    missing
        .map(|name| format!("study.pictures: no variant has left {name}.png; there are {}", names.join(", ")))
        .collect()
}

fn is_column(study: &Study, name: &str) -> bool {
    study.columns.is_empty() || study.columns.iter().any(|column| name.starts_with(column.as_str()))
}

/// One row a variant: its labels, the metrics asked for, and what it took.
fn table_of_variants(study: &Study, results: &[VariantResult]) -> Section {
    let mut names: Vec<(String, String)> = Vec::new();
    for (name, _, unit) in results.iter().flat_map(VariantResult::metrics) {
        if is_column(study, name) && !names.iter().any(|(other, _)| other == name) {
            names.push((name.to_owned(), unit.to_owned()));
        }
    }
    let has_energy = results.iter().any(|result| result.energy_residual().is_some());
    let heads: Vec<String> = study
        .axes
        .iter()
        .map(|axis| axis.name.clone())
        .chain(names.iter().map(|(name, unit)| format!("{name} [{unit}]")))
        .chain(has_energy.then(|| format!("{ENERGY_RESIDUAL} [-]")))
        .chain(["time [s]".to_owned()])
        .collect();
    let row = |result: &VariantResult| {
        let values = names.iter().map(|(name, _)| result.metric(name).map_or(String::new(), number));
        let residual = has_energy.then(|| result.energy_residual().map_or(String::new(), number));
        let took = number(result.time("wall_s"));
        result.labels.iter().cloned().chain(values).chain(residual).chain([took]).collect()
    };
    Section { title: "All variants".into(), heads, rows: results.iter().map(row).collect() }
}

/// Results that share their labels on some axes, in the order in which they first occur.
fn groups<'a>(
    study: &Study,
    by: &[String],
    only: &BTreeMap<String, Vec<String>>,
    results: &'a [VariantResult],
) -> Vec<(String, Vec<&'a VariantResult>)> {
    let mut groups: Vec<(String, Vec<&VariantResult>)> = Vec::new();
    let is_drawn = |result: &&VariantResult| {
        let mut axes = only.iter().filter_map(|(name, labels)| Some((study.axis(name)?, labels)));
        axes.all(|(axis, labels)| labels.contains(&result.labels[axis]))
    };
    for result in results.iter().filter(is_drawn) {
        let key = result.key(study, by);
        match groups.iter_mut().find(|(other, _)| *other == key) {
            Some((_, members)) => members.push(result),
            None => groups.push((key, vec![result])),
        }
    }
    groups
}

fn curves_chart(study: &Study, curves: &Curves, results: &[VariantResult]) -> Chart {
    let mut chart = Chart { title: curves.title.clone(), ..Chart::default() };
    for (colour, (name, members)) in groups(study, &curves.by, &curves.only, results).into_iter().enumerate()
    {
        let tables: Vec<Table> = members.iter().filter_map(|member| member.table(&curves.table)).collect();
        let lines: Vec<Line> = tables
            .iter()
            .map(|table| table.column(&curves.x).into_iter().zip(table.column(&curves.y)).collect())
            .collect();
        if let Some(table) = tables.first() {
            let spoken = |column: &str| table.label(column).replace('_', " ");
            (chart.x_label, chart.y_label) = (spoken(&curves.x), spoken(&curves.y));
        }
        if let [only] = lines.as_slice() {
            chart.series.push(Series { name, colour, mark: Mark::Line, points: only.clone() });
            continue;
        }
        let band = band(&lines);
        let of = |pick: fn(&Spread) -> f64| band.iter().map(|spread| (spread.x, pick(spread))).collect();
        chart.series.push(Series { name, colour, mark: Mark::Line, points: of(|spread| spread.mean) });
        for points in [of(|spread| spread.low), of(|spread| spread.high)] {
            chart.series.push(Series { name: String::new(), colour, mark: Mark::Dashes, points });
        }
    }
    chart
}

/// A curve.
type Line = Vec<(f64, f64)>;

/// Several curves at one place.
struct Spread {
    x: f64,
    low: f64,
    mean: f64,
    high: f64,
}

/// Lowest, mean and highest of several curves over their common range.
fn band(lines: &[Line]) -> Vec<Spread> {
    let from = lines.iter().filter_map(|line| line.first()).fold(f64::NEG_INFINITY, |x, p| x.max(p.0));
    let to = lines.iter().filter_map(|line| line.last()).fold(f64::INFINITY, |x, p| x.min(p.0));
    if from >= to || !from.is_finite() || !to.is_finite() {
        return Vec::new();
    }
    let at = |x: f64| {
        let values: Vec<f64> = lines.iter().filter_map(|line| interpolated(line, x)).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let (low, high) = values.iter().fold((mean, mean), |(l, h), v| (l.min(*v), h.max(*v)));
        Spread { x, low, mean, high }
    };
    (0..=80).map(|i| at(from + (to - from) * f64::from(i) / 80.0)).collect()
}

fn interpolated(line: &[(f64, f64)], x: f64) -> Option<f64> {
    let after = line.iter().position(|point| point.0 >= x)?;
    let (b, a) = (line[after], line[after.saturating_sub(1)]);
    let share = if b.0 > a.0 { (x - a.0) / (b.0 - a.0) } else { 1.0 };
    Some(a.1 + share * (b.1 - a.1))
}

fn trend_chart(study: &Study, trend: &Trend, results: &[VariantResult]) -> Chart {
    let unit = results.iter().find_map(|result| {
        result.metrics().find(|(name, ..)| *name == trend.metric).map(|(.., unit)| unit.to_owned())
    });
    let y_label = match unit.as_deref() {
        Some("-") | None => trend.metric.clone(),
        Some(unit) => format!("{} [{unit}]", trend.metric),
    };
    let mut chart =
        Chart { title: trend.title.clone(), x_label: trend.over.clone(), y_label, series: Vec::new() };
    let Some(axis) = study.axis(&trend.over) else { return chart };
    let place = |label: &String| {
        let number = study.axes[axis].values.iter().position(|choice| choice.label == *label);
        label.parse::<f64>().unwrap_or(number.unwrap_or(0) as f64)
    };
    for (colour, (name, members)) in groups(study, &trend.by, &trend.only, results).into_iter().enumerate() {
        let points: Vec<(f64, f64)> = members
            .iter()
            .filter_map(|member| Some((place(&member.labels[axis]), member.metric(&trend.metric)?)))
            .collect();
        let mut at: BTreeMap<u64, (f64, f64, f64)> = BTreeMap::new();
        for &(x, y) in &points {
            let sum = at.entry(ordered(x)).or_insert((x, 0.0, 0.0));
            (sum.1, sum.2) = (sum.1 + y, sum.2 + 1.0);
        }
        let means = at.into_values().map(|(x, sum, n)| (x, sum / n)).collect();
        chart.series.push(Series { name, colour, mark: Mark::Line, points: means });
        chart.series.push(Series { name: String::new(), colour, mark: Mark::Ring, points });
    }
    chart
}

/// Bits that sort as the numbers do.
fn ordered(x: f64) -> u64 {
    let bits = (x + 0.0).to_bits();
    if x < 0.0 { !bits } else { bits | (1 << 63) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_band_of_two_straight_lines_is_between_them_over_their_common_range() {
        let lines = vec![vec![(0.0, 0.0), (2.0, 2.0)], vec![(1.0, 3.0), (3.0, 9.0)]];
        let band = band(&lines);
        assert_eq!((band[0].x, band[80].x), (1.0, 2.0));
        for Spread { x, low, mean, high } in band {
            let (a, b) = (x, 3.0 * x);
            assert!(
                (low - a).abs() < 1e-12 && (high - b).abs() < 1e-12 && (mean - (a + b) / 2.0).abs() < 1e-12
            );
        }
    }

    #[test]
    fn the_energy_residual_of_every_variant_is_shown_whatever_columns_are_asked_for() {
        let axis = r#"(axes: [(name: "seed", values: [(label: "1", set: {}), (label: "2", set: {}), (label: "3", set: {})])], columns: ["grains"])"#;
        let study: Study = crate::scene::dialect().from_str(axis).unwrap();
        let result = |(variant, residual): (&Variant, Option<f64>)| VariantResult {
            labels: variant.labels.clone(),
            folder: PathBuf::new(),
            summary: serde_json::json!({"energy": residual.map(|r| serde_json::json!({"residual_fraction": r}))}),
        };
        let variants = study.variants();
        let outcome_of = |residuals: [Option<f64>; 3]| {
            outcome(&study, &variants.iter().zip(residuals).map(result).collect::<Vec<_>>())
        };
        let seen = outcome_of([Some(1e-3), Some(-2e-3), None]);
        let metric = |name: &str| seen.metrics.iter().find(|m| m.name == name).map(|m| m.value);
        assert_eq!(metric("1: energy residual over work or loss"), Some(1e-3));
        assert_eq!(metric("largest energy residual over work or loss of all variants"), Some(-2e-3));
        let Section { heads, rows, .. } = &seen.sections[0];
        assert_eq!(heads[1..], ["energy residual over work or loss [-]", "time [s]"]);
        assert_eq!([0, 1, 2].map(|i| rows[i][1].as_str()), ["0.001000", "-0.002000", ""]);
        // Where nothing moves there is no such column.
        let still = outcome_of([None; 3]);
        assert!(still.metrics.is_empty() && still.sections[0].heads == ["seed", "time [s]"]);
    }

    #[test]
    fn pictures_of_variants_are_shown_with_their_labels_and_missing_ones_are_told() {
        let axis = r#"(axes: [(name: "c [m]", values: [(label: "1", set: {}), (label: "2", set: {})])], pictures: ["ruts", "tracks"])"#;
        let study: Study = crate::scene::dialect().from_str(axis).unwrap();
        let home = tempfile::tempdir().unwrap();
        let result = |variant: &Variant| {
            let folder = home.path().join(variant.folder());
            fs::create_dir(&folder).unwrap();
            fs::write(folder.join("ruts.png"), &variant.labels[0]).unwrap();
            let summary = serde_json::json!({"pictures": {"ruts": "Sinkage: white 0"}});
            VariantResult { labels: variant.labels.clone(), folder, summary }
        };
        let results: Vec<VariantResult> = study.variants().iter().map(result).collect();
        let pictures = outcome(&study, &results).pictures;
        let seen: Vec<_> =
            pictures.iter().map(|p| (p.name.as_str(), p.caption.as_str(), p.png.as_slice())).collect();
        let expected =
            [("1_ruts", "c 1 m: Sinkage: white 0", &b"1"[..]), ("2_ruts", "c 2 m: Sinkage: white 0", b"2")];
        assert_eq!(seen, expected);
        assert_eq!(
            missing_pictures(&study, &results),
            ["study.pictures: no variant has left tracks.png; there are ruts"]
        );
    }

    #[test]
    fn numbers_are_sorted_by_size_whatever_their_sign() {
        let mut numbers = [3.0, -1.0, 0.0, -20.0, 0.5];
        numbers.sort_by_key(|x| ordered(*x));
        assert_eq!(numbers, [-20.0, -1.0, 0.0, 0.5, 3.0]);
    }
}
