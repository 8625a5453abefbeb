//! The scalar that a contact law computes with.

use serde::{Serialize, de::DeserializeOwned};
use std::fmt::Debug;
use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A floating-point number: `f64` or `f32`. Every operation is branch-free, so that a loop over contacts
/// becomes vector instructions.
pub trait Real:
    Copy
    + Default
    + Debug
    + PartialOrd
    + Send
    + Sync
    + Serialize
    + DeserializeOwned
    + Sum
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + 'static
{
    /// Additive identity.
    const ZERO: Self;
    /// Multiplicative identity.
    const ONE: Self;
    /// Nearest value to `value`.
    fn from_f64(value: f64) -> Self;
    /// The same value in double precision.
    fn to_f64(self) -> f64;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Nearest integer, halves to even, of a number below 2²².
    fn round_ties_even(self) -> Self;
    /// Neither infinite nor NaN.
    fn is_finite(self) -> bool;

    /// The larger of two numbers (`other` where either is NaN).
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }

    /// The smaller of two numbers (`other` where either is NaN).
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
}

macro_rules! real {
    ($($scalar:ty: $rounder:literal),*) => {$(
        impl Real for $scalar {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                value as $scalar
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                self.sqrt()
            }
            #[inline(always)]
            fn round_ties_even(self) -> Self {
                // At 1.5 × 2^(bits − 1) neighbouring numbers are one apart: the sum is rounded, without a call.
                (self + $rounder) - $rounder
            }
            #[inline(always)]
            fn is_finite(self) -> bool {
                self.is_finite()
            }
        }
    )*};
}
real!(f64: 6_755_399_441_055_744.0, f32: 12_582_912.0);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_is_that_of_the_standard_library() {
        for value in [-2.5_f64, -1.5, -0.5000001, -0.5, -0.0, 0.0, 0.3, 0.5, 0.50001, 1.5, 2.5, 1e6 + 0.5] {
            assert_eq!(Real::round_ties_even(value), value.round_ties_even(), "{value}");
            let value = value as f32;
            assert_eq!(Real::round_ties_even(value), value.round_ties_even(), "{value}");
        }
    }
}
