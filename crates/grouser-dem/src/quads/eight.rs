//! Places, motion and orientations of eight pairs at once with 512-bit vectors, in double precision: half the loads, shuffles and
//! stores of four at a time, and the same bytes.

use super::quad::Quad;
use super::{MotionLanes, PlaceLanes, Places, fetch_memory};
use crate::force_pass::Waiting;
use crate::slab::Pair;
use grouser_contact::{BLOCK, F64, Sphere};
use grouser_geometry::Orientation;
use std::arch::x86_64::*;

/// Rows that stand in front in the registers of [`transposed`]; behind each of them stands the second one after it.
const ROWS_BESIDE_OTHERS: [usize; 4] = [0, 1, 4, 5];

/// As [`super::look`], eight pairs at a time, until fewer are left or fit.
///
/// # Safety
/// As [`super::look`], on a machine that has AVX-512F and AVX-512VL.
#[target_feature(enable = "avx2,avx512f,avx512vl")]
pub(crate) unsafe fn look_eight(
    pairs: &[Pair],
    mut next: usize,
    from: u32,
    touching: &mut u64,
    waiting: &mut Waiting,
    places: &Places<F64>,
    lanes: &PlaceLanes<f64>,
) -> usize {
    // SAFETY: by the caller's promise; a sphere begins with its position and its radius; images are below 32.
    unsafe {
        let count = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
        while let Some(eight) = pairs.get(next..).and_then(<[Pair]>::first_chunk::<8>)
            && waiting.has_room_for_eight()
        {
            let near = |n: usize| places.spheres.add(eight[n].grains()[0] as usize).cast::<f64>();
            let far = |n: usize| places.spheres.add(eight[n].grains()[1] as usize).cast::<f64>();
            // From the second to the first, and the first one's radius.
            let mut rows = [_mm512_setzero_pd(); 4];
            for (n, p) in ROWS_BESIDE_OTHERS.into_iter().enumerate() {
                let (first, second) = (two_rows(near(p), near(p + 2)), two_rows(far(p), far(p + 2)));
                rows[n] = _mm512_mask_sub_pd(first, 0b0111_0111, first, second);
            }
            if !Pair::are_within_the_box(eight) {
                for (n, p) in ROWS_BESIDE_OTHERS.into_iter().enumerate() {
                    let shift = |n: usize| places.shifts.add(eight[n].image()).cast();
                    rows[n] = _mm512_sub_pd(rows[n], two_rows(shift(p), shift(p + 2)));
                }
            }
            let [x, y, z, radius] = transposed(rows);
            let other = _mm512_insertf64x4::<1>(
                _mm512_castpd256_pd512(__m256d::fourths([far(0), far(1), far(2), far(3)])),
                __m256d::fourths([far(4), far(5), far(6), far(7)]),
            );
            // (x² + y²) + (z² − reach²), negative where they touch.
            let reach = _mm512_add_pd(radius, other);
            let across = _mm512_add_pd(_mm512_mul_pd(x, x), _mm512_mul_pd(y, y));
            let along = _mm512_sub_pd(_mm512_mul_pd(z, z), _mm512_mul_pd(reach, reach));
            let room = _mm512_add_pd(across, along);
            let mask = _mm512_cmp_pd_mask::<_CMP_LT_OQ>(room, _mm512_setzero_pd());
            let excess = _mm512_castsi512_pd(_mm512_xor_si512(
                _mm512_castpd_si512(room),
                _mm512_castpd_si512(_mm512_set1_pd(-0.0)),
            ));
            let n = waiting.n();
            let [lane_x, lane_y, lane_z] = lanes.difference;
            let [lane_radius, lane_other] = lanes.radius;
            let put = [
                (lane_x, x),
                (lane_y, y),
                (lane_z, z),
                (lanes.excess, excess),
                (lane_radius, radius),
                (lane_other, other),
            ];
            for (lane, value) in put {
                // Behind those that touch others stay, so that every lane holds what a law stands.
                _mm512_storeu_pd(lane.add(n), _mm512_mask_compress_pd(value, mask, value));
            }
            let place = _mm256_add_epi32(count, _mm256_set1_epi32((from as usize + next) as i32));
            let mut packed = [0_u32; 8];
            let mut packed_pairs = [eight[0]; 8];
            _mm256_storeu_si256(packed.as_mut_ptr().cast(), _mm256_maskz_compress_epi32(mask, place));
            let all = _mm512_loadu_si512(eight.as_ptr().cast());
            _mm512_storeu_si512(packed_pairs.as_mut_ptr().cast(), _mm512_mask_compress_epi64(all, mask, all));
            waiting.append_of_eight(packed, packed_pairs, mask.count_ones() as usize);
            fetch_memory(places, from as usize + next, 8);
            *touching |= u64::from(mask) << next;
            next += 8;
        }
    }
    next
}

/// As [`super::gather`], eight pairs at a time.
///
/// # Safety
/// As [`super::gather`], on a machine that has AVX-512F.
#[target_feature(enable = "avx2,avx512f")]
pub(crate) unsafe fn gather_eight<const HAS_FRAMES: bool>(
    waiting: &Waiting,
    spheres: *const Sphere<F64>,
    orientations: *const Orientation,
    lanes: &MotionLanes<f64>,
) {
    // SAFETY: by the caller's promise; velocity, mass, spin and material are eight numbers' room in a row.
    unsafe {
        for (group, eight) in waiting.pairs_in_groups::<8>().iter().enumerate() {
            let k = 8 * group;
            let mut velocity = [_mm512_setzero_pd(); 3];
            for body in 0..2 {
                let mut rows = [std::ptr::null::<f64>(); 8];
                for n in 0..8 {
                    let grain = eight[n].grains()[body] as usize;
                    rows[n] = (&raw const (*spheres.add(grain)).velocity).cast();
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
                        rows[n] = orientations.add(eight[n].grains()[body] as usize).cast();
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
        transposed([
            two_rows(a.add(from), c.add(from)),
            two_rows(b.add(from), d.add(from)),
            two_rows(e.add(from), g.add(from)),
            two_rows(f.add(from), h.add(from)),
        ])
    }
}

/// Columns of eight rows a to h of four numbers, two in each register.
#[target_feature(enable = "avx2,avx512f")]
#[inline]
pub(super) fn transposed([ac, bd, eg, fh]: [__m512d; 4]) -> [__m512d; 4] {
    let (first_xz, first_yw) = (_mm512_unpacklo_pd(ac, bd), _mm512_unpackhi_pd(ac, bd));
    let (last_xz, last_yw) = (_mm512_unpacklo_pd(eg, fh), _mm512_unpackhi_pd(eg, fh));
    [
        _mm512_shuffle_f64x2::<0b10_00_10_00>(first_xz, last_xz),
        _mm512_shuffle_f64x2::<0b10_00_10_00>(first_yw, last_yw),
        _mm512_shuffle_f64x2::<0b11_01_11_01>(first_xz, last_xz),
        _mm512_shuffle_f64x2::<0b11_01_11_01>(first_yw, last_yw),
    ]
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
