//! One block of contacts on its way through a pass: looked at, gathered, put to the contact law, scattered in order.

mod gather;
mod look;
mod memory;
mod respond;
mod scatter;

#[cfg(target_arch = "x86_64")]
use crate::force_pass::{InstructionSet, in_quads};
use crate::force_pass::{PassInput, Waiting};
use crate::slab::{Slab, SlabSums};
use grouser_contact::{
    BLOCK, Blocked, ContactLaw, ContactLedger, Lanes, PairTable, Precision, Quaternion, Real, RotationLaw,
};

/// What law `L` asks to know about orientations.
pub(crate) type FrameOf<T, L> = <<L as ContactLaw<T>>::Rotation as RotationLaw<T>>::Frame;

/// Grains turn as spheres do; known when compiled.
const fn turns_as_sphere<T: Real, L: ContactLaw<T>>() -> bool {
    <L::Rotation as RotationLaw<T>>::IS_SPHERE
}

/// The two types are one; known when compiled.
#[inline(always)]
fn is_same<A: 'static, B: 'static>() -> bool {
    std::any::TypeId::of::<A>() == std::any::TypeId::of::<B>()
}

/// The law asks for orientations as quaternions; known when compiled.
#[inline(always)]
fn has_quaternions<T: Real, L: ContactLaw<T>>() -> bool {
    is_same::<FrameOf<T, L>, Quaternion<T>>()
}

/// Lanes that loops over a block go through at a time: a number that every vector width divides.
const GROUP: usize = 16;

/// One number for each lane of a group.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
struct Group<T>([T; GROUP]);

impl<T: Real> Default for Group<T> {
    fn default() -> Self {
        Self([T::ZERO; GROUP])
    }
}

/// One component for each contact of a block. Inputs are overwritten by outputs where both have three components.
pub(crate) struct Block<T: Real, L: ContactLaw<T>> {
    /// Centre of the second body to centre of the first [m]; after the law the force on the first [N].
    difference: [Lanes<T>; 3],
    /// (r₁ + r₂)² − distance² [m²], taken in the precision of coordinates.
    excess: Lanes<T>,
    radius: [Lanes<T>; 2],
    mass: [Lanes<T>; 2],
    /// Velocity of the first centre against the second [m/s]; after the law n × F [N].
    velocity: [Lanes<T>; 3],
    /// Spins [rad/s]; after a law that does not turn grains as spheres the torques [N·m].
    spin: [[Lanes<T>; 3]; 2],
    /// Orientations, where the law asks for them.
    frame: [<FrameOf<T, L> as Blocked<T>>::Block; 2],
    /// Distance of the contact point from each centre [m].
    arm: [Lanes<T>; 2],
    /// R* [m].
    effective_radius: Lanes<T>,
    /// m* [kg].
    effective_mass: Lanes<T>,
    memory: <L::Memory as Blocked<T>>::Block,
    normal_modulus: Lanes<T>,
    tangential_modulus: Lanes<T>,
    damping: Lanes<T>,
    tangential_damping_ratio: Lanes<T>,
    friction: Lanes<T>,
    /// Sums over all blocks of a pass, one for each lane of a group.
    ledger: [Group<T>; 6],
    /// How far overlaps exceed the largest one that is allowed [m], one for each lane of a group.
    depth: Group<T>,
}

/// There are registers for this precision; known when compiled.
#[inline(always)]
fn has_quads<P: Precision>() -> bool {
    #[cfg(target_arch = "x86_64")]
    return in_quads!(P, Quads => size_of::<Quads>()).is_some();
    #[cfg(not(target_arch = "x86_64"))]
    false
}

/// Eight contacts can be gathered at once.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn has_eights<P: Precision>(set: InstructionSet) -> bool {
    is_same::<P, grouser_contact::F64>() && set == InstructionSet::Avx512
}

impl<T: Real, L: ContactLaw<T>> Block<T, L> {
    /// Lanes that hold what any law stands, for beds of materials in `table`.
    pub fn new(table: &PairTable<T>) -> Self {
        let mut block = Self {
            difference: Default::default(),
            excess: Lanes([T::from_f64(0.5); BLOCK]),
            radius: [Lanes([T::ONE; BLOCK]); 2],
            mass: [Lanes([T::ONE; BLOCK]); 2],
            velocity: Default::default(),
            spin: Default::default(),
            frame: Default::default(),
            arm: Default::default(),
            effective_radius: Default::default(),
            effective_mass: Default::default(),
            memory: Default::default(),
            normal_modulus: Default::default(),
            tangential_modulus: Default::default(),
            damping: Default::default(),
            tangential_damping_ratio: Default::default(),
            friction: Default::default(),
            ledger: Default::default(),
            depth: Default::default(),
        };
        for k in 0..BLOCK {
            block.difference[0].0[k] = T::ONE;
            block.set_pair(k, table, 0, 0);
        }
        block
    }

    /// Constants of materials `i` and `j` for contact `k`.
    #[inline(always)]
    fn set_pair(&mut self, k: usize, table: &PairTable<T>, i: u32, j: u32) {
        let pair = table.pair(i, j);
        self.normal_modulus.0[k] = pair.normal_modulus;
        self.tangential_modulus.0[k] = pair.tangential_modulus;
        self.damping.0[k] = pair.damping;
        self.tangential_damping_ratio.0[k] = pair.tangential_damping_ratio;
        self.friction.0[k] = pair.friction;
    }

    #[inline(always)]
    pub fn work<P: Precision<Real = T>, const HAS_QUADS: bool, const LEDGER: bool>(
        &mut self,
        waiting: &Waiting,
        slab: &mut Slab<T, L::Memory>,
        input: &PassInput<P, L>,
    ) {
        let places = waiting.places();
        self.gather::<P, HAS_QUADS>(waiting, slab, input);
        // Groups of lanes: a constant trip count that every vector width divides; constant bounds of their number, without which
        // the compiler looks for lanes behind the last one and works on some of them one at a time.
        for group in (0..BLOCK / GROUP).take_while(|group| group * GROUP < places.len()) {
            self.touch(group * GROUP, places.len(), input.largest_overlap);
        }
        for group in (0..BLOCK / GROUP).take_while(|group| group * GROUP < places.len()) {
            self.respond::<LEDGER>(group * GROUP, places.len(), &input.law, input.time_step);
        }
        self.scatter::<P, HAS_QUADS>(waiting, slab, input.grains);
    }

    /// Sums begin anew.
    #[inline(always)]
    pub fn forget_sums(&mut self) {
        (self.ledger, self.depth) = Default::default();
    }

    /// Sums since they began.
    pub fn totals(&self, time_step: T) -> SlabSums {
        let total = |lanes: &Group<T>| lanes.0.iter().map(|value| value.to_f64()).sum::<f64>();
        let dt = time_step.to_f64();
        let [normal_elastic, tangential_elastic, normal_damping, tangential, sliding, turning] = &self.ledger;
        let ledger = ContactLedger {
            normal_elastic: total(normal_elastic),
            tangential_elastic: total(tangential_elastic),
            normal_damping: total(normal_damping) * dt,
            tangential: total(tangential) * dt,
            sliding: total(sliding) * dt,
            turning: total(turning) * dt,
            ..Default::default()
        };
        let is_too_deep = self.depth.0.iter().any(|&depth| depth > T::ZERO);
        SlabSums { ledger, is_too_deep }
    }
}
