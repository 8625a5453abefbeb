//! A study: every variant is a run of its own in a folder of its own; then all of them are compared.

use super::clock::{Clock, Taken};
use super::driver::Driver;
use super::leave::{Left, leave};
use super::study_outcome::{VariantResult, missing_pictures, outcome};
use super::{Ended, Options, Progress, RunError, SetupError, Stage, compose};
use crate::output::write_atomic;
use crate::scene::{Scenario, Study, Variant, resolved, variant};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Runs every variant that is not done yet, and compares all of them.
///
/// # Errors
/// The error of the first variant that fails; those before it are compared all the same.
pub(super) fn run(driver: Driver, study: &Study) -> Result<Ended, RunError> {
    let clock = Clock::start();
    let Driver { scenario, options, progress } = driver;
    let text = resolved(scenario);
    let kept = fs::read_to_string(options.folder.join("scenario.ron")).ok();
    if options.resumes && kept.is_some_and(|kept| kept != text) {
        return Err(RunError::OtherScenario { folder: options.folder.display().to_string() });
    }
    write_atomic(&options.folder.join("scenario.ron"), text.as_bytes())?;
    let variants = study.variants();
    let mut results = Vec::new();
    let mut ended = Ok(Ended::Done);
    for (number, each) in variants.iter().enumerate() {
        let mut part = Part { number, n_parts: variants.len(), label: each.labels.join(", "), progress };
        ended = run_variant(scenario, each, options, &mut part);
        if !matches!(ended, Ok(Ended::Done)) {
            break;
        }
        results.extend(VariantResult::read(&options.folder.join(each.folder()), each));
    }
    let steps = |key: &str| results.iter().map(|r: &VariantResult| r.time(key)).sum::<f64>();
    let (n_steps, time_s) = (steps("steps") as u64, steps("simulated_s"));
    let left = Left { outcome: outcome(study, &results), series: &[], n_steps, time_s };
    for text in missing_pictures(study, &results) {
        progress.note(&text);
    }
    let taken = clock.stop();
    let taken = Taken { setup_s: steps("setup_s").min(taken.wall_s), ..taken };
    leave(&Driver { scenario, options, progress }, left, &taken, &ended)?;
    ended
}

/// Runs one variant, or takes it as it is when it was done before this run was taken up.
fn run_variant(
    scenario: &Scenario,
    each: &Variant,
    options: &Options,
    part: &mut Part,
) -> Result<Ended, RunError> {
    let folder = options.folder.join(each.folder());
    let scene = variant(scenario, each).map_err(|messages| {
        let texts: Vec<String> = messages.iter().map(ToString::to_string).collect();
        SetupError::Variant(texts.join("\n"))
    })?;
    let is_same = fs::read_to_string(folder.join("scenario.ron")).is_ok_and(|text| text == resolved(&scene));
    if options.resumes && is_same && is_done(&folder) {
        return Ok(Ended::Done);
    }
    let resumes = options.resumes && is_same && folder.join("checkpoint.bin").is_file();
    let (is_interrupted, git) = (options.is_interrupted, options.git.clone());
    compose::run(&scene, &Options { folder, resumes, is_interrupted, git }, part)
}

fn is_done(folder: &Path) -> bool {
    let text = fs::read_to_string(folder.join("summary.json")).unwrap_or_default();
    serde_json::from_str::<Value>(&text).is_ok_and(|summary| summary["status"] == "done")
}

/// Progress of one variant as a part of the whole.
struct Part<'a> {
    number: usize,
    n_parts: usize,
    label: String,
    progress: &'a mut dyn Progress,
}

impl Progress for Part<'_> {
    fn stage(&mut self, stage: &Stage) {
        let text =
            format!("variant {} of {} ({}): {}", self.number + 1, self.n_parts, self.label, stage.text);
        self.progress.stage(&Stage { text, done: stage.done });
    }

    fn note(&mut self, text: &str) {
        self.progress.note(&format!("{}: {text}", self.label));
    }
}
