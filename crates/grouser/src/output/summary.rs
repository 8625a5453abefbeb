//! `summary.json`: what a run was, what it cost, and what came out, for programs.

use super::write_atomic;
use serde::Serialize;
use std::collections::BTreeMap;
use std::io;
use std::path::Path;

/// Version of the fields below.
pub const SCHEMA: &str = "grouser-summary-1";

/// The whole summary.
#[derive(Debug, Clone, Serialize)]
pub struct Summary {
    /// [`SCHEMA`].
    pub schema: &'static str,
    /// Title of the scenario.
    pub scenario: String,
    /// Version of grouser.
    pub version: &'static str,
    /// Commit that the program was built from; `unknown` outside a repository.
    pub git: String,
    /// Operating system, architecture and number of processors.
    pub host: String,
    /// Threads that computed.
    pub threads: usize,
    /// `done`, `failed` or `interrupted`.
    pub status: Status,
    /// Run with `--quick`: a scene smaller and coarser than the file's.
    pub is_quick: bool,
    /// What went wrong.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
    /// Simulated and spent time.
    pub time: Time,
    /// The step of time and what binds it; absent where nothing is integrated in time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_step: Option<TimeStep>,
    /// Where the work went; absent where nothing moves.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy: Option<Energy>,
    /// Conventions behind the numbers: name → meaning.
    pub conventions: BTreeMap<&'static str, String>,
    /// Results.
    pub metrics: Vec<Metric>,
    /// What pictures show: name of the file without `.png` → caption.
    pub pictures: BTreeMap<String, String>,
    /// Files in the folder.
    pub files: Vec<String>,
}

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// To its end.
    Done,
    /// The numerics failed.
    Failed,
    /// By Ctrl-C, with a checkpoint.
    Interrupted,
}

/// Simulated and spent time [s].
#[derive(Debug, Clone, Copy, Default, Serialize)]
pub struct Time {
    /// Simulated time.
    pub simulated_s: f64,
    /// Time by the clock, this run only.
    pub wall_s: f64,
    /// Time of all threads together, this run only; null where the system does not tell.
    pub cpu_s: Option<f64>,
    /// Time by the clock before the first step of the scene proper, such as settling the bed.
    pub setup_s: f64,
    /// Steps of time.
    pub steps: u64,
}

/// The step of time and what binds it.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct TimeStep {
    /// Step used [s].
    pub dt_s: f64,
    /// Name of the binding criterion.
    pub binding: String,
    /// Step over the binding criterion's critical step.
    pub fraction: f64,
    /// All criteria.
    pub criteria: Vec<Criterion>,
}

/// A limit of the time step.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Criterion {
    /// Name.
    pub name: String,
    /// Critical step [s].
    pub critical_s: f64,
    /// What it is binding for: which grain, pair, wall or tool.
    pub place: String,
}

/// Where the work went [J].
#[derive(Debug, Clone, Default, Serialize)]
#[allow(non_snake_case)]
pub struct Energy {
    /// Work done on the system by tools.
    pub input_J: f64,
    /// Kinetic, elastic and gravitational energy gained.
    pub stored_J: f64,
    /// Lost to damping and friction.
    pub dissipated_J: f64,
    /// What the ledger misses, over the largest of its entries.
    pub residual_fraction: f64,
    /// Every entry by name.
    pub entries: Vec<EnergyEntry>,
}

/// One line of the ledger.
#[derive(Debug, Clone, Serialize)]
#[allow(non_snake_case)]
pub struct EnergyEntry {
    /// Name.
    pub name: String,
    /// Energy [J].
    pub value_J: f64,
}

/// One result.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Metric {
    /// Name.
    pub name: String,
    /// Value; null when it could not be found.
    pub value: f64,
    /// Unit.
    pub unit: String,
    /// What it is compared with.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reference: Option<f64>,
    /// Half width of the 95 % confidence interval, in the same unit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub uncertainty: Option<f64>,
    /// Where the reference is from.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
}

impl Metric {
    /// A number without reference.
    pub fn new(name: impl Into<String>, value: f64, unit: impl Into<String>) -> Self {
        Self { name: name.into(), value, unit: unit.into(), ..Self::default() }
    }
}

impl From<&grouser_dem::TimeStep> for TimeStep {
    fn from(step: &grouser_dem::TimeStep) -> Self {
        let criterion = |c: &grouser_dem::Criterion| Criterion {
            name: c.name.clone(),
            critical_s: c.time_s,
            place: format!("{} (fraction {})", c.place, c.fraction),
        };
        Self {
            dt_s: step.step_s,
            binding: step.binding().name.clone(),
            fraction: step.binding().fraction,
            criteria: step.criteria.iter().map(criterion).collect(),
        }
    }
}

impl Energy {
    /// A ledger; the residual is over the larger of work and loss.
    pub fn new(input: f64, stored: f64, lost: f64, entries: Vec<EnergyEntry>) -> Self {
        let scale = input.abs().max(lost);
        let residual_fraction = if scale > 0.0 { (input - stored - lost) / scale } else { 0.0 };
        Self { input_J: input, stored_J: stored, dissipated_J: lost, residual_fraction, entries }
    }
}

impl Summary {
    /// Writes `summary.json` into a folder.
    pub fn write(&self, folder: &Path) -> io::Result<()> {
        let text = serde_json::to_string_pretty(self).map_err(io::Error::other)? + "\n";
        write_atomic(&folder.join("summary.json"), text.as_bytes())
    }
}
