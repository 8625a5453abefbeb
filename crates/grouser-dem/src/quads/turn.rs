//! Orientations of up to four grains, or of eight, at once, as [`crate::turning`] turns one.

use super::Quads;
use super::eight::transposed;
use super::quad::Quad;
use super::several::{Eight, Four};
use crate::euler::Axes;
use crate::integrate::Motion;
use grouser_contact::{Real, Sphere};
use grouser_geometry::Orientation;
use std::arch::x86_64::*;

/// Turns eight grains by the spins `turns`, one a row, over two half steps [s].
///
/// # Safety
/// The machine has AVX-512F; there are eight orientations.
#[target_feature(enable = "avx2,avx512f")]
#[inline]
pub(super) unsafe fn turn_eight<Q: Quads>(
    orientations: *mut Orientation,
    turns: [Q::Narrow; 8],
    half_step: f64,
) {
    // SAFETY: by the caller's promise; `Orientation` is a quaternion, four numbers in a row, and no more.
    unsafe {
        let place: *mut f64 = orientations.cast();
        let two = |n: usize| _mm512_loadu_pd(place.add(4 * n));
        let before = columns_of_pairs([two(0), two(2), two(4), two(6)]);
        let [a, b, c, d, e, f, g, h] = turns;
        let [x, y, z, _] =
            columns_of_pairs([joined::<Q>(a, b), joined::<Q>(c, d), joined::<Q>(e, f), joined::<Q>(g, h)]);
        let after = crate::euler::turned(before, [x, y, z], half_step);
        for (n, two) in pairs_of_columns(after).into_iter().enumerate() {
            _mm512_storeu_pd(place.add(8 * n), two);
        }
    }
}

/// Both in one register, in double precision.
#[target_feature(enable = "avx2,avx512f")]
#[inline]
unsafe fn joined<Q: Quads>(a: Q::Narrow, b: Q::Narrow) -> __m512d {
    // SAFETY: by the caller's promise.
    unsafe { _mm512_insertf64x4::<1>(_mm512_castpd256_pd512(a.doubles()), b.doubles()) }
}

/// Turns one to four grains by the spins `turns`, one a row, over two half steps [s].
///
/// # Safety
/// The machine has AVX2.
#[target_feature(enable = "avx2")]
#[inline]
pub(super) unsafe fn turn_four<Q: Quads>(
    orientations: &mut [Orientation],
    turns: [Q::Narrow; 4],
    half_step: f64,
) {
    // SAFETY: by the caller's promise.
    unsafe {
        let before = quaternions(orientations);
        let after = crate::euler::turned(before, doubles::<Q>(Q::Narrow::transposed(turns)), half_step);
        put(orientations, after);
    }
}

/// Corrects the spin of one to four grains, bodies of rotation, and turns them freely; `torques` over m r² and their
/// `changes` are one a row. Gives the squares of the spins.
///
/// # Safety
/// The machine has AVX2; there are as many orientations as spheres.
#[target_feature(enable = "avx2")]
#[inline]
pub(super) unsafe fn turn_about_axis<Q: Quads>(
    motion: &Motion<Q::Real>,
    spheres: &mut [Sphere<Q>],
    orientations: &mut [Orientation],
    torques: [Q::Narrow; 4],
    changes: [Q::Narrow; 4],
) -> Q::Narrow {
    let (turning, last) = (&motion.turning, spheres.len() - 1);
    let axis = turning.axis().unwrap_or(0);
    let half_step = 0.5 * motion.time_step.to_f64();
    // SAFETY: by the caller's promise; spin and material are four numbers' room in a row.
    unsafe {
        let start = spheres.as_mut_ptr();
        let spin_of = |n: usize| (&raw mut (*start.add(n.min(last))).spin).cast::<Q::Real>();
        let rows = [spin_of(0), spin_of(1), spin_of(2), spin_of(3)];
        let [a, b, c, d] = rows;
        let [x, y, z, material] = Q::Narrow::transposed([
            Q::Narrow::load(a),
            Q::Narrow::load(b),
            Q::Narrow::load(c),
            Q::Narrow::load(d),
        ]);
        let before = quaternions(orientations);
        let axes = Axes::of(before);
        let [cx, cy, cz] = turning.spin(doubles::<Q>(Q::Narrow::transposed(changes)), axes);
        let hastening = Q::Narrow::splat(motion.hastening);
        let spin = doubles::<Q>([
            x.plus(Q::Narrow::of_doubles(cx.0).times(hastening)),
            y.plus(Q::Narrow::of_doubles(cy.0).times(hastening)),
            z.plus(Q::Narrow::of_doubles(cz.0).times(hastening)),
            material,
        ]);
        let torque = doubles::<Q>(Q::Narrow::transposed(torques));
        let kicked = turning.kicked(spin, torque, axes, half_step);
        let middle = turning.middle_about(axis, &kicked, half_step);
        let (after, [x, y, z]) = turning.turned(&kicked, middle, torque, before, half_step);
        put(orientations, after);
        let [x, y, z] = [Q::Narrow::of_doubles(x.0), Q::Narrow::of_doubles(y.0), Q::Narrow::of_doubles(z.0)];
        for (n, row) in Q::Narrow::transposed([x, y, z, material]).into_iter().enumerate() {
            if n <= last {
                row.store(rows[n]);
            }
        }
        x.times(x).plus(y.times(y)).plus(z.times(z))
    }
}

