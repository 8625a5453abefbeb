//! What every rotation law takes and gives, and the free sphere.

use crate::{Blocked, Contact, ContactVelocity, Memory, PairProperties, Real, Response, Vector};
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use std::fmt::Debug;

/// What a rotation law sees of one of the two bodies.
#[derive(Clone, Copy, Debug)]
pub struct Body<T, O> {
    /// Distance from the centre to the contact point [m].
    pub arm: T,
    /// Angular velocity in the world frame [rad/s].
    pub spin: Vector<T>,
    /// 1/(m r²) [1/(kg·m²)]; zero for a body of prescribed motion.
    pub inverse_moment: T,
    /// How the body is turned; `()` where the law does not ask.
    pub frame: O,
}

impl<T: Real, O> Body<T, O> {
    /// A body that does not turn, touched at its centre: the other side of a rigid wall.
    #[inline(always)]
    pub fn at_rest(frame: O) -> Self {
        Self { arm: T::ZERO, spin: Vector::ZERO, inverse_moment: T::ZERO, frame }
    }
}

/// Torques about the two centres, in the world frame.
#[derive(Clone, Copy, Debug)]
pub struct Couples<T> {
    /// On the first and on the second body [N·m].
    pub torques: [Vector<T>; 2],
    /// Power that the law takes from the motion beyond what the sphere's torques exchange with the tangential spring [W].
    /// Negative where it drives.
    pub spent: T,
}

impl<T: Real> Couples<T> {
    /// Torques of the tangential force on spheres, −arm n × F on both.
    #[inline(always)]
    pub fn of_spheres<O>(contact: &Contact<T>, response: &Response<T>, bodies: &[Body<T, O>; 2]) -> Self {
        let couple = contact.normal.cross(response.tangential_force);
        Self { torques: [couple * -bodies[0].arm, couple * -bodies[1].arm], spent: T::ZERO }
    }
}

/// What a law needs to know about how a body is turned.
pub trait Frame<T: Real>: Blocked<T> {
    /// The law asks for orientations: they are kept, and integrated.
    const IS_TRACKED: bool;
    /// From the unit quaternion (i, j, k, real part) that turns the body frame into the world frame.
    fn from_quaternion(quaternion: [f64; 4]) -> Self;
}

impl<T: Real> Frame<T> for () {
    const IS_TRACKED: bool = false;
    #[inline(always)]
    fn from_quaternion(_: [f64; 4]) -> Self {}
}

/// A law: from forces, spins and orientations to torques. Owns no arrays; branch-free.
pub trait RotationLaw<T: Real>: Copy + Debug + Send + Sync + Serialize + DeserializeOwned + 'static {
    /// Torques are those of the tangential force on spheres, inertia is the solid sphere's: nothing else is asked for.
    const IS_SPHERE: bool = false;
    /// What a contact remembers of the turning.
    type Memory: Memory<T>;
    /// What it needs to know about orientations.
    type Frame: Frame<T>;

    /// Velocity of the first body against the second where they touch [m/s]; `centres` is that of the first centre against the
    /// second. Spheres touch on the line between their centres.
    #[inline(always)]
    fn velocity_at_contact(
        &self,
        normal: Vector<T>,
        centres: Vector<T>,
        bodies: &[Body<T, Self::Frame>; 2],
    ) -> Vector<T> {
        let rolled = bodies[0].spin * bodies[0].arm + bodies[1].spin * bodies[1].arm;
        centres - rolled.cross(normal)
    }

    /// The same along the normal and in the tangent plane.
    #[inline(always)]
    fn velocity_in_parts(
        &self,
        normal: Vector<T>,
        centres: Vector<T>,
        bodies: &[Body<T, Self::Frame>; 2],
    ) -> ContactVelocity<T> {
        ContactVelocity::of(self.velocity_at_contact(normal, centres, bodies), normal)
    }

    /// Torques and memory after this step.
    fn couples(
        &self,
        contact: &Contact<T>,
        pair: &PairProperties<T>,
        response: &Response<T>,
        bodies: &[Body<T, Self::Frame>; 2],
        memory: Self::Memory,
    ) -> (Couples<T>, Self::Memory);

    /// Principal moments of inertia about the body axes over m r² [-]; 2/5 for the solid sphere.
    #[inline(always)]
    fn inertia_ratios(&self) -> [f64; 3] {
        [0.4; 3]
    }
}

/// Spheres turn as spheres do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Free;

impl<T: Real> RotationLaw<T> for Free {
    const IS_SPHERE: bool = true;
    type Memory = ();
    type Frame = ();

    #[inline(always)]
    fn couples(
        &self,
        contact: &Contact<T>,
        _: &PairProperties<T>,
        response: &Response<T>,
        bodies: &[Body<T, ()>; 2],
        (): (),
    ) -> (Couples<T>, ()) {
        (Couples::of_spheres(contact, response, bodies), ())
    }
}
