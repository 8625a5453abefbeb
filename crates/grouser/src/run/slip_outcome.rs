//! What has come of a wheel's slips: predictions beside measurements, every model in one table.

use super::experiment::{Outcome, Section, Verdict};
use super::report::number;
use super::slip_sweep::{Model, Scene, SlipSweep, plate_fit};
use crate::output::chart::{Chart, Mark, Series};
use crate::output::summary::{Energy, EnergyEntry, Metric};
use crate::scene::{ContactSize, Scenario, SlipPoint, WheelMeasured};
use grouser_iscm::wheel::OperatingPoint;
use std::collections::BTreeMap;

/// Everything that follows from the steady states found so far.
pub fn outcome(scenario: &Scenario, sweep: &SlipSweep) -> Outcome {
    let measured = scenario.reference.iter().find_map(|reference| reference.wheel());
    let found = Found { scenario, sweep, measured };
    Outcome {
        energy: found.energy(),
        conventions: conventions(),
        metrics: found.metrics(),
        tables: vec![("slips".into(), sweep.table.clone())],
        charts: found.charts(),
        verdict: found.verdict(),
        sections: vec![found.prediction(), found.models(), found.soil()],
        ..Outcome::default()
    }
}

fn conventions() -> BTreeMap<&'static str, String> {
    BTreeMap::from([
        ("slip", "(ωR − v)/(ωR): positive while driving, below zero while braking".into()),
        ("sinkage", "undisturbed ground minus lowest point of the wheel".into()),
        (
            "drawbar_pull",
            "net forward force of the ground on the wheel: thrust minus compaction resistance".into(),
        ),
        ("torque", "of the drive on the wheel, positive forwards".into()),
        ("work", "per metre of rim: power over ωR".into()),
        ("model", "column of slips.csv: number of the model in the report's table, counted from 0".into()),
        ("axes", "x forwards, y left, z up".into()),
    ])
}

/// Predictions and what they are compared with.
struct Found<'a> {
    scenario: &'a Scenario,
    sweep: &'a SlipSweep,
    measured: Option<&'a WheelMeasured>,
}

