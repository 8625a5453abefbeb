//! Numbers that the constitutive laws are written for: one `f64`, eight at once, or value and derivative.

mod dual;
mod lanes;

use std::ops::{Add, Div, Mul, Neg, Sub};

pub use dual::Dual;
pub use lanes::{LANES, Lanes};

/// What a constitutive law needs of a number.
///
/// A law written once for every `Real` serves single evaluations (`f64`), the explicit step ([`Lanes`]: eight elements at
/// once) and the tangent stiffness ([`Dual`]: exact directional derivatives).
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Send
    + Sync
    + 'static
{
    /// The number `value`, the same in every lane, without derivative.
    fn constant(value: f64) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Cube root.
    fn cbrt(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Whether the components' root of the sum of squares is above `bound` in any lane, derivatives included; false for NaN.
    fn norm_above(components: &[[Self; 3]; 3], bound: f64) -> bool;
    /// `factor` times this number.
    #[inline(always)]
    fn scaled(self, factor: f64) -> Self {
        self * Self::constant(factor)
    }
}

impl Real for f64 {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }
    #[inline(always)]
    fn cbrt(self) -> Self {
        self.cbrt()
    }
    #[inline(always)]
    fn ln(self) -> Self {
        self.ln()
    }
    #[inline(always)]
    fn norm_above(components: &[[Self; 3]; 3], bound: f64) -> bool {
        components.as_flattened().iter().map(|c| c * c).sum::<f64>() > bound * bound
    }
}
