//! Experiments on a bed of grains: the bed settles, or is found in the cache, and is then used in passes, each on its
//! own copy.

use super::experiment::{Advanced, Outcome, Status};
use super::{Experiment, Law, LawBed, Progress, RunError, SetupError, bed, cache, level, time_step};
use crate::output::summary::{self, Metric};
use crate::output::{PolyData, Table};
use crate::scene::{Grains, Scenario};
use grouser_contact::Real;
use grouser_dem::{Criterion, Failure, SettleCriterion, Settled, Settling, Stability};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// Samples between two looks at how much of the stable step the contacts leave.
const SAMPLES_PER_LOOK: u64 = 10;

/// Something that is done to a copy of the settled bed: a plate pressed into it, a wheel rolled over it.
pub trait Pass<L: Law>: Serialize + DeserializeOwned + Sized {
    /// What stays of a pass.
    type Finished: Serialize + DeserializeOwned;

    /// Number of passes of a scene.
    fn n_passes(scenario: &Scenario) -> usize;

    /// Begins the pass of this number, from 0, with steps of `time_step` [s].
    ///
    /// # Errors
    /// When the tool cannot be built.
    fn begin(
        scenario: &Scenario,
        number: usize,
        bed: LawBed<L>,
        time_step: f64,
        done: &[Self::Finished],
    ) -> Result<Self, SetupError>;

    /// Goes on to the next sample, which is taken.
    ///
    /// # Errors
    /// When the motion has become meaningless.
    fn advance(&mut self, scenario: &Scenario) -> Result<(), Broken>;

    /// Steps made and steps in all.
    fn steps(&self) -> (u64, u64);

    /// Steps from one sample to the next.
    fn steps_per_sample(&self) -> u64;

    /// What this is, in a few words, for progress and failures.
    fn label(&self) -> String;

    /// Everything as ParaView sees it.
    fn frames(&self) -> Vec<(&'static str, PolyData<'static>)>;

    /// Its bed.
    fn bed(&self) -> &LawBed<L>;

    /// Name and rows of the time series so far, for runs that are interrupted or fail.
    fn rows(&self) -> (&str, &Table);

    /// What stays.
    fn finish(self, scenario: &Scenario) -> Self::Finished;

    /// What has come of the passes so far, beyond what [`OnBed`] says about bed and time step.
    fn outcome(scenario: &Scenario, bed: &LawBed<L>, done: &[Self::Finished]) -> Outcome;
}

/// Why a pass cannot go on.
#[derive(Clone, Debug, PartialEq)]
pub struct Broken {
    /// What happened, to which grain or element.
    pub what: String,
    /// What to do.
    pub remedy: String,
}

impl From<Failure> for Broken {
    fn from(failure: Failure) -> Self {
        Self { what: failure.to_string(), remedy: failure.remedy().into() }
    }
}

/// A bed and its passes, as a state.
#[derive(Serialize, Deserialize)]
#[serde(bound = "L: Law, P: Pass<L>")]
pub struct OnBed<L: Law, P: Pass<L>> {
    time_step: f64,
    stage: Stage<L, P>,
    done: Vec<P::Finished>,
    /// Largest share of the stable step that was seen.
    stability: Stability,
}

#[derive(Serialize, Deserialize)]
#[serde(bound = "L: Law, P: Pass<L>")]
enum Stage<L: Law, P: Pass<L>> {
    Settling { bed: Box<LawBed<L>>, settling: Settling },
    Passing { settled: Settled, bed: Box<LawBed<L>>, pass: Option<Box<P>> },
}

impl<L: Law, P: Pass<L>> OnBed<L, P> {
    /// A loose bed about to settle, or one that was kept.
    ///
    /// # Errors
    /// When bed or tool cannot be built.
    pub fn begin(
        scenario: &Scenario,
        soil: &Grains,
        law: L,
        progress: &mut dyn Progress,
    ) -> Result<Self, RunError> {
        let time_step = time_step(scenario, soil).map_err(SetupError::from)?.step_s;
        let mut begun = Self {
            time_step,
            stage: match cache::find::<LawBed<L>>(&bed::key(scenario, soil, time_step)) {
                Some((bed, settled)) => {
                    progress.note("the settled bed was found in the cache");
                    Stage::Passing { settled, bed: Box::new(bed::in_use::<L>(bed, scenario)?), pass: None }
                }
                None => {
                    let criterion = SettleCriterion {
                        kinetic_energy_ratio: soil.settle.energy_ratio,
                        longest_s: soil.settle.longest_s,
                    };
                    let bed = Box::new(bed::loose_bed(scenario, soil, law)?);
                    let step = time_step * soil.settle.time_step_factor;
                    Stage::Settling { bed, settling: Settling::new(criterion, step) }
                }
            },
            done: Vec::new(),
            stability: Stability::default(),
        };
        begun.begin_pass(scenario)?;
        Ok(begun)
    }

