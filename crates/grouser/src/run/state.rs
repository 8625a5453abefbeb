//! The run as a state that can be stopped and taken up again between any two steps.

use super::press::{PressLedger, Pressing};
use super::progress::{Progress, Stage};
use super::results;
use super::{Ended, Law, RunError, SetupError, WithLaw, bed, cache, time_step, with_law};
use crate::output::{Series, Table, checkpoint, write_atomic};
use crate::scene::{Motion, Plates, Press, Scenario, Soil, Tool, resolved};
use grouser_dem::{Bed, Failure, SettleCriterion, Settled, Settling, TimeStep};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

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

/// Everything between two steps of a run.
#[derive(Serialize, Deserialize)]
#[serde(bound = "L: Law")]
pub(super) struct State<L: Law> {
    /// The resolved scenario that the run began with.
    scenario: String,
    pub stage: RunStage<L>,
    pub done: Vec<Finished>,
    pub grains: Series,
    pub plate: Series,
    /// Steps of all tools.
    pub n_steps: u64,
    /// Simulated time of all tools [s].
    pub time_s: f64,
}

/// Where the run is.
#[derive(Serialize, Deserialize)]
#[serde(bound = "L: Law")]
pub(super) enum RunStage<L: Law> {
    Settling { bed: Box<Bed<L>>, settling: Settling },
    Pressing { settled: Settled, bed: Box<Bed<L>>, pressing: Box<Pressing<L>> },
    Done { settled: Settled, bed: Box<Bed<L>> },
}

/// A plate that has reached its depth.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Finished {
    /// Diameter [m].
    pub diameter: f64,
    /// Height of the bed's surface before the plate came [m].
    pub level: f64,
    /// Time series.
    pub table: Table,
    /// Where the work went.
    pub ledger: PressLedger,
}

/// What is known of the clock.
pub struct Clock {
    /// Time by the clock [s].
    pub wall_s: f64,
    /// Time until the first plate moved [s].
    pub setup_s: f64,
    /// Processor time of all threads [s].
    pub cpu_s: Option<f64>,
}

/// Runs a scene into a folder.
///
/// # Errors
/// When the scene cannot be built, its motion becomes meaningless, or a file cannot be written.
pub fn run(scenario: &Scenario, options: &Options, progress: &mut dyn Progress) -> Result<Ended, RunError> {
    fs::create_dir_all(&options.folder)?;
    with_law(&scenario.dials, Runner { scenario, options, progress })
}

pub(super) struct Runner<'a> {
    pub scenario: &'a Scenario,
    pub options: &'a Options<'a>,
    progress: &'a mut dyn Progress,
}

impl WithLaw for Runner<'_> {
    type Output = Result<Ended, RunError>;
    fn with<L: Law>(mut self, law: L) -> Self::Output {
        let step = time_step(self.scenario).map_err(SetupError::from)?;
        let begun = Instant::now();
        let mut setup_s = 0.0;
        let mut state = if self.options.resumes { self.resumed::<L>()? } else { self.begun(law, &step)? };
        let ended = self.go(&mut state, &step, begun, &mut setup_s);
        let clock = Clock { wall_s: begun.elapsed().as_secs_f64(), setup_s, cpu_s: cpu_seconds() };
        results::leave(&self, &state, &step, &clock, &ended)?;
        ended
    }
}

