//! Slack tracks: where their links come to rest between ground, wheels and each other (P2 §2.3.3.1).
//!
//! Links above the axles are held by the wheels; between their tops the track hangs as a catenary; below it is a chain that bends
//! around the wheels and lies on the ground. Steps as in `docs/theory/iscm.md`, T1 to T4.

mod banded;
mod catenary;
mod chain;
mod drawn;
mod lay;
mod wheel_forces;

pub use catenary::Catenary;
pub use chain::{Answer, Chain, Settled, Touch};
pub use drawn::{DrawnTrack, Followed, ShoeShift};
pub use lay::{Lay, TrackShape, tight_pitch};
pub(crate) use wheel_forces::forces_on_wheels;
