//! What a contact sees of a spherical body, and what the body receives.

use crate::{F64, Precision, Real, Vector};
use serde::{Deserialize, Serialize};

/// A sphere in motion: one record, three aligned groups of four numbers, so that a neighbour costs two cache
/// lines in double precision and one in mixed precision.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
#[repr(C, align(32))]
pub struct Sphere<P: Precision = F64> {
    /// Centre [m].
    pub position: Vector<P::Coordinate>,
    /// Radius [m].
    pub radius: P::Coordinate,
    /// Velocity of the centre [m/s], at the same instant as the position.
    pub velocity: Vector<P::Real>,
    /// Mass [kg].
    pub mass: P::Real,
    /// Angular velocity in the world frame [rad/s].
    pub spin: Vector<P::Real>,
    /// Row of the material table.
    pub material: u32,
}

impl<P: Precision> Sphere<P> {
    /// Moment of inertia of the solid sphere over its mass, 2/5 r² [m²].
    #[inline(always)]
    pub fn inertia_per_mass(&self) -> P::Real {
        let radius = P::Real::from_f64(self.radius.to_f64());
        P::Real::from_f64(0.4) * radius * radius
    }

    /// Moment of inertia of the solid sphere, 2/5 m r² [kg·m²].
    #[inline(always)]
    pub fn inertia(&self) -> P::Real {
        self.mass * self.inertia_per_mass()
    }

    /// Every number is finite.
    pub fn is_finite(&self) -> bool {
        self.position.is_finite() && self.velocity.is_finite() && self.spin.is_finite()
    }
}

/// Force and torque on one body, about its centre, in the world frame; one cache line in double precision.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
#[repr(C, align(32))]
pub struct Load<T: Real = f64> {
    /// Force [N].
    pub force: Vector<T>,
    /// Keeps `torque` on an aligned group of four; always zero.
    pub unused_force: T,
    /// Torque about the centre [N·m].
    pub torque: Vector<T>,
    /// Completes the group of four; always zero.
    pub unused_torque: T,
}

impl<T: Real> Load<T> {
    /// Load of a force and a torque.
    #[inline(always)]
    pub fn new(force: Vector<T>, torque: Vector<T>) -> Self {
        Self { force, unused_force: T::ZERO, torque, unused_torque: T::ZERO }
    }

    /// Adds a force acting at the centre and a torque.
    #[inline(always)]
    pub fn add(&mut self, force: Vector<T>, torque: Vector<T>) {
        self.force += force;
        self.torque += torque;
    }
}
