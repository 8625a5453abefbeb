//! One grain's step of Verlet's scheme, translation and rotation in one register or two.
//!
//! Every function becomes part of one that is compiled for AVX2 or more.

use super::Quads;
use super::octet::Octet;
use super::quad::{NarrowsTo, Quad};
use crate::integrate::{Motion, Watch};
use grouser_contact::{Load, Real, Sphere, Vector};
use std::ops::Range;

/// Grains, what moves them all alike, and what was seen on the way.
pub(super) struct Mover<Q: Quads> {
    spheres: *mut Sphere<Q>,
    loads: *mut Load<Q::Real>,
    accelerations: *mut [Vector<Q::Real>; 2],
    half_steps: Q::Both,
    steps: Q::Both,
    gravity: Q::Both,
    nothing: Q::Both,
    inverse_ratio: Q::Real,
    /// Largest squares of velocities, and 0 × the sum of all squares.
    fastest: <Q::Both as Octet>::Sums,
    checksum: <Q::Both as Octet>::Sums,
}

impl<Q: Quads> Mover<Q> {
    /// Of grains in three arrays of one length; `inverse_ratio` is m r² over the moment of inertia.
    #[inline(always)]
    pub unsafe fn new(
        motion: &Motion<Q::Real>,
        inverse_ratio: f64,
        spheres: &mut [Sphere<Q>],
        loads: &mut [Load<Q::Real>],
        accelerations: &mut [[Vector<Q::Real>; 2]],
    ) -> Self {
        let (dt, zero) = (motion.time_step, Q::Real::ZERO);
        let half = Q::Real::from_f64(0.5) * dt;
        // −0 leaves every number as it is, zeros with their sign.
        let Vector { x, y, z } = motion.gravity;
        let gravity = [x, y, z, zero, -zero, -zero, -zero, -zero];
        // SAFETY: whoever calls this is compiled for AVX2, as below.
        unsafe {
            Self {
                spheres: spheres.as_mut_ptr(),
                loads: loads.as_mut_ptr(),
                accelerations: accelerations.as_mut_ptr(),
                half_steps: Q::Both::of_halves(half, half),
                steps: Q::Both::of_halves(dt, dt),
                gravity: Q::Both::load(gravity.as_ptr()),
                nothing: Q::Both::of_halves(zero, zero),
                inverse_ratio: Q::Real::from_f64(inverse_ratio),
                fastest: Q::Both::no_sums(),
                checksum: Q::Both::no_sums(),
            }
        }
    }

    /// What turns a grain that is not turned: nothing.
    #[inline(always)]
    pub unsafe fn none(&self) -> Q::Narrow {
        // SAFETY: as above.
        unsafe { self.nothing.rotation() }
    }

    /// The grains of a range that exists.
    #[inline(always)]
    pub unsafe fn spheres(&mut self, range: Range<usize>) -> &mut [Sphere<Q>] {
        // SAFETY: the mover has borrowed them all.
        unsafe { std::slice::from_raw_parts_mut(self.spheres.add(range.start), range.len()) }
    }

    /// Tells what was seen.
    #[inline(always)]
    pub unsafe fn tell(&self, watch: &mut Watch<Q::Real>) {
        // SAFETY: as above.
        unsafe {
            let [fastest, _] = Q::Both::scalars(self.fastest);
            let [checksum, of_spins] = Q::Both::scalars(self.checksum);
            watch.see(fastest, Q::Real::ZERO);
            watch.see(checksum, of_spins);
        }
    }

    /// Moves the grain at `index`. Gives what turns it, the spin in the middle of the step or the torque over m r², and the change of
    /// the latter. Constants as for [`super::advance()`].
    #[inline(always)]
    pub unsafe fn moved<
        const CORRECTS: bool,
        const PREDICTS: bool,
        const HAS_ORIENTATIONS: bool,
        const IS_HELD: bool,
        const IS_ABOUT_AXIS: bool,
    >(
        &mut self,
        index: usize,
    ) -> [Q::Narrow; 2] {
        let &mut Self { half_steps, steps, gravity, nothing, inverse_ratio, .. } = self;
        // SAFETY: by the caller's promise; records are groups of four numbers, accelerations six in a row.
        unsafe {
            let sphere = self.spheres.add(index);
            let position: *mut Q::Coordinate = (&raw mut (*sphere).position).cast();
            let velocity: *mut Q::Real = (&raw mut (*sphere).velocity).cast();
            let load: *mut Q::Real = self.loads.add(index).cast();
            let acceleration: *mut Q::Real = self.accelerations.add(index).cast();

            let before = Q::Both::load_six(acceleration);
            let old = Q::Both::load(velocity);
            let (mut after, mut change, mut now) = (before, nothing, old);
            if CORRECTS {
                // One division serves 1/m and 1/J.
                let mobility = if HAS_ORIENTATIONS {
                    let radius = Q::Real::from_f64((*sphere).radius.to_f64());
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
                return [nothing.rotation(); 2];
            }
            nothing.store(load);
            let middle = now.plus(after.times(half_steps));
            let travel = middle.translation().times(steps.translation());
            let place = Q::Wide::load(position);
            place.plus(Q::Wide::widened(travel)).with_last_of(place).store(position);
            let mut next = now.plus(after.times(steps));
            if IS_HELD || IS_ABOUT_AXIS {
                next = next.turning_as(old);
            }
            next.with_lasts_of(old).store(velocity);
            let squares = next.squares();
            self.fastest = Q::Both::larger(squares, self.fastest);
            self.checksum = Q::Both::plus_nothing_of(self.checksum, squares);
            [if IS_ABOUT_AXIS { after.rotation() } else { middle.rotation() }, change.rotation()]
        }
    }
}
