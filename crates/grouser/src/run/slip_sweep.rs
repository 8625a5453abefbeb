//! A single wheel at one slip after the other, on ground fitted to plates, in both fidelities of the soil contact model.

use super::experiment::{Advanced, Experiment, Outcome, Status};
use super::{Estimate, Progress, RunError, SetupError, slip_outcome};
use crate::calibration::{PlateFit, PlatePoint, fit_plates};
use crate::output::{PolyData, Table};
use crate::scene::{ContactSize, Motion, PlateTested, RigidWheel, Scenario, Slips, Soil, Tool};
use grouser_iscm::pressure::{Bekker, PressureLaw};
use grouser_iscm::wheel::{
    OperatingPoint, PressurePeak, SingleWheel, WheelError, WheelSoil, closed_form, grid,
};
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// Columns of the sweep, one row a slip and model.
const COLUMNS: [(&str, &str); 14] = [
    ("model", "-"),
    ("slip", "-"),
    ("load", "N"),
    ("sinkage", "m"),
    ("drawbar_pull", "N"),
    ("thrust", "N"),
    ("compaction_resistance", "N"),
    ("torque", "N·m"),
    ("axle_work", "J/m"),
    ("drawbar_work", "J/m"),
    ("compaction_loss", "J/m"),
    ("shear_loss", "J/m"),
    ("energy_residual", "-"),
    ("force_evaluations", "-"),
];

/// A fidelity with a place of the stress peak.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Model {
    /// On the terrain grid instead of in closed form.
    pub is_grid: bool,
    /// The scene's own stress peak instead of the one at the lowest point.
    pub has_peak: bool,
}

impl Model {
    /// All four, the scene's own first.
    pub const ALL: [Self; 4] = [
        Self { is_grid: false, has_peak: true },
        Self { is_grid: true, has_peak: true },
        Self { is_grid: false, has_peak: false },
        Self { is_grid: true, has_peak: false },
    ];

    /// In words.
    pub fn label(self) -> String {
        let fidelity = if self.is_grid { "ISCM grid" } else { "closed form" };
        format!("{fidelity}, {}", if self.has_peak { "peak as in the scene" } else { "peak at the bottom" })
    }
}

/// What has been computed so far.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SlipSweep {
    /// Steady states by slip, each with one entry a model.
    pub points: Vec<[OperatingPoint; 4]>,
    /// Sinkage at the slip nearest zero for every rule of the contact's size [m].
    pub sinkage_by_size: [f64; 3],
    /// The length b that the scene's rule gives [m].
    pub size_m: f64,
    /// Everything as a table.
    pub table: Table,
}

impl SlipSweep {
    /// Fits the ground and finds the size of the contact.
    ///
    /// # Errors
    /// When the plates fix no law or the ground does not carry the wheel.
    pub fn begin(scenario: &Scenario) -> Result<Self, RunError> {
        let Scene { soil, wheel, slips } = Scene::of(scenario);
        let fit = plate_fit(scenario, soil).ok_or_else(|| {
            SetupError::Wheel(
                "the measured plates fix no pressure–sinkage law; expected at least four points of two diameters up to soil.fit_to_m"
                    .into(),
            )
        })?;
        let mut sizes = [0.0; 3];
        let mut sinkages = [0.0; 3];
        let nearest = slips.points.iter().min_by(|a, b| a.slip.abs().total_cmp(&b.slip.abs()));
        let load = nearest.map_or(0.0, |point| point.load_n);
        for (k, rule) in ContactSize::ALL.into_iter().enumerate() {
            (sizes[k], sinkages[k]) = contact_size(&fit, soil, wheel, rule, load).map_err(refused)?;
        }
        let own = ContactSize::ALL.iter().position(|rule| *rule == soil.contact_size).unwrap_or(0);
        Ok(Self {
            points: Vec::new(),
            sinkage_by_size: sinkages,
            size_m: sizes[own],
            table: Table::new(&COLUMNS),
        })
    }
}

/// Soil, tool and motion of such a scene.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    /// The ground.
    pub soil: &'a PlateTested,
    /// The wheel.
    pub wheel: &'a RigidWheel,
    /// Its slips.
    pub slips: &'a Slips,
}

impl<'a> Scene<'a> {
    /// Takes the parts of a scenario that was composed for this experiment.
    pub fn of(scenario: &'a Scenario) -> Self {
        match (&scenario.soil, &scenario.tool, &scenario.motion) {
            (Soil::PlateTested(soil), Some(Tool::RigidWheel(wheel)), Some(Motion::Slips(slips))) => {
                Self { soil, wheel, slips }
            }
            _ => unreachable!("composed for a wheel at given slips"),
        }
    }
}

