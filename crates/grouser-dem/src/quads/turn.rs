//! Orientations of up to four grains at once, as [`crate::turning`] turns one.

use super::Quads;
use super::four::Four;
use super::quad::Quad;
use crate::euler::Axes;
use crate::integrate::Motion;
use grouser_contact::{Real, Sphere};
use grouser_geometry::Orientation;
use std::arch::x86_64::{__m256d, _mm256_loadu_pd, _mm256_storeu_pd};

/// Turns one to four grains by the spins `turns`, one a row.
///
/// # Safety
/// The machine has AVX2.
#[target_feature(enable = "avx2")]
#[inline]
pub(super) unsafe fn turn_four<Q: Quads>(
    motion: &Motion<Q::Real>,
    orientations: &mut [Orientation],
    turns: [Q::Narrow; 4],
) {
    // SAFETY: by the caller's promise.
    unsafe {
        let half_step = 0.5 * motion.time_step.to_f64();
        let before = quaternions(orientations);
        let after = crate::euler::turned(before, doubles::<Q>(Q::Narrow::transposed(turns)), half_step);
        put(orientations, after);
    }
}

/// Corrects the spin of one to four grains, bodies of rotation about `axis`, and turns them freely; `torques` over m r² and their
/// `changes` are one a row. Gives the squares of the spins.
///
/// # Safety
/// The machine has AVX2; there are as many orientations as spheres.
#[target_feature(enable = "avx2")]
#[inline]
pub(super) unsafe fn turn_about_axis<Q: Quads>(
    motion: &Motion<Q::Real>,
    axis: usize,
    spheres: &mut [Sphere<Q>],
    orientations: &mut [Orientation],
    torques: [Q::Narrow; 4],
    changes: [Q::Narrow; 4],
) -> Q::Narrow {
    let (turning, last) = (&motion.turning, spheres.len() - 1);
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
