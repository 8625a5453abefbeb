//! The pass's data movement in double precision with 256-bit vectors: four records of four numbers become four lanes of
//! four numbers and back.
//!
//! The compiler vectorises the contact law by itself, but not the way between sorted records and lanes, which costs more
//! than the law (`docs/performance.md`). Every function does the same operations in the same order as its plain counterpart
//! in [`crate::force_pass`], so that the bytes are the same.

use crate::force_pass::Waiting;
use crate::slab::Pair;
use grouser_contact::{BLOCK, Lanes, Load, Sphere};
use std::arch::x86_64::*;

/// Sorted spheres and the shift of each periodic image (fourth number zero).
#[derive(Clone, Copy)]
pub(crate) struct Places<'a> {
    pub spheres: *const Sphere,
    pub shifts: &'a [[f64; 4]; 32],
}

/// Lanes that the gather fills.
pub(crate) struct GatherLanes {
    pub difference: [*mut f64; 3],
    pub excess: *mut f64,
    pub radius: [*mut f64; 2],
    pub mass: [*mut f64; 2],
    pub velocity: [*mut f64; 3],
    pub spin: [[*mut f64; 3]; 2],
}

/// Start of a lane array, whatever scalar the compiler believes it to hold; callers know that it is `f64`.
pub(crate) fn start<T>(lanes: &mut Lanes<T>) -> *mut f64 {
    lanes.0.as_mut_ptr().cast()
}

/// One bit for each of the leading pairs, a multiple of four of them, that touch; these are appended to `waiting`.
///
/// # Safety
/// The machine has AVX2; pairs hold numbers of spheres that exist.
#[target_feature(enable = "avx2")]
pub(crate) unsafe fn touching(pairs: &[Pair], from: u32, places: Places, waiting: &mut Waiting) -> u64 {
    let mut touching = 0;
    for (group, four) in pairs.chunks_exact(4).enumerate() {
        // SAFETY: by the caller's promise.
        let room = room(std::array::from_fn(|n| unsafe { relative_place(four[n], places) }.0));
        let mask = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(room, _mm256_setzero_pd()));
        waiting.append_four(mask as usize, from + 4 * group as u32);
        touching |= (mask as u64) << (4 * group);
    }
    touching
}

/// Fills the lanes `k..k + 4` with the contacts of four pairs.
///
/// # Safety
/// As [`touching`]; lane arrays hold [`BLOCK`] numbers and k + 4 ≤ [`BLOCK`].
#[target_feature(enable = "avx2")]
pub(crate) unsafe fn gather(pairs: [Pair; 4], places: Places, lanes: &GatherLanes, k: usize) {
    debug_assert!(k + 4 <= BLOCK);
    // SAFETY: by the caller's promise; records are three aligned groups of four numbers.
    unsafe {
        let store = |to: *mut f64, value: __m256d| _mm256_storeu_pd(to.add(k), value);
        let relative = pairs.map(|pair| relative_place(pair, places));
        let minus = _mm256_set1_pd(-0.0);
        store(lanes.excess, _mm256_xor_pd(room(relative.map(|(place, _)| place)), minus));
        let records =
            pairs.map(|pair| pair.grains().map(|grain| places.spheres.add(grain as usize).cast::<f64>()));
        let [x, y, z, radius] = transposed(relative.map(|(_, with_radius)| with_radius));
        store(lanes.difference[0], x);
        store(lanes.difference[1], y);
        store(lanes.difference[2], z);
        store(lanes.radius[0], radius);
        let [x, y, z, mass] = transposed(records.map(|[first, second]| {
            let velocity = _mm256_load_pd(first.add(4));
            _mm256_blend_pd::<0b1000>(_mm256_sub_pd(velocity, _mm256_load_pd(second.add(4))), velocity)
        }));
        store(lanes.velocity[0], x);
        store(lanes.velocity[1], y);
        store(lanes.velocity[2], z);
        store(lanes.mass[0], mass);
        for body in 0..2 {
            let [x, y, z, _] = transposed(records.map(|bodies| _mm256_load_pd(bodies[body].add(8))));
            store(lanes.spin[body][0], x);
            store(lanes.spin[body][1], y);
            store(lanes.spin[body][2], z);
        }
        // Radius and mass of the second body stand last in the first two groups of its record.
        let last = records
            .map(|[_, second]| _mm_unpackhi_pd(_mm_load_pd(second.add(2)), _mm_load_pd(second.add(6))));
        let even = _mm256_set_m128d(last[2], last[0]);
        let odd = _mm256_set_m128d(last[3], last[1]);
        store(lanes.radius[1], _mm256_unpacklo_pd(even, odd));
        store(lanes.mass[1], _mm256_unpackhi_pd(even, odd));
    }
}

