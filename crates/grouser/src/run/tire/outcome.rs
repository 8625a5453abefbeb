//! What has come of rolling: traction by both definitions, sinkage, deflection and contact patch, pictures.

use super::parts;
use super::tire_run::Rolled;
use crate::output::chart::{Chart, Mark, Series};
use crate::output::summary::Metric;
use crate::run::experiment::{Outcome, Picture, Section, Verdict};
use crate::run::report::number;
use crate::scene::Scenario;
use std::collections::BTreeMap;

/// Share of the travel, at its end, over which means are taken [-].
const EVALUATED: f64 = 0.6;

/// Mean, smallest and largest of a column over the evaluated travel.
#[derive(Clone, Copy, Debug)]
struct Spread {
    mean: f64,
    low: f64,
    high: f64,
}

/// Columns whose spread is reported, with their names and units.
const SPREADS: [(&str, &str, &str); 8] = [
    ("gross_tractive_effort", "gross tractive effort T_H", "N"),
    ("running_resistance", "running resistance T_R", "N"),
    ("drawbar_pull", "drawbar pull T_P", "N"),
    ("torque_over_radius", "torque over radius", "N"),
    ("torque_over_radius_minus_pull", "torque over radius minus drawbar pull", "N"),
    ("force_z", "vertical force", "N"),
    ("sinkage", "sinkage while travelling", "m"),
    ("deflection", "deflection while travelling", "m"),
];

impl Rolled {
    fn rows(&self) -> std::ops::Range<usize> {
        let time = self.table.column("time");
        let end = time.last().copied().unwrap_or(0.0);
        let from = end - EVALUATED * (end - self.travel_from);
        let first = time.iter().position(|&t| t >= from).unwrap_or(time.len());
        first..time.len()
    }

    fn spread(&self, column: &str) -> Spread {
        let values = &self.table.column(column)[self.rows()];
        let n = values.len().max(1) as f64;
        Spread {
            mean: values.iter().sum::<f64>() / n,
            low: values.iter().copied().fold(f64::INFINITY, f64::min),
            high: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        }
    }

    /// Value of a column when the load was reached.
    fn when_sunk(&self, column: &str) -> f64 {
        let time = self.table.column("time");
        let row = time.iter().rposition(|&t| t <= self.travel_from).unwrap_or(0);
        self.table.column(column).get(row).copied().unwrap_or(f64::NAN)
    }
}

/// Everything that follows from the tire that has travelled its way; nothing but the grains' number before.
pub fn outcome(scenario: &Scenario, n_grains: usize, done: &[Rolled]) -> Outcome {
    let mut outcome = Outcome { conventions: conventions(), ..Outcome::default() };
    outcome.metrics.push(beside("grains, beside the paper's", n_grains as f64, "-", 21_812.0, "P0 Table 2"));
    let Some(tire) = done.first() else { return outcome };
    outcome.energy = Some(tire.ledger.energy());
    outcome.metrics.extend(metrics(scenario, tire));
    outcome.tables = vec![("tire".into(), tire.table.clone())];
    outcome.charts = charts(tire);
    outcome.verdict = Some(verdict(tire));
    outcome.sections = vec![table(tire)];
    outcome.files.clone_from(&tire.files);
    let picture = |(name, caption, png): &(String, String, Vec<u8>)| Picture {
        name: name.clone(),
        caption: caption.clone(),
        png: png.clone(),
    };
    outcome.pictures = tire.pictures.iter().map(picture).collect();
    outcome
}

fn conventions() -> BTreeMap<&'static str, String> {
    let evaluated = 100.0 * EVALUATED;
    BTreeMap::from([
        (
            "axes",
            "x along the travel, y along the axle, z up; the origin is a lower corner of the box".into(),
        ),
        (
            "slip",
            "(ω R − v)/(ω R) with the outer radius R of the size code; ω follows from slip and speed".into(),
        ),
        ("sinkage", "height of the undisturbed surface minus height of the tire's lowest point".into()),
        (
            "deflection",
            "radius of the inflated tire without load minus height of the axle above its lowest point".into(),
        ),
        (
            "gross_tractive_effort",
            "T_H: sum over contacts of the forces on the tire that point along x".into(),
        ),
        (
            "running_resistance",
            "T_R: sum over contacts of the forces on the tire that point against x".into(),
        ),
        ("drawbar_pull", "T_P = T_H − |T_R|".into()),
        (
            "second definition",
            "T_H = torque of the drive over R, |T_R| = T_H − T_P, as the measurements were evaluated".into(),
        ),
        ("contact patch", "area of the convex hull of the contact points, seen from above".into()),
        (
            "means",
            format!("mean, smallest and largest sample of the last {evaluated:.0} % of the travel's time"),
        ),
        ("moments_about", "the axle".into()),
    ])
}

