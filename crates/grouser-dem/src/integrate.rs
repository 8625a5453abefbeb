//! Velocity Verlet with positions and velocities at the same instant whenever contacts are evaluated.
//!
//! Predict: x ← x + v Δt + ½ a Δt², v* = v + a Δt. Forces at (x, v*) give a′. Correct: v = v* + ½ (a′ − a) Δt.
//! Newmark's scheme (N. M. Newmark, J. Eng. Mech. 85 (1959) 67–94), semi-implicit as in P1: the same predictor, and the corrector
//! x += β (a′ − a) Δt², v = v* + γ (a′ − a) Δt, once a step; Verlet is β = 0, γ = ½.
//! The usual half-step form evaluates dashpots with a velocity half a step old, which sticks at size ratios above three.

use crate::force_pass::InstructionSet;
#[cfg(target_arch = "x86_64")]
use crate::force_pass::in_quads;
use crate::grains::{Grains, Rotation};
#[cfg(target_arch = "x86_64")]
use crate::quads;
use crate::shared_grains::SharedGrains;
use grouser_contact::{Load, ParameterError, Precision, Real, Sphere, Vector};
use grouser_geometry::{Orientation, Vec3};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// How grains go on from step to step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Integrator {
    /// Velocity Verlet.
    #[default]
    VelocityVerlet,
    /// Newmark's scheme with one corrector a step; β = ¼, γ = ½ is the mean acceleration.
    Newmark {
        /// Share β of the change of acceleration in the position, in [0, ½] [-].
        beta: f64,
        /// Share γ of the change of acceleration in the velocity, in [½, 1] [-].
        gamma: f64,
    },
}

impl Integrator {
    /// Refuses shares outside the range of the scheme.
    ///
    /// # Errors
    /// Names the share, its range and the reason.
    pub fn validate(self) -> Result<(), ParameterError> {
        let [beta, gamma] = self.shares();
        let expected = "in [0, 0.5]: more, a grain would overshoot the place that its force asks for";
        ParameterError::check("Newmark's beta", beta, (0.0..=0.5).contains(&beta), expected)?;
        let expected = "in [0.5, 1]: less, the scheme yields energy";
        ParameterError::check("Newmark's gamma", gamma, (0.5..=1.0).contains(&gamma), expected)
    }

    /// β and γ [-].
    fn shares(self) -> [f64; 2] {
        match self {
            Self::VelocityVerlet => [0.0, 0.5],
            Self::Newmark { beta, gamma } => [beta, gamma],
        }
    }

    /// Bound of the way in a step over speed times step [-]: corrected, no grain turns round faster than by twice its speed.
    pub(crate) fn reach(self) -> f64 {
        1.0 + 2.0 * self.shares()[0]
    }
}

/// Fastest grain seen by a predictor, and whether every number was finite.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pace {
    pub fastest_squared: f64,
    pub is_finite: bool,
}

impl Pace {
    /// Of no grains.
    pub const STILL: Self = Self { fastest_squared: 0.0, is_finite: true };

    /// Of two sets of grains; the order does not matter.
    pub fn and(self, other: Self) -> Self {
        Self {
            fastest_squared: self.fastest_squared.max(other.fastest_squared),
            is_finite: self.is_finite && other.is_finite,
        }
    }
}

/// Which halves of the scheme a grain goes through once its forces are known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stages {
    /// None: somebody else will.
    None,
    /// Correct, then predict the next step.
    CorrectAndPredict,
}

pub(crate) use crate::turning::Turning;

/// Grains that are moved, and what moves them.
struct Moved<'a, P: Precision> {
    spheres: &'a mut [Sphere<P>],
    loads: &'a mut [Load<P::Real>],
    accelerations: &'a mut [[Vector<P::Real>; 2]],
    orientations: Option<&'a mut [Orientation]>,
}

impl<'a, P: Precision> Moved<'a, P> {
    fn of(grains: &'a mut Grains<P>, range: Range<usize>) -> Self {
        let Grains { spheres, loads, accelerations, orientations, .. } = grains;
        Self {
            spheres: &mut spheres[range.clone()],
            loads: &mut loads[range.clone()],
            accelerations: &mut accelerations[range.clone()],
            orientations: orientations.as_mut().map(|all| &mut all[range]),
        }
    }
}

