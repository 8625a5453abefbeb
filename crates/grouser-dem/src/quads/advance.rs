//! The motion of free spheres, one record's group of four numbers at a time.

use super::Quads;
use super::octet::Octet;
use super::quad::{NarrowsTo, Quad};
use crate::integrate::{Motion, Watch};
use grouser_contact::{Load, Real, Sphere, Vector};

/// Corrects and predicts every sphere, as `Motion::correct` and `Motion::predict` do for grains that turn freely.
///
/// # Safety
/// The machine has AVX2.
#[target_feature(enable = "avx2")]
pub(crate) unsafe fn advance<Q: Quads>(
    motion: &Motion<Q::Real>,
    spheres: &mut [Sphere<Q>],
    loads: &mut [Load<Q::Real>],
    accelerations: &mut [[Vector<Q::Real>; 2]],
    watch: &mut Watch<Q::Real>,
) {
    assert!(spheres.len() == loads.len() && spheres.len() == accelerations.len());
    // SAFETY: the three slices have one length; records are groups of four numbers, accelerations six in a row.
    unsafe {
        let scalar = Q::Real::from_f64;
        let (dt, zero) = (motion.time_step, Q::Real::ZERO);
        let half = scalar(0.5) * dt;
        let (half_steps, steps) = (Q::Both::of_halves(half, half), Q::Both::of_halves(dt, dt));
        let (half_step, step) = (half_steps.translation(), steps.translation());
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

            let (mass, inertia_per_mass) = ((*sphere).mass, (*sphere).inertia_per_mass());
            let inverse = Q::Real::ONE / (mass * inertia_per_mass);
            let before = Q::Both::load_six(acceleration);
            let mobility = Q::Both::of_halves(inverse * inertia_per_mass, inverse);
            let after = Q::Both::load(load).times(mobility).plus(gravity);
            after.store_six(acceleration);
            nothing.store(load);

            let old = Q::Both::load(motion);
            let now = old.plus(after.minus(before).times(half_steps));
            let travel = now.translation().plus(after.translation().times(half_step)).times(step);
            let place = Q::Wide::load(position);
            place.plus(Q::Wide::widened(travel)).with_last_of(place).store(position);
            let next = now.plus(after.times(steps));
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
