//! A vehicle driven over soft ground: one drive after another.

use super::drive::{Drive, Parts, parts};
use super::driving_outcome;
use super::experiment::{Advanced, Experiment, Outcome, Status};
use super::vehicle_frames;
use super::{Estimate, Progress, RunError, SetupError};
use crate::output::{PolyData, Table};
use crate::scene::Scenario;
use grouser_geometry::HeightGrid;
use grouser_iscm::machine::Machine;
use grouser_iscm::run::{RunSettings, RunState};
use grouser_iscm::rut::rut_depths;
use serde::{Deserialize, Serialize};

/// The scene on its way.
#[derive(Serialize, Deserialize)]
pub struct Driving {
    /// The drive that is going on; none between two drives.
    state: Option<RunState>,
    table: Option<Table>,
    done: Vec<Driven>,
    /// What follows from the scenario alone.
    #[serde(skip)]
    built: Option<Built>,
}

/// The machine and the settings of the drive that is going on.
struct Built {
    machine: Machine,
    settings: RunSettings,
}

/// What a finished drive leaves.
#[derive(Serialize, Deserialize)]
pub struct Driven {
    /// Which drive it was.
    pub drive: Drive,
    /// One row for each run step.
    pub table: Table,
    /// Rut depths by windows, left and right track [m].
    pub rut_depths: [Vec<f64>; 2],
    /// Sinkage of the ground [m], for drives with the scene's own settings.
    pub sinkage: Option<HeightGrid>,
    /// Mass of the machine [kg].
    pub mass: f64,
    /// Run steps whose equilibrium is only as accurate as the grid allows.
    pub n_limited: usize,
}

/// What a scene will cost.
pub fn estimate(scenario: &Scenario) -> Estimate {
    let Some(parts) = parts(scenario) else { return Estimate::default() };
    let drives = Drive::all(&parts);
    let n_steps: usize = drives.iter().map(|drive| (parts.route.length() / drive.run_step) as usize).sum();
    let lines = vec![
        ("drives", drives.len().to_string()),
        ("run steps", format!("{n_steps}, each with {} intermediate ones", parts.route.intermediate_steps)),
    ];
    Estimate { lines, wall: None }
}

impl Driving {
    /// Before the first drive.
    ///
    /// # Errors
    /// When the scene has no vehicle or no route.
    pub fn begin(scenario: &Scenario) -> Result<Self, RunError> {
        parts(scenario).ok_or_else(|| SetupError::Vehicle("the scene has no vehicle and route".into()))?;
        Ok(Self { state: None, table: None, done: Vec::new(), built: None })
    }

    /// Machine and settings of the present drive, made anew when the run was taken up from a checkpoint.
    fn build(&mut self, parts: &Parts, drive: &Drive) -> Result<(), RunError> {
        if self.built.is_none() {
            let machine = parts
                .vehicle
                .machine(&drive.equipment)
                .map_err(|(path, message)| SetupError::Vehicle(format!("tool.{path}: {message}")))?;
            self.built = Some(Built { machine, settings: drive.settings(parts.route) });
        }
        Ok(())
    }

    fn start(&mut self, parts: &Parts, drive: &Drive) -> Result<(), RunError> {
        let terrain = parts
            .ground
            .terrain(drive.spacing)
            .map_err(|(path, error)| SetupError::Vehicle(format!("soil.{path}: {error}")))?;
        let Some(built) = &self.built else { return Ok(()) };
        let state = RunState::start(&built.machine, terrain, &built.settings)
            .map_err(|error| failed(&error, 0, 0.0, drive))?;
        self.state = Some(state);
        let bodies = built.machine.mechanism.bodies();
        let mut columns = vec![
            ("distance", "m"),
            ("height", "m"),
            ("pitch", "rad"),
            ("roll", "rad"),
            ("rolling_force", "N"),
            ("normal_force", "N"),
            ("vertical_force", "N"),
            ("rolling_resistance", "-"),
            ("rolling_resistance_vertical", "-"),
        ];
        let names: Vec<String> = built
            .machine
            .feet
            .iter()
            .map(|foot| format!("load_{}", bodies[foot.body].name.replace(' ', "_")))
            .collect();
        columns.extend(names.iter().map(|name| (name.as_str(), "N")));
        self.table = Some(Table::new(&columns));
        Ok(())
    }

