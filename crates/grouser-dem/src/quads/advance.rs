//! The motion of grains, translation and rotation of one grain at a time, orientations of four.

use super::Quads;
use super::octet::Octet;
use super::quad::{NarrowsTo, Quad};
use super::turn::{turn_about_axis, turn_four};
use crate::integrate::{Motion, Watch};
use grouser_contact::{Load, Real, Sphere, Vector};
use grouser_geometry::Orientation;

/// Corrects (`CORRECTS`) and predicts (`PREDICTS`) every grain, as `Motion` does with Verlet's scheme one number at a time: `correct` and `predict`, or
/// `correct_turned` and `predict_turned` where grains have orientations (`HAS_ORIENTATIONS`). `IS_HELD` are grains that never turn;
/// `IS_ABOUT_AXIS` grains that do, with the inertia of a body of rotation and no sphere, which go through both stages.
///
/// # Safety
/// The machine has AVX2; with orientations there is one for each grain; the inertia is spherical but where `IS_HELD` or
/// `IS_ABOUT_AXIS` say otherwise.
#[target_feature(enable = "avx2")]
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
) {
    assert!(CORRECTS && PREDICTS || !IS_ABOUT_AXIS);
    assert!(spheres.len() == loads.len() && spheres.len() == accelerations.len());
    assert!(!HAS_ORIENTATIONS || spheres.len() == orientations.len());
    let inverse_ratio = Q::Real::from_f64(if IS_ABOUT_AXIS { 1.0 } else { motion.turning.inverse_ratio() });
    let axis = motion.turning.axis().unwrap_or(0);
    // SAFETY: the three slices have one length; records are groups of four numbers, accelerations six in a row.
    unsafe {
        let scalar = Q::Real::from_f64;
        let (dt, zero) = (motion.time_step, Q::Real::ZERO);
        let half = scalar(0.5) * dt;
        let (half_steps, steps) = (Q::Both::of_halves(half, half), Q::Both::of_halves(dt, dt));
        let step = steps.translation();
        let nothing = Q::Both::of_halves(zero, zero);
        // −0 leaves every number as it is, zeros with their sign.
        let Vector { x, y, z } = motion.gravity;
        let gravity = [x, y, z, zero, -zero, -zero, -zero, -zero];
        let gravity = Q::Both::load(gravity.as_ptr());
        let (mut fastest, mut checksum) = (Q::Both::no_sums(), Q::Both::no_sums());
        // Of four grains: what turns them, the spin in the middle of the step or torques over m r² and their change.
        let none = nothing.rotation();
        let (mut turns, mut changes, mut of_spins) = ([none; 4], [none; 4], none);
        for index in 0..spheres.len() {
            let sphere = spheres.as_mut_ptr().add(index);
            let position: *mut Q::Coordinate = (&raw mut (*sphere).position).cast();
            let velocity: *mut Q::Real = (&raw mut (*sphere).velocity).cast();
            let load: *mut Q::Real = loads.as_mut_ptr().add(index).cast();
            let acceleration: *mut Q::Real = accelerations.as_mut_ptr().add(index).cast();

            let before = Q::Both::load_six(acceleration);
            let old = Q::Both::load(velocity);
            let (mut after, mut change, mut now) = (before, nothing, old);
            if CORRECTS {
                // One division serves 1/m and 1/J.
                let mobility = if HAS_ORIENTATIONS {
                    let radius = scalar((*sphere).radius.to_f64());
                    let inverse = Q::Real::ONE / ((*sphere).mass * radius * radius);
                    Q::Both::of_halves(inverse * radius * radius, inverse * inverse_ratio)
                } else {
                    let inertia_per_mass = (*sphere).inertia_per_mass();
                    let inverse = Q::Real::ONE / ((*sphere).mass * inertia_per_mass);
                    Q::Both::of_halves(inverse * inertia_per_mass, inverse)
                };
                after = Q::Both::load(load).times(mobility).plus(gravity);
                if IS_HELD {
                    after = after.turning_as(before);
                }
                after.store_six(acceleration);
                change = after.minus(before);
                now = old.plus(change.times(half_steps));
            }
            if !PREDICTS {
                if IS_HELD {
                    now = now.turning_as(old);
                }
                now.with_lasts_of(old).store(velocity);
                continue;
            }
            nothing.store(load);
            let middle = now.plus(after.times(half_steps));
            let travel = middle.translation().times(step);
            let place = Q::Wide::load(position);
            place.plus(Q::Wide::widened(travel)).with_last_of(place).store(position);
            let mut next = now.plus(after.times(steps));
            if IS_HELD || IS_ABOUT_AXIS {
                next = next.turning_as(old);
            }
            next.with_lasts_of(old).store(velocity);
            let squares = next.squares();
            fastest = Q::Both::larger(squares, fastest);
            checksum = Q::Both::plus_nothing_of(checksum, squares);
            if HAS_ORIENTATIONS && !IS_HELD {
                let place = index % 4;
                turns[place] = if IS_ABOUT_AXIS { after.rotation() } else { middle.rotation() };
                if IS_ABOUT_AXIS {
                    changes[place] = change.rotation();
                }
                if place == 3 || index + 1 == spheres.len() {
                    let four = index - place..=index;
                    let turned = &mut orientations[four.clone()];
                    if IS_ABOUT_AXIS {
                        let spheres = &mut spheres[four];
                        let squares = turn_about_axis(motion, axis, spheres, turned, turns, changes);
                        of_spins = of_spins.plus(squares.times(none));
                    } else {
                        turn_four::<Q>(motion, turned, turns);
                    }
                }
            }
        }
        let [fastest, _] = Q::Both::scalars(fastest);
        let [checksum, of_other_spins] = Q::Both::scalars(checksum);
        watch.see(fastest, zero);
        watch.see(checksum, of_other_spins);
        let mut sums = [zero; 4];
        of_spins.store(sums.as_mut_ptr());
        for sum in sums {
            watch.see(zero, sum);
        }
    }
}
