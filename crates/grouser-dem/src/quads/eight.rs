//! Motion and orientations of eight pairs at once with 512-bit vectors, in double precision: half the loads, shuffles and stores
//! of four at a time, and the same bytes.

use super::MotionLanes;
use crate::slab::Pair;
use grouser_contact::{BLOCK, F64, Sphere};
use grouser_geometry::Orientation;
use std::arch::x86_64::*;

/// Fills lanes 0.. with the motion, and with the orientations if `HAS_FRAMES`, of the pairs at `at`.
///
/// # Safety
/// As [`super::gather`], on a machine that has AVX-512F; [`BLOCK`] is a multiple of eight.
#[target_feature(enable = "avx2,avx512f")]
pub(crate) unsafe fn gather_eight<const HAS_FRAMES: bool>(
    pairs: &[Pair],
    at: &[u32],
    spheres: *const Sphere<F64>,
    orientations: *const Orientation,
    lanes: &MotionLanes<f64>,
) {
    debug_assert!(at.len() <= BLOCK && BLOCK.is_multiple_of(8));
    // SAFETY: by the caller's promise; velocity, mass, spin and material are eight numbers' room in a row.
    unsafe {
        for k in (0..at.len()).step_by(8) {
            let mut grains = [[0; 8]; 2];
            for n in 0..8 {
                let [first, second] = pairs.get_unchecked(at[(k + n).min(at.len() - 1)] as usize).grains();
                (grains[0][n], grains[1][n]) = (first as usize, second as usize);
            }
            let mut velocity = [_mm512_setzero_pd(); 3];
            for body in 0..2 {
                let mut rows = [std::ptr::null::<f64>(); 8];
                for n in 0..8 {
                    rows[n] = (&raw const (*spheres.add(grains[body][n])).velocity).cast();
                }
                let [x, y, z, mass] = columns(rows, 0);
                let spin = columns(rows, 4);
                if body == 0 {
                    velocity = [x, y, z];
                } else {
                    for (axis, other) in [x, y, z].into_iter().enumerate() {
                        let relative = _mm512_sub_pd(velocity[axis], other);
                        _mm512_storeu_pd(lanes.velocity[axis].add(k), relative);
                    }
                }
                _mm512_storeu_pd(lanes.mass[body].add(k), mass);
                for axis in 0..3 {
                    _mm512_storeu_pd(lanes.spin[body][axis].add(k), spin[axis]);
                }
                if HAS_FRAMES {
                    for n in 0..8 {
                        rows[n] = orientations.add(grains[body][n]).cast();
                    }
                    for (component, column) in columns(rows, 0).into_iter().enumerate() {
                        _mm512_storeu_pd(lanes.frame[body].add(component * BLOCK + k), column);
                    }
                }
            }
        }
    }
}

/// Columns of the four numbers that lie `from` numbers behind each of eight pointers.
#[target_feature(enable = "avx2,avx512f")]
#[inline]
unsafe fn columns([a, b, c, d, e, f, g, h]: [*const f64; 8], from: usize) -> [__m512d; 4] {
    // SAFETY: by the caller's promise.
    unsafe {
        let (ae, bf) = (two_rows(a.add(from), e.add(from)), two_rows(b.add(from), f.add(from)));
        let (cg, dh) = (two_rows(c.add(from), g.add(from)), two_rows(d.add(from), h.add(from)));
        let (ab_even, ab_odd) = (_mm512_unpacklo_pd(ae, bf), _mm512_unpackhi_pd(ae, bf));
        let (cd_even, cd_odd) = (_mm512_unpacklo_pd(cg, dh), _mm512_unpackhi_pd(cg, dh));
        let low = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
        let high = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
        [
            _mm512_permutex2var_pd(ab_even, low, cd_even),
            _mm512_permutex2var_pd(ab_odd, low, cd_odd),
            _mm512_permutex2var_pd(ab_even, high, cd_even),
            _mm512_permutex2var_pd(ab_odd, high, cd_odd),
        ]
    }
}

/// Four numbers from each of two places.
#[target_feature(enable = "avx2,avx512f")]
#[inline]
unsafe fn two_rows(low: *const f64, high: *const f64) -> __m512d {
    // SAFETY: by the caller's promise.
    unsafe {
        let low = _mm512_castpd256_pd512(_mm256_loadu_pd(low));
        _mm512_insertf64x4::<1>(low, _mm256_loadu_pd(high))
    }
}