impl Found<'_> {
    fn slips(&self) -> &[SlipPoint] {
        let points = &Scene::of(self.scenario).slips.points;
        &points[..self.sweep.points.len().min(points.len())]
    }

    /// Measured slip, sinkage [m] and drawbar pull over load [-] nearest to a slip, within 0.02.
    fn measured_at(&self, slip: f64) -> Option<(f64, f64)> {
        let points = &self.measured?.points;
        let nearest = points.iter().min_by(|a, b| (a.slip - slip).abs().total_cmp(&(b.slip - slip).abs()))?;
        ((nearest.slip - slip).abs() < 0.02).then_some((nearest.sinkage_m, nearest.pull_over_load))
    }

    /// Pull over load, predicted minus measured, where both are known: (slip, difference), slips from 0 on.
    fn pull_errors(&self, model: usize) -> Vec<(f64, f64)> {
        let pairs = self.slips().iter().zip(&self.sweep.points);
        pairs
            .filter(|(at, _)| at.slip > -0.02)
            .filter_map(|(at, found)| {
                let (_, pull) = self.measured_at(at.slip)?;
                Some((at.slip, found[model].drawbar_pull / at.load_n - pull))
            })
            .collect()
    }

    fn verdict(&self) -> Option<Verdict> {
        let measured = self.measured?;
        let (at, found) = self
            .slips()
            .iter()
            .zip(&self.sweep.points)
            .min_by(|a, b| a.0.slip.abs().total_cmp(&b.0.slip.abs()))?;
        let (sinkage, _) = self.measured_at(at.slip)?;
        let errors = self.pull_errors(0);
        let within = errors.iter().filter(|(_, e)| e.abs() <= 0.03).count();
        let worst = errors.iter().copied().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
        Some(Verdict {
            heading: "From plates to a wheel".into(),
            text: format!(
                "At zero slip the wheel is predicted to sink {:.1} mm and sank {:.1} mm. Drawbar pull over load is within 0.03 of the \
                 measurement at {within} of {} slips from 0 on; the largest difference is {:+.3} at slip {:.3}.",
                1e3 * found[0].sinkage,
                1e3 * sinkage,
                errors.len(),
                worst.1,
                worst.0
            ),
            source: format!("Measurement: {}", measured.source),
        })
    }

    /// Every slip with both fidelities beside the measurement.
    fn prediction(&self) -> Section {
        let heads = [
            "slip",
            "sinkage measured [mm]",
            "closed form",
            "grid",
            "pull over load measured [-]",
            "closed form",
            "grid",
            "torque [N·m]",
        ];
        let rows = self.slips().iter().zip(&self.sweep.points).map(|(at, found)| {
            let known = self.measured_at(at.slip);
            let or_blank =
                |value: Option<f64>, digits: usize| value.map_or(String::new(), |v| format!("{v:.digits$}"));
            vec![
                format!("{:.3}", at.slip),
                or_blank(known.map(|k| 1e3 * k.0), 1),
                format!("{:.1}", 1e3 * found[0].sinkage),
                format!("{:.1}", 1e3 * found[1].sinkage),
                or_blank(known.map(|k| k.1), 3),
                format!("{:.3}", found[0].drawbar_pull / at.load_n),
                format!("{:.3}", found[1].drawbar_pull / at.load_n),
                format!("{:.3}", found[0].torque),
            ]
        });
        Section::new("Predicted from the plates, and measured", &heads, rows.collect())
    }

    /// All models: how far off, and what they cost.
    fn models(&self) -> Section {
        let heads = [
            "number",
            "model",
            "largest difference of pull over load [-]",
            "largest difference to the closed form: sinkage [%]",
            "pull over load [-]",
            "force evaluations a slip",
            "largest energy residual [-]",
        ];
        let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0_f64, |a, b| a.max(b.abs()));
        let rows = Model::ALL.iter().enumerate().map(|(k, model)| {
            let points = &self.sweep.points;
            let exact = k - k % 2;
            let loads = self.slips().iter().map(|at| at.load_n);
            let mean =
                points.iter().map(|p| p[k].n_evaluations as f64).sum::<f64>() / points.len().max(1) as f64;
            vec![
                k.to_string(),
                model.label(),
                number(largest(&mut self.pull_errors(k).into_iter().map(|e| e.1))),
                number(100.0 * largest(&mut points.iter().map(|p| p[k].sinkage / p[exact].sinkage - 1.0))),
                number(largest(
                    &mut points
                        .iter()
                        .zip(loads)
                        .map(|(p, w)| (p[k].drawbar_pull - p[exact].drawbar_pull) / w),
                )),
                format!("{mean:.1}"),
                number(largest(&mut points.iter().map(|p| p[k].energy_residual()))),
            ]
        });
        Section::new("Fidelities", &heads, rows.collect())
    }

    /// The fitted ground, and what the choice of the contact's size does.
    fn soil(&self) -> Section {
        let soil = Scene::of(self.scenario).soil;
        let mut rows = Vec::new();
        if let Some(fit) = plate_fit(self.scenario, soil) {
            let of = |value: f64, half: f64| format!("{} ± {}", number(value), number(half));
            rows.push(vec!["k_c [kPa/m^(n−1)]".into(), of(1e-3 * fit.k_c.value, 1e-3 * fit.k_c.half_width)]);
            rows.push(vec!["k_φ [kPa/mⁿ]".into(), of(1e-3 * fit.k_phi.value, 1e-3 * fit.k_phi.half_width)]);
            rows.push(vec!["n [-]".into(), of(fit.n.value, fit.n.half_width)]);
            rows.push(vec!["rms over mean pressure".into(), format!("{:.1} %", 100.0 * fit.relative_rms)]);
        }
        rows.push(vec!["b of the wheel [mm]".into(), number(1e3 * self.sweep.size_m)]);
        for (rule, sinkage) in ContactSize::ALL.iter().zip(self.sweep.sinkage_by_size) {
            rows.push(vec![
                format!("sinkage at zero slip [mm], b = {}", rule.label()),
                number(1e3 * sinkage),
            ]);
        }
        Section::new("Ground fitted to the plates, p = (k_c/b + k_φ) zⁿ, ± 95 % confidence", &["", ""], rows)
    }

    fn metrics(&self) -> Vec<Metric> {
        let mut metrics = Vec::new();
        let source = self.measured.map(|measured| measured.source.clone());
        for (at, found) in self.slips().iter().zip(&self.sweep.points) {
            let known = self.measured_at(at.slip);
            for (fidelity, p) in [("closed form", &found[0]), ("grid", &found[1])] {
                let mut push = |name: &str, value: f64, unit: &str, reference: Option<f64>| {
                    metrics.push(Metric {
                        name: format!("{name} at slip {}, {fidelity}", at.slip),
                        value,
                        unit: unit.into(),
                        reference,
                        uncertainty: None,
                        source: reference.and(source.clone()),
                    });
                };
                push("sinkage", p.sinkage, "m", known.map(|k| k.0));
                push("drawbar pull over load", p.drawbar_pull / at.load_n, "-", known.map(|k| k.1));
                push("torque", p.torque, "N·m", None);
                if p.drawbar_pull > 0.0 && p.axle_work > 0.0 {
                    push("tractive efficiency", p.tractive_efficiency(), "-", None);
                }
            }
        }
        metrics
    }

    /// Work of one metre of rim at each slip, added up.
    fn energy(&self) -> Option<Energy> {
        let sum =
            |pick: fn(&OperatingPoint) -> f64| self.sweep.points.iter().map(|p| pick(&p[1])).sum::<f64>();
        let (axle, drawbar) = (sum(|p| p.axle_work), sum(|p| p.drawbar_work));
        let (compaction, shear) = (sum(|p| p.compaction_loss), sum(|p| p.shear_loss));
        let largest = [axle, drawbar, compaction, shear].iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        let entry = |name: &str, value: f64| EnergyEntry { name: name.into(), value_J: value };
        (largest > 0.0).then(|| Energy {
            input_J: axle,
            stored_J: 0.0,
            dissipated_J: compaction + shear,
            residual_fraction: (axle - drawbar - compaction - shear) / largest,
            entries: vec![
                entry("axle, one metre of rim at every slip, grid", axle),
                entry("drawbar", drawbar),
                entry("compaction", compaction),
                entry("shear", shear),
            ],
        })
    }

    fn charts(&self) -> Vec<(String, Chart)> {
        let chart = |title: &str, y_label: &str| Chart {
            title: title.into(),
            x_label: "slip [-]".into(),
            y_label: y_label.into(),
            series: Vec::new(),
        };
        let mut sinkage = chart("Sinkage of the wheel", "sinkage z [mm]");
        let mut pull = chart("Drawbar pull over load", "drawbar pull over load [-]");
        let curve = |k: usize, pick: &dyn Fn(&SlipPoint, &OperatingPoint) -> f64| -> Vec<(f64, f64)> {
            let pairs = self.slips().iter().zip(&self.sweep.points);
            pairs.map(|(at, found)| (at.slip, pick(at, &found[k]))).collect()
        };
        for (k, model) in Model::ALL.iter().enumerate() {
            let mark = if model.is_grid { Mark::Dashes } else { Mark::Line };
            let series = |points| Series { name: model.label(), colour: 1 + k / 2, mark, points };
            sinkage.series.push(series(curve(k, &|_, p| 1e3 * p.sinkage)));
            pull.series.push(series(curve(k, &|at, p| p.drawbar_pull / at.load_n)));
        }
        if let Some(measured) = self.measured {
            let ring = |points| Series { name: "measured".into(), colour: 0, mark: Mark::Ring, points };
            let of = |pick: &dyn Fn(&crate::scene::WheelPoint) -> f64| {
                measured.points.iter().map(|p| (p.slip, pick(p))).collect::<Vec<_>>()
            };
            sinkage.series.push(ring(of(&|p| 1e3 * p.sinkage_m)));
            pull.series.push(ring(of(&|p| p.pull_over_load)));
        }
        if self.sweep.points.is_empty() {
            return Vec::new();
        }
        vec![("drawbar_pull".into(), pull), ("sinkage".into(), sinkage)]
    }
}
