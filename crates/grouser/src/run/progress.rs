//! What a run says while it runs.

use std::time::Duration;

/// What a run is doing.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// In a few words.
    pub text: String,
    /// Share of the run that is done [-] and the time that the rest will take by the pace so far; `None` while nobody
    /// knows.
    pub done: Option<(f64, Duration)>,
}

/// Whoever wants to know.
pub trait Progress {
    /// Something has been done. Called a few times a second at most.
    fn stage(&mut self, stage: &Stage);
    /// A line worth keeping.
    fn note(&mut self, text: &str);
}

/// Silence.
impl Progress for () {
    fn stage(&mut self, _: &Stage) {}
    fn note(&mut self, _: &str) {}
}
