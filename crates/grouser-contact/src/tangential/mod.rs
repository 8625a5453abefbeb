//! Tangential forces: one law, one file.

mod mindlin;

pub use mindlin::{Loading, Tangential, mindlin};
