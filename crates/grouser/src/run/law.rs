//! From the dials to a contact law's type, once a run.

use crate::scene::{Dials, RestitutionTail};
use grouser_contact::{ContactLaw, HertzMindlin};

/// A law that runs and checkpoints can be made of.
pub trait Law: ContactLaw<f64> + Default {}
impl<L: ContactLaw<f64> + Default> Law for L {}

/// Work that is done with whatever law the dials name.
pub trait WithLaw {
    /// Result of the work.
    type Output;
    /// Does the work with a law.
    fn with<L: Law>(self, law: L) -> Self::Output;
}

/// Calls `work` with the law that `dials` name.
pub fn with_law<W: WithLaw>(dials: &Dials, work: W) -> W::Output {
    match dials.restitution_tail {
        RestitutionTail::Keep => work.with(HertzMindlin::<true, false>),
        RestitutionTail::CutCorrected => work.with(HertzMindlin::<false, false>),
    }
}