/// The first three of four columns.
#[target_feature(enable = "avx2")]
#[inline]
unsafe fn doubles<Q: Quads>([x, y, z, _]: [Q::Narrow; 4]) -> [Four; 3] {
    // SAFETY: by the caller's promise.
    unsafe { [Four(x.doubles()), Four(y.doubles()), Four(z.doubles())] }
}

/// Components of up to four quaternions, the last one repeated.
#[target_feature(enable = "avx2")]
#[inline]
unsafe fn quaternions(orientations: &[Orientation]) -> [Four; 4] {
    let last = orientations.len() - 1;
    // SAFETY: by the caller's promise; a quaternion is four numbers in a row.
    unsafe {
        let row = |n: usize| _mm256_loadu_pd(orientations[last.min(n)].coords.as_ptr());
        let [x, y, z, w] = __m256d::transposed([row(0), row(1), row(2), row(3)]);
        [Four(x), Four(y), Four(z), Four(w)]
    }
}

/// The way back.
#[target_feature(enable = "avx2")]
#[inline]
unsafe fn put(orientations: &mut [Orientation], [x, y, z, w]: [Four; 4]) {
    // SAFETY: as above; `Orientation` is a quaternion and no more.
    unsafe {
        let rows = __m256d::transposed([x.0, y.0, z.0, w.0]);
        for (orientation, row) in orientations.iter_mut().zip(rows) {
            _mm256_storeu_pd((&raw mut *orientation).cast(), row);
        }
    }
}

/// Eight rows of four numbers, two in each register, become columns, all in the order 0, 2, 1, 3, 4, 6, 5, 7 of the rows.
#[target_feature(enable = "avx512f")]
#[inline]
unsafe fn columns_of_pairs(rows: [__m512d; 4]) -> [Eight; 4] {
    let [x, y, z, w] = transposed(rows);
    [Eight(x), Eight(y), Eight(z), Eight(w)]
}

/// The way back.
#[target_feature(enable = "avx512f")]
#[inline]
unsafe fn pairs_of_columns([x, y, z, w]: [Eight; 4]) -> [__m512d; 4] {
    // Rows 0, 1, 4, 5 and rows 2, 3, 6, 7.
    let (xy, xy_others) = (_mm512_unpacklo_pd(x.0, y.0), _mm512_unpackhi_pd(x.0, y.0));
    let (zw, zw_others) = (_mm512_unpacklo_pd(z.0, w.0), _mm512_unpackhi_pd(z.0, w.0));
    let low = _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11);
    let high = _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15);
    [
        _mm512_permutex2var_pd(xy, low, zw),
        _mm512_permutex2var_pd(xy_others, low, zw_others),
        _mm512_permutex2var_pd(xy, high, zw),
        _mm512_permutex2var_pd(xy_others, high, zw_others),
    ]
}