    fn finish(&mut self, parts: &Parts, drive: Drive) {
        let (Some(state), Some(table), Some(built)) =
            (self.state.take(), self.table.take(), self.built.take())
        else {
            return;
        };
        let ruts = [1.0, -1.0].map(|side| ruts(parts, &state, side));
        let sinkage = drive.varied.is_none().then(|| {
            let mut grid = state.terrain.grid().clone();
            grid.heights_mut().copy_from_slice(state.terrain.sinkage());
            grid
        });
        let mass = built.machine.mechanism.mass();
        self.done.push(Driven { drive, table, rut_depths: ruts, sinkage, mass, n_limited: state.n_limited });
    }
}

/// Rut depths [m] along the track on one side of the route.
fn ruts(parts: &Parts, state: &RunState, side: f64) -> Vec<f64> {
    let Some(axle) = parts.vehicle.frames.first().and_then(|frame| frame.axles.first()) else {
        return Vec::new();
    };
    let (from, to) = parts.route.rut_section_m.unwrap_or((0.0, parts.route.length()));
    let beside = |distance: f64| {
        let (p, heading) = parts.route.way().at(distance);
        let off = side * axle.half_track_m;
        [p[0] - off * heading.sin(), p[1] + off * heading.cos()]
    };
    rut_depths(&state.terrain, beside(from), beside(to), axle.wheel_width_m, parts.route.rut_window_m)
}

/// A drive that could not go on.
fn failed(error: &grouser_iscm::run::RunError, step: u64, distance: f64, drive: &Drive) -> RunError {
    RunError::Numerics {
        what: error.to_string(),
        remedy: "see the message".into(),
        step,
        time_s: distance,
        place: format!(" at 1 m/s, {}", drive.label()),
    }
}

impl Experiment for Driving {
    fn advance(&mut self, scenario: &Scenario, progress: &mut dyn Progress) -> Result<Advanced, RunError> {
        let Some(parts) = parts(scenario) else { return Ok(Advanced::done()) };
        let drives = Drive::all(&parts);
        let Some(drive) = drives.get(self.done.len()).cloned() else { return Ok(Advanced::done()) };
        self.build(&parts, &drive)?;
        if self.state.is_none() {
            self.start(&parts, &drive)?;
            progress.note(&drive.label());
            return Ok(Advanced { frames_due: parts.route.frames_every_steps > 0, ..Advanced::default() });
        }
        let (Some(state), Some(table), Some(built)) = (&mut self.state, &mut self.table, &self.built) else {
            return Ok(Advanced::done());
        };
        if !state.can_go_on(&built.settings) {
            self.finish(&parts, drive);
            return Ok(Advanced {
                is_done: self.done.len() == drives.len(),
                checkpoint_due: true,
                ..Advanced::default()
            });
        }
        let before = state.distance(&built.settings);
        let step = state
            .step(&built.machine, &built.settings)
            .map_err(|error| failed(&error, state.n_steps as u64, before, &drive))?;
        let (at, total) = (&step.configuration, &step.total);
        let mut row = vec![
            step.distance,
            at.height,
            at.pitch,
            at.roll,
            total.force,
            total.normal_force,
            total.vertical_force,
            total.coefficient(),
            total.coefficient_of_vertical(),
        ];
        row.extend(&step.foot_loads);
        table.push(&row);
        let every = |n: usize| n > 0 && state.n_steps % n == 0;
        Ok(Advanced {
            is_done: false,
            n_steps: 1,
            time_s: (step.distance - before) / parts.route.shown_speed_m_s,
            frames_due: every(parts.route.frames_every_steps),
            checkpoint_due: every(parts.route.checkpoint_every_steps),
        })
    }

    fn status(&self, scenario: &Scenario) -> Status {
        let Some(parts) = parts(scenario) else {
            return Status { text: String::new(), done: None, is_preparing: false };
        };
        let drives = Drive::all(&parts);
        let work = |drive: &Drive| parts.route.length() / drive.run_step / drive.spacing.powi(2);
        let all: f64 = drives.iter().map(work).sum();
        let driven = match (&self.state, &self.built) {
            (Some(state), Some(built)) => state.distance(&built.settings),
            _ => 0.0,
        };
        let here = drives.get(self.done.len()).map_or(0.0, work) * driven / parts.route.length();
        let done = drives.iter().take(self.done.len()).map(work).sum::<f64>() + here;
        let label = drives.get(self.done.len()).map_or(String::new(), Drive::label);
        Status { text: format!("{label}: {driven:.2} m"), done: Some(done / all), is_preparing: false }
    }

    fn frames(&self) -> Vec<(&'static str, PolyData<'static>)> {
        match (&self.state, &self.built) {
            (Some(state), Some(built)) => vehicle_frames::frames(&built.machine, state, &built.settings),
            _ => Vec::new(),
        }
    }

    fn outcome(&self, scenario: &Scenario) -> Outcome {
        driving_outcome::outcome(scenario, &self.done)
    }
}
