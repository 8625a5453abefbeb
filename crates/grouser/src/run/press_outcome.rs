//! What has come of pressing: curves over measured ones, fits of both, metrics, charts.

use super::experiment::{Outcome, Section, Verdict};
use super::press::Pressed;
use super::report::number;
use super::tool_ledger::ToolLedger;
use crate::calibration::{Estimated, PlateFit, PlatePoint, fit_plates};
use crate::output::chart::{Chart, Mark, Series};
use crate::output::summary::Metric;
use crate::scene::{Motion, PressureSinkage, Scenario};
use std::collections::BTreeMap;

/// Everything that follows from the tools that have reached their depth.
pub fn outcome(scenario: &Scenario, done: &[Pressed]) -> Outcome {
    let comparison = Comparison::new(scenario, done);
    let ledgers: Vec<ToolLedger> = done.iter().map(|tool| tool.ledger).collect();
    Outcome {
        energy: Some(ToolLedger::energy(&ledgers)),
        conventions: conventions(),
        metrics: comparison.metrics(),
        tables: done.iter().map(|tool| (tool.name.clone(), tool.table.clone())).collect(),
        charts: comparison.charts(),
        verdict: comparison.verdict(),
        sections: comparison.fits().into_iter().collect(),
        ..Outcome::default()
    }
}

/// Measured and simulated curves of a press, and the laws fitted to both.
pub struct Comparison<'a> {
    /// Plates that reached their depth.
    pub plates: &'a [Pressed],
    /// What was measured, when the scene has it.
    pub measured: Option<&'a PressureSinkage>,
    /// Fit to the simulated curves.
    pub fit: Option<PlateFit>,
    /// Fit to the measured points, over the same sinkages.
    pub fit_measured: Option<PlateFit>,
}

fn conventions() -> BTreeMap<&'static str, String> {
    BTreeMap::from([
        ("axes", "x and y along the surface, z up; the origin is a lower corner of the box".into()),
        (
            "sinkage",
            "height of the undisturbed surface minus height of the plate's lower face; the surface is the mean of \
             the highest points of grains over cells two grain diameters wide"
                .into(),
        ),
        ("pressure", "vertical force over the area of the plate's circle, mean over one sample interval".into()),
        ("force", "of the grains on the plate, world axes".into()),
        ("moments_about", "the centre of the plate's lower face".into()),
        ("power and work", "of the plate on the grains".into()),
        ("slip", "does not occur in this scene".into()),
    ])
}

impl<'a> Comparison<'a> {
    fn new(scenario: &'a Scenario, plates: &'a [Pressed]) -> Self {
        let measured = scenario.reference.iter().find_map(|reference| reference.plates());
        let depth = match &scenario.motion {
            Some(Motion::Press(press)) => press.depth_m,
            _ => 0.0,
        };
        let simulated: Vec<PlatePoint> = plates.iter().flat_map(Pressed::points).collect();
        let of_measurement = |measured: &PressureSinkage| -> Vec<PlatePoint> {
            let of_plate = |plate: &crate::scene::PlateCurve| {
                let radius = plate.diameter_m / 2.0;
                let points = plate.points.iter().filter(|(sinkage, _)| *sinkage <= depth);
                points
                    .map(move |&(sinkage, pressure)| PlatePoint { radius, sinkage, pressure })
                    .collect::<Vec<_>>()
            };
            measured.plates.iter().flat_map(of_plate).collect()
        };
        Self {
            plates,
            measured,
            fit: fit_plates(&simulated),
            fit_measured: measured.and_then(|measured| fit_plates(&of_measurement(measured))),
        }
    }

    /// Pairs of (sinkage, simulated, measured pressure) wherever both are known, for one plate.
    pub fn differences(&self, plate: &Pressed) -> Vec<(f64, f64, f64)> {
        let Some(measured) = self.measured else { return Vec::new() };
        let is_same = |curve: &&crate::scene::PlateCurve| (curve.diameter_m - plate.diameter).abs() < 1e-6;
        let curves = measured.plates.iter().filter(is_same);
        curves
            .flat_map(|curve| &curve.points)
            .filter_map(|&(sinkage, pressure)| Some((sinkage, plate.pressure_at(sinkage)?, pressure)))
            .collect()
    }

