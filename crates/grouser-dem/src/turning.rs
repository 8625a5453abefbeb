//! Rotation of grains whose orientation is kept: quaternions without trigonometry, Euler's equations where needed.
//!
//! Spherical inertia: q is turned by the spin in the middle of the step, with the rational (Cayley) rotation.
//! Other inertia: the body-frame angular momentum m follows the implicit midpoint rule, m′ = m + Δt m̄ × ω̄ with m̄ = (m + m′)/2,
//! ω̄ = J⁻¹ m̄, and q the Cayley rotation of ω̄ Δt. Without torque this keeps the energy and the angular momentum in the world
//! frame to rounding, for any step. Formulas: [`crate::euler`].

use crate::euler::{Axes, Number, middle_about_axis, plus_scaled, turned};
use crate::grains::Rotation;
use crate::integrate::{Motion, Watch};
use grouser_contact::{Load, Precision, Real, Sphere, Vector};
use grouser_geometry::{Orientation, Vec3};

/// Principal moments of inertia over m r².
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turning {
    ratios: [f64; 3],
    symmetry: Symmetry,
}

/// Which moments of inertia are alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Symmetry {
    /// All: the inertia of a sphere of whatever density.
    Sphere,
    /// The two about the other axes.
    About(usize),
    None,
}

/// Grains that have been given half a kick, about to turn freely.
pub(crate) struct Kicked<N> {
    axes: Axes<N>,
    /// Angular momentum over m r², in the world frame and in the body frame.
    momentum: [N; 3],
    of_body: [N; 3],
}

/// Iterations of the midpoint rule; the change shrinks by half the angle turned in a step, each time.
const MOST_ITERATIONS: usize = 20;

impl Turning {
    pub fn new(ratios: [f64; 3]) -> Self {
        let pair = |axis: usize| ratios[(axis + 1) % 3] == ratios[(axis + 2) % 3];
        let symmetry = match (pair(0), pair(1), pair(2)) {
            (true, true, _) => Symmetry::Sphere,
            (true, ..) => Symmetry::About(0),
            (_, true, _) => Symmetry::About(1),
            (.., true) => Symmetry::About(2),
            _ => Symmetry::None,
        };
        Self { ratios, symmetry }
    }

    /// m r² over the moment of inertia, which is the same about every axis.
    pub fn inverse_ratio(&self) -> f64 {
        1.0 / self.ratios[0]
    }

    /// The inertia is that of a sphere of whatever density.
    pub fn is_spherical(&self) -> bool {
        self.symmetry == Symmetry::Sphere
    }

    /// The axis about which the inertia is that of a body of rotation and no sphere.
    pub fn axis(&self) -> Option<usize> {
        if let Symmetry::About(axis) = self.symmetry { Some(axis) } else { None }
    }

    /// Angular velocity of the angular momentum over m r², both in the world frame.
    #[inline(always)]
    pub fn spin<N: Number>(&self, momentum: [N; 3], axes: Axes<N>) -> [N; 3] {
        let [a, b, c] = self.ratios;
        axes.stretched(momentum, [1.0 / a, 1.0 / b, 1.0 / c])
    }

    /// Half a kick [s] of a torque over m r².
    #[inline(always)]
    pub fn kicked<N: Number>(
        &self,
        spin: [N; 3],
        torque: [N; 3],
        axes: Axes<N>,
        half_step: f64,
    ) -> Kicked<N> {
        let momentum = plus_scaled(axes.stretched(spin, self.ratios), torque, N::of(half_step));
        Kicked { axes, momentum, of_body: axes.to_body(momentum) }
    }

    /// Spin in the middle of the free rotation, in the body frame, for a body of rotation about `axis`.
    #[inline(always)]
    pub fn middle_about<N: Number>(&self, axis: usize, kicked: &Kicked<N>, half_step: f64) -> [N; 3] {
        middle_about_axis(axis, self.ratios, kicked.of_body, half_step)
    }

    /// The same whatever the inertia.
    fn middle(&self, kicked: &Kicked<f64>, half_step: f64) -> [f64; 3] {
        if let Symmetry::About(axis) = self.symmetry {
            return self.middle_about(axis, kicked, half_step);
        }
        let (before, ratios) = (Vec3::from(kicked.of_body), Vec3::from(self.ratios));
        let mut spin = before.component_div(&ratios);
        for _ in 0..MOST_ITERATIONS {
            // m̄ = m + ½Δt m̄ × ω̄
            let momentum = spin.component_mul(&ratios);
            let next = (before + momentum.cross(&spin) * half_step).component_div(&ratios);
            let change = (next - spin).norm_squared();
            spin = next;
            if change <= 1e-31 * spin.norm_squared() {
                break;
            }
        }
        spin.into()
    }

    /// Orientation and spin after the free rotation with the body-frame spin `middle` and the other half of the kick.
    #[inline(always)]
    pub fn turned<N: Number>(
        &self,
        kicked: &Kicked<N>,
        middle: [N; 3],
        torque: [N; 3],
        orientation: [N; 4],
        half_step: f64,
    ) -> ([N; 4], [N; 3]) {
        let turned = turned(orientation, kicked.axes.to_world(middle), half_step);
        let momentum = plus_scaled(kicked.momentum, torque, N::of(half_step));
        (turned, self.spin(momentum, Axes::of(turned)))
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
        let change = if self.turning.is_spherical() {
            let after = load.torque * (inverse * T::from_f64(self.turning.inverse_ratio()));
            let change = after - *angular;
            *angular = after;
            change
        } else {
            // Torque over m r² stands for the angular acceleration.
            let after = load.torque * inverse;
            let change = wide(after - *angular);
            *angular = after;
            narrow(self.turning.spin(change, Axes::of(orientation.coords.into())))
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
            if self.turning.is_spherical() {
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
        torque: [f64; 3],
        orientation: &mut Orientation,
    ) {
        let half_step = 0.5 * self.time_step.to_f64();
        let before: [f64; 4] = orientation.coords.into();
        let kicked = self.turning.kicked(wide(sphere.spin), torque, Axes::of(before), half_step);
        let middle = self.turning.middle(&kicked, half_step);
        let (after, spin) = self.turning.turned(&kicked, middle, torque, before, half_step);
        *orientation = Orientation::new_unchecked(after.into());
        sphere.spin = narrow(spin);
    }
}

/// q ← (1, ½ω Δt) q, of unit length again.
#[inline(always)]
pub(crate) fn turn(orientation: &mut Orientation, spin: [f64; 3], time_step: f64) {
    let after = turned(orientation.coords.into(), spin, 0.5 * time_step);
    *orientation = Orientation::new_unchecked(after.into());
}

fn wide<T: Real>(v: Vector<T>) -> [f64; 3] {
    v.cast::<f64>().to_array()
}

fn narrow<T: Real>([x, y, z]: [f64; 3]) -> Vector<T> {
    Vector::new(x, y, z).cast()
}
