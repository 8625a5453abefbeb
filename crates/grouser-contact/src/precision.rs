//! Precision as a choice of types: which scalar holds positions, which one computes contacts.

use crate::Real;
use serde::{Deserialize, Serialize};

/// A pair of scalars: `Coordinate` for positions and radii, `Real` for everything else.
pub trait Precision: Copy + Default + Send + Sync + std::fmt::Debug + 'static {
    /// Scalar of positions and radii; differences are taken in it.
    type Coordinate: Real;
    /// Scalar of velocities, forces, contact memory and contact arithmetic.
    type Real: Real;
}

/// Double precision throughout.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct F64;
/// Positions in double precision, contact arithmetic in single precision.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Mixed;
/// Single precision throughout.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct F32;

impl Precision for F64 {
    type Coordinate = f64;
    type Real = f64;
}

impl Precision for Mixed {
    type Coordinate = f64;
    type Real = f32;
}

impl Precision for F32 {
    type Coordinate = f32;
    type Real = f32;
}