    /// Begins the next pass, if the bed has settled and one is left.
    fn begin_pass(&mut self, scenario: &Scenario) -> Result<(), SetupError> {
        let time_step = self.time_step;
        if let Stage::Passing { bed, pass, .. } = &mut self.stage {
            let number = self.done.len();
            *pass = match number < P::n_passes(scenario) {
                true => Some(Box::new(P::begin(scenario, number, (**bed).clone(), time_step, &self.done)?)),
                false => None,
            };
        }
        Ok(())
    }

    fn settle(
        &mut self,
        scenario: &Scenario,
        soil: &Grains,
        progress: &mut dyn Progress,
    ) -> Result<Advanced, RunError> {
        let time_step = self.time_step;
        let Stage::Settling { bed, settling } = &mut self.stage else { return Ok(Advanced::default()) };
        let settled = settling.advance(bed).map_err(|failure| {
            let time_s = settling.time();
            let n_steps = (time_s / (time_step * soil.settle.time_step_factor)).round() as u64;
            RunError::numerics(&failure, n_steps, time_s, ", settling")
        })?;
        let Some(settled) = settled else { return Ok(Advanced::default()) };
        if !settled.is_settled {
            let (longest_s, asked) = (soil.settle.longest_s, soil.settle.energy_ratio);
            return Err(
                SetupError::NotSettled { longest_s, ratio: settled.kinetic_energy_ratio, asked }.into()
            );
        }
        cache::keep(&bed::key(scenario, soil, time_step), &**bed, settled);
        progress.note(&format!("the bed settled within {:.3} s of simulated time", settled.time_s));
        let bed = Box::new(bed::in_use::<L>((**bed).clone(), scenario)?);
        self.stage = Stage::Passing { settled, bed, pass: None };
        self.begin_pass(scenario)?;
        Ok(Advanced { checkpoint_due: true, is_done: self.is_done(), ..Advanced::default() })
    }

    /// Ends a pass that has made all its steps, and begins the next one.
    fn end_pass(&mut self, scenario: &Scenario) -> Result<Advanced, RunError> {
        if let Stage::Passing { pass, .. } = &mut self.stage
            && let Some(pass) = pass.take()
        {
            self.done.push(pass.finish(scenario));
            self.begin_pass(scenario)?;
        }
        Ok(Advanced { checkpoint_due: true, is_done: self.is_done(), ..Advanced::default() })
    }

    fn is_done(&self) -> bool {
        matches!(self.stage, Stage::Passing { pass: None, .. })
    }
}

impl<L: Law, P: Pass<L>> Experiment for OnBed<L, P> {
    fn advance(&mut self, scenario: &Scenario, progress: &mut dyn Progress) -> Result<Advanced, RunError> {
        let soil = scenario.soil.grains().expect("composed for grains");
        let time_step = self.time_step;
        let Stage::Passing { pass, .. } = &mut self.stage else {
            return self.settle(scenario, soil, progress);
        };
        let Some(pass) = pass.as_mut().filter(|pass| pass.steps().0 < pass.steps().1) else {
            return self.end_pass(scenario);
        };
        let before = pass.steps().0;
        pass.advance(scenario).map_err(|Broken { what, remedy }| {
            let n_steps = pass.steps().0;
            let (time_s, place) = (n_steps as f64 * time_step, format!(", {}", pass.label()));
            RunError::Numerics { what, remedy, step: n_steps, time_s, place }
        })?;
        let (now, all) = pass.steps();
        let n_steps = now - before;
        if now.is_multiple_of(SAMPLES_PER_LOOK * pass.steps_per_sample()) {
            let seen = pass.bed().stability(time_step);
            if seen.share > Stability::LIMIT && self.stability.share <= Stability::LIMIT {
                progress.note(&trembling(&seen, scenario, time_step, now as f64 * time_step));
            }
            if seen.share > self.stability.share {
                self.stability = seen;
            }
        }
        // Due at the first sample at or after every multiple of the interval.
        let is_due = |interval_s: f64| {
            let samples = (interval_s / scenario.outputs.sample_every_s).round().max(1.0) as u64;
            let every = samples * pass.steps_per_sample();
            now % every < n_steps.min(every)
        };
        Ok(Advanced {
            is_done: false,
            n_steps,
            time_s: n_steps as f64 * time_step,
            frames_due: is_due(scenario.outputs.vtk_every_s) || now >= all,
            checkpoint_due: is_due(scenario.outputs.checkpoint_every_s),
        })
    }

