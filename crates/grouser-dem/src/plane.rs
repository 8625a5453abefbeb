//! Analytic planes: floors and side walls.

use crate::block::FrameOf;
use crate::cell_grid::to_f64;
use crate::force_pass::PassInput;
use crate::leeway::Leeways;
use crate::slab::SlabSums;
use grouser_contact::{
    Body, Contact, ContactLaw, ContactLedger, Frame, Memory, Precision, Real, RotationLaw, Sphere, Vector,
};
use grouser_geometry::Vec3;
use serde::{Deserialize, Serialize};

/// A half-space that grains cannot enter.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plane {
    /// A point of the surface [m].
    pub point: Vec3,
    /// Unit normal into the space of the grains.
    pub normal: Vec3,
    /// Row of the material table.
    pub material: u32,
}

impl Plane {
    /// Height of a point above the surface [m].
    pub fn height(&self, place: Vec3) -> f64 {
        (place - self.point).dot(&self.normal)
    }
}

/// Grains of one slab near one plane.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "M: Memory<T>")]
pub(crate) struct PlaneList<T: Real, M> {
    /// Grains (sorted order) that may touch before the next rebuild.
    pub grains: Vec<u32>,
    /// What each of them remembers; zero where it does not touch.
    pub memory: Vec<M>,
    /// Force that the grains exert on the plane at the last pass [N].
    pub force: Vec3,
    #[serde(skip)]
    scalar: std::marker::PhantomData<T>,
}

impl<T: Real, M: Memory<T>> PlaneList<T, M> {
    /// Grains of `range` that may come to touch `plane` within their `leeways`; `remembered(grain)` is what a grain brings along.
    pub fn build<P: Precision<Real = T>>(
        plane: &Plane,
        range: impl Iterator<Item = u32>,
        spheres: &[Sphere<P>],
        leeways: &Leeways<P::Coordinate>,
        remembered: impl Fn(u32) -> M,
    ) -> Self {
        let near = |&grain: &u32| {
            let sphere = &spheres[grain as usize];
            let drift = leeways.drift_of(grain as usize).cast::<f64>();
            let falls = -Vec3::new(drift.x, drift.y, drift.z).dot(&plane.normal);
            let reach = sphere.radius.to_f64() + leeways.of(grain as usize).to_f64() + falls.max(0.0);
            plane.height(to_f64(sphere)) < reach
        };
        let grains: Vec<u32> = range.filter(near).collect();
        let memory = grains.iter().map(|&grain| remembered(grain)).collect();
        Self::of(grains, memory)
    }

    /// The list of `grains`, by rising place, with what each of them remembers.
    pub fn of(grains: Vec<u32>, memory: Vec<M>) -> Self {
        Self { grains, memory, force: Vec3::zeros(), scalar: std::marker::PhantomData }
    }

    /// What `grain` remembers of this plane.
    pub fn memory_of(&self, grain: u32) -> Option<M> {
        self.grains.binary_search(&grain).ok().map(|place| self.memory[place])
    }

    /// Adds the plane's forces to the grains.
    ///
    /// The plane is rigid: R* and m* are those of the grain, and the contact point lies on the surface.
    pub fn forces<P: Precision<Real = T>, L: ContactLaw<T, Memory = M>>(
        &mut self,
        plane: &Plane,
        input: &PassInput<P, L>,
    ) -> SlabSums {
        let (mut total, mut ledger) = (Vector::<f64>::ZERO, ContactLedger::default());
        let (mut is_too_deep, largest_overlap) = (false, input.largest_overlap.to_f64());
        let dt = input.time_step.to_f64();
        let normal = Vector::new(plane.normal.x, plane.normal.y, plane.normal.z).cast::<T>();
        for (&grain, memory) in self.grains.iter().zip(&mut self.memory) {
            let sphere = *input.grains.sphere(grain);
            let radius = sphere.radius.to_f64();
            let overlap = radius - plane.height(to_f64(&sphere));
            if overlap <= 0.0 {
                *memory = M::default();
                continue;
            }
            is_too_deep |= overlap > largest_overlap * radius;
            let (overlap, arm) = (T::from_f64(overlap), T::from_f64(radius - overlap));
            let effective_radius = T::from_f64(radius);
            let mut frame = <FrameOf<T, L>>::default();
            if <FrameOf<T, L>>::IS_TRACKED {
                frame = <FrameOf<T, L>>::from_quaternion(input.grains.quaternion(grain));
            }
            let inverse_moment = T::ONE / (sphere.mass * effective_radius * effective_radius);
            let of_grain = Body { arm, spin: sphere.spin, inverse_moment, frame };
            let bodies = [of_grain, Body::at_rest(<FrameOf<T, L>>::default())];
            let velocity = input.law.rotation().velocity_in_parts(normal, sphere.velocity, &bodies);
            let contact = Contact {
                overlap,
                normal,
                velocity,
                normal_spin: T::from_f64(0.5) * sphere.spin.dot(normal),
                effective_radius,
                effective_mass: sphere.mass,
                time_step: input.time_step,
            };
            let pair = input.table.pair(sphere.material, plane.material);
            let (response, remembered) = input.law.respond(&contact, pair, *memory);
            let force = normal * response.normal_force + response.tangential_force;
            let mut torque = normal.cross(response.tangential_force) * -arm;
            *memory = remembered;
            if !<L::Rotation as RotationLaw<T>>::IS_SPHERE {
                let (couples, remembered) = input.law.couples(&contact, pair, &response, &bodies, remembered);
                (torque, *memory) = (couples.torques[0], remembered);
                ledger.turning += couples.spent.to_f64() * dt;
            }
            input.grains.add_load(grain, force, torque);
            total -= force.cast();
            ledger.add(&response.energy, dt);
        }
        self.force = Vec3::new(total.x, total.y, total.z);
        SlabSums { ledger, is_too_deep }
    }
}
