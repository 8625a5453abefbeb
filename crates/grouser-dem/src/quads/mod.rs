//! The pass's data movement with 256-bit vectors: four records become four lanes of each component and back.
//!
//! The compiler vectorises the contact law by itself, but not the way between sorted records and lanes, which costs more
//! than the law (`docs/performance.md`). Every function does the same operations in the same order as its plain counterpart
//! in [`crate::force_pass`] and [`crate::integrate`], so that the bytes are the same. Loops over a block are inside, and no
//! closure stands between a loop and its instructions: either would leave a call for every four contacts.

mod advance;
mod eight;
mod memory;
mod mover;
mod octet;
mod quad;
mod several;
mod turn;

pub(crate) use advance::advance;
pub(crate) use eight::{gather_eight, look_eight};
pub(crate) use memory::{recall, remember};

use crate::force_pass::Waiting;
use crate::slab::Pair;
use grouser_contact::{BLOCK, F32, F64, Lanes, Load, Mixed, Precision, Sphere};
use grouser_geometry::Orientation;
use octet::{Octet, Two};
use quad::{NarrowsTo, Quad};
use std::arch::x86_64::{__m128, __m256, __m256d, _MM_HINT_T0, _mm_prefetch, _mm256_loadu_pd};

/// Precisions and the registers that hold four of their scalars.
pub(crate) trait Quads: Precision {
    type Wide: Quad<Scalar = Self::Coordinate> + NarrowsTo<Self::Narrow>;
    type Narrow: Quad<Scalar = Self::Real>;
    type Both: Octet<Scalar = Self::Real, Half = Self::Narrow>;
}

impl Quads for F64 {
    type Wide = __m256d;
    type Narrow = __m256d;
    type Both = Two;
}

impl Quads for Mixed {
    type Wide = __m256d;
    type Narrow = __m128;
    type Both = __m256;
}

impl Quads for F32 {
    type Wide = __m128;
    type Narrow = __m128;
    type Both = __m256;
}

/// Sorted spheres and the shift of each periodic image (fourth number zero).
pub(crate) struct Places<Q: Quads> {
    pub spheres: *const Sphere<Q>,
    pub shifts: *const [Q::Coordinate; 4],
    /// What the pairs remember, which is fetched early, and the size of that in bytes; nothing is read here.
    pub memory: *const u8,
    pub memory_bytes: usize,
}

/// Lanes that [`look`] fills.
pub(crate) struct PlaceLanes<T> {
    pub difference: [*mut T; 3],
    pub excess: *mut T,
    pub radius: [*mut T; 2],
}

/// Lanes that [`gather`] fills.
pub(crate) struct MotionLanes<T> {
    pub mass: [*mut T; 2],
    pub velocity: [*mut T; 3],
    pub spin: [[*mut T; 3]; 2],
    /// Orientations (i, j, k, real part): four arrays of lanes that follow each other.
    pub frame: [*mut T; 2],
}

/// Start of a lane array, whatever scalar the compiler believes it to hold; callers know that it is `U`.
#[inline(always)]
pub(crate) fn start<T, U>(lanes: &mut Lanes<T>) -> *mut U {
    lanes.0.as_mut_ptr().cast()
}

/// Looks at the groups of four pairs from `next` on until the block is full; sets one bit in `touching` for each pair that
/// touches, and appends it to `waiting` and to the lanes. Gives the first pair that was not looked at.
///
/// # Safety
/// The machine has AVX2; pairs hold numbers of spheres that exist; lane arrays hold [`BLOCK`] numbers.
#[target_feature(enable = "avx2")]
pub(crate) unsafe fn look<Q: Quads>(
    pairs: &[Pair],
    mut next: usize,
    from: u32,
    touching: &mut u64,
    waiting: &mut Waiting,
    places: &Places<Q>,
    lanes: &PlaceLanes<Q::Real>,
) -> usize {
    // SAFETY: by the caller's promise; images are below 32.
    unsafe {
        while next + 4 <= pairs.len() && waiting.has_room() {
            let four = pairs.as_ptr().add(next);
            let (first_a, second_a, row_a) = row(*four, places);
            let (first_b, second_b, row_b) = row(*four.add(1), places);
            let (first_c, second_c, row_c) = row(*four.add(2), places);
            let (first_d, second_d, row_d) = row(*four.add(3), places);
            let [x, y, z, _] = Q::Wide::transposed([row_a, row_b, row_c, row_d]);
            let radius = Q::Wide::fourths([first_a, first_b, first_c, first_d]);
            let other = Q::Wide::fourths([second_a, second_b, second_c, second_d]);
            // (x² + y²) + (z² − reach²), negative where they touch.
            let reach = radius.plus(other);
            let across = x.times(x).plus(y.times(y));
            let room = across.plus(z.times(z).minus(reach.times(reach)));
            let mask = room.negative();
            let n = waiting.n();
            let put = [
                (lanes.difference[0], x),
                (lanes.difference[1], y),
                (lanes.difference[2], z),
                (lanes.excess, room.negated()),
                (lanes.radius[0], radius),
                (lanes.radius[1], other),
            ];
            for (lane, value) in put {
                value.narrowed().packed(mask).store(lane.add(n));
            }
            // A pair is as long as a number in double precision.
            let mut touching_first = [*four; 4];
            let in_front = __m256d::load(four.cast()).packed(mask);
            in_front.store(touching_first.as_mut_ptr().cast());
            waiting.append_four(mask, from + next as u32, touching_first);
            fetch_memory(places, from as usize + next, 4);
            *touching |= (mask as u64) << next;
            next += 4;
        }
    }
    next
}

