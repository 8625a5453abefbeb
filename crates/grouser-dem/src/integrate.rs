//! Velocity Verlet with positions and velocities at the same instant whenever contacts are evaluated.
//!
//! Predict: x ← x + v Δt + ½ a Δt², v* = v + a Δt. Forces at (x, v*) give a′. Correct: v = v* + ½ (a′ − a) Δt.
//! The usual half-step form evaluates dashpots with a velocity half a step old, which sticks at size ratios above three.

use crate::grains::{Grains, Rotation};
use grouser_contact::{Load, Precision, Real, Sphere, Vector};
use grouser_geometry::{Orientation, Vec3};
use rayon::prelude::*;

/// Grains that one task works on.
const CHUNK: usize = 1024;

/// Spheres, loads and accelerations of the same grains.
type Chunk<'a, P> = (
    (&'a mut [Sphere<P>], &'a mut [Load<<P as Precision>::Real>]),
    &'a mut [[Vector<<P as Precision>::Real>; 2]],
);

/// Fastest grain seen by a predictor, and whether every number was finite.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pace {
    pub fastest_squared: f64,
    pub is_finite: bool,
}

impl Pace {
    fn slower(self, other: Self) -> Self {
        Self {
            fastest_squared: self.fastest_squared.max(other.fastest_squared),
            is_finite: self.is_finite && other.is_finite,
        }
    }
}

/// Moves every grain to the end of the step, predicts its velocity there, and clears its load.
pub(crate) fn predict<P: Precision>(grains: &mut Grains<P>, rotation: Rotation, time_step: f64) -> Pace {
    let dt = P::Real::from_f64(time_step);
    let half = P::Real::from_f64(0.5);
    let work = |((spheres, loads), accelerations): Chunk<P>| {
        let (mut fastest, mut checksum) = (P::Real::ZERO, P::Real::ZERO);
        for ((sphere, load), [linear, angular]) in spheres.iter_mut().zip(loads).zip(accelerations) {
            let travel = (sphere.velocity + *linear * (half * dt)) * dt;
            sphere.position += travel.cast();
            sphere.velocity += *linear * dt;
            if rotation == Rotation::Free {
                sphere.spin += *angular * dt;
            }
            let speed = sphere.velocity.norm_squared();
            fastest = fastest.max(speed);
            checksum += (speed + sphere.spin.norm_squared()) * P::Real::ZERO;
            *load = Load::default();
        }
        Pace { fastest_squared: fastest.to_f64(), is_finite: checksum == P::Real::ZERO }
    };
    let still = || Pace { fastest_squared: 0.0, is_finite: true };
    let pace = grains
        .spheres
        .par_chunks_mut(CHUNK)
        .zip(grains.loads.par_chunks_mut(CHUNK))
        .zip(grains.accelerations.par_chunks_mut(CHUNK))
        .map(work)
        .reduce(still, Pace::slower);
    if let Some(orientations) = &mut grains.orientations {
        for (orientation, sphere) in orientations.iter_mut().zip(&grains.spheres) {
            let spin = sphere.spin.cast::<f64>();
            let turn = Orientation::from_scaled_axis(Vec3::new(spin.x, spin.y, spin.z) * time_step);
            *orientation = turn * *orientation;
            orientation.renormalize_fast();
        }
    }
    pace
}

/// Corrects the velocities with the forces at the new positions; `gravity` is an acceleration [m/s²].
pub(crate) fn correct<P: Precision>(
    grains: &mut Grains<P>,
    rotation: Rotation,
    gravity: Vec3,
    time_step: f64,
) {
    let half_step = P::Real::from_f64(0.5 * time_step);
    let gravity = Vector::new(gravity.x, gravity.y, gravity.z).cast::<P::Real>();
    let work = |((spheres, loads), accelerations): Chunk<P>| {
        for ((sphere, load), [linear, angular]) in spheres.iter_mut().zip(loads).zip(accelerations) {
            let inverse_mass = P::Real::ONE / sphere.mass;
            let after = load.force * inverse_mass + gravity;
            sphere.velocity += (after - *linear) * half_step;
            *linear = after;
            if rotation == Rotation::Free {
                let after = load.torque * (P::Real::ONE / sphere.inertia());
                sphere.spin += (after - *angular) * half_step;
                *angular = after;
            }
        }
    };
    grains
        .spheres
        .par_chunks_mut(CHUNK)
        .zip(grains.loads.par_chunks_mut(CHUNK))
        .zip(grains.accelerations.par_chunks_mut(CHUNK))
        .for_each(work);
}