impl Runner<'_> {
    /// A run at its beginning: a kept bed that has settled before, or a loose one.
    fn begun<L: Law>(&mut self, law: L, step: &TimeStep) -> Result<State<L>, RunError> {
        checkpoint::remove(&self.options.folder);
        let text = resolved(self.scenario);
        write_atomic(&self.options.folder.join("scenario.ron"), text.as_bytes())?;
        let stage = match cache::find(&bed::key(self.scenario, step.step_s)) {
            Some((bed, settled)) => {
                self.progress.note("the settled bed was found in the cache");
                self.next_stage(Box::new(bed), settled, 0, step)?
            }
            None => {
                let Soil::Grains(soil) = &self.scenario.soil;
                let criterion = SettleCriterion {
                    kinetic_energy_ratio: soil.settle.energy_ratio,
                    longest_s: soil.settle.longest_s,
                };
                let bed = Box::new(bed::loose_bed(self.scenario, law)?);
                RunStage::Settling { bed, settling: Settling::new(criterion, step.step_s) }
            }
        };
        Ok(State {
            scenario: text,
            stage,
            done: Vec::new(),
            grains: Series::new("grains"),
            plate: Series::new("plate"),
            n_steps: 0,
            time_s: 0.0,
        })
    }

    fn resumed<L: Law>(&mut self) -> Result<State<L>, RunError> {
        let state: State<L> = checkpoint::read(&self.options.folder)?;
        if state.scenario != resolved(self.scenario) {
            return Err(RunError::OtherScenario { folder: self.options.folder.display().to_string() });
        }
        Ok(state)
    }

    /// Goes on until the scene ends or somebody interrupts.
    fn go<L: Law>(
        &mut self,
        state: &mut State<L>,
        step: &TimeStep,
        begun: Instant,
        setup_s: &mut f64,
    ) -> Result<Ended, RunError> {
        let mut pace = Pace::default();
        loop {
            if self.options.is_interrupted.load(Ordering::Relaxed) {
                checkpoint::write(&self.options.folder, state)?;
                return Ok(Ended::Interrupted);
            }
            match &mut state.stage {
                RunStage::Settling { bed, settling } => {
                    let settled = settling.advance(bed).map_err(|failure| {
                        let time_s = settling.time();
                        let n = (time_s / step.step_s).round() as u64;
                        RunError::Numerics { failure, step: n, time_s, place: ", settling".into() }
                    })?;
                    if pace.is_due() {
                        let energy_ratio = settling.energy_ratio(bed);
                        self.progress.stage(&Stage::Settling { time_s: settling.time(), energy_ratio });
                    }
                    if let Some(settled) = settled {
                        self.finish_settling(state, settled, step)?;
                    }
                }
                RunStage::Pressing { pressing, .. } => {
                    if *setup_s == 0.0 {
                        *setup_s = begun.elapsed().as_secs_f64();
                    }
                    let n_steps = pressing.steps_to_sample();
                    pressing.advance(n_steps).map_err(|failure| self.failure(failure, pressing))?;
                    state.n_steps += n_steps;
                    state.time_s += n_steps as f64 * step.step_s;
                    let (done, left) = (pressing.steps_done(), pressing.steps_left());
                    if pace.is_due() {
                        let stage = self.stage(state.done.len(), pressing, &mut pace);
                        self.progress.stage(&stage);
                    }
                    self.write_frames(state, done)?;
                    if left == 0 {
                        self.finish_plate(state, step)?;
                        checkpoint::write(&self.options.folder, state)?;
                    } else if self.is_due(done, n_steps, self.scenario.outputs.checkpoint_every_s, step) {
                        checkpoint::write(&self.options.folder, state)?;
                    }
                }
                RunStage::Done { .. } => return Ok(Ended::Done),
            }
        }
    }

    fn failure<L: Law>(&self, failure: Failure, pressing: &Pressing<L>) -> RunError {
        let place = format!(", plate of {} mm", 1e3 * pressing.diameter());
        RunError::Numerics { failure, step: pressing.steps_done(), time_s: pressing.time(), place }
    }

    fn finish_settling<L: Law>(
        &mut self,
        state: &mut State<L>,
        settled: Settled,
        step: &TimeStep,
    ) -> Result<(), RunError> {
        let Soil::Grains(soil) = &self.scenario.soil;
        if !settled.is_settled {
            let (longest_s, asked) = (soil.settle.longest_s, soil.settle.energy_ratio);
            return Err(
                SetupError::NotSettled { longest_s, ratio: settled.kinetic_energy_ratio, asked }.into()
            );
        }
        let RunStage::Settling { bed, .. } = &state.stage else { return Ok(()) };
        let bed = bed.clone();
        cache::keep(&bed::key(self.scenario, step.step_s), &*bed, settled);
        self.progress.note(&format!("the bed settled within {:.3} s of simulated time", settled.time_s));
        state.stage = self.next_stage(bed, settled, 0, step)?;
        checkpoint::write(&self.options.folder, state)?;
        Ok(())
    }

    fn finish_plate<L: Law>(&mut self, state: &mut State<L>, step: &TimeStep) -> Result<(), RunError> {
        let RunStage::Pressing { settled, bed, pressing } = &state.stage else { return Ok(()) };
        let (diameter, table, ledger) = (pressing.diameter(), pressing.table().clone(), pressing.ledger());
        let (bed, settled) = (bed.clone(), *settled);
        let level = pressing.level();
        state.done.push(Finished { diameter, level, table, ledger });
        state.stage = self.next_stage(bed, settled, state.done.len(), step)?;
        Ok(())
    }

    /// The stage after `n_done` plates.
    fn next_stage<L: Law>(
        &self,
        bed: Box<Bed<L>>,
        settled: Settled,
        n_done: usize,
        step: &TimeStep,
    ) -> Result<RunStage<L>, RunError> {
        let Some((plates, press)) = self.plates() else { return Ok(RunStage::Done { settled, bed }) };
        let Some(&diameter) = plates.diameters_m.get(n_done) else {
            return Ok(RunStage::Done { settled, bed });
        };
        let pressing = Pressing::new(self.scenario, (plates, press), diameter, (*bed).clone(), step.step_s)?;
        Ok(RunStage::Pressing { settled, bed, pressing: Box::new(pressing) })
    }

    fn plates(&self) -> Option<(&Plates, &Press)> {
        match (&self.scenario.tool, &self.scenario.motion) {
            (Some(Tool::Plates(plates)), Some(Motion::Press(press))) => Some((plates, press)),
            _ => None,
        }
    }

    fn write_frames<L: Law>(&mut self, state: &mut State<L>, done: u64) -> Result<(), RunError> {
        let RunStage::Pressing { pressing, .. } = &state.stage else { return Ok(()) };
        let folder = &self.options.folder;
        let every = self.steps_of(self.scenario.outputs.vtk_every_s, pressing);
        // Frames of all plates follow each other: time goes on from plate to plate.
        if done % every < pressing.steps_per_sample().min(every) || pressing.steps_left() == 0 {
            let (mut grains, mut plate) = (pressing.grains_frame(), pressing.plate_frame());
            grains.time = state.time_s;
            plate.time = state.time_s;
            state.grains.push(folder, &grains)?;
            state.plate.push(folder, &plate)?;
        }
        Ok(())
    }

    fn steps_of<L: Law>(&self, interval: f64, pressing: &Pressing<L>) -> u64 {
        let samples = (interval / self.scenario.outputs.sample_every_s).round().max(1.0) as u64;
        samples * pressing.steps_per_sample()
    }

    fn is_due(&self, done: u64, n_steps: u64, interval: f64, step: &TimeStep) -> bool {
        let every = (interval / step.step_s).round().max(1.0) as u64;
        done % every < n_steps
    }

    fn stage<L: Law>(&self, plate: usize, pressing: &Pressing<L>, pace: &mut Pace) -> Stage {
        let n_plates = self.plates().map_or(1, |(plates, _)| plates.diameters_m.len());
        let share = pressing.steps_done() as f64 / pressing.n_steps() as f64;
        let done = (plate as f64 + share) / n_plates as f64;
        Stage::Pressing { plate, n_plates, diameter_m: pressing.diameter(), done, left: pace.left(done) }
    }
}

/// When to speak, and how long the rest will take.
#[derive(Default)]
struct Pace {
    spoke: Option<Instant>,
    first: Option<(Instant, f64)>,
}

impl Pace {
    fn is_due(&mut self) -> bool {
        let is_due = self.spoke.is_none_or(|spoke| spoke.elapsed() > Duration::from_millis(250));
        if is_due {
            self.spoke = Some(Instant::now());
        }
        is_due
    }

    fn left(&mut self, done: f64) -> Duration {
        let &mut (begun, first) = self.first.get_or_insert((Instant::now(), done));
        let share = (done - first).max(1e-9);
        Duration::from_secs_f64((begun.elapsed().as_secs_f64() * (1.0 - done) / share).min(1e7))
    }
}

/// Processor time of all threads of this process [s]; `None` where the system does not tell.
fn cpu_seconds() -> Option<f64> {
    let text = fs::read_to_string("/proc/self/stat").ok()?;
    let fields: Vec<&str> = text.rsplit(')').next()?.split_whitespace().collect();
    let ticks: f64 = fields.get(11)?.parse::<f64>().ok()? + fields.get(12)?.parse::<f64>().ok()?;
    // The kernel reports in hundredths of a second on every Linux.
    Some(ticks / 100.0)
}
