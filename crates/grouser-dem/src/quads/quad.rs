//! Four numbers in one register, in double or single precision.
//!
//! Every function needs AVX2; none fuses or approximates, so that each lane holds what plain arithmetic gives.

use std::arch::x86_64::*;

/// Four numbers.
pub(crate) trait Quad: Copy {
    /// One of them.
    type Scalar: Copy;

    unsafe fn splat(value: Self::Scalar) -> Self;
    unsafe fn load(from: *const Self::Scalar) -> Self;
    unsafe fn store(self, to: *mut Self::Scalar);
    unsafe fn plus(self, other: Self) -> Self;
    unsafe fn minus(self, other: Self) -> Self;
    unsafe fn times(self, other: Self) -> Self;
    /// The sign of each number flipped.
    unsafe fn negated(self) -> Self;
    /// The first three of `self`, the last of `other`.
    unsafe fn with_last_of(self, other: Self) -> Self;
    /// One bit for each negative number (not for −0).
    unsafe fn negative(self) -> usize;
    /// The numbers whose bits are set in `mask`, first ones first.
    unsafe fn packed(self, mask: usize) -> Self;
    /// Rows become columns.
    unsafe fn transposed(rows: [Self; 4]) -> [Self; 4];
    /// Fourth numbers of four groups.
    unsafe fn fourths(groups: [*const Self::Scalar; 4]) -> Self;
    /// Columns of the eight numbers that follow each of four pointers.
    unsafe fn columns_of_eight(rows: [*const Self::Scalar; 4]) -> [[Self; 4]; 2];
    /// Adds row n of `forces` and of `couples` times `factor` to the eight numbers at `to`, forces with the sign of `sign`.
    unsafe fn add_eight(
        to: *mut Self::Scalar,
        force: Self,
        sign: Self::Scalar,
        couple: Self,
        factor: Self::Scalar,
    );
    /// (x² + y²) + z² of the first three of both.
    unsafe fn squares(first: Self, second: Self) -> [Self::Scalar; 2];
    /// Six numbers in a row: the first three, and the last three.
    unsafe fn load_six(from: *const Self::Scalar) -> [Self; 2];
    unsafe fn store_six(parts: [Self; 2], to: *mut Self::Scalar);
}

/// Narrowing of four numbers; the identity where both are alike.
pub(crate) trait NarrowsTo<R> {
    unsafe fn narrowed(self) -> R;
    unsafe fn widened(narrow: R) -> Self;
}

/// For each mask of four bits the 32-bit words that move four 64-bit numbers to the front.
const FRONT_64: [[i32; 8]; 16] = front_64();
/// The same for 32-bit numbers.
const FRONT_32: [[i32; 4]; 16] = front_32();

const fn front_32() -> [[i32; 4]; 16] {
    let mut table = [[0; 4]; 16];
    let mut mask = 0;
    while mask < 16 {
        let (mut bit, mut n) = (0, 0);
        while bit < 4 {
            if mask >> bit & 1 == 1 {
                table[mask][n] = bit;
                n += 1;
            }
            bit += 1;
        }
        mask += 1;
    }
    table
}

const fn front_64() -> [[i32; 8]; 16] {
    let narrow = front_32();
    let mut table = [[0; 8]; 16];
    let mut mask = 0;
    while mask < 16 {
        let mut n = 0;
        while n < 4 {
            table[mask][2 * n] = 2 * narrow[mask][n];
            table[mask][2 * n + 1] = 2 * narrow[mask][n] + 1;
            n += 1;
        }
        mask += 1;
    }
    table
}

