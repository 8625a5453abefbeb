//! Terramechanics from one scenario file.
#![allow(missing_docs)]
pub mod diagnostic;
pub mod output;
pub mod scene;
