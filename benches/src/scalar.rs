//! Precision as an argument of a program.

use clap::ValueEnum;

/// Scalars of positions and of contact arithmetic, as [`grouser_contact::F64`] and its kin.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Scalar {
    /// Double precision throughout.
    F64,
    /// Positions in double, contacts and motion in single precision.
    Mixed,
    /// Single precision throughout.
    F32,
}