    /// How far simulation and measurement are apart, in words.
    fn verdict(&self) -> Option<Verdict> {
        let differences = self.plates.iter().flat_map(|plate| self.differences(plate));
        let ratios: Vec<f64> = differences
            .map(|(_, simulated, measured)| simulated / measured)
            .filter(|ratio| ratio.is_finite() && *ratio > 0.0)
            .collect();
        let measured = self.measured.filter(|_| !ratios.is_empty())?;
        let mean = (ratios.iter().map(|ratio| ratio.ln()).sum::<f64>() / ratios.len() as f64).exp();
        let (low, high) = ratios.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), r| (l.min(*r), h.max(*r)));
        Some(Verdict {
            heading: "How far apart".into(),
            text: format!(
                "Simulated pressure is {mean:.2} times the measured one on geometric average over {} points; the ratio \
                 runs from {low:.2} to {high:.2}.",
                ratios.len()
            ),
            source: format!("Measurement: {}", measured.source),
        })
    }

    /// The parameters fitted to both.
    fn fits(&self) -> Option<Section> {
        let row = |(name, fit): (&str, &PlateFit)| {
            let of = |e: &Estimated, scale: f64| {
                format!("{} ± {}", number(scale * e.value), number(scale * e.half_width))
            };
            vec![
                name.to_owned(),
                of(&fit.k_c, 1e-3),
                of(&fit.k_phi, 1e-3),
                of(&fit.n, 1.0),
                format!("{:.1} %", 100.0 * fit.relative_rms),
                fit.n_points.to_string(),
            ]
        };
        let fits = [("simulation", &self.fit), ("measurement", &self.fit_measured)];
        let rows: Vec<_> =
            fits.into_iter().filter_map(|(name, fit)| Some((name, fit.as_ref()?))).map(row).collect();
        let heads = ["", "k_c [kPa/m^(n−1)]", "k_φ [kPa/mⁿ]", "n [-]", "rms / mean", "points"];
        let title = "p = (k_c/b + k_φ) zⁿ with b the plate's radius, ± 95 % confidence";
        (!rows.is_empty()).then(|| Section::new(title, &heads, rows))
    }

    /// The charts of the report, by file name.
    pub fn charts(&self) -> Vec<(String, Chart)> {
        let mut curves = Chart {
            title: "Mean pressure under circular plates".into(),
            x_label: "sinkage z [mm]".into(),
            y_label: "mean pressure p [kPa]".into(),
            series: Vec::new(),
        };
        let scaled = |points: &mut dyn Iterator<Item = (f64, f64)>| -> Vec<(f64, f64)> {
            points.map(|(sinkage, pressure)| (1e3 * sinkage, 1e-3 * pressure)).collect()
        };
        for (colour, plate) in self.plates.iter().enumerate() {
            let label = &plate.label;
            let mut simulated = plate.points().into_iter().map(|p| (p.sinkage, p.pressure));
            let name = format!("{label} simulated");
            curves.series.push(Series { name, colour, mark: Mark::Line, points: scaled(&mut simulated) });
            let depth = plate.points().last().map_or(0.0, |point| point.sinkage);
            let is_same = |c: &&crate::scene::PlateCurve| (c.diameter_m - plate.diameter).abs() < 1e-6;
            for curve in self.measured.iter().flat_map(|m| m.plates.iter()).filter(is_same) {
                let mut points = curve.points.iter().copied().filter(|(sinkage, _)| *sinkage <= 1.05 * depth);
                let name = format!("{label} measured");
                curves.series.push(Series { name, colour, mark: Mark::Ring, points: scaled(&mut points) });
            }
            if let Some(fit) = &self.fit {
                let mut law = (0..=60).map(|k| {
                    let sinkage = depth * f64::from(k) / 60.0;
                    (sinkage, fit.pressure(plate.diameter / 2.0, sinkage))
                });
                let name = format!("{label} fitted to the simulation");
                curves.series.push(Series { name, colour, mark: Mark::Dashes, points: scaled(&mut law) });
            }
        }
        let mut work = Chart {
            title: "Work of the plates on the bed".into(),
            x_label: "sinkage z [mm]".into(),
            y_label: "work [J]".into(),
            series: Vec::new(),
        };
        for (colour, plate) in self.plates.iter().enumerate() {
            let (sinkage, spent) = (plate.table.column("sinkage"), plate.table.column("work"));
            let points = sinkage.into_iter().map(|z| 1e3 * z).zip(spent).collect();
            let name = plate.label.clone();
            work.series.push(Series { name, colour, mark: Mark::Line, points });
        }
        if self.plates.is_empty() {
            Vec::new()
        } else {
            vec![("pressure_sinkage".into(), curves), ("work".into(), work)]
        }
    }

    fn metrics(&self) -> Vec<Metric> {
        let mut metrics = Vec::new();
        for plate in self.plates {
            let label = &plate.label;
            for (sinkage, simulated, measured) in self.differences(plate) {
                metrics.push(Metric {
                    name: format!("{label}: pressure at {:.1} mm", 1e3 * sinkage),
                    value: simulated,
                    unit: "Pa".into(),
                    reference: Some(measured),
                    uncertainty: None,
                    source: self.measured.map(|measured| measured.source.clone()),
                });
            }
            for (name, share) in
                [("a quarter of the depth", 0.25), ("half the depth", 0.5), ("the depth", 1.0)]
            {
                let name = format!("{label}: pressure at {name}");
                metrics.push(Metric::new(&name, plate.mean_pressure_before(share), "Pa"));
            }
            let mean = plate.mean_pressure();
            metrics.push(Metric::new(format!("{label}: mean pressure on the way down"), mean, "Pa"));
            metrics.push(Metric {
                name: format!("{label}: energy residual"),
                value: plate.ledger.residual_fraction(),
                unit: "-".into(),
                ..Metric::default()
            });
            metrics.extend(plate.zone.metrics(label));
        }
        if let Some(fit) = &self.fit {
            let of = |name: &str, unit: &str, pick: fn(&PlateFit) -> Estimated| Metric {
                name: format!("{name}, fitted to the simulation"),
                value: pick(fit).value,
                unit: unit.into(),
                reference: self.fit_measured.as_ref().map(|fit| pick(fit).value),
                uncertainty: Some(pick(fit).half_width),
                source: self
                    .fit_measured
                    .as_ref()
                    .map(|_| "the same law fitted to the measured points".into()),
            };
            metrics.push(of("k_c", "Pa/m^(n-1)", |fit| fit.k_c));
            metrics.push(of("k_phi", "Pa/m^n", |fit| fit.k_phi));
            metrics.push(of("n", "-", |fit| fit.n));
        }
        metrics
    }
}