/// Adds the lanes `k..k + n` of forces and of n × F, `n` ≤ 4, to the loads of their grains.
///
/// # Safety
/// As [`gather`]; no other thread works on these grains.
#[target_feature(enable = "avx2")]
pub(crate) unsafe fn scatter(
    pairs: &[Pair],
    loads: *mut Load,
    [forces, couples]: [[*mut f64; 3]; 2],
    arms: [*mut f64; 2],
    k: usize,
) {
    // SAFETY: by the caller's promise; loads are two aligned groups of four numbers.
    unsafe {
        let lane = |from: *mut f64| _mm256_loadu_pd(from.add(k));
        let rows = |[x, y, z]: [*mut f64; 3]| transposed([lane(x), lane(y), lane(z), _mm256_setzero_pd()]);
        let (forces, couples) = (rows(forces), rows(couples));
        for (n, pair) in pairs.iter().enumerate() {
            let [near, far] = pair.grains().map(|grain| loads.add(grain as usize).cast::<f64>());
            let add =
                |to: *mut f64, value: __m256d| _mm256_store_pd(to, _mm256_add_pd(_mm256_load_pd(to), value));
            let arm = |body: usize| _mm256_set1_pd(-*arms[body].add(k + n));
            add(near, forces[n]);
            add(near.add(4), _mm256_mul_pd(couples[n], arm(0)));
            add(far, _mm256_xor_pd(forces[n], _mm256_set1_pd(-0.0)));
            add(far.add(4), _mm256_mul_pd(couples[n], arm(1)));
        }
    }
}

/// (x, y, z, reach) of a pair, and (x, y, z, radius of the first).
#[target_feature(enable = "avx2")]
#[inline]
unsafe fn relative_place(pair: Pair, places: Places) -> (__m256d, __m256d) {
    // SAFETY: by the caller's promise; images are below 32.
    unsafe {
        let [first, second] =
            pair.grains().map(|grain| _mm256_load_pd(places.spheres.add(grain as usize).cast::<f64>()));
        let shift = _mm256_loadu_pd(places.shifts[pair.image()].as_ptr());
        let difference = _mm256_sub_pd(_mm256_sub_pd(first, second), shift);
        let reach = _mm256_add_pd(first, second);
        (_mm256_blend_pd::<0b1000>(difference, reach), _mm256_blend_pd::<0b1000>(difference, first))
    }
}

/// (x² + y²) + (z² − reach²) of four pairs: negative where they touch.
#[target_feature(enable = "avx2")]
#[inline]
fn room(places: [__m256d; 4]) -> __m256d {
    let minus_last = _mm256_set_pd(-0.0, 0.0, 0.0, 0.0);
    let squares = places.map(|place| _mm256_mul_pd(place, _mm256_xor_pd(place, minus_last)));
    let (first, last) = (_mm256_hadd_pd(squares[0], squares[1]), _mm256_hadd_pd(squares[2], squares[3]));
    _mm256_add_pd(_mm256_permute2f128_pd::<0x20>(first, last), _mm256_permute2f128_pd::<0x31>(first, last))
}

#[target_feature(enable = "avx2")]
#[inline]
fn transposed([a, b, c, d]: [__m256d; 4]) -> [__m256d; 4] {
    let (ab_even, ab_odd) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
    let (cd_even, cd_odd) = (_mm256_unpacklo_pd(c, d), _mm256_unpackhi_pd(c, d));
    [
        _mm256_permute2f128_pd::<0x20>(ab_even, cd_even),
        _mm256_permute2f128_pd::<0x20>(ab_odd, cd_odd),
        _mm256_permute2f128_pd::<0x31>(ab_even, cd_even),
        _mm256_permute2f128_pd::<0x31>(ab_odd, cd_odd),
    ]
}
