//! Eight numbers that go through the same arithmetic.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::Real;

/// How many elements are computed at once: one AVX-512 register, two of AVX2.
pub const LANES: usize = 8;

/// One number for each of [`LANES`] elements. Plain arithmetic without fused operations: the same bits on every machine.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub struct Lanes(pub [f64; LANES]);

impl Lanes {
    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        Self(self.0.map(f))
    }

    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let mut result = self;
        for lane in 0..LANES {
            result.0[lane] = f(self.0[lane], other.0[lane]);
        }
        result
    }

    /// The smaller number of each lane.
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        // A NaN in `self` must win, so that it is seen.
        self.zip(other, |a, b| if b < a { b } else { a })
    }

    /// Sum over the lanes, in their order.
    #[inline(always)]
    pub fn sum(self) -> f64 {
        self.0.iter().sum()
    }
}

macro_rules! operator {
    ($Trait:ident, $method:ident, $op:tt) => {
        impl $Trait for Lanes {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, |a, b| a $op b)
            }
        }
    };
}
operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
operator!(Div, div, /);

impl Neg for Lanes {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|a| -a)
    }
}

impl Real for Lanes {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self([value; LANES])
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }
    #[inline(always)]
    fn cbrt(self) -> Self {
        self.map(f64::cbrt)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        self.map(f64::ln)
    }
    #[inline(always)]
    fn norm_above(components: &[[Self; 3]; 3], bound: f64) -> bool {
        let mut sum = Self::constant(0.0);
        for &c in components.as_flattened() {
            sum = sum + c * c;
        }
        let mut any = false;
        for lane in 0..LANES {
            any |= sum.0[lane] > bound * bound;
        }
        any
    }
}