/// Fetches what `n` pairs from place `start` on remember.
#[inline(always)]
fn fetch_memory<Q: Quads>(places: &Places<Q>, start: usize, n: usize) {
    let mut line = start * places.memory_bytes;
    while line < (start + n) * places.memory_bytes {
        // SAFETY: nothing is read.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(places.memory.wrapping_add(line).cast()) };
        line += 64;
    }
}

/// Positions of the two grains, and (x, y, z) from the second to the first.
#[target_feature(enable = "avx2")]
#[inline]
unsafe fn row<Q: Quads>(
    pair: Pair,
    places: &Places<Q>,
) -> (*const Q::Coordinate, *const Q::Coordinate, Q::Wide) {
    // SAFETY: by the caller's promise.
    unsafe {
        let [first, second] = pair.grains();
        let first: *const Q::Coordinate = places.spheres.add(first as usize).cast();
        let second: *const Q::Coordinate = places.spheres.add(second as usize).cast();
        let shift = Q::Wide::load(places.shifts.add(pair.image()).cast());
        (first, second, Q::Wide::load(first).minus(Q::Wide::load(second)).minus(shift))
    }
}

/// Fills lanes 0.. with the motion, and with the orientations if `HAS_FRAMES`, of the pairs that wait.
///
/// # Safety
/// As [`look`]; with `HAS_FRAMES` there is an orientation for each sphere.
#[target_feature(enable = "avx2")]
pub(crate) unsafe fn gather<Q: Quads, const HAS_FRAMES: bool>(
    waiting: &Waiting,
    spheres: *const Sphere<Q>,
    orientations: *const Orientation,
    lanes: &MotionLanes<Q::Real>,
) {
    // SAFETY: by the caller's promise; velocity, mass, spin and material are eight numbers' room in a row.
    unsafe {
        for (group, &[a, b, c, d]) in waiting.pairs_in_groups().iter().enumerate() {
            let k = 4 * group;
            let [a, b, c, d] = [a.grains(), b.grains(), c.grains(), d.grains()];
            let [first_a, second_a] = motions(a, spheres);
            let [first_b, second_b] = motions(b, spheres);
            let [first_c, second_c] = motions(c, spheres);
            let [first_d, second_d] = motions(d, spheres);
            let [[x, y, z, mass], spin] = Q::Narrow::columns_of_eight([first_a, first_b, first_c, first_d]);
            let [[x2, y2, z2, mass2], spin2] =
                Q::Narrow::columns_of_eight([second_a, second_b, second_c, second_d]);
            x.minus(x2).store(lanes.velocity[0].add(k));
            y.minus(y2).store(lanes.velocity[1].add(k));
            z.minus(z2).store(lanes.velocity[2].add(k));
            mass.store(lanes.mass[0].add(k));
            mass2.store(lanes.mass[1].add(k));
            for axis in 0..3 {
                spin[axis].store(lanes.spin[0][axis].add(k));
                spin2[axis].store(lanes.spin[1][axis].add(k));
            }
            if HAS_FRAMES {
                for body in 0..2 {
                    let row = |grain: u32| _mm256_loadu_pd(orientations.add(grain as usize).cast());
                    let rows = [row(a[body]), row(b[body]), row(c[body]), row(d[body])];
                    for (component, column) in __m256d::transposed(rows).into_iter().enumerate() {
                        Q::Narrow::of_doubles(column).store(lanes.frame[body].add(component * BLOCK + k));
                    }
                }
            }
        }
    }
}

