//! A law for forces together with a law for turning.

use crate::{Body, Contact, ContactLaw, Couples, Free, PairProperties, Real, Response, RotationLaw};
use serde::{Deserialize, Serialize};

/// `forces` as they are, with the torques of `rotation` instead of the sphere's.
///
/// ```
/// use grouser_contact::*;
/// let shape = GrainShape::Angular { aspect_ratio: 0.5 };
/// let rotation = Tilting::<false>::new(&TiltingSettings::of(shape))?;
/// let law = Rotating { forces: HertzMindlin::new(Tail::CutCorrected), rotation };
/// assert_eq!(RotationLaw::<f64>::inertia_ratios(&law.rotation), [1.0 / 3.0; 3]);
/// # Ok::<(), ParameterError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Rotating<L, R> {
    /// Normal and tangential force.
    pub forces: L,
    /// Torques and inertia.
    pub rotation: R,
}

impl<T, L, R> ContactLaw<T> for Rotating<L, R>
where
    T: Real,
    L: ContactLaw<T, Rotation = Free>,
    R: RotationLaw<T>,
{
    type Memory = (L::Memory, R::Memory);
    type Rotation = R;

    #[inline(always)]
    fn rotation(&self) -> R {
        self.rotation
    }

    #[inline(always)]
    fn respond(
        &self,
        contact: &Contact<T>,
        pair: &PairProperties<T>,
        (of_force, of_turning): Self::Memory,
    ) -> (Response<T>, Self::Memory) {
        let (response, of_force) = self.forces.respond(contact, pair, of_force);
        (response, (of_force, of_turning))
    }

    #[inline(always)]
    fn couples(
        &self,
        contact: &Contact<T>,
        pair: &PairProperties<T>,
        response: &Response<T>,
        bodies: &[Body<T, R::Frame>; 2],
        (of_force, of_turning): Self::Memory,
    ) -> (Couples<T>, Self::Memory) {
        let (couples, of_turning) = self.rotation.couples(contact, pair, response, bodies, of_turning);
        (couples, (of_force, of_turning))
    }
}
