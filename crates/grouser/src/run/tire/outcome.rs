//! What has come of rolling: traction over slip, the models side by side, pictures.

use super::variant::parts;
use super::{Rolled, TireLedger};
use crate::output::chart::{Chart, Mark, Series};
use crate::output::summary::Metric;
use crate::run::experiment::{Outcome, Picture, Section, Verdict};
use crate::run::report::number;
use crate::scene::{Scenario, Tread};
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

impl Spread {
    fn text(&self) -> String {
        format!("{} ({} … {})", number(self.mean), number(self.low), number(self.high))
    }
}

/// Everything that follows from the tires that have travelled their way.
pub fn outcome(scenario: &Scenario, n_grains: usize, done: &[Rolled]) -> Outcome {
    let ledgers: Vec<TireLedger> = done.iter().map(|tire| tire.ledger).collect();
    let picture = |(name, caption, png): &(String, String, Vec<u8>)| Picture {
        name: name.clone(),
        caption: caption.clone(),
        png: png.clone(),
    };
    Outcome {
        energy: Some(TireLedger::energy(&ledgers)),
        conventions: conventions(),
        metrics: metrics(scenario, n_grains, done),
        tables: done.iter().map(|tire| (tire.variant.name(), tire.table.clone())).collect(),
        charts: charts(done),
        pictures: done.iter().flat_map(|tire| &tire.pictures).map(picture).collect(),
        files: done.iter().flat_map(|tire| tire.files.clone()).collect(),
        verdict: verdict(done),
        sections: vec![side_by_side(done)],
        ..Outcome::default()
    }
}

fn conventions() -> BTreeMap<&'static str, String> {
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
            "outer radius of the size code minus height of the axle above the tire's lowest point".into(),
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
            format!(
                "mean, smallest and largest sample of the last {:.0} % of the travel's time",
                100.0 * EVALUATED
            ),
        ),
        ("moments_about", "the axle".into()),
    ])
}

/// The table of all variants.
fn side_by_side(done: &[Rolled]) -> Section {
    let row = |tire: &Rolled| {
        let [all, solid, contacts] = tire.spent;
        let share = |part: f64| {
            if all > 0.0 && tire.n_elements > 0 {
                format!("{:.0} %", 100.0 * part / all)
            } else {
                "–".into()
            }
        };
        let cost = if all > 0.0 { format!("{all:.1} s") } else { "–".into() };
        let mut row = vec![tire.variant.label()];
        row.extend(
            ["drawbar_pull", "gross_tractive_effort", "running_resistance", "torque_over_radius", "force_z"]
                .map(|column| tire.spread(column).text()),
        );
        row.push(format!("{:.1}", 1e3 * tire.when_sunk("sinkage")));
        row.push(format!("{:.1}", 1e3 * tire.when_sunk("deflection")));
        row.push(format!("{:.4}", tire.when_sunk("contact_patch")));
        row.push(format!("{:.2} %", 100.0 * tire.ledger.residual_fraction()));
        row.extend([cost, share(solid), share(contacts)]);
        row
    };
    let heads = [
        "tire",
        "drawbar pull T_P [N]",
        "T_H [N]",
        "T_R [N]",
        "torque/R [N]",
        "vertical force [N]",
        "sinkage at full load [mm]",
        "deflection [mm]",
        "contact patch [m²]",
        "energy residual",
        "time by the clock",
        "of it the solid",
        "of it contacts",
    ];
    Section::new("Tires side by side: mean (smallest … largest)", &heads, done.iter().map(row).collect())
}

fn metrics(scenario: &Scenario, n_grains: usize, done: &[Rolled]) -> Vec<Metric> {
    let mut metrics = Vec::new();
    let paper = |name: &str, value: f64, unit: &str, reference: f64, source: &str| Metric {
        name: name.into(),
        value,
        unit: unit.into(),
        reference: Some(reference),
        uncertainty: None,
        source: Some(source.into()),
    };
    metrics.push(paper("grains, beside the paper's", n_grains as f64, "-", 21_812.0, "P0 Table 2"));
    for tire in done {
        let label = tire.variant.label();
        if tire.n_elements > 0 {
            let name = format!("{label}: elements, beside the paper's");
            metrics.push(paper(&name, tire.n_elements as f64, "-", 24_287.0, "P0 Table 2"));
        }
        for (column, name) in [
            ("drawbar_pull", "drawbar pull"),
            ("gross_tractive_effort", "gross tractive effort"),
            ("running_resistance", "running resistance"),
            ("torque_over_radius", "torque over radius"),
        ] {
            metrics.push(Metric::new(format!("{label}: {name}"), tire.spread(column).mean, "N"));
        }
        metrics.push(Metric::new(format!("{label}: sinkage at full load"), tire.when_sunk("sinkage"), "m"));
        metrics.push(Metric::new(
            format!("{label}: deflection at full load"),
            tire.when_sunk("deflection"),
            "m",
        ));
        let patch = tire.when_sunk("contact_patch");
        let name = format!("{label}: contact patch, beside load over inflation pressure");
        match parts(scenario) {
            Some((shape, roll)) if shape.inflation_pa > 0.0 => {
                let expected = roll.load_n / shape.inflation_pa;
                metrics.push(paper(&name, patch, "m²", expected, "5 kN over 0.14 MPa in P0 Tables 1 and 2"));
            }
            _ => metrics.push(Metric::new(name, patch, "m²")),
        }
        let residual = tire.ledger.residual_fraction();
        metrics.push(Metric::new(format!("{label}: energy residual"), residual, "-"));
    }
    metrics
}

