//! Four or eight numbers in double precision with operators, for the turning of as many grains at once.

use crate::euler::Number;
use std::arch::x86_64::*;
use std::ops::{Add, Div, Mul, Sub};

/// Four numbers. Only code that is compiled for AVX2 makes any; there every operator is one instruction.
#[derive(Clone, Copy)]
pub(crate) struct Four(pub __m256d);

/// Eight numbers. Only code that is compiled for AVX-512F makes any.
#[derive(Clone, Copy)]
pub(crate) struct Eight(pub __m512d);

macro_rules! operators {
    ($numbers:ident: $($operator:ident $name:ident $instruction:ident),*; $same:ident $root:ident) => {
        $(impl $operator for $numbers {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                // SAFETY: whoever has made the numbers has the instruction.
                Self(unsafe { $instruction(self.0, other.0) })
            }
        })*
        impl Number for $numbers {
            #[inline(always)]
            fn of(value: f64) -> Self {
                // SAFETY: as above.
                Self(unsafe { $same(value) })
            }
            #[inline(always)]
            fn root(self) -> Self {
                // SAFETY: as above.
                Self(unsafe { $root(self.0) })
            }
        }
    };
}
operators!(Four: Add add _mm256_add_pd, Sub sub _mm256_sub_pd, Mul mul _mm256_mul_pd, Div div _mm256_div_pd; _mm256_set1_pd _mm256_sqrt_pd);
operators!(Eight: Add add _mm512_add_pd, Sub sub _mm512_sub_pd, Mul mul _mm512_mul_pd, Div div _mm512_div_pd; _mm512_set1_pd _mm512_sqrt_pd);
