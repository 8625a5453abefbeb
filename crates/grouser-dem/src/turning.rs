//! Rotation of grains whose orientation is kept: quaternions without trigonometry, Euler's equations where needed.
//!
//! Spherical inertia: q is turned by the spin in the middle of the step, with the rational (Cayley) rotation.
//! Other inertia: the body-frame angular momentum m follows the implicit midpoint rule, m′ = m + Δt m̄ × ω̄ with m̄ = (m + m′)/2,
//! ω̄ = J⁻¹ m̄, and q the Cayley rotation of ω̄ Δt. Without torque this keeps the energy and the angular momentum in the world
//! frame to rounding, for any step.

use crate::grains::Rotation;
use crate::integrate::{Motion, Watch};
use grouser_contact::{Load, Precision, Real, Sphere, Vector};
use grouser_geometry::nalgebra::Quaternion;
use grouser_geometry::{Orientation, Vec3};

/// Principal moments of inertia over m r².
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turning {
    ratios: Vec3,
    is_spherical: bool,
}

/// Iterations of the midpoint rule; the change shrinks by half the angle turned in a step, each time.
const MOST_ITERATIONS: usize = 20;

impl Turning {
    pub fn new(ratios: [f64; 3]) -> Self {
        Self { ratios: ratios.into(), is_spherical: ratios[0] == ratios[1] && ratios[1] == ratios[2] }
    }

    /// m r² over the moment of inertia, which is the same about every axis.
    pub fn inverse_ratio(&self) -> f64 {
        1.0 / self.ratios.x
    }

    /// The inertia is that of a sphere of whatever density.
    pub fn is_spherical(&self) -> bool {
        self.is_spherical
    }

    /// Angular velocity of the angular momentum over m r², both in the world frame.
    fn spin(&self, momentum: Vec3, orientation: &Orientation) -> Vec3 {
        let body = orientation.inverse_transform_vector(&momentum);
        orientation.transform_vector(&body.component_div(&self.ratios))
    }

    /// Angular momentum over m r² of an angular velocity.
    fn momentum(&self, spin: Vec3, orientation: &Orientation) -> Vec3 {
        let body = orientation.inverse_transform_vector(&spin);
        orientation.transform_vector(&body.component_mul(&self.ratios))
    }
}

impl<T: Real> Motion<T> {
    /// Second half of the step for a grain with an orientation.
    #[inline(always)]
    pub fn correct_turned<P: Precision<Real = T>>(
        &self,
        sphere: &mut Sphere<P>,
        load: &Load<T>,
        [linear, angular]: &mut [Vector<T>; 2],
        orientation: &mut Orientation,
    ) {
        let radius = T::from_f64(sphere.radius.to_f64());
        // One division serves 1/m and 1/(m r²).
        let inverse = T::ONE / (sphere.mass * radius * radius);
        let after = load.force * (inverse * radius * radius) + self.gravity;
        self.correct_centre(sphere, after - *linear);
        *linear = after;
        if self.rotation == Rotation::Fixed {
            return;
        }
        let change = if self.turning.is_spherical {
            let after = load.torque * (inverse * T::from_f64(self.turning.inverse_ratio()));
            let change = after - *angular;
            *angular = after;
            change
        } else {
            // Torque over m r² stands for the angular acceleration.
            let after = load.torque * inverse;
            let change = wide(after - *angular);
            *angular = after;
            narrow(self.turning.spin(change, orientation))
        };
        sphere.spin += change * self.hastening;
        if self.placing > T::ZERO {
            turn(orientation, wide(change), self.placing.to_f64());
        }
    }

    /// First half of the next step for a grain with an orientation. Clears its load.
    #[inline(always)]
    pub fn predict_turned<P: Precision<Real = T>>(
        &self,
        sphere: &mut Sphere<P>,
        load: &mut Load<T>,
        [linear, angular]: &mut [Vector<T>; 2],
        orientation: &mut Orientation,
        watch: &mut Watch<T>,
    ) {
        let (dt, half) = (self.time_step, T::from_f64(0.5));
        let travel = (sphere.velocity + *linear * (half * dt)) * dt;
        sphere.position += travel.cast();
        sphere.velocity += *linear * dt;
        if self.rotation == Rotation::Free {
            if self.turning.is_spherical {
                let middle = sphere.spin + *angular * (half * dt);
                turn(orientation, wide(middle), dt.to_f64());
                sphere.spin += *angular * dt;
            } else {
                self.turn_other(sphere, wide(*angular), orientation);
            }
        }
        *load = Load::default();
        watch.see(sphere.velocity.norm_squared(), sphere.spin.norm_squared());
    }

    /// Half a kick, the free rotation, half a kick.
    fn turn_other<P: Precision<Real = T>>(
        &self,
        sphere: &mut Sphere<P>,
        torque: Vec3,
        orientation: &mut Orientation,
    ) {
        let dt = self.time_step.to_f64();
        let ratios = self.turning.ratios;
        let kicked = self.turning.momentum(wide(sphere.spin), orientation) + torque * (0.5 * dt);
        let before = orientation.inverse_transform_vector(&kicked);
        let mut spin = before.component_div(&ratios);
        for _ in 0..MOST_ITERATIONS {
            // m̄ = m + ½Δt m̄ × ω̄
            let momentum = spin.component_mul(&ratios);
            let next = (before + momentum.cross(&spin) * (0.5 * dt)).component_div(&ratios);
            let change = (next - spin).norm_squared();
            spin = next;
            if change <= 1e-31 * spin.norm_squared() {
                break;
            }
        }
        turn(orientation, orientation.transform_vector(&spin), dt);
        sphere.spin = narrow(self.turning.spin(kicked + torque * (0.5 * dt), orientation));
    }
}

/// q ← (1, ½ω Δt) q, of unit length again.
#[inline(always)]
pub(crate) fn turn(orientation: &mut Orientation, spin: Vec3, time_step: f64) {
    let turn = Quaternion::from_parts(1.0, spin * (0.5 * time_step));
    let turned = turn * orientation.quaternion();
    *orientation = Orientation::new_unchecked(turned * (1.0 / turned.norm_squared().sqrt()));
}

fn wide<T: Real>(v: Vector<T>) -> Vec3 {
    let v = v.cast::<f64>();
    Vec3::new(v.x, v.y, v.z)
}

fn narrow<T: Real>(v: Vec3) -> Vector<T> {
    Vector::new(v.x, v.y, v.z).cast()
}