/// The motion of grains between two force passes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion<T> {
    pub time_step: T,
    pub gravity: Vector<T>,
    pub rotation: Rotation,
    pub stages: Stages,
    pub turning: Turning,
    /// β Δt² [s²]; zero for Verlet.
    pub placing: T,
    /// γ Δt [s].
    pub hastening: T,
}

impl<T: Real> Motion<T> {
    /// Motion with a step [s] under gravity [m/s²].
    pub fn new(
        time_step: f64,
        gravity: Vec3,
        rotation: Rotation,
        stages: Stages,
        turning: Turning,
        integrator: Integrator,
    ) -> Self {
        let gravity = Vector::new(gravity.x, gravity.y, gravity.z).cast();
        let [beta, gamma] = integrator.shares();
        Self {
            time_step: T::from_f64(time_step),
            gravity,
            rotation,
            stages,
            turning,
            placing: T::from_f64(beta * time_step * time_step),
            hastening: T::from_f64(gamma) * T::from_f64(time_step),
        }
    }

    /// Verlet's scheme, which vector instructions are written for.
    fn is_verlet(&self) -> bool {
        self.placing == T::ZERO && self.hastening == T::from_f64(0.5) * self.time_step
    }

    /// The stages that follow the force pass, for a range of grains.
    pub fn advance<P: Precision<Real = T>>(
        &self,
        grains: SharedGrains<P>,
        range: Range<u32>,
        set: InstructionSet,
    ) -> Pace {
        if self.stages == Stages::None {
            return Pace::STILL;
        }
        let orientations = grains.orientations(range.clone());
        let (spheres, loads, accelerations) = grains.range(range);
        self.go_through::<P, true, true>(Moved { spheres, loads, accelerations, orientations }, set)
    }

    /// Corrects the grains of a range.
    pub fn correct_all<P: Precision<Real = T>>(
        &self,
        grains: &mut Grains<P>,
        range: Range<usize>,
        set: InstructionSet,
    ) {
        self.go_through::<P, true, false>(Moved::of(grains, range), set);
    }

    /// Predicts the grains of a range and clears their loads.
    pub fn predict_all<P: Precision<Real = T>>(
        &self,
        grains: &mut Grains<P>,
        range: Range<usize>,
        set: InstructionSet,
    ) -> Pace {
        self.go_through::<P, false, true>(Moved::of(grains, range), set)
    }

    /// Corrects the grains where asked for, then predicts them where asked for.
    fn go_through<P: Precision<Real = T>, const CORRECTS: bool, const PREDICTS: bool>(
        &self,
        mut moved: Moved<P>,
        set: InstructionSet,
    ) -> Pace {
        if let Some(pace) = self.in_registers::<P, CORRECTS, PREDICTS>(&mut moved, set) {
            return pace;
        }
        let mut watch = Watch::default();
        let Moved { spheres, loads, accelerations, orientations } = moved;
        let mut orientations = orientations.map(|all| all.iter_mut());
        for ((sphere, load), acceleration) in spheres.iter_mut().zip(loads).zip(accelerations) {
            let orientation = orientations.as_mut().and_then(Iterator::next);
            match orientation {
                Some(orientation) => {
                    if CORRECTS {
                        self.correct_turned(sphere, load, acceleration, orientation);
                    }
                    if PREDICTS {
                        self.predict_turned(sphere, load, acceleration, orientation, &mut watch);
                    }
                }
                None => {
                    if CORRECTS {
                        self.correct(sphere, load, acceleration);
                    }
                    if PREDICTS {
                        self.predict(sphere, load, acceleration, &mut watch);
                    }
                }
            }
        }
        watch.pace()
    }