impl Pressed {
    /// Samples after the plate has reached the surface.
    pub fn points(&self) -> Vec<PlatePoint> {
        let (sinkage, pressure) = (self.table.column("sinkage"), self.table.column("pressure"));
        let radius = self.diameter / 2.0;
        let points = sinkage.into_iter().zip(pressure).filter(|(sinkage, _)| *sinkage > 0.0);
        points.map(|(sinkage, pressure)| PlatePoint { radius, sinkage, pressure }).collect()
    }

    /// Mean pressure over all sinkages that were reached [Pa]: work over area and sinkage, which no single jump decides.
    fn mean_pressure(&self) -> f64 {
        let points = self.points();
        points.iter().map(|point| point.pressure).sum::<f64>() / points.len().max(1) as f64
    }

    /// Mean pressure over the tenth of the way before `share` of it [Pa]: single samples of few grains jump.
    fn mean_pressure_before(&self, share: f64) -> f64 {
        let points = self.points();
        let depth = points.last().map_or(0.0, |point| point.sinkage);
        let window = (share - 0.1) * depth..=share * depth;
        let seen = points.iter().filter(|point| window.contains(&point.sinkage));
        let (sum, n) = seen.fold((0.0, 0), |(sum, n), point| (sum + point.pressure, n + 1));
        if n > 0 { sum / f64::from(n) } else { 0.0 }
    }

    /// Pressure at a sinkage, between the samples around it; `None` beyond them.
    pub fn pressure_at(&self, sinkage: f64) -> Option<f64> {
        let points = self.points();
        let after = points.iter().position(|point| point.sinkage >= sinkage)?;
        let (a, b) = (points.get(after.checked_sub(1)?)?, &points[after]);
        let share = (sinkage - a.sinkage) / (b.sinkage - a.sinkage);
        Some(a.pressure + share * (b.pressure - a.pressure))
    }
}