/// Where the velocities of two grains begin.
#[target_feature(enable = "avx2")]
#[inline]
unsafe fn motions<Q: Quads>([first, second]: [u32; 2], spheres: *const Sphere<Q>) -> [*const Q::Real; 2] {
    // SAFETY: by the caller's promise.
    unsafe {
        [
            (&raw const (*spheres.add(first as usize)).velocity).cast(),
            (&raw const (*spheres.add(second as usize)).velocity).cast(),
        ]
    }
}

/// Adds the lanes of forces, to the second grain with the opposite sign, and of the torques on each to the loads of the grains of
/// `pairs`.
///
/// # Safety
/// As [`scatter`].
#[target_feature(enable = "avx2")]
pub(crate) unsafe fn scatter_torques<Q: Quads>(
    pairs: &[Pair],
    loads: *mut Load<Q::Real>,
    forces: [*mut Q::Real; 3],
    torques: [[*mut Q::Real; 3]; 2],
) {
    // SAFETY: by the caller's promise; loads are two groups of four numbers.
    unsafe {
        for k in (0..pairs.len()).step_by(4) {
            let force = rows::<Q>(forces, k);
            let torque = [rows::<Q>(torques[0], k), rows::<Q>(torques[1], k)];
            for n in 0..(pairs.len() - k).min(4) {
                let [near, far] = pairs.get_unchecked(k + n).grains();
                let near = loads.add(near as usize).cast();
                Q::Both::load(near).plus(Q::Both::joined(force[n], torque[0][n])).store(near);
                let far = loads.add(far as usize).cast();
                Q::Both::load(far).plus(Q::Both::joined(force[n].negated(), torque[1][n])).store(far);
            }
        }
    }
}

/// Four vectors, each followed by zero, from the lanes `k..k + 4` of their components.
#[target_feature(enable = "avx2")]
#[inline]
unsafe fn rows<Q: Quads>([x, y, z]: [*mut Q::Real; 3], k: usize) -> [Q::Narrow; 4] {
    // SAFETY: by the caller's promise.
    unsafe {
        Q::Narrow::transposed([
            Q::Narrow::load(x.add(k)),
            Q::Narrow::load(y.add(k)),
            Q::Narrow::load(z.add(k)),
            Q::Narrow::splat(Q::Real::default()),
        ])
    }
}

/// Adds the lanes of forces and of n × F to the loads of the grains of `pairs`.
///
/// # Safety
/// As [`gather`]; there are at most [`BLOCK`] pairs; no other thread works on these grains.
#[target_feature(enable = "avx2")]
pub(crate) unsafe fn scatter<Q: Quads>(
    pairs: &[Pair],
    loads: *mut Load<Q::Real>,
    forces: [*mut Q::Real; 3],
    couples: [*mut Q::Real; 3],
    arms: [*mut Q::Real; 2],
) {
    // SAFETY: by the caller's promise; loads are two groups of four numbers.
    unsafe {
        let one = <Q::Real as grouser_contact::Real>::ONE;
        let padding = Q::Narrow::splat(Q::Real::default());
        let (near_side, far_side) = (Q::Both::of_halves(one, one), Q::Both::of_halves(-one, one));
        let mut k = 0;
        while k < pairs.len() {
            let [x, y, z] = forces;
            let force = Q::Narrow::transposed([
                Q::Narrow::load(x.add(k)),
                Q::Narrow::load(y.add(k)),
                Q::Narrow::load(z.add(k)),
                padding,
            ]);
            let [x, y, z] = couples;
            let couple = Q::Narrow::transposed([
                Q::Narrow::load(x.add(k)).negated(),
                Q::Narrow::load(y.add(k)).negated(),
                Q::Narrow::load(z.add(k)).negated(),
                padding,
            ]);
            for n in 0..(pairs.len() - k).min(4) {
                let [near, far] = pairs.get_unchecked(k + n).grains();
                let both = Q::Both::joined(force[n], couple[n]);
                for (grain, side, arm) in [(near, near_side, arms[0]), (far, far_side, arms[1])] {
                    let load = loads.add(grain as usize).cast();
                    let share = both.times(side.with_rotation_of(arm.add(k + n)));
                    Q::Both::load(load).plus(share).store(load);
                }
            }
            k += 4;
        }
    }
}
