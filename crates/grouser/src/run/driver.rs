//! Any experiment from its beginning, or from a checkpoint, to its end: checkpoints, interruptions, frames, progress.

use super::clock::{Clock, Pace};
use super::leave::{Left, leave};
use super::{Ended, Experiment, Progress, RunError, Stage};
use crate::output::{Series, checkpoint, write_atomic};
use crate::scene::{Scenario, resolved};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};

/// How to run.
pub struct Options<'a> {
    /// Folder for everything that the run leaves.
    pub folder: PathBuf,
    /// Take up the run that the folder's checkpoint holds.
    pub resumes: bool,
    /// Somebody asked for an end.
    pub is_interrupted: &'a AtomicBool,
    /// Commit that the program was built from.
    pub git: String,
}

/// Everything between two instants of a run.
#[derive(Serialize, Deserialize)]
#[serde(bound = "E: Experiment")]
pub(super) struct State<E: Experiment> {
    /// The resolved scenario that the run began with.
    scenario: String,
    pub experiment: E,
    pub series: Vec<Series>,
    /// Steps without those of preparation.
    pub n_steps: u64,
    /// Simulated time without that of preparation [s].
    pub time_s: f64,
}

/// A scene, where its results go, and who is told.
pub(super) struct Driver<'a> {
    pub scenario: &'a Scenario,
    pub options: &'a Options<'a>,
    pub progress: &'a mut dyn Progress,
}

impl Driver<'_> {
    /// Runs an experiment into the folder. `begin` makes it when the run is not taken up from a checkpoint.
    ///
    /// # Errors
    /// When the scene cannot be built, its motion becomes meaningless, or a file cannot be written.
    pub fn drive<E: Experiment>(
        mut self,
        begin: impl FnOnce(&mut dyn Progress) -> Result<E, RunError>,
    ) -> Result<Ended, RunError> {
        let mut clock = Clock::start();
        let mut state = if self.options.resumes { self.resumed()? } else { self.begun(begin)? };
        let ended = self.go(&mut state, &mut clock);
        let State { experiment, series, n_steps, time_s, .. } = &state;
        let outcome = experiment.outcome(self.scenario);
        let left = Left { outcome, series, n_steps: *n_steps, time_s: *time_s };
        leave(&self, left, &clock.stop(), &ended)?;
        ended
    }

    fn begun<E: Experiment>(
        &mut self,
        begin: impl FnOnce(&mut dyn Progress) -> Result<E, RunError>,
    ) -> Result<State<E>, RunError> {
        checkpoint::remove(&self.options.folder);
        let scenario = resolved(self.scenario);
        write_atomic(&self.options.folder.join("scenario.ron"), scenario.as_bytes())?;
        let experiment = begin(self.progress)?;
        Ok(State { scenario, experiment, series: Vec::new(), n_steps: 0, time_s: 0.0 })
    }

    fn resumed<E: Experiment>(&mut self) -> Result<State<E>, RunError> {
        let state: State<E> = checkpoint::read(&self.options.folder)?;
        if state.scenario != resolved(self.scenario) {
            return Err(RunError::OtherScenario { folder: self.options.folder.display().to_string() });
        }
        Ok(state)
    }

    /// Goes on until the scene ends or somebody interrupts.
    fn go<E: Experiment>(&mut self, state: &mut State<E>, clock: &mut Clock) -> Result<Ended, RunError> {
        let folder = &self.options.folder;
        let mut pace = Pace::default();
        loop {
            if self.options.is_interrupted.load(Ordering::Relaxed) {
                checkpoint::write(folder, state)?;
                return Ok(Ended::Interrupted);
            }
            if pace.is_due() {
                let status = state.experiment.status(self.scenario);
                let done = status.done.map(|done| (done, pace.left(done)));
                self.progress.stage(&Stage { text: status.text, done });
                if !status.is_preparing {
                    clock.is_prepared();
                }
            }
            let advanced = state.experiment.advance(self.scenario, self.progress)?;
            state.n_steps += advanced.n_steps;
            state.time_s += advanced.time_s;
            if advanced.n_steps > 0 {
                clock.is_prepared();
            }
            if advanced.frames_due {
                self.write_frames(state)?;
            }
            if advanced.checkpoint_due || advanced.is_done {
                checkpoint::write(folder, state)?;
            }
            if advanced.is_done {
                return Ok(Ended::Done);
            }
        }
    }

    /// The next frame of every series. Simulated time goes on from part to part of a run.
    fn write_frames<E: Experiment>(&mut self, state: &mut State<E>) -> Result<(), RunError> {
        for (name, mut frame) in state.experiment.frames() {
            frame.time = state.time_s;
            let index = state.series.iter().position(|series| series.name() == name);
            let index = index.unwrap_or_else(|| {
                state.series.push(Series::new(name));
                state.series.len() - 1
            });
            state.series[index].push(&self.options.folder, &frame)?;
        }
        Ok(())
    }
}
