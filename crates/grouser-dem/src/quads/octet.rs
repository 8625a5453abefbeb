//! Two groups of four numbers, what a record holds of translation and of rotation, moved together.
//!
//! Every function needs AVX2; none fuses or approximates, so that each number is what plain arithmetic gives.

use super::quad::Quad;
use std::arch::x86_64::*;

/// Eight numbers: four of translation, then four of rotation.
pub(crate) trait Octet: Copy {
    /// One of them.
    type Scalar: Copy;
    /// Four of them.
    type Half: Quad<Scalar = Self::Scalar>;
    /// The sum of squares of each half, somewhere in a register.
    type Sums: Copy;

    /// Each half filled with one number.
    unsafe fn of_halves(translation: Self::Scalar, rotation: Self::Scalar) -> Self;
    unsafe fn joined(translation: Self::Half, rotation: Self::Half) -> Self;
    unsafe fn load(from: *const Self::Scalar) -> Self;
    unsafe fn store(self, to: *mut Self::Scalar);
    /// Six numbers in a row become the first three of each half.
    unsafe fn load_six(from: *const Self::Scalar) -> Self;
    unsafe fn store_six(self, to: *mut Self::Scalar);
    unsafe fn plus(self, other: Self) -> Self;
    unsafe fn minus(self, other: Self) -> Self;
    unsafe fn times(self, other: Self) -> Self;
    unsafe fn translation(self) -> Self::Half;
    unsafe fn rotation(self) -> Self::Half;
    /// The half of translation of `self`, that of rotation of `other`.
    unsafe fn turning_as(self, other: Self) -> Self;
    /// The half of rotation filled with the number at `from`.
    unsafe fn with_rotation_of(self, from: *const Self::Scalar) -> Self;
    /// The first three of each half of `self`, the last ones of `other`.
    unsafe fn with_lasts_of(self, other: Self) -> Self;
    /// (x² + y²) + z² of each half.
    unsafe fn squares(self) -> Self::Sums;
    unsafe fn no_sums() -> Self::Sums;
    /// The larger of each, of `seen` where `new` is not a number.
    unsafe fn larger(new: Self::Sums, seen: Self::Sums) -> Self::Sums;
    /// `sum` + 0 · `new`.
    unsafe fn plus_nothing_of(sum: Self::Sums, new: Self::Sums) -> Self::Sums;
    unsafe fn scalars(sums: Self::Sums) -> [Self::Scalar; 2];
}

/// Eight numbers in double precision.
#[derive(Clone, Copy)]
pub(crate) struct Two(__m256d, __m256d);