    /// The same by vector instructions; `None` where none are written for it.
    #[cfg(target_arch = "x86_64")]
    fn in_registers<P: Precision<Real = T>, const CORRECTS: bool, const PREDICTS: bool>(
        &self,
        Moved { spheres, loads, accelerations, orientations }: &mut Moved<P>,
        set: InstructionSet,
    ) -> Option<Pace> {
        let is_held = self.rotation == Rotation::Fixed;
        let is_about_axis = self.turning.axis().is_some() && !is_held;
        let has_loops = is_held || self.turning.is_spherical() || is_about_axis && CORRECTS && PREDICTS;
        if set == InstructionSet::Baseline || !self.is_verlet() || !has_loops {
            return None;
        }
        let mut watch = Watch::<T>::default();
        in_quads!(P, Q => {
            let advance = match (orientations.is_some(), is_held, is_about_axis) {
                (false, false, _) => quads::advance::<Q, CORRECTS, PREDICTS, false, false, false>,
                (false, true, _) => quads::advance::<Q, CORRECTS, PREDICTS, false, true, false>,
                (true, true, _) => quads::advance::<Q, CORRECTS, PREDICTS, true, true, false>,
                (true, false, false) => quads::advance::<Q, CORRECTS, PREDICTS, true, false, false>,
                (true, false, true) => quads::advance::<Q, CORRECTS, PREDICTS, true, false, true>,
            };
            // SAFETY: `Q` is `P`, so that these are the same types; `detect` found AVX2 on this machine.
            unsafe {
                advance(
                    &*(&raw const *self).cast(),
                    &mut *(&raw mut **spheres as *mut [Sphere<Q>]),
                    &mut *(&raw mut **loads as *mut [Load<<Q as Precision>::Real>]),
                    &mut *(&raw mut **accelerations as *mut [[Vector<<Q as Precision>::Real>; 2]]),
                    orientations.as_deref_mut().unwrap_or_default(),
                    &mut *(&raw mut watch).cast(),
                    set,
                );
            }
        })
        .map(|()| watch.pace())
    }

    #[cfg(not(target_arch = "x86_64"))]
    fn in_registers<P: Precision<Real = T>, const CORRECTS: bool, const PREDICTS: bool>(
        &self,
        _: &mut Moved<P>,
        _: InstructionSet,
    ) -> Option<Pace> {
        None
    }

    #[inline(always)]
    fn correct<P: Precision<Real = T>>(
        &self,
        sphere: &mut Sphere<P>,
        load: &Load<T>,
        [linear, angular]: &mut [Vector<T>; 2],
    ) {
        // One division serves 1/m and 1/J = 1/(2/5 m r²).
        let inertia_per_mass = sphere.inertia_per_mass();
        let inverse = T::ONE / (sphere.mass * inertia_per_mass);
        let after = load.force * (inverse * inertia_per_mass) + self.gravity;
        self.correct_centre(sphere, after - *linear);
        *linear = after;
        if self.rotation == Rotation::Free {
            let after = load.torque * inverse;
            sphere.spin += (after - *angular) * self.hastening;
            *angular = after;
        }
    }

    /// Velocity and place with the change of acceleration over the step [m/s²].
    #[inline(always)]
    pub fn correct_centre<P: Precision<Real = T>>(&self, sphere: &mut Sphere<P>, change: Vector<T>) {
        sphere.velocity += change * self.hastening;
        if self.placing > T::ZERO {
            sphere.position += (change * self.placing).cast();
        }
    }

    #[inline(always)]
    fn predict<P: Precision<Real = T>>(
        &self,
        sphere: &mut Sphere<P>,
        load: &mut Load<T>,
        [linear, angular]: &mut [Vector<T>; 2],
        watch: &mut Watch<T>,
    ) {
        let dt = self.time_step;
        let travel = (sphere.velocity + *linear * (T::from_f64(0.5) * dt)) * dt;
        sphere.position += travel.cast();
        sphere.velocity += *linear * dt;
        if self.rotation == Rotation::Free {
            sphere.spin += *angular * dt;
        }
        *load = Load::default();
        watch.see(sphere.velocity.norm_squared(), sphere.spin.norm_squared());
    }
}

/// Keeps an eye on the fastest grain; 0 × x is NaN for every x that is not finite.
#[derive(Clone, Copy, Default)]
pub(crate) struct Watch<T> {
    fastest_squared: T,
    checksum: T,
}

impl<T: Real> Watch<T> {
    #[inline(always)]
    pub fn see(&mut self, speed_squared: T, spin_squared: T) {
        self.fastest_squared = speed_squared.max(self.fastest_squared);
        self.checksum += (speed_squared + spin_squared) * T::ZERO;
    }

    fn pace(&self) -> Pace {
        Pace { fastest_squared: self.fastest_squared.to_f64(), is_finite: self.checksum == T::ZERO }
    }
}
