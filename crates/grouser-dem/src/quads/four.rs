//! Four numbers in double precision with operators, for the turning of four grains at once.

use crate::euler::Number;
use std::arch::x86_64::*;
use std::ops::{Add, Div, Mul, Sub};

/// Four numbers. Only code that is compiled for AVX2 makes any; there every operator is one instruction.
#[derive(Clone, Copy)]
pub(crate) struct Four(pub __m256d);

macro_rules! operators {
    ($($operator:ident $name:ident $instruction:ident),*) => {$(
        impl $operator for Four {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                // SAFETY: whoever has made the numbers has the instruction.
                Self(unsafe { $instruction(self.0, other.0) })
            }
        }
    )*};
}
operators!(Add add _mm256_add_pd, Sub sub _mm256_sub_pd, Mul mul _mm256_mul_pd, Div div _mm256_div_pd);

impl Number for Four {
    #[inline(always)]
    fn of(value: f64) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm256_set1_pd(value) })
    }
    #[inline(always)]
    fn root(self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm256_sqrt_pd(self.0) })
    }
}
