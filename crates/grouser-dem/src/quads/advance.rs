//! The motion of grains, translation and rotation of one grain at a time, orientations of eight.
//!
//! Where the inertia is a sphere's these go in groups of eight, written out: what turns them stays in registers then, and AVX-512
//! turns eight at once. From a loop with one place for each grain it would go through memory.

use super::Quads;
use super::mover::Mover;
use super::quad::Quad;
use super::turn::{turn_about_axis, turn_eight, turn_four};
use crate::force_pass::InstructionSet;
use crate::integrate::{Motion, Watch};
use grouser_contact::{Load, Real, Sphere, Vector};
use grouser_geometry::Orientation;

/// Grains whose orientations are turned together.
const GROUP: usize = 8;

/// [`go`] with the registers of an instruction set.
macro_rules! advance_compiled_for {
    ($name:ident, $features:literal, $is_wide:literal) => {
        #[target_feature(enable = $features)]
        unsafe fn $name<
            Q: Quads,
            const CORRECTS: bool,
            const PREDICTS: bool,
            const HAS_ORIENTATIONS: bool,
            const IS_HELD: bool,
            const IS_ABOUT_AXIS: bool,
        >(
            motion: &Motion<Q::Real>,
            spheres: &mut [Sphere<Q>],
            loads: &mut [Load<Q::Real>],
            accelerations: &mut [[Vector<Q::Real>; 2]],
            orientations: &mut [Orientation],
            watch: &mut Watch<Q::Real>,
        ) {
            // SAFETY: by the caller's promise.
            unsafe {
                go::<Q, CORRECTS, PREDICTS, HAS_ORIENTATIONS, IS_HELD, IS_ABOUT_AXIS, $is_wide>(
                    motion,
                    spheres,
                    loads,
                    accelerations,
                    orientations,
                    watch,
                );
            }
        }
    };
}
advance_compiled_for!(advance_avx2, "avx2", false);
advance_compiled_for!(advance_avx512, "avx2,avx512f,avx512dq,avx512vl", true);

/// Corrects (`CORRECTS`) and predicts (`PREDICTS`) every grain, as `Motion` does with Verlet's scheme one number at a time: `correct` and `predict`, or
/// `correct_turned` and `predict_turned` where grains have orientations (`HAS_ORIENTATIONS`). `IS_HELD` are grains that never turn;
/// `IS_ABOUT_AXIS` grains that do, with the inertia of a body of rotation and no sphere, which go through both stages.
///
/// # Safety
/// The machine has `set`, AVX2 at least; with orientations there is one for each grain; the inertia is spherical but where `IS_HELD`
/// or `IS_ABOUT_AXIS` say otherwise.
pub(crate) unsafe fn advance<
    Q: Quads,
    const CORRECTS: bool,
    const PREDICTS: bool,
    const HAS_ORIENTATIONS: bool,
    const IS_HELD: bool,
    const IS_ABOUT_AXIS: bool,
>(
    motion: &Motion<Q::Real>,
    spheres: &mut [Sphere<Q>],
    loads: &mut [Load<Q::Real>],
    accelerations: &mut [[Vector<Q::Real>; 2]],
    orientations: &mut [Orientation],
    watch: &mut Watch<Q::Real>,
    set: InstructionSet,
) {
    let go = match set {
        InstructionSet::Avx512 => {
            advance_avx512::<Q, CORRECTS, PREDICTS, HAS_ORIENTATIONS, IS_HELD, IS_ABOUT_AXIS>
        }
        _ => advance_avx2::<Q, CORRECTS, PREDICTS, HAS_ORIENTATIONS, IS_HELD, IS_ABOUT_AXIS>,
    };
    // SAFETY: by the caller's promise.
    unsafe { go(motion, spheres, loads, accelerations, orientations, watch) }
}

/// What [`advance`] does. `IS_WIDE` where the function that this becomes part of is compiled for AVX-512.
///
/// # Safety
/// As [`advance`].
#[inline(always)]
unsafe fn go<
    Q: Quads,
    const CORRECTS: bool,
    const PREDICTS: bool,
    const HAS_ORIENTATIONS: bool,
    const IS_HELD: bool,
    const IS_ABOUT_AXIS: bool,
    const IS_WIDE: bool,
>(
    motion: &Motion<Q::Real>,
    spheres: &mut [Sphere<Q>],
    loads: &mut [Load<Q::Real>],
    accelerations: &mut [[Vector<Q::Real>; 2]],
    orientations: &mut [Orientation],
    watch: &mut Watch<Q::Real>,
) {
    assert!(CORRECTS && PREDICTS || !IS_ABOUT_AXIS);
    assert!(spheres.len() == loads.len() && spheres.len() == accelerations.len());
    assert!(!HAS_ORIENTATIONS || spheres.len() == orientations.len());
    let n = spheres.len();
    // SAFETY: the three slices have one length, with orientations the fourth, too, which no index reaches.
    unsafe {
        let inverse_ratio = if IS_ABOUT_AXIS { 1.0 } else { motion.turning.inverse_ratio() };
        let mut mover = Mover::<Q>::new(motion, inverse_ratio, spheres, loads, accelerations);
        let none = mover.none();
        let mut of_spins = none;
        let half_step = 0.5 * motion.time_step.to_f64();
        macro_rules! moved {
            ($index:expr) => {
                mover.moved::<CORRECTS, PREDICTS, HAS_ORIENTATIONS, IS_HELD, IS_ABOUT_AXIS>($index)
            };
        }
        let turns_any = HAS_ORIENTATIONS && PREDICTS && !IS_HELD;
        let n_in_groups = if turns_any && !IS_ABOUT_AXIS { n - n % GROUP } else { 0 };
        for from in (0..n_in_groups).step_by(GROUP) {
            let [a, _] = moved!(from);
            let [b, _] = moved!(from + 1);
            let [c, _] = moved!(from + 2);
            let [d, _] = moved!(from + 3);
            let [e, _] = moved!(from + 4);
            let [f, _] = moved!(from + 5);
            let [g, _] = moved!(from + 6);
            let [h, _] = moved!(from + 7);
            if IS_WIDE {
                turn_eight::<Q>(orientations.as_mut_ptr().add(from), [a, b, c, d, e, f, g, h], half_step);
            } else {
                turn_four::<Q>(&mut orientations[from..from + 4], [a, b, c, d], half_step);
                turn_four::<Q>(&mut orientations[from + 4..from + 8], [e, f, g, h], half_step);
            }
        }
        if !turns_any {
            for index in 0..n {
                moved!(index);
            }
        } else {
            let (mut turns, mut changes) = ([none; 4], [none; 4]);
            for from in (n_in_groups..n).step_by(4) {
                let four = from..n.min(from + 4);
                for index in four.clone() {
                    [turns[index - from], changes[index - from]] = moved!(index);
                }
                let turned = &mut orientations[four.clone()];
                if IS_ABOUT_AXIS {
                    let spheres = mover.spheres(four);
                    let squares = turn_about_axis(motion, spheres, turned, turns, changes);
                    of_spins = of_spins.plus(squares.times(none));
                } else {
                    turn_four::<Q>(turned, turns, half_step);
                }
            }
        }
        mover.tell(watch);
        let zero = Q::Real::ZERO;
        let mut sums = [zero; 4];
        of_spins.store(sums.as_mut_ptr());
        for sum in sums {
            watch.see(zero, sum);
        }
    }
}