impl Octet for Two {
    type Scalar = f64;
    type Half = __m256d;
    type Sums = __m128d;

    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn of_halves(translation: f64, rotation: f64) -> Self {
        Self(_mm256_set1_pd(translation), _mm256_set1_pd(rotation))
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn joined(translation: __m256d, rotation: __m256d) -> Self {
        Self(translation, rotation)
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn load(from: *const f64) -> Self {
        unsafe { Self(_mm256_loadu_pd(from), _mm256_loadu_pd(from.add(4))) }
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn store(self, to: *mut f64) {
        unsafe {
            _mm256_storeu_pd(to, self.0);
            _mm256_storeu_pd(to.add(4), self.1);
        }
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn load_six(from: *const f64) -> Self {
        unsafe {
            let rotation = _mm256_permute4x64_pd::<0b00_11_10_01>(_mm256_loadu_pd(from.add(2)));
            Self(_mm256_loadu_pd(from), rotation)
        }
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn store_six(self, to: *mut f64) {
        unsafe {
            let third = _mm256_permute4x64_pd::<0b10_10_10_10>(self.0);
            let rest = _mm256_permute4x64_pd::<0b10_01_00_00>(self.1);
            _mm256_storeu_pd(to, self.0);
            _mm256_storeu_pd(to.add(2), _mm256_blend_pd::<0b0001>(rest, third));
        }
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn plus(self, other: Self) -> Self {
        Self(_mm256_add_pd(self.0, other.0), _mm256_add_pd(self.1, other.1))
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn minus(self, other: Self) -> Self {
        Self(_mm256_sub_pd(self.0, other.0), _mm256_sub_pd(self.1, other.1))
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn times(self, other: Self) -> Self {
        Self(_mm256_mul_pd(self.0, other.0), _mm256_mul_pd(self.1, other.1))
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn translation(self) -> __m256d {
        self.0
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn rotation(self) -> __m256d {
        self.1
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn turning_as(self, other: Self) -> Self {
        Self(self.0, other.1)
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn with_rotation_of(self, from: *const f64) -> Self {
        unsafe { Self(self.0, _mm256_broadcast_sd(&*from)) }
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn with_lasts_of(self, other: Self) -> Self {
        Self(_mm256_blend_pd::<0b1000>(self.0, other.0), _mm256_blend_pd::<0b1000>(self.1, other.1))
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn squares(self) -> __m128d {
        unsafe {
            let Self(first, second) = self.with_lasts_of(Self::of_halves(0.0, 0.0));
            let sums = _mm256_hadd_pd(_mm256_mul_pd(first, first), _mm256_mul_pd(second, second));
            _mm_add_pd(_mm256_castpd256_pd128(sums), _mm256_extractf128_pd::<1>(sums))
        }
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn no_sums() -> __m128d {
        _mm_setzero_pd()
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn larger(new: __m128d, seen: __m128d) -> __m128d {
        _mm_max_pd(new, seen)
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn plus_nothing_of(sum: __m128d, new: __m128d) -> __m128d {
        _mm_add_pd(sum, _mm_mul_pd(new, _mm_setzero_pd()))
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn scalars(sums: __m128d) -> [f64; 2] {
        [_mm_cvtsd_f64(sums), _mm_cvtsd_f64(_mm_unpackhi_pd(sums, sums))]
    }
}

impl Octet for __m256 {
    type Scalar = f32;
    type Half = __m128;
    type Sums = __m256;

    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn of_halves(translation: f32, rotation: f32) -> Self {
        _mm256_set_m128(_mm_set1_ps(rotation), _mm_set1_ps(translation))
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn joined(translation: __m128, rotation: __m128) -> Self {
        _mm256_set_m128(rotation, translation)
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn load(from: *const f32) -> Self {
        unsafe { _mm256_loadu_ps(from) }
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn store(self, to: *mut f32) {
        unsafe { _mm256_storeu_ps(to, self) }
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn load_six(from: *const f32) -> Self {
        unsafe {
            let rotation = _mm_permute_ps::<0b00_11_10_01>(_mm_loadu_ps(from.add(2)));
            _mm256_set_m128(rotation, _mm_loadu_ps(from))
        }
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn store_six(self, to: *mut f32) {
        unsafe {
            let (first, second) = (_mm256_castps256_ps128(self), _mm256_extractf128_ps::<1>(self));
            let third = _mm_permute_ps::<0b10_10_10_10>(first);
            let rest = _mm_permute_ps::<0b10_01_00_00>(second);
            _mm_storeu_ps(to, first);
            _mm_storeu_ps(to.add(2), _mm_blend_ps::<0b0001>(rest, third));
        }
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn plus(self, other: Self) -> Self {
        _mm256_add_ps(self, other)
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn minus(self, other: Self) -> Self {
        _mm256_sub_ps(self, other)
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn times(self, other: Self) -> Self {
        _mm256_mul_ps(self, other)
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn translation(self) -> __m128 {
        _mm256_castps256_ps128(self)
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn rotation(self) -> __m128 {
        _mm256_extractf128_ps::<1>(self)
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn turning_as(self, other: Self) -> Self {
        _mm256_blend_ps::<0b1111_0000>(self, other)
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn with_rotation_of(self, from: *const f32) -> Self {
        unsafe { _mm256_blend_ps::<0b1111_0000>(self, _mm256_broadcast_ss(&*from)) }
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn with_lasts_of(self, other: Self) -> Self {
        _mm256_blend_ps::<0b1000_1000>(self, other)
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn squares(self) -> __m256 {
        unsafe {
            let places = self.with_lasts_of(_mm256_setzero_ps());
            let pairs = _mm256_mul_ps(places, places);
            let sums = _mm256_hadd_ps(pairs, pairs);
            _mm256_hadd_ps(sums, sums)
        }
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn no_sums() -> __m256 {
        _mm256_setzero_ps()
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn larger(new: __m256, seen: __m256) -> __m256 {
        _mm256_max_ps(new, seen)
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn plus_nothing_of(sum: __m256, new: __m256) -> __m256 {
        _mm256_add_ps(sum, _mm256_mul_ps(new, _mm256_setzero_ps()))
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn scalars(sums: __m256) -> [f32; 2] {
        [_mm256_cvtss_f32(sums), _mm_cvtss_f32(_mm256_extractf128_ps::<1>(sums))]
    }
}
