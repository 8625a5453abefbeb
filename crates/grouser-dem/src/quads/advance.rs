//! The motion of grains with the inertia of spheres, translation and rotation of one grain at a time.

use super::Quads;
use super::octet::Octet;
use super::quad::{NarrowsTo, Quad};
use crate::integrate::{Motion, Watch};
use crate::turning::turn;
use grouser_contact::{Load, Real, Sphere, Vector};
use grouser_geometry::{Orientation, Vec3};

/// Corrects and predicts every grain, as `Motion` does with Verlet's scheme one number at a time: `correct` and `predict`, or
/// `correct_turned` and `predict_turned` where grains have orientations (`HAS_ORIENTATIONS`). `IS_HELD` are grains that never turn.
///
/// # Safety
/// The machine has AVX2; with orientations there is one for each grain, and the inertia is spherical.
#[target_feature(enable = "avx2")]
pub(crate) unsafe fn advance<Q: Quads, const HAS_ORIENTATIONS: bool, const IS_HELD: bool>(
    motion: &Motion<Q::Real>,
    spheres: &mut [Sphere<Q>],
    loads: &mut [Load<Q::Real>],
    accelerations: &mut [[Vector<Q::Real>; 2]],
    orientations: &mut [Orientation],
    watch: &mut Watch<Q::Real>,
) {
    assert!(spheres.len() == loads.len() && spheres.len() == accelerations.len());
    assert!(!HAS_ORIENTATIONS || spheres.len() == orientations.len());
    let step_s = motion.time_step.to_f64();
    let inverse_ratio = Q::Real::from_f64(motion.turning.inverse_ratio());
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
        for index in 0..spheres.len() {
            let sphere = spheres.as_mut_ptr().add(index);
            let position: *mut Q::Coordinate = (&raw mut (*sphere).position).cast();
            let motion: *mut Q::Real = (&raw mut (*sphere).velocity).cast();
            let load: *mut Q::Real = loads.as_mut_ptr().add(index).cast();
            let acceleration: *mut Q::Real = accelerations.as_mut_ptr().add(index).cast();

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
            let before = Q::Both::load_six(acceleration);
            let mut after = Q::Both::load(load).times(mobility).plus(gravity);
            if IS_HELD {
                after = after.turning_as(before);
            }
            after.store_six(acceleration);
            nothing.store(load);

            let old = Q::Both::load(motion);
            let now = old.plus(after.minus(before).times(half_steps));
            let middle = now.plus(after.times(half_steps));
            let travel = middle.translation().times(step);
            let place = Q::Wide::load(position);
            place.plus(Q::Wide::widened(travel)).with_last_of(place).store(position);
            let mut next = now.plus(after.times(steps));
            if IS_HELD {
                next = next.turning_as(old);
            } else if HAS_ORIENTATIONS {
                let mut spin = [zero; 4];
                middle.rotation().store(spin.as_mut_ptr());
                let spin = Vec3::new(spin[0].to_f64(), spin[1].to_f64(), spin[2].to_f64());
                turn(&mut orientations[index], spin, step_s);
            }
            next.with_lasts_of(old).store(motion);
            let squares = next.squares();
            fastest = Q::Both::larger(squares, fastest);
            checksum = Q::Both::plus_nothing_of(checksum, squares);
        }
        let [fastest, _] = Q::Both::scalars(fastest);
        let [checksum, of_spins] = Q::Both::scalars(checksum);
        watch.see(fastest, zero);
        watch.see(checksum, of_spins);
    }
}
