//! Shear of the ground under driven gear: what turns torque into thrust. Theory: `docs/theory/iscm_shear.md`.

mod displacement;
mod janosi_hanamoto;
mod machine;
mod traction;

pub use displacement::{Motion, ShearPath};
pub use janosi_hanamoto::JanosiHanamoto;
pub use machine::{MachineTraction, NoPull, machine_slip, machine_traction};
pub(crate) use traction::polygon_traction;
pub use traction::{Traction, foot_traction};