/// Bekker's law fitted to the plates up to the scene's sinkage.
pub fn plate_fit(scenario: &Scenario, soil: &PlateTested) -> Option<PlateFit> {
    let plates = scenario.reference.iter().filter_map(|reference| reference.plates());
    let points: Vec<PlatePoint> = plates
        .flat_map(|measured| &measured.plates)
        .flat_map(|plate| plate.points.iter().map(|&(z, p)| (plate.diameter_m / 2.0, z, p)))
        .filter(|&(_, sinkage, _)| sinkage <= soil.fit_to_m)
        .map(|(radius, sinkage, pressure)| PlatePoint { radius, sinkage, pressure })
        .collect();
    fit_plates(&points)
}

fn wheel_soil(fit: &PlateFit, soil: &PlateTested, size: f64, peak: PressurePeak) -> WheelSoil {
    let pressure = PressureLaw::Bekker(Bekker {
        cohesive_modulus: fit.k_c.value,
        frictional_modulus: fit.k_phi.value,
        exponent: fit.n.value,
        plate_width: size,
    });
    WheelSoil { pressure, shear: soil.shear(), peak, rebound: None }
}

fn single_wheel(wheel: &RigidWheel, load: f64) -> SingleWheel {
    SingleWheel { radius: wheel.radius_m, width: wheel.width_m, lugs: None, load }
}

/// The length b and the sinkage [m] at zero slip that agree with each other.
fn contact_size(
    fit: &PlateFit,
    soil: &PlateTested,
    wheel: &RigidWheel,
    rule: ContactSize,
    load: f64,
) -> Result<(f64, f64), WheelError> {
    let single = single_wheel(wheel, load);
    let (mut size, mut sinkage) = (wheel.width_m.min(wheel.radius_m), 0.0);
    for _ in 0..60 {
        let ground = wheel_soil(fit, soil, size, soil.peak);
        sinkage = closed_form::operating_point(&single, &ground, 0.0, 0.0)?.sinkage;
        let length = (sinkage * (2.0 * wheel.radius_m - sinkage)).sqrt();
        // Half way each time: the two answers lie on either side of the agreement.
        size = 0.5 * (size + rule.of(wheel.width_m, length));
    }
    Ok((size, sinkage))
}

fn refused(error: WheelError) -> RunError {
    SetupError::Wheel(error.to_string()).into()
}

impl Experiment for SlipSweep {
    fn advance(&mut self, scenario: &Scenario, _: &mut dyn Progress) -> Result<Advanced, RunError> {
        let Scene { soil, wheel, slips } = Scene::of(scenario);
        let Some(point) = slips.points.get(self.points.len()) else { return Ok(Advanced::done()) };
        let Some(fit) = plate_fit(scenario, soil) else { return Ok(Advanced::done()) };
        let single = single_wheel(wheel, point.load_n);
        let spacing = wheel.radius_m / slips.cells_per_radius;
        let settings =
            grid::GridSettings { spacing, sinkage_resolution: spacing / 16.0, integration_resolution: 4 };
        let at = |model: Model| {
            let peak = if model.has_peak { soil.peak } else { PressurePeak::Bottom };
            let ground = wheel_soil(&fit, soil, self.size_m, peak);
            match model.is_grid {
                false => closed_form::operating_point(&single, &ground, point.slip, 0.0),
                true => grid::operating_point(&single, &ground, point.slip, 0.0, &settings),
            }
            .map_err(refused)
        };
        let [a, b, c, d] = Model::ALL;
        let found = [at(a)?, at(b)?, at(c)?, at(d)?];
        for (number, p) in found.iter().enumerate() {
            self.table.push(&[
                number as f64,
                p.slip,
                point.load_n,
                p.sinkage,
                p.drawbar_pull,
                p.thrust,
                p.compaction_resistance,
                p.torque,
                p.axle_work,
                p.drawbar_work,
                p.compaction_loss,
                p.shear_loss,
                p.energy_residual(),
                p.n_evaluations as f64,
            ]);
        }
        self.points.push(found);
        let is_done = self.points.len() == slips.points.len();
        Ok(Advanced { n_steps: 1, is_done, checkpoint_due: true, ..Advanced::default() })
    }

    fn status(&self, scenario: &Scenario) -> Status {
        let n = Scene::of(scenario).slips.points.len();
        Status {
            text: format!("slip {} of {n}", (self.points.len() + 1).min(n)),
            done: Some(self.points.len() as f64 / n.max(1) as f64),
            is_preparing: false,
        }
    }

    fn frames(&self) -> Vec<(&'static str, PolyData<'static>)> {
        Vec::new()
    }

    fn outcome(&self, scenario: &Scenario) -> Outcome {
        slip_outcome::outcome(scenario, self)
    }
}

/// What a sweep will cost.
pub fn estimate(scenario: &Scenario) -> Estimate {
    let slips = Scene::of(scenario).slips;
    let (n, cells) = (slips.points.len(), slips.cells_per_radius);
    // A polygon of ground and its way to the rim's entry: about a microsecond (`docs/performance.md`).
    let per_point = 6.0 * cells * cells * (1.0 + cells / 32.0) * 1e-6;
    Estimate {
        lines: vec![("slips", format!("{n}, each by two fidelities with two places of the stress peak"))],
        wall: Some(Duration::from_secs_f64(2.0 * n as f64 * per_point)),
    }
}