impl Quad for __m256d {
    type Scalar = f64;

    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn splat(value: f64) -> Self {
        _mm256_set1_pd(value)
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn load(from: *const f64) -> Self {
        unsafe { _mm256_loadu_pd(from) }
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn store(self, to: *mut f64) {
        unsafe { _mm256_storeu_pd(to, self) }
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn plus(self, other: Self) -> Self {
        _mm256_add_pd(self, other)
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn minus(self, other: Self) -> Self {
        _mm256_sub_pd(self, other)
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn times(self, other: Self) -> Self {
        _mm256_mul_pd(self, other)
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn negated(self) -> Self {
        _mm256_xor_pd(self, _mm256_set1_pd(-0.0))
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn with_last_of(self, other: Self) -> Self {
        _mm256_blend_pd::<0b1000>(self, other)
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn negative(self) -> usize {
        _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(self, _mm256_setzero_pd())) as usize
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn packed(self, mask: usize) -> Self {
        let order = unsafe { _mm256_loadu_si256(FRONT_64[mask & 15].as_ptr().cast()) };
        _mm256_castps_pd(_mm256_permutevar8x32_ps(_mm256_castpd_ps(self), order))
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn transposed([a, b, c, d]: [Self; 4]) -> [Self; 4] {
        let (ab_even, ab_odd) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
        let (cd_even, cd_odd) = (_mm256_unpacklo_pd(c, d), _mm256_unpackhi_pd(c, d));
        [
            _mm256_permute2f128_pd::<0x20>(ab_even, cd_even),
            _mm256_permute2f128_pd::<0x20>(ab_odd, cd_odd),
            _mm256_permute2f128_pd::<0x31>(ab_even, cd_even),
            _mm256_permute2f128_pd::<0x31>(ab_odd, cd_odd),
        ]
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn fourths([a, b, c, d]: [*const f64; 4]) -> Self {
        unsafe {
            let low = _mm_loadh_pd(_mm_load_sd(a.add(3)), b.add(3));
            let high = _mm_loadh_pd(_mm_load_sd(c.add(3)), d.add(3));
            _mm256_set_m128d(high, low)
        }
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn columns_of_eight([a, b, c, d]: [*const f64; 4]) -> [[Self; 4]; 2] {
        unsafe {
            [
                Self::transposed([Self::load(a), Self::load(b), Self::load(c), Self::load(d)]),
                Self::transposed([
                    Self::load(a.add(4)),
                    Self::load(b.add(4)),
                    Self::load(c.add(4)),
                    Self::load(d.add(4)),
                ]),
            ]
        }
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn add_eight(to: *mut f64, force: Self, sign: f64, couple: Self, factor: f64) {
        unsafe {
            let force = _mm256_xor_pd(force, _mm256_set1_pd(if sign < 0.0 { -0.0 } else { 0.0 }));
            _mm256_add_pd(Self::load(to), force).store(to);
            let couple = _mm256_mul_pd(couple, _mm256_set1_pd(factor));
            _mm256_add_pd(Self::load(to.add(4)), couple).store(to.add(4));
        }
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn squares(first: Self, second: Self) -> [f64; 2] {
        let keep = _mm256_castsi256_pd(_mm256_set_epi64x(0, -1, -1, -1));
        let (first, second) = (_mm256_and_pd(first, keep), _mm256_and_pd(second, keep));
        let sums = _mm256_hadd_pd(_mm256_mul_pd(first, first), _mm256_mul_pd(second, second));
        let total = _mm_add_pd(_mm256_castpd256_pd128(sums), _mm256_extractf128_pd::<1>(sums));
        [_mm_cvtsd_f64(total), _mm_cvtsd_f64(_mm_unpackhi_pd(total, total))]
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn load_six(from: *const f64) -> [Self; 2] {
        unsafe { [Self::load(from), _mm256_permute4x64_pd::<0b00_11_10_01>(Self::load(from.add(2)))] }
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn store_six([first, second]: [Self; 2], to: *mut f64) {
        unsafe {
            let third = _mm256_permute4x64_pd::<0b10_10_10_10>(first);
            let rest = _mm256_permute4x64_pd::<0b10_01_00_00>(second);
            first.store(to);
            _mm256_blend_pd::<0b0001>(rest, third).store(to.add(2));
        }
    }
}

impl Quad for __m128 {
    type Scalar = f32;

    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn splat(value: f32) -> Self {
        _mm_set1_ps(value)
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn load(from: *const f32) -> Self {
        unsafe { _mm_loadu_ps(from) }
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn store(self, to: *mut f32) {
        unsafe { _mm_storeu_ps(to, self) }
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn plus(self, other: Self) -> Self {
        _mm_add_ps(self, other)
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn minus(self, other: Self) -> Self {
        _mm_sub_ps(self, other)
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn times(self, other: Self) -> Self {
        _mm_mul_ps(self, other)
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn negated(self) -> Self {
        _mm_xor_ps(self, _mm_set1_ps(-0.0))
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn with_last_of(self, other: Self) -> Self {
        _mm_blend_ps::<0b1000>(self, other)
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn negative(self) -> usize {
        _mm_movemask_ps(_mm_cmp_ps::<_CMP_LT_OQ>(self, _mm_setzero_ps())) as usize
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn packed(self, mask: usize) -> Self {
        let order = unsafe { _mm_loadu_si128(FRONT_32[mask & 15].as_ptr().cast()) };
        _mm_permutevar_ps(self, order)
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn transposed([a, b, c, d]: [Self; 4]) -> [Self; 4] {
        let (ab_low, ab_high) = (_mm_unpacklo_ps(a, b), _mm_unpackhi_ps(a, b));
        let (cd_low, cd_high) = (_mm_unpacklo_ps(c, d), _mm_unpackhi_ps(c, d));
        [
            _mm_movelh_ps(ab_low, cd_low),
            _mm_movehl_ps(cd_low, ab_low),
            _mm_movelh_ps(ab_high, cd_high),
            _mm_movehl_ps(cd_high, ab_high),
        ]
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn fourths([a, b, c, d]: [*const f32; 4]) -> Self {
        unsafe { _mm_setr_ps(*a.add(3), *b.add(3), *c.add(3), *d.add(3)) }
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn columns_of_eight([a, b, c, d]: [*const f32; 4]) -> [[Self; 4]; 2] {
        unsafe {
            let (a, b) = (_mm256_loadu_ps(a), _mm256_loadu_ps(b));
            let (c, d) = (_mm256_loadu_ps(c), _mm256_loadu_ps(d));
            let (ab_low, ab_high) = (_mm256_unpacklo_ps(a, b), _mm256_unpackhi_ps(a, b));
            let (cd_low, cd_high) = (_mm256_unpacklo_ps(c, d), _mm256_unpackhi_ps(c, d));
            let x = _mm256_shuffle_ps::<0x44>(ab_low, cd_low);
            let y = _mm256_shuffle_ps::<0xee>(ab_low, cd_low);
            let z = _mm256_shuffle_ps::<0x44>(ab_high, cd_high);
            let last = _mm256_shuffle_ps::<0xee>(ab_high, cd_high);
            [
                [
                    _mm256_castps256_ps128(x),
                    _mm256_castps256_ps128(y),
                    _mm256_castps256_ps128(z),
                    _mm256_castps256_ps128(last),
                ],
                [
                    _mm256_extractf128_ps::<1>(x),
                    _mm256_extractf128_ps::<1>(y),
                    _mm256_extractf128_ps::<1>(z),
                    _mm256_extractf128_ps::<1>(last),
                ],
            ]
        }
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn add_eight(to: *mut f32, force: Self, sign: f32, couple: Self, factor: f32) {
        unsafe {
            let both = _mm256_set_m128(couple, force);
            let factors = _mm256_set_m128(_mm_set1_ps(factor), _mm_set1_ps(sign));
            _mm256_storeu_ps(to, _mm256_add_ps(_mm256_loadu_ps(to), _mm256_mul_ps(both, factors)));
        }
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn squares(first: Self, second: Self) -> [f32; 2] {
        let keep = _mm_castsi128_ps(_mm_set_epi32(0, -1, -1, -1));
        let (first, second) = (_mm_and_ps(first, keep), _mm_and_ps(second, keep));
        let sums = _mm_hadd_ps(_mm_mul_ps(first, first), _mm_mul_ps(second, second));
        let total = _mm_hadd_ps(sums, sums);
        [_mm_cvtss_f32(total), _mm_cvtss_f32(_mm_movehdup_ps(total))]
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn load_six(from: *const f32) -> [Self; 2] {
        unsafe { [Self::load(from), _mm_permute_ps::<0b00_11_10_01>(Self::load(from.add(2)))] }
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn store_six([first, second]: [Self; 2], to: *mut f32) {
        unsafe {
            let third = _mm_permute_ps::<0b10_10_10_10>(first);
            let rest = _mm_permute_ps::<0b10_01_00_00>(second);
            first.store(to);
            _mm_blend_ps::<0b0001>(rest, third).store(to.add(2));
        }
    }
}

impl NarrowsTo<__m256d> for __m256d {
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn narrowed(self) -> __m256d {
        self
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn widened(narrow: __m256d) -> Self {
        narrow
    }
}

impl NarrowsTo<__m128> for __m256d {
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn narrowed(self) -> __m128 {
        _mm256_cvtpd_ps(self)
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn widened(narrow: __m128) -> Self {
        _mm256_cvtps_pd(narrow)
    }
}

impl NarrowsTo<__m128> for __m128 {
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn narrowed(self) -> __m128 {
        self
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn widened(narrow: __m128) -> Self {
        narrow
    }
}