    fn status(&self, scenario: &Scenario) -> Status {
        match &self.stage {
            Stage::Settling { bed, settling } => Status {
                text: format!(
                    "settling  {:.3} s simulated, kinetic energy over Σ m g r {:.1e}",
                    settling.time(),
                    settling.energy_ratio(bed)
                ),
                done: None,
                is_preparing: true,
            },
            Stage::Passing { pass, .. } => {
                let n_passes = P::n_passes(scenario).max(1);
                let share =
                    pass.as_ref().map_or(0.0, |pass| pass.steps().0 as f64 / pass.steps().1.max(1) as f64);
                let number = (self.done.len() + 1).min(n_passes);
                let label = pass.as_ref().map_or(String::new(), |pass| pass.label());
                Status {
                    text: if n_passes > 1 { format!("{number} of {n_passes}: {label}") } else { label },
                    done: Some((self.done.len() as f64 + share) / n_passes as f64),
                    is_preparing: false,
                }
            }
        }
    }

    fn frames(&self) -> Vec<(&'static str, PolyData<'static>)> {
        match &self.stage {
            Stage::Passing { pass: Some(pass), .. } => pass.frames(),
            _ => Vec::new(),
        }
    }

    fn outcome(&self, scenario: &Scenario) -> Outcome {
        let (bed, settled) = match &self.stage {
            Stage::Settling { bed, .. } => (bed, None),
            Stage::Passing { bed, settled, .. } => (bed, Some(settled)),
        };
        let mut outcome = P::outcome(scenario, bed, &self.done);
        if let Stage::Passing { pass: Some(pass), .. } = &self.stage {
            let (name, rows) = pass.rows();
            outcome.tables.push((name.into(), rows.clone()));
        }
        if let Some(settled) = settled {
            outcome.metrics.splice(0..0, bed_metrics(bed, settled));
        }
        if self.stability.share > 0.0 {
            outcome.metrics.push(Metric::new(
                "bound of the stable step, largest share",
                self.stability.share,
                "-",
            ));
        }
        let step = scenario.soil.grains().and_then(|soil| time_step(scenario, soil).ok());
        outcome.time_step = step.as_ref().map(summary::TimeStep::from);
        outcome
    }
}

/// What to say of a bed whose contacts vibrate faster than steps of `step_s` can follow.
fn trembling(seen: &Stability, scenario: &Scenario, step_s: f64, time_s: f64) -> String {
    let criteria = scenario.soil.grains().and_then(|soil| time_step(scenario, soil).ok());
    let rayleigh = criteria.iter().flat_map(|step| &step.criteria).filter(|c| c.name == Criterion::RAYLEIGH);
    let shortest = rayleigh.map(Criterion::step_s).fold(f64::INFINITY, f64::min);
    // A step shorter in proportion is enough; a fifth less leaves room for loads that still grow.
    let enough = 0.8 * scenario.dials.time_step_fraction * step_s / shortest * Stability::LIMIT / seen.share;
    format!(
        "at {time_s:.3} s the load on grain {} takes {:.1} of the bound of the stable step; beyond {} beds may shake and gain \
         energy. Look at the energy residual; try --set dials.time_step_fraction={enough:.2e}",
        seen.grain,
        seen.share,
        Stability::LIMIT,
    )
}

/// What the settled bed is like.
fn bed_metrics<L: Law>(bed: &LawBed<L>, settled: &Settled) -> Vec<Metric> {
    let spheres = &bed.grains().spheres;
    let size = [0, 1].map(|axis| bed.settings().domain.size()[axis]);
    let level = level::surface_level(spheres, size);
    let solid: f64 =
        spheres.iter().map(|s| 4.0 / 3.0 * std::f64::consts::PI * s.radius.to_f64().powi(3)).sum();
    vec![
        Metric::new("grains", spheres.len() as f64, "-"),
        Metric::new("bed depth", level, "m"),
        Metric::new("bulk density", level::bulk_density(spheres, size, level), "kg/m³"),
        Metric::new("solid fraction", solid / (size[0] * size[1] * level), "-"),
        Metric::new("contacts per grain", 2.0 * bed.n_contacts() as f64 / spheres.len() as f64, "-"),
        Metric::new("settling time", settled.time_s, "s"),
        Metric::new("kinetic energy over Σ m g r when settled", settled.kinetic_energy_ratio, "-"),
    ]
}
