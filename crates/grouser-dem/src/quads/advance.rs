//! The motion of free spheres, one record's group of four numbers at a time.

use super::Quads;
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
    // Here and not behind a pointer, where every grain would wait for the last one's to be stored.
    let mut seen = *watch;
    // SAFETY: the three slices have one length; records are groups of four numbers, accelerations six in a row.
    unsafe {
        let scalar = Q::Real::from_f64;
        let (dt, zero) = (motion.time_step, Q::Real::ZERO);
        let half_step = Q::Narrow::splat(scalar(0.5) * dt);
        let step = Q::Narrow::splat(dt);
        let nothing = Q::Narrow::splat(zero);
        let gravity = [motion.gravity.x, motion.gravity.y, motion.gravity.z, zero];
        let gravity = Q::Narrow::load(gravity.as_ptr());
        for index in 0..spheres.len() {
            let sphere = spheres.as_mut_ptr().add(index);
            let position: *mut Q::Coordinate = (&raw mut (*sphere).position).cast();
            let velocity: *mut Q::Real = (&raw mut (*sphere).velocity).cast();
            let spin: *mut Q::Real = (&raw mut (*sphere).spin).cast();
            let load: *mut Q::Real = loads.as_mut_ptr().add(index).cast();
            let acceleration: *mut Q::Real = accelerations.as_mut_ptr().add(index).cast();

            let (mass, inertia_per_mass) = ((*sphere).mass, (*sphere).inertia_per_mass());
            let inverse = Q::Real::ONE / (mass * inertia_per_mass);
            let [linear, angular] = Q::Narrow::load_six(acceleration);
            let force = Q::Narrow::load(load).times(Q::Narrow::splat(inverse * inertia_per_mass));
            let after = force.plus(gravity);
            let turning = Q::Narrow::load(load.add(4)).times(Q::Narrow::splat(inverse));
            Q::Narrow::store_six([after, turning], acceleration);
            nothing.store(load);
            nothing.store(load.add(4));

            let (v, w) = (Q::Narrow::load(velocity), Q::Narrow::load(spin));
            let now = v.plus(after.minus(linear).times(half_step));
            let turned = w.plus(turning.minus(angular).times(half_step));
            let travel = now.plus(after.times(half_step)).times(step);
            let place = Q::Wide::load(position);
            place.plus(Q::Wide::widened(travel)).with_last_of(place).store(position);
            let next = now.plus(after.times(step)).with_last_of(v);
            let spinning = turned.plus(turning.times(step)).with_last_of(w);
            next.store(velocity);
            spinning.store(spin);
            let [speed_squared, spin_squared] = Q::Narrow::squares(next, spinning);
            seen.see(speed_squared, spin_squared);
        }
    }
    *watch = seen;
}
