//! From the dials to a contact law's type in a precision, once a run.

use crate::scene::{Dials, Figures, Forces, Precision as Named, RestitutionTail, Rolling, Rotation};
use grouser_contact::{
    Body, ConstantRolling, Contact, ContactLaw, Couples, Dlr, ElasticPlasticRolling, F32, F64, HertzMindlin,
    Mixed, PairProperties, ParameterError, PlaneTilting, Precision, Response, Rotating, RotationLaw, Tail,
    Tilting,
};
use serde::{Deserialize, Serialize};
use std::marker::PhantomData;

/// A law in its precision: what runs and checkpoints are made of.
pub trait Law: ContactLaw<<<Self as Law>::Precision as Precision>::Real> {
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

impl<P: Precision, L: ContactLaw<P::Real>> Law for InPrecision<P, L> {
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

/// A law in precision `P`.
fn in_precision<P: Precision, L: ContactLaw<P::Real>>(law: L) -> InPrecision<P, L> {
    InPrecision { law, precision: PhantomData }
}

/// A law in double precision.
fn double<L: ContactLaw<f64>>(law: L) -> InPrecision<F64, L> {
    in_precision(law)
}

/// Work that is done with whatever law the dials name.
pub trait WithLaw {
    /// Result of the work.
    type Output;
    /// Does the work with a law.
    fn with<L: Law>(self, law: L) -> Self::Output;
}

/// Calls `work` with the law that `dials` name. Forces other than Hertz–Mindlin are built with free, fixed and tilting grains only,
/// precisions other than double with free and fixed ones: each further pair is a whole engine more to compile.
///
/// # Errors
/// When a constant is outside its range or the combination is not built; a checked scenario excludes both.
pub fn with_law<W: WithLaw>(dials: &Dials, work: W) -> Result<W::Output, ParameterError> {
    let hertz_mindlin = HertzMindlin::new(match dials.restitution_tail {
        RestitutionTail::Keep => Tail::Keep,
        RestitutionTail::CutCorrected => Tail::CutCorrected,
    });
    let turns_as_sphere = matches!(dials.rotation, Rotation::Free | Rotation::Fixed);
    match (dials.forces, turns_as_sphere, dials.precision) {
        (Forces::HertzMindlin, true, Named::Mixed) => Ok(work.with(in_precision::<Mixed, _>(hertz_mindlin))),
        (Forces::HertzMindlin, true, Named::F32) => Ok(work.with(in_precision::<F32, _>(hertz_mindlin))),
        (Forces::HertzMindlin, _, Named::F64) => with_hertz_mindlin(hertz_mindlin, &dials.rotation, work),
        (Forces::Dlr(dlr), _, Named::F64) => with_dlr(dlr.law()?, &dials.rotation, work),
        _ => not_built(),
    }
}

fn with_dlr<W: WithLaw>(forces: Dlr, rotation: &Rotation, work: W) -> Result<W::Output, ParameterError> {
    match rotation {
        Rotation::Free | Rotation::Fixed => Ok(work.with(double(forces))),
        Rotation::Tilting(tilting) if tilting.figures == Figures::OneBody && !tilting.shape.is_round() => {
            Ok(work.with(double(Rotating { forces, rotation: Tilting::<false>::new(&tilting.settings())? })))
        }
        _ => not_built(),
    }
}

fn with_hertz_mindlin<W: WithLaw>(
    forces: HertzMindlin,
    rotation: &Rotation,
    work: W,
) -> Result<W::Output, ParameterError> {
    Ok(match *rotation {
        Rotation::Free | Rotation::Fixed => work.with(double(forces)),
        Rotation::Rolling(Rolling::Constant { friction }) => {
            work.with(double(Rotating { forces, rotation: ConstantRolling::new(friction)? }))
        }
        Rotation::Rolling(Rolling::ElasticPlastic { friction, damping_ratio }) => {
            work.with(double(Rotating {
                forces,
                rotation: ElasticPlasticRolling::new(friction, damping_ratio)?,
            }))
        }
        Rotation::Tilting(tilting) => {
            let settings = tilting.settings();
            match (tilting.figures, tilting.shape.is_round()) {
                (Figures::OneBody, false) => {
                    work.with(double(Rotating { forces, rotation: Tilting::<false>::new(&settings)? }))
                }
                (Figures::OneBody, true) => {
                    work.with(double(Rotating { forces, rotation: Tilting::<true>::new(&settings)? }))
                }
                (Figures::EachForItself, _) => {
                    work.with(double(Rotating { forces, rotation: PlaneTilting::new(&settings)? }))
                }
            }
        }
    })
}

fn not_built<T>() -> Result<T, ParameterError> {
    let expected = "Hertz-Mindlin forces in F64 for this rotation; in single and mixed precision grains turn freely or not at all (tilting \
                    ones would not come to rest), with Dlr freely, not at all, or as boxes";
    Err(ParameterError { name: "combination of forces and rotation", value: f64::NAN, expected })
}

/// Nothing is done: asks whether [`with_law`] can.
pub struct Possible;

impl WithLaw for Possible {
    type Output = ();
    fn with<L: Law>(self, _: L) {}
}

impl crate::scene::Dlr {
    /// The contact law of these constants.
    ///
    /// # Errors
    /// When a constant is outside its range.
    pub fn law(&self) -> Result<Dlr, ParameterError> {
        let &Self {
            tangential_stiffness_n_m: stiffness,
            normal_damping_n_s_m: damping,
            stick_over_slip: ratio,
        } = self;
        let positive = stiffness > 0.0 && stiffness.is_finite();
        ParameterError::check("tangential stiffness", stiffness, positive, "a positive number")?;
        let holds = damping >= 0.0 && damping.is_finite();
        ParameterError::check("normal damping", damping, holds, "zero or a positive number")?;
        let holds = ratio >= 1.0 && ratio.is_finite();
        ParameterError::check(
            "stick over slip friction",
            ratio,
            holds,
            "at least 1: a contact sticks before it slides",
        )?;
        Ok(Dlr { tangential_stiffness: stiffness, normal_damping: damping, stick_over_slip: ratio })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Tilting as Angular;
    use grouser_contact::GrainShape;

    fn possible(dials: &str) -> Result<(), ParameterError> {
        let dials: Dials = crate::scene::dialect().from_str(dials).unwrap();
        with_law(&dials, Possible)
    }

    #[test]
    fn every_rotation_is_one_line_of_a_scene() {
        for rotation in [
            "Free",
            "Fixed",
            "Rolling(Constant(friction: 0.1))",
            "Rolling(ElasticPlastic(friction: 0.1))",
            "Tilting(shape: Cube)",
            "Tilting(shape: Bar(aspect_ratio: 0.5), arms: LongSide)",
            "Tilting(shape: Disc(aspect_ratio: 0.3), inertia: ThinRod)",
        ] {
            for tail in ["CutCorrected", "Keep"] {
                possible(&format!("(rotation: {rotation}, restitution_tail: {tail})"))
                    .unwrap_or_else(|error| panic!("{rotation}, {tail}: {error}"));
            }
        }
        let dlr = "Dlr(tangential_stiffness_n_m: 1e4, normal_damping_n_s_m: 0.1)";
        possible(&format!("(forces: {dlr}, rotation: Tilting(shape: Plate(aspect_ratio: 0.2)))")).unwrap();
    }

    #[test]
    fn what_cannot_be_is_refused_with_the_reason() {
        let error = possible("(rotation: Tilting(shape: Angular(aspect_ratio: 2)))").unwrap_err();
        assert_eq!((error.name, error.value), ("aspect ratio", 2.0));
        let error = possible("(precision: Mixed, rotation: Tilting(shape: Cube))").unwrap_err();
        assert!(error.expected.contains("F64"), "{error}");
        assert_eq!(
            possible("(rotation: Rolling(Constant(friction: -1)))").unwrap_err().name,
            "rolling friction"
        );
        let angular = Angular {
            shape: GrainShape::Planes([grouser_contact::PlaneShape::Circle { scale: 0.05 }; 3]),
            arms: Default::default(),
            inertia: Default::default(),
            smoothing_rad: 0.01,
            build_up: 10.0,
            lift_damping: 1.0,
            figures: Figures::OneBody,
        };
        let dials = Dials { rotation: Rotation::Tilting(angular), ..Dials::default() };
        assert_eq!(with_law(&dials, Possible).unwrap_err().name, "arm scale");
    }
}
