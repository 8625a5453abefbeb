//! What a run leaves at its end: time series, curves, fits, metrics, plots, summary and report.

use super::level::bulk_density;
use super::state::{Clock, Finished, RunStage, Runner, State};
use super::{Ended, Law, RunError, report};
use crate::calibration::{PlateFit, PlatePoint, fit_plates};
use crate::output::chart::{Chart, Mark, Series};
use crate::output::summary::{self, Criterion, Energy, EnergyEntry, Metric, Status, Summary, Time};
use crate::output::write_atomic;
use crate::scene::{Motion, PressureSinkage, Reference};
use grouser_dem::TimeStep;
use std::collections::BTreeMap;
use std::io;

/// Measured and simulated curves of a press, and the laws fitted to both.
pub struct Comparison<'a> {
    /// Plates that reached their depth.
    pub plates: &'a [Finished],
    /// What was measured, when the scene has it.
    pub measured: Option<&'a PressureSinkage>,
    /// Fit to the simulated curves.
    pub fit: Option<PlateFit>,
    /// Fit to the measured points, over the same sinkages.
    pub fit_measured: Option<PlateFit>,
}

/// Writes everything that follows from the finished plates.
pub(super) fn leave<L: Law>(
    runner: &Runner,
    state: &State<L>,
    step: &TimeStep,
    clock: &Clock,
    ended: &Result<Ended, RunError>,
) -> Result<(), RunError> {
    let folder = &runner.options.folder;
    let mut files = vec!["scenario.ron".to_owned(), "summary.json".to_owned(), "report.html".to_owned()];
    let mut write = |name: String, bytes: &[u8]| -> io::Result<()> {
        write_atomic(&folder.join(&name), bytes)?;
        files.push(name);
        Ok(())
    };
    for plate in &state.done {
        write(format!("plate_{:.0}mm.csv", 1e3 * plate.diameter), plate.table.to_csv().as_bytes())?;
    }
    let comparison = Comparison::new(runner, &state.done);
    let charts = comparison.charts();
    for (name, chart) in &charts {
        let drawn = |error: Box<dyn std::error::Error + Send + Sync>| io::Error::other(error.to_string());
        write(format!("{name}.svg"), chart.to_svg().map_err(drawn)?.as_bytes())?;
        write(format!("{name}.png"), &chart.to_png().map_err(drawn)?)?;
    }
    if !state.done.is_empty() || state.time_s > 0.0 {
        files.extend([state.grains.index(), state.plate.index()]);
    }
    if !matches!(ended, Ok(Ended::Done)) {
        files.push("checkpoint.bin".into());
    }
    let summary = Summary {
        schema: summary::SCHEMA,
        scenario: runner.scenario.title.clone(),
        version: env!("CARGO_PKG_VERSION"),
        git: runner.options.git.clone(),
        host: format!(
            "{} {}, {} processors",
            std::env::consts::OS,
            std::env::consts::ARCH,
            std::thread::available_parallelism().map_or(1, usize::from)
        ),
        threads: rayon::current_num_threads(),
        status: match ended {
            Ok(Ended::Done) => Status::Done,
            Ok(Ended::Interrupted) => Status::Interrupted,
            Err(_) => Status::Failed,
        },
        error: ended.as_ref().err().map(ToString::to_string),
        time: Time {
            simulated_s: state.time_s,
            wall_s: clock.wall_s,
            cpu_s: clock.cpu_s,
            setup_s: clock.setup_s,
            steps: state.n_steps,
        },
        time_step: summary::TimeStep {
            dt_s: step.step_s,
            binding: step.binding().name.clone(),
            fraction: step.binding().fraction,
            criteria: step
                .criteria
                .iter()
                .map(|c| Criterion {
                    name: c.name.clone(),
                    critical_s: c.time_s,
                    place: format!("{} (fraction {})", c.place, c.fraction),
                })
                .collect(),
        },
        energy: energy(&state.done),
        conventions: conventions(),
        metrics: [bed_metrics(state), comparison.metrics()].concat(),
        files,
    };
    summary.write(folder)?;
    let page = report::page(runner.scenario, &summary, &charts, &comparison);
    write_atomic(&folder.join("report.html"), page.as_bytes())?;
    Ok(())
}

