//! What every kind of scene is to the driver: something that goes on from instant to instant, can be looked at, stopped
//! and taken up again at each, and has an outcome.

use super::{Progress, RunError};
use crate::output::chart::Chart;
use crate::output::summary::{Energy, Metric, TimeStep};
use crate::output::{PolyData, Table};
use crate::scene::Scenario;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;

/// A scene on its way. Its serialised form is the whole state: a checkpoint holds nothing else.
pub trait Experiment: Serialize + DeserializeOwned {
    /// Goes on to the next instant at which the run may be stopped, usually the next sample.
    ///
    /// # Errors
    /// When the scene cannot be built after all or its motion becomes meaningless.
    fn advance(&mut self, scenario: &Scenario, progress: &mut dyn Progress) -> Result<Advanced, RunError>;

    /// What is going on, in a few words, and how much of it is done.
    fn status(&self, scenario: &Scenario) -> Status;

    /// Everything as ParaView sees it now: one entry for each series of files. Asked for when due only.
    fn frames(&self) -> Vec<(&'static str, PolyData<'static>)>;

    /// What has come of it so far; the run may have been interrupted or have failed.
    fn outcome(&self, scenario: &Scenario) -> Outcome;
}

/// What happened between two instants.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Advanced {
    /// Nothing is left to do.
    pub is_done: bool,
    /// Steps made, those of preparation not counted.
    pub n_steps: u64,
    /// Time simulated [s], that of preparation not counted.
    pub time_s: f64,
    /// Frames are to be written now.
    pub frames_due: bool,
    /// A checkpoint is to be written now.
    pub checkpoint_due: bool,
}

impl Advanced {
    /// Nothing happened and nothing is left.
    pub fn done() -> Self {
        Self { is_done: true, ..Self::default() }
    }
}

/// Where a run is.
#[derive(Clone, Debug, PartialEq)]
pub struct Status {
    /// A few words.
    pub text: String,
    /// Share that is done [-]; `None` while nobody knows how long it takes.
    pub done: Option<f64>,
    /// The scene is still being prepared: a bed settles, a solid finds its equilibrium.
    pub is_preparing: bool,
}

/// Everything that a run leaves besides its frames and checkpoints.
#[derive(Default)]
pub struct Outcome {
    /// The time step and what bound it, where there is one.
    pub time_step: Option<TimeStep>,
    /// Where the energy went, in dynamic runs.
    pub energy: Option<Energy>,
    /// Sign, zero and frame of every quantity that could be taken otherwise.
    pub conventions: BTreeMap<&'static str, String>,
    /// Numbers worth comparing.
    pub metrics: Vec<Metric>,
    /// Time series by name: `<name>.csv`.
    pub tables: Vec<(String, Table)>,
    /// Charts by name: `<name>.svg`, `<name>.png`, and the report.
    pub charts: Vec<(String, Chart)>,
    /// Pictures by name as PNG: `<name>.png`, and the report, with a caption.
    pub pictures: Vec<Picture>,
    /// Further files by name.
    pub files: Vec<(String, Vec<u8>)>,
    /// The answer in a sentence or two, first in the report.
    pub verdict: Option<Verdict>,
    /// Tables of the report, before the metrics.
    pub sections: Vec<Section>,
}

/// A picture.
pub struct Picture {
    /// Name of the file without `.png`.
    pub name: String,
    /// What it shows.
    pub caption: String,
    /// The file.
    pub png: Vec<u8>,
}

/// The answer, in words.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Verdict {
    /// Heading.
    pub heading: String,
    /// Sentences.
    pub text: String,
    /// What it is compared with, and where that is from; empty when there is nothing.
    pub source: String,
}

/// A table of the report.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// Heading.
    pub title: String,
    /// Heads of the columns.
    pub heads: Vec<String>,
    /// Cells by row.
    pub rows: Vec<Vec<String>>,
}

impl Section {
    /// A table of `rows` under `heads`.
    pub fn new(title: impl Into<String>, heads: &[&str], rows: Vec<Vec<String>>) -> Self {
        Self { title: title.into(), heads: heads.iter().map(|head| (*head).to_owned()).collect(), rows }
    }
}