fn charts(done: &[Rolled]) -> Vec<(String, Chart)> {
    let line = |column: &'static str, colour: usize, tire: &Rolled| {
        let points = tire.table.column("time").into_iter().zip(tire.table.column(column)).collect();
        Series { name: column.replace('_', " "), colour, mark: Mark::Line, points }
    };
    let mut charts: Vec<(String, Chart)> = done
        .iter()
        .map(|tire| {
            let chart = Chart {
                title: tire.variant.label(),
                x_label: "time [s]".into(),
                y_label: "force [N]".into(),
                series: ["force_z", "gross_tractive_effort", "running_resistance", "drawbar_pull"]
                    .into_iter()
                    .enumerate()
                    .map(|(colour, column)| line(column, colour, tire))
                    .collect(),
            };
            (format!("{}_forces", tire.variant.name()), chart)
        })
        .collect();
    let mut over_slip = Vec::new();
    for (k, tread) in ["lugged", "smooth"].into_iter().enumerate() {
        let is_its = |tire: &&Rolled| (tire.variant.tread == Tread::Smooth) == (tread == "smooth");
        for (c, (column, mark)) in
            [("drawbar_pull", Mark::Line), ("gross_tractive_effort", Mark::Dashes)].into_iter().enumerate()
        {
            let mut points: Vec<(f64, f64)> = done
                .iter()
                .filter(is_its)
                .map(|tire| (100.0 * tire.variant.slip, tire.spread(column).mean))
                .collect();
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            if points.len() > 1 {
                let name = format!("{tread}: {}", column.replace('_', " "));
                over_slip.push(Series { name, colour: 2 * k + c, mark, points });
            }
        }
    }
    if !over_slip.is_empty() {
        let chart = Chart {
            title: "Traction over slip".into(),
            x_label: "slip [%]".into(),
            y_label: "force [N]".into(),
            series: over_slip,
        };
        charts.insert(0, ("traction_over_slip".into(), chart));
    }
    charts
}

fn verdict(done: &[Rolled]) -> Option<Verdict> {
    let first = done.first()?;
    let of = |tire: &Rolled, column: &str| tire.spread(column).mean;
    let (pull, gross, resistance) =
        (of(first, "drawbar_pull"), of(first, "gross_tractive_effort"), of(first, "running_resistance"));
    let sign = if pull > 0.0 { "The tire pulls" } else { "The tire must be pushed" };
    let mut text = format!(
        "{sign}: T_H {} N, T_R {} N, drawbar pull T_P {} N ({}).",
        number(gross),
        number(resistance),
        number(pull),
        first.variant.label()
    );
    let slips: Vec<&Rolled> = done
        .iter()
        .filter(|t| t.variant.tread == first.variant.tread && t.variant.model == first.variant.model)
        .collect();
    if slips.len() > 1 {
        let last = slips[slips.len() - 1];
        text += &format!(
            " From slip {:.0} % to {:.0} % the pull goes from {} N to {} N.",
            100.0 * slips[0].variant.slip,
            100.0 * last.variant.slip,
            number(of(slips[0], "drawbar_pull")),
            number(of(last, "drawbar_pull"))
        );
    }
    let same = |tire: &&Rolled| {
        tire.variant.tread != first.variant.tread
            && tire.variant.model == first.variant.model
            && tire.variant.slip == first.variant.slip
    };
    if let Some(other) = done.iter().find(same) {
        text += &format!(" {}: pull {} N.", other.variant.label(), number(of(other, "drawbar_pull")));
    }
    let source = "No value of P0 Fig. 15 is printed; its trends are T_P > 0 at 5 % slip, T_H > |T_R|, T_P rising with slip".into();
    Some(Verdict { heading: "Traction".into(), text, source })
}
