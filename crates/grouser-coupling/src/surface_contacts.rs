//! Contacts between grains and a triangle surface that moves as a rigid body.

use crate::candidates::{Candidates, Margin};
use crate::contact_pass::{Carrier, Contacts, Deepest, Seen, Step, asks_for_orientations};
use crate::touches::Touch;
use grouser_contact::{ContactLaw, ContactLedger, Load, Memory, Precision, Sphere};
use grouser_geometry::{Orientation, RigidMotion, TriangleSurface, Vec3, Wrench};
use serde::{Deserialize, Serialize};

/// Contacts of one surface with the grains of one bed, and what they remember.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound = "M: Serialize + serde::de::DeserializeOwned")]
pub struct SurfaceContacts<M> {
    surface: TriangleSurface,
    /// Distance of the farthest vertex from the origin of the body frame [m].
    farthest: f64,
    material: u32,
    candidates: Candidates,
    contacts: Contacts<M>,
}

/// A surface that moves as a rigid body and sums the forces on it.
struct Rigid<'a> {
    motion: &'a RigidMotion,
    total: Wrench,
}

impl Carrier for Rigid<'_> {
    #[inline]
    fn place_in_frame(&self, place: &Vec3) -> Vec3 {
        self.motion.point_in_body(place)
    }
    #[inline]
    fn point(&self, in_frame: &Vec3) -> Vec3 {
        self.motion.point(in_frame)
    }
    #[inline]
    fn direction(&self, in_frame: &Vec3) -> Vec3 {
        self.motion.orientation * in_frame
    }
    #[inline]
    fn velocity(&self, _: &Touch, point: &Vec3) -> Vec3 {
        self.motion.velocity_at(point)
    }
    #[inline]
    fn spin(&self, _: &Touch, _: &Vec3) -> Vec3 {
        self.motion.spin
    }
    #[inline]
    fn receive(&mut self, _: &Touch, point: &Vec3, force: Vec3) {
        self.total += Wrench::of_force_at(force, point, &self.motion.position);
    }
}

impl<M> SurfaceContacts<M> {
    /// No contacts yet of a surface, given in its body frame, made of row `material` of the material table.
    /// The mesh doctor must have found it sound.
    pub fn new(surface: TriangleSurface, material: u32) -> Self {
        Self {
            farthest: surface.vertices.iter().fold(0.0, |most, vertex| most.max(vertex.norm())),
            surface,
            material,
            candidates: Candidates::default(),
            contacts: Contacts::default(),
        }
    }

    /// Forces of one step: adds to the `loads` of the grains, and returns force and moment on the surface about the
    /// origin of its body frame.
    ///
    /// `ids` are the permanent numbers of the grains; results do not depend on the order in which grains are stored. The surface is
    /// rigid: R* and m* are those of the grain, and the contact point lies on the surface.
    pub fn forces<P: Precision, L: ContactLaw<P::Real, Memory = M>>(
        &mut self,
        motion: &RigidMotion,
        grains: (&[Sphere<P>], &[u32]),
        loads: &mut [Load<P::Real>],
        step: &Step<L, P::Real>,
    ) -> Wrench
    where
        M: Memory<P::Real>,
    {
        self.forces_seen(motion, grains, loads, step, |_| ())
    }

    /// [`Self::forces`], with every contact shown to `observe`, by rising number of the grain.
    ///
    /// Laws that ask for orientations do not compile here: see [`Self::forces_on_turned`].
    pub fn forces_seen<P: Precision, L: ContactLaw<P::Real, Memory = M>>(
        &mut self,
        motion: &RigidMotion,
        (spheres, ids): (&[Sphere<P>], &[u32]),
        loads: &mut [Load<P::Real>],
        step: &Step<L, P::Real>,
        observe: impl FnMut(Seen),
    ) -> Wrench
    where
        M: Memory<P::Real>,
    {
        const { assert!(!asks_for_orientations::<P, L>(), "angular grains: use `forces_on_turned`") };
        self.forces_on_turned(motion, (spheres, ids, None), loads, step, observe)
    }

    /// [`Self::forces_seen`] on grains whose `orientations` are kept; `None` where the law does not ask for them.
    ///
    /// # Panics
    /// When the law asks for orientations and there are none.
    pub fn forces_on_turned<P: Precision, L: ContactLaw<P::Real, Memory = M>>(
        &mut self,
        motion: &RigidMotion,
        (spheres, ids, orientations): (&[Sphere<P>], &[u32], Option<&[Orientation]>),
        loads: &mut [Load<P::Real>],
        step: &Step<L, P::Real>,
        observe: impl FnMut(Seen),
    ) -> Wrench
    where
        M: Memory<P::Real>,
    {
        // 1. Grains near the surface.
        let speed = step.fastest + motion.velocity.norm() + motion.spin.norm() * self.farthest;
        let travel = speed * step.time_step;
        let in_frame = |place: &Vec3| motion.point_in_body(place);
        self.candidates.refresh(&self.surface, in_frame, (spheres, ids), travel, Margin::DEFAULT);
        // 2. to 6.
        let mut carrier = Rigid { motion, total: Wrench::default() };
        let surface = (&self.surface, self.material);
        self.contacts.pass(
            &self.candidates,
            surface,
            &mut carrier,
            (spheres, orientations),
            loads,
            step,
            observe,
        );
        carrier.total
    }

    /// The surface in its body frame.
    pub fn surface(&self) -> &TriangleSurface {
        &self.surface
    }

    /// Number of contacts of the last step.
    pub fn n_contacts(&self) -> usize {
        self.contacts.n_contacts()
    }

    /// Energy of the contacts since the beginning.
    pub fn ledger(&self) -> &ContactLedger {
        &self.contacts.ledger
    }

    /// The deepest contact of the last step.
    pub fn deepest(&self) -> Option<Deepest> {
        self.contacts.deepest
    }
}
