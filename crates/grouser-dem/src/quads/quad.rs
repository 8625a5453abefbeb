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
    /// Columns of the three numbers that each of four pointers points to.
    unsafe fn columns_of_three(rows: [*const Self::Scalar; 4]) -> [Self; 3];
    /// Stores the n-th of each column as the three numbers that pointer n points to.
    unsafe fn store_as_rows(columns: [Self; 3], rows: [*mut Self::Scalar; 4]);
    /// Columns of the eight numbers that follow each of four pointers.
    unsafe fn columns_of_eight(rows: [*const Self::Scalar; 4]) -> [[Self; 4]; 2];
    /// The nearest numbers to four in double precision.
    unsafe fn of_doubles(doubles: __m256d) -> Self;
    /// The same numbers in double precision.
    unsafe fn doubles(self) -> __m256d;
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
    unsafe fn columns_of_three([a, b, c, d]: [*const f64; 4]) -> [Self; 3] {
        unsafe {
            let ac = _mm256_set_m128d(_mm_loadu_pd(c), _mm_loadu_pd(a));
            let bd = _mm256_set_m128d(_mm_loadu_pd(d), _mm_loadu_pd(b));
            let low = _mm_loadh_pd(_mm_load_sd(a.add(2)), b.add(2));
            let high = _mm_loadh_pd(_mm_load_sd(c.add(2)), d.add(2));
            [_mm256_unpacklo_pd(ac, bd), _mm256_unpackhi_pd(ac, bd), _mm256_set_m128d(high, low)]
        }
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn store_as_rows([x, y, z]: [Self; 3], [a, b, c, d]: [*mut f64; 4]) {
        unsafe {
            let (ac, bd) = (_mm256_unpacklo_pd(x, y), _mm256_unpackhi_pd(x, y));
            let (z_ab, z_cd) = (_mm256_castpd256_pd128(z), _mm256_extractf128_pd::<1>(z));
            _mm_storeu_pd(a, _mm256_castpd256_pd128(ac));
            _mm_store_sd(a.add(2), z_ab);
            _mm_storeu_pd(b, _mm256_castpd256_pd128(bd));
            _mm_storeh_pd(b.add(2), z_ab);
            _mm_storeu_pd(c, _mm256_extractf128_pd::<1>(ac));
            _mm_store_sd(c.add(2), z_cd);
            _mm_storeu_pd(d, _mm256_extractf128_pd::<1>(bd));
            _mm_storeh_pd(d.add(2), z_cd);
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
    unsafe fn of_doubles(doubles: __m256d) -> Self {
        doubles
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn doubles(self) -> __m256d {
        self
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
    unsafe fn columns_of_three([a, b, c, d]: [*const f32; 4]) -> [Self; 3] {
        unsafe {
            let two = |low: *const f32, high: *const f32| {
                _mm_castpd_ps(_mm_loadh_pd(_mm_load_sd(low.cast()), high.cast()))
            };
            let (ab, cd) = (two(a, b), two(c, d));
            let z = _mm_setr_ps(*a.add(2), *b.add(2), *c.add(2), *d.add(2));
            [_mm_shuffle_ps::<0b10_00_10_00>(ab, cd), _mm_shuffle_ps::<0b11_01_11_01>(ab, cd), z]
        }
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn store_as_rows([x, y, z]: [Self; 3], [a, b, c, d]: [*mut f32; 4]) {
        unsafe {
            let ab = _mm_castps_pd(_mm_unpacklo_ps(x, y));
            let cd = _mm_castps_pd(_mm_unpackhi_ps(x, y));
            _mm_store_sd(a.cast(), ab);
            _mm_store_ss(a.add(2), z);
            _mm_storeh_pd(b.cast(), ab);
            _mm_store_ss(b.add(2), _mm_movehdup_ps(z));
            _mm_store_sd(c.cast(), cd);
            _mm_store_ss(c.add(2), _mm_movehl_ps(z, z));
            _mm_storeh_pd(d.cast(), cd);
            _mm_store_ss(d.add(2), _mm_shuffle_ps::<0b11_11_11_11>(z, z));
        }
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
    unsafe fn of_doubles(doubles: __m256d) -> Self {
        _mm256_cvtpd_ps(doubles)
    }
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn doubles(self) -> __m256d {
        _mm256_cvtps_pd(self)
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
