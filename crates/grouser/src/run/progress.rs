//! What a run says while it runs.

use std::time::Duration;

/// What a run is doing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stage {
    /// The bed comes to rest; how far the energy still is from the criterion is not known beforehand.
    Settling {
        /// Simulated time [s].
        time_s: f64,
        /// Kinetic energy over Σ m g r [-].
        energy_ratio: f64,
    },
    /// A plate is on its way.
    Pressing {
        /// Number of the plate, from 0.
        plate: usize,
        /// Number of plates.
        n_plates: usize,
        /// Diameter [m].
        diameter_m: f64,
        /// Share of all plates' steps that are done [-].
        done: f64,
        /// Time that the rest will take, by the pace so far.
        left: Duration,
    },
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
