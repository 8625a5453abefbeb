//! Normal forces: one law, one file.

mod hertz;
mod tsuji;

pub use hertz::{hertz_energy, hertz_stiffness};
pub use tsuji::{Tail, damping_coefficient, restitution_with_cut_tail};
