//! What every contact law takes and gives.

use crate::{Body, Couples, PairProperties, Real, RotationLaw, Vector};
use serde::{Serialize, de::DeserializeOwned};
use std::fmt::Debug;

/// One contact at one instant. The normal points from the second body to the first.
#[derive(Clone, Copy, Debug)]
pub struct Contact<T> {
    /// Overlap δ [m], positive while touching.
    pub overlap: T,
    /// Unit normal n from the second body to the first [-].
    pub normal: Vector<T>,
    /// Velocity of the first body against the second at the contact point.
    pub velocity: ContactVelocity<T>,
    /// Mean spin of the two bodies about the normal [rad/s]: turns the tangential memory with the pair.
    pub normal_spin: T,
    /// Effective radius R* = r₁ r₂ / (r₁ + r₂) [m]; r₁ against a plane.
    pub effective_radius: T,
    /// Reduced mass m* = m₁ m₂ / (m₁ + m₂) [kg]; m₁ against a body of prescribed motion.
    pub effective_mass: T,
    /// Time step [s].
    pub time_step: T,
}

/// A velocity where two bodies touch, in two parts.
#[derive(Clone, Copy, Debug)]
pub struct ContactVelocity<T> {
    /// Along the normal [m/s], negative on approach.
    pub normal: T,
    /// In the tangent plane [m/s].
    pub tangential: Vector<T>,
}

impl<T: Real> ContactVelocity<T> {
    /// The parts of `velocity` [m/s].
    #[inline(always)]
    pub fn of(velocity: Vector<T>, normal: Vector<T>) -> Self {
        let along = velocity.dot(normal);
        Self { normal: along, tangential: velocity - normal * along }
    }
}

/// Force on the first body (the second receives the opposite), and where the power goes.
#[derive(Clone, Copy, Debug)]
pub struct Response<T> {
    /// Normal force [N], positive when it pushes the bodies apart.
    pub normal_force: T,
    /// Tangential force on the first body [N].
    pub tangential_force: Vector<T>,
    /// Flow of energy at this instant.
    pub energy: ContactEnergy<T>,
}

/// Energy of a contact; whoever keeps no ledger does not read it, and the compiler drops it.
#[derive(Clone, Copy, Debug, Default)]
pub struct ContactEnergy<T> {
    /// Elastic energy stored by the normal overlap [J].
    pub normal_elastic: T,
    /// Elastic energy stored by the tangential spring [J].
    pub tangential_elastic: T,
    /// Power lost in the normal dashpot [W].
    pub normal_damping: T,
    /// Power that the tangential motion spends on the contact [W].
    pub tangential: T,
    /// The part of `tangential` that is spent while the contact slides [W].
    pub sliding: T,
}

/// A law: from one contact and its memory to force and new memory. Owns no arrays; branch-free.
pub trait ContactLaw<T: Real>: Copy + Debug + Send + Sync + Serialize + DeserializeOwned + 'static {
    /// What a contact remembers from step to step.
    type Memory: Memory<T>;
    /// How grains of this law turn; [`crate::Free`] unless the law is wrapped in [`crate::Rotating`].
    type Rotation: RotationLaw<T>;

    /// How grains of this law turn.
    fn rotation(&self) -> Self::Rotation;

    /// Force and memory after this step.
    fn respond(
        &self,
        contact: &Contact<T>,
        pair: &PairProperties<T>,
        memory: Self::Memory,
    ) -> (Response<T>, Self::Memory);

    /// Torques on the two bodies; `memory` is the one that [`ContactLaw::respond`] returned. Asked for only where
    /// [`RotationLaw::IS_SPHERE`] is false.
    #[inline(always)]
    fn couples(
        &self,
        contact: &Contact<T>,
        _pair: &PairProperties<T>,
        response: &Response<T>,
        bodies: &[Body<T, <Self::Rotation as RotationLaw<T>>::Frame>; 2],
        memory: Self::Memory,
    ) -> (Couples<T>, Self::Memory) {
        (Couples::of_spheres(contact, response, bodies), memory)
    }
}

/// Number of contacts that a kernel works on at once: many, because each loop over a block ends waiting for its last contacts, but
/// no more than the first-level cache holds (measured, `docs/performance.md`).
pub const BLOCK: usize = 128;