/// The plates' ledgers together.
fn energy(plates: &[Finished]) -> Energy {
    let sum = |of: fn(&super::PressLedger) -> f64| plates.iter().map(|plate| of(&plate.ledger)).sum::<f64>();
    let entry =
        |name: &str, of: fn(&super::PressLedger) -> f64| EnergyEntry { name: name.into(), value_J: sum(of) };
    let (input, stored, lost) = (sum(|l| l.input), sum(|l| l.stored()), sum(|l| l.dissipated()));
    let scale = input.abs().max(lost);
    Energy {
        input_J: input,
        stored_J: stored,
        dissipated_J: lost,
        residual_fraction: if scale > 0.0 { (input - stored - lost) / scale } else { 0.0 },
        entries: vec![
            entry("work of the plates", |l| l.input),
            entry("kinetic energy gained", |l| l.kinetic),
            entry("elastic energy gained among grains", |l| l.elastic),
            entry("elastic energy gained at the plates", |l| l.plate_elastic),
            entry("gravitational energy gained", |l| l.gravitational),
            entry("lost in normal dashpots", |l| l.normal_damping),
            entry("lost by sliding friction", |l| l.sliding),
            entry("lost by tangential dashpots and slackened springs", |l| l.sticking),
        ],
    }
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

fn bed_metrics<L: Law>(state: &State<L>) -> Vec<Metric> {
    let (bed, settled) = match &state.stage {
        RunStage::Settling { .. } => return Vec::new(),
        RunStage::Pressing { bed, settled, .. } | RunStage::Done { bed, settled } => (bed, settled),
    };
    let spheres = &bed.grains().spheres;
    let size = [0, 1].map(|axis| bed.settings().domain.size()[axis]);
    let level = super::level::surface_level(spheres, size);
    let density = bulk_density(spheres, size, level);
    let solid: f64 = spheres.iter().map(|s| 4.0 / 3.0 * std::f64::consts::PI * s.radius.powi(3)).sum();
    let metric = |name: &str, value: f64, unit: &str| Metric {
        name: name.into(),
        value,
        unit: unit.into(),
        ..Metric::default()
    };
    vec![
        metric("grains", spheres.len() as f64, "-"),
        metric("bed depth", level, "m"),
        metric("bulk density", density, "kg/m³"),
        metric("solid fraction", solid / (size[0] * size[1] * level), "-"),
        metric("contacts per grain", 2.0 * bed.n_contacts() as f64 / spheres.len() as f64, "-"),
        metric("settling time", settled.time_s, "s"),
        metric("kinetic energy over Σ m g r when settled", settled.kinetic_energy_ratio, "-"),
    ]
}

impl<'a> Comparison<'a> {
    fn new(runner: &'a Runner, plates: &'a [Finished]) -> Self {
        let measured = runner.scenario.reference.first().map(|Reference::PressureSinkage(measured)| measured);
        let depth = match &runner.scenario.motion {
            Some(Motion::Press(press)) => press.depth_m,
            _ => 0.0,
        };
        let simulated: Vec<PlatePoint> = plates.iter().flat_map(Finished::points).collect();
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
    pub fn differences(&self, plate: &Finished) -> Vec<(f64, f64, f64)> {
        let Some(measured) = self.measured else { return Vec::new() };
        let is_same = |curve: &&crate::scene::PlateCurve| (curve.diameter_m - plate.diameter).abs() < 1e-6;
        let curves = measured.plates.iter().filter(is_same);
        curves
            .flat_map(|curve| &curve.points)
            .filter_map(|&(sinkage, pressure)| Some((sinkage, plate.pressure_at(sinkage)?, pressure)))
            .collect()
    }

    /// The charts of the report, by file name.
    pub fn charts(&self) -> Vec<(&'static str, Chart)> {
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
            let label = format!("{:.0} mm", 1e3 * plate.diameter);
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
            let name = format!("{:.0} mm", 1e3 * plate.diameter);
            work.series.push(Series { name, colour, mark: Mark::Line, points });
        }
        if self.plates.is_empty() { Vec::new() } else { vec![("pressure_sinkage", curves), ("work", work)] }
    }

    fn metrics(&self) -> Vec<Metric> {
        let mut metrics = Vec::new();
        for plate in self.plates {
            let label = format!("{:.0} mm plate", 1e3 * plate.diameter);
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
            metrics.push(Metric {
                name: format!("{label}: energy residual"),
                value: plate.ledger.residual_fraction(),
                unit: "-".into(),
                ..Metric::default()
            });
        }
        if let Some(fit) = &self.fit {
            let of = |name: &str, unit: &str, pick: fn(&PlateFit) -> crate::calibration::Estimated| Metric {
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

impl Finished {
    /// Samples after the plate has reached the surface.
    pub fn points(&self) -> Vec<PlatePoint> {
        let (sinkage, pressure) = (self.table.column("sinkage"), self.table.column("pressure"));
        let radius = self.diameter / 2.0;
        let points = sinkage.into_iter().zip(pressure).filter(|(sinkage, _)| *sinkage > 0.0);
        points.map(|(sinkage, pressure)| PlatePoint { radius, sinkage, pressure }).collect()
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