fn beside(name: &str, value: f64, unit: &str, reference: f64, source: &str) -> Metric {
    let (reference, source) = (Some(reference), Some(source.into()));
    Metric { reference, source, ..Metric::new(name, value, unit) }
}

fn metrics(scenario: &Scenario, tire: &Rolled) -> Vec<Metric> {
    let mut metrics = Vec::new();
    if tire.n_elements > 0 {
        let n = tire.n_elements as f64;
        metrics.push(beside("elements, beside the paper's", n, "-", 24_287.0, "P0 Table 2"));
        metrics.push(Metric::new("sub-steps of the tread in a step", f64::from(tire.sub_steps), "-"));
        metrics.push(Metric::new("steps with a refit of the boxes", tire.refit_share, "-"));
    }
    for (column, name, unit) in SPREADS {
        metrics.push(Metric::new(name, tire.spread(column).mean, unit));
    }
    let over_load = tire.spread("drawbar_pull").mean / tire.spread("force_z").mean;
    metrics.push(Metric::new("drawbar pull over vertical force", over_load, "-"));
    for (column, name) in [("sinkage", "sinkage at full load"), ("deflection", "deflection at full load")] {
        metrics.push(Metric::new(name, tire.when_sunk(column), "m"));
    }
    let patch = tire.when_sunk("contact_patch");
    metrics.push(match parts(scenario) {
        Some((shape, roll)) if shape.inflation_pa > 0.0 => {
            let expected = roll.load_n / shape.inflation_pa;
            let source = "load over inflation pressure; 5 kN over 0.14 MPa in P0 Tables 1 and 2";
            beside("contact patch at full load", patch, "m²", expected, source)
        }
        _ => Metric::new("contact patch at full load", patch, "m²"),
    });
    let deepest = tire.table.column("deepest_overlap").into_iter().fold(0.0, f64::max);
    metrics.push(Metric::new("largest overlap over a grain's radius", deepest, "-"));
    let energy = tire.ledger.energy();
    metrics.push(Metric::new("energy residual", energy.residual_fraction, "-"));
    let [all, solid, contacts] = tire.spent;
    if all > 0.0 && tire.n_elements > 0 {
        metrics.push(Metric::new("share of the clock's time in the tread", solid / all, "-"));
        metrics.push(Metric::new("share of the clock's time in the tread's contacts", contacts / all, "-"));
    }
    metrics
}

/// Mean, smallest and largest of what was measured while travelling.
fn table(tire: &Rolled) -> Section {
    let row = |&(column, name, unit): &(&str, &str, &str)| {
        let Spread { mean, low, high } = tire.spread(column);
        vec![format!("{name} [{unit}]"), number(mean), number(low), number(high)]
    };
    Section::new(
        "While travelling",
        &["quantity", "mean", "smallest", "largest"],
        SPREADS.iter().map(row).collect(),
    )
}

fn charts(tire: &Rolled) -> Vec<(String, Chart)> {
    let chart = |title: &str, x: &str, y_label: &str, columns: &[&str]| {
        let line = |(colour, column): (usize, &&str)| Series {
            name: column.replace('_', " "),
            colour,
            mark: Mark::Line,
            points: tire.table.column(x).into_iter().zip(tire.table.column(column)).collect(),
        };
        Chart {
            title: title.into(),
            x_label: tire.table.label(x),
            y_label: y_label.into(),
            series: columns.iter().enumerate().map(line).collect(),
        }
    };
    let forces =
        ["force_z", "gross_tractive_effort", "running_resistance", "drawbar_pull", "torque_over_radius"];
    vec![
        ("forces".into(), chart("Forces of the ground on the tire", "time", "force [N]", &forces)),
        ("heights".into(), chart("Sinkage and deflection", "time", "[m]", &["sinkage", "deflection"])),
    ]
}

fn verdict(tire: &Rolled) -> Verdict {
    let of = |column: &str| tire.spread(column).mean;
    let (pull, gross, resistance) =
        (of("drawbar_pull"), of("gross_tractive_effort"), of("running_resistance"));
    let sign = if pull > 0.0 { "The tire pulls" } else { "The tire must be pushed" };
    let text = format!(
        "{sign}: T_H {} N, T_R {} N, drawbar pull T_P {} N; sinkage {:.1} mm and deflection {:.1} mm at full load.",
        number(gross),
        number(resistance),
        number(pull),
        1e3 * tire.when_sunk("sinkage"),
        1e3 * tire.when_sunk("deflection"),
    );
    let source = "No value of P0 Fig. 15 is printed; its trends are T_P > 0 at 5 % slip, T_H > |T_R|, T_P rising with slip".into();
    Verdict { heading: "Traction".into(), text, source }
}