/// A value that each contact of a block has, kept as one array a component; `()` takes no bytes and no time.
pub trait Blocked<T: Real>: Copy + Default + Debug + Send + Sync + 'static {
    /// The values of [`BLOCK`] contacts.
    type Block: Copy + Default;
    /// Puts this value into place `k` of a block.
    fn store(self, block: &mut Self::Block, k: usize);
    /// Puts four values into places `k..k + 4` of a block.
    #[inline(always)]
    fn store_four(four: [Self; 4], block: &mut Self::Block, k: usize) {
        for (n, value) in four.into_iter().enumerate() {
            value.store(block, k + n);
        }
    }
    /// The value at place `k` of a block.
    fn load(block: &Self::Block, k: usize) -> Self;
}

/// What a contact remembers.
pub trait Memory<T: Real>: Blocked<T> + PartialEq + Serialize + DeserializeOwned {
    /// The memory seen from the other body.
    fn seen_from_the_other(self) -> Self;
}

impl<T: Real> Blocked<T> for () {
    type Block = ();
    #[inline(always)]
    fn store(self, (): &mut (), _: usize) {}
    #[inline(always)]
    fn load((): &(), _: usize) -> Self {}
}

impl<T: Real> Memory<T> for () {
    #[inline(always)]
    fn seen_from_the_other(self) -> Self {}
}

impl<T: Real, A: Blocked<T>, B: Blocked<T>> Blocked<T> for (A, B) {
    type Block = (A::Block, B::Block);
    #[inline(always)]
    fn store(self, block: &mut Self::Block, k: usize) {
        self.0.store(&mut block.0, k);
        self.1.store(&mut block.1, k);
    }
    #[inline(always)]
    fn store_four(four: [Self; 4], block: &mut Self::Block, k: usize) {
        // Written out here and below: closures over arrays are not inlined into a pass for wider vectors.
        let [a, b, c, d] = four;
        A::store_four([a.0, b.0, c.0, d.0], &mut block.0, k);
        B::store_four([a.1, b.1, c.1, d.1], &mut block.1, k);
    }
    #[inline(always)]
    fn load(block: &Self::Block, k: usize) -> Self {
        (A::load(&block.0, k), B::load(&block.1, k))
    }
}

impl<T: Real, A: Memory<T>, B: Memory<T>> Memory<T> for (A, B) {
    #[inline(always)]
    fn seen_from_the_other(self) -> Self {
        (self.0.seen_from_the_other(), self.1.seen_from_the_other())
    }
}

impl<T: Real> Blocked<T> for T {
    type Block = Lanes<T>;
    #[inline(always)]
    fn store(self, block: &mut Self::Block, k: usize) {
        block.0[k] = self;
    }
    #[inline(always)]
    fn store_four(four: [Self; 4], block: &mut Self::Block, k: usize) {
        block.0[k..k + 4].copy_from_slice(&four);
    }
    #[inline(always)]
    fn load(block: &Self::Block, k: usize) -> Self {
        block.0[k]
    }
}

/// A number that is the same from both bodies.
impl<T: Real> Memory<T> for T {
    #[inline(always)]
    fn seen_from_the_other(self) -> Self {
        self
    }
}

/// One number for each contact of a block, on its own cache lines.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Lanes<T>(pub [T; BLOCK]);

impl<T: Real> Default for Lanes<T> {
    fn default() -> Self {
        Self([T::ZERO; BLOCK])
    }
}

impl<T: Real> Memory<T> for Vector<T> {
    #[inline(always)]
    fn seen_from_the_other(self) -> Self {
        -self
    }
}

impl<T: Real> Blocked<T> for Vector<T> {
    type Block = [Lanes<T>; 3];
    #[inline(always)]
    fn store(self, block: &mut Self::Block, k: usize) {
        block[0].0[k] = self.x;
        block[1].0[k] = self.y;
        block[2].0[k] = self.z;
    }
    #[inline(always)]
    fn store_four(four: [Self; 4], block: &mut Self::Block, k: usize) {
        let [a, b, c, d] = four;
        block[0].0[k..k + 4].copy_from_slice(&[a.x, b.x, c.x, d.x]);
        block[1].0[k..k + 4].copy_from_slice(&[a.y, b.y, c.y, d.y]);
        block[2].0[k..k + 4].copy_from_slice(&[a.z, b.z, c.z, d.z]);
    }
    #[inline(always)]
    fn load(block: &Self::Block, k: usize) -> Self {
        Self::new(block[0].0[k], block[1].0[k], block[2].0[k])
    }
}
