//! From the dials to a contact law's type in a precision, once a run.

use crate::scene::{Dials, Precision as Named, RestitutionTail};
use grouser_contact::{
    Body, Contact, ContactLaw, Couples, F32, F64, HertzMindlin, Mixed, PairProperties, Precision, Response,
    RotationLaw,
};
use serde::{Deserialize, Serialize};
use std::marker::PhantomData;

/// A law in its precision: what runs and checkpoints are made of.
pub trait Law: ContactLaw<<<Self as Law>::Precision as Precision>::Real> + Default {
    /// Scalars of positions and of contact arithmetic.
    type Precision: Precision;
}

/// Scalar that a law computes contacts with.
pub type RealOf<L> = <<L as Law>::Precision as Precision>::Real;
/// A bed whose grains meet under law `L`.
pub type LawBed<L> = grouser_dem::Bed<L, <L as Law>::Precision>;

/// Law `L` in precision `P`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(bound(serialize = "L: Serialize", deserialize = "L: Deserialize<'de>"))]
pub struct InPrecision<P, L> {
    law: L,
    #[serde(skip)]
    precision: PhantomData<P>,
}

impl<P: Precision, L: ContactLaw<P::Real> + Default> Law for InPrecision<P, L> {
    type Precision = P;
}

impl<P: Precision, L: ContactLaw<P::Real>> ContactLaw<P::Real> for InPrecision<P, L> {
    type Memory = L::Memory;
    type Rotation = L::Rotation;

    #[inline(always)]
    fn rotation(&self) -> L::Rotation {
        self.law.rotation()
    }

    #[inline(always)]
    fn respond(
        &self,
        contact: &Contact<P::Real>,
        pair: &PairProperties<P::Real>,
        memory: L::Memory,
    ) -> (Response<P::Real>, L::Memory) {
        self.law.respond(contact, pair, memory)
    }

    #[inline(always)]
    fn couples(
        &self,
        contact: &Contact<P::Real>,
        pair: &PairProperties<P::Real>,
        response: &Response<P::Real>,
        bodies: &[Body<P::Real, <L::Rotation as RotationLaw<P::Real>>::Frame>; 2],
        memory: L::Memory,
    ) -> (Couples<P::Real>, L::Memory) {
        self.law.couples(contact, pair, response, bodies, memory)
    }
}

/// Work that is done with whatever law the dials name.
pub trait WithLaw {
    /// Result of the work.
    type Output;
    /// Does the work with a law.
    fn with<L: Law>(self, law: L) -> Self::Output;
}

/// Calls `work` with the law and the precision that `dials` name.
pub fn with_law<W: WithLaw>(dials: &Dials, work: W) -> W::Output {
    match dials.precision {
        Named::F64 => in_precision::<F64, W>(dials, work),
        Named::Mixed => in_precision::<Mixed, W>(dials, work),
        Named::F32 => in_precision::<F32, W>(dials, work),
    }
}

fn in_precision<P: Precision, W: WithLaw>(dials: &Dials, work: W) -> W::Output {
    match dials.restitution_tail {
        RestitutionTail::Keep => work.with(InPrecision::<P, HertzMindlin<true, false>>::default()),
        RestitutionTail::CutCorrected => work.with(InPrecision::<P, HertzMindlin<false, false>>::default()),
    }
}
