//! One step of grains and a solid that deforms: P0 Fig. 8, numbered as in `docs/theory/coupling.md`.

use crate::{DeformingContacts, Seen, Step};
use grouser_contact::{ContactLaw, Load, Memory, Precision, Sphere};
use grouser_geometry::{Orientation, Vec3};

/// A solid as the coupled step sees it: explicit, and with the nodes that its mirrored surface is made of.
pub trait SteppedSolid {
    /// Why a sub-step failed.
    type Error;
    /// Brings supports and frame to `share` of the step [-], in a sub-step of `h` [s].
    fn carry(&mut self, _share: f64, _h: f64) {}
    /// Moves the nodes to the end of a sub-step of `h` [s].
    ///
    /// # Errors
    /// The solid's own.
    fn advance_positions(&mut self, h: f64) -> Result<(), Self::Error>;
    /// Gives them the velocities there, with the contact forces added since the last [`Self::clear_forces`].
    ///
    /// # Errors
    /// The solid's own.
    fn advance_velocities(&mut self, h: f64) -> Result<(), Self::Error>;
    /// Place of a node in the world [m].
    fn place(&self, node: u32) -> Vec3;
    /// Takes all contact forces from the nodes.
    fn clear_forces(&mut self);
    /// Adds a contact force in the world to a node [N].
    fn add_force(&mut self, node: u32, force: Vec3);
}

/// Grains at the end of the step, and their loads.
pub struct MovedGrains<'a, P: Precision> {
    /// Grains.
    pub spheres: &'a [Sphere<P>],
    /// Their permanent numbers.
    pub ids: &'a [u32],
    /// Their orientations, where the law asks for them.
    pub orientations: Option<&'a [Orientation]>,
    /// What the contacts are added to.
    pub loads: &'a mut [Load<P::Real>],
}

/// One coupled step, in which the solid makes `sub_steps` of its own; C1, the grains' move to its end, is done.
///
/// # Errors
/// Those of the solid.
pub fn coupled_step<S: SteppedSolid, P: Precision, L: ContactLaw<P::Real, Memory = M>, M: Memory<P::Real>>(
    solid: &mut S,
    contacts: &mut DeformingContacts<M>,
    MovedGrains { spheres, ids, orientations, loads }: MovedGrains<P>,
    step: &Step<L, P::Real>,
    sub_steps: u32,
    observe: impl FnMut(Seen),
) -> Result<(), S::Error> {
    let n = f64::from(sub_steps);
    let h = step.time_step / n;
    solid.clear_forces();
    for k in 1..=sub_steps {
        // C2. Supports and frame move.
        solid.carry(f64::from(k) / n, h);
        // C3. The solid follows, all but the end of the last sub-step without contacts.
        solid.advance_positions(h)?;
        if k < sub_steps {
            solid.advance_velocities(h)?;
        }
    }
    // C4. Its displaced surface is mirrored, with its mean velocity over the step.
    contacts.follow_in(step.time_step, |node| solid.place(node));
    // C5. Pairs, and the forces between them; the grains receive theirs.
    contacts.forces_on_turned((spheres, ids, orientations), loads, step, observe);
    // C6. The nodes receive theirs, as the impulse of the whole step at its end.
    contacts.spread(|node, force| solid.add_force(node, force * n));
    // C7. The solid's accelerations and velocities at the end of the step.
    solid.advance_velocities(h)
}
