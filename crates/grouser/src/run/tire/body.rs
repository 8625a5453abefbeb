//! What rolls: a rigid tire or an elastic one, in one step among the grains.

use super::axle::Axle;
use super::elastic_tire::ElasticTire;
use super::traction::Traction;
use super::tread::{Tread, TreadError, TreadSpec, shape};
use crate::run::Law;
use crate::run::law::RealOf;
use crate::run::on_bed::Broken;
use crate::scene::{SubSteps, Tire};
use grouser_contact::{ContactLedger, PairTable};
use grouser_coupling::{Deepest, Margin, Step, SurfaceContacts};
use grouser_dem::{Failure, Grains};
use grouser_fem::DynamicsError;
use grouser_geometry::{TriangleSurface, Vec3};
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// What rolls.
#[derive(Clone, Serialize, Deserialize)]
#[serde(bound = "L: Law")]
pub enum Body<L: Law> {
    /// A surface that moves with the axle; work of the grains on it [J] and its power now [W].
    Rigid { contacts: Box<SurfaceContacts<L::Memory>>, work: [f64; 2] },
    /// An elastic tread.
    Elastic(Box<ElasticTire<L>>),
}

/// What a step needs beside tire and grains.
#[derive(Clone, Copy)]
pub struct StepInput<'a, L: Law> {
    /// Contact law of the bed.
    pub law: &'a L,
    /// Constants of every pair of materials.
    pub table: &'a PairTable<RealOf<L>>,
    /// Acceleration of free fall [m/s²].
    pub gravity: Vec3,
    /// Step of the grains [s].
    pub dt: f64,
    /// Overlap over the grain's radius at which the run is given up [-].
    pub largest_overlap: f64,
}

impl<L: Law> Body<L> {
    /// The tire of a scene on its axle, of row `material` of the material table: `tread` inflated, or rigid without one.
    ///
    /// # Errors
    /// [`TreadError`].
    pub fn new(
        tire: &Tire,
        tread: Option<Tread>,
        axle: &Axle,
        material: u32,
        dt: f64,
    ) -> Result<Self, TreadError> {
        let Some(tread) = tread else {
            let mesh = shape(tire).mesh()?;
            let outer = mesh.facets("outer").expect("treads have an outer surface");
            let (surface, _) = mesh.triangle_surface(outer);
            let contacts = Box::new(SurfaceContacts::new(surface, material));
            return Ok(Self::Rigid { contacts, work: [0.0; 2] });
        };
        let sub_steps = match tire.sub_steps {
            SubSteps::Auto => None,
            SubSteps::Fixed(n) => Some(n),
        };
        let margin = Margin(tire.refit_margin);
        ElasticTire::new(tread, axle.now(), material, margin, sub_steps, dt)
            .map(|tire| Self::Elastic(Box::new(tire)))
    }

    /// The inflated tread of a spec.
    ///
    /// # Errors
    /// [`TreadError`].
    pub fn inflated(spec: Option<&TreadSpec>) -> Result<Option<Tread>, TreadError> {
        spec.map(TreadSpec::inflated).transpose()
    }

    /// One step of tire and axle; the bed has moved its grains. Gives the deepest contact's overlap over the grain's radius [-].
    ///
    /// # Errors
    /// When an element turns inside out or a grain is pressed further than the contact law means.
    pub fn step(
        &mut self,
        axle: &mut Axle,
        grains: &mut Grains<L::Precision>,
        input: StepInput<L>,
        traction: &mut Traction,
    ) -> Result<f64, Broken> {
        let deepest = match self {
            Self::Elastic(tire) => {
                tire.coupled_step(axle, grains, input, traction)?;
                tire.contacts().deepest()
            }
            Self::Rigid { contacts, work } => {
                let StepInput { law, table, dt, .. } = input;
                axle.predict(dt);
                let motion = axle.now().motion();
                let step = Step { law, table, time_step: dt, fastest: grains.fastest() };
                let Grains { spheres, ids, loads, orientations, .. } = grains;
                let seen = (&spheres[..], &ids[..], orientations.as_deref());
                let on_tire = contacts.forces_on_turned(&motion, seen, loads, &step, |seen| {
                    traction.add(&seen, &motion.position);
                });
                axle.receive(on_tire.force.z, on_tire.force.z);
                let power = on_tire.force.dot(&motion.velocity) + on_tire.moment.dot(&motion.spin);
                work[0] += 0.5 * (work[1] + power) * dt;
                work[1] = power;
                contacts.deepest()
            }
        };
        match deepest {
            Some(Deepest { grain, position, depth }) if depth > input.largest_overlap => {
                Err(Failure::OverlapTooLarge { grain, position, depth }.into())
            }
            Some(Deepest { depth, .. }) => Ok(depth),
            None => Ok(0.0),
        }
    }

    /// Energy of the contacts since the beginning.
    pub fn contact_ledger(&self) -> &ContactLedger {
        match self {
            Self::Rigid { contacts, .. } => contacts.ledger(),
            Self::Elastic(tire) => tire.contacts().ledger(),
        }
    }

    /// Number of contacts now.
    pub fn n_contacts(&self) -> usize {
        match self {
            Self::Rigid { contacts, .. } => contacts.n_contacts(),
            Self::Elastic(tire) => tire.contacts().n_contacts(),
        }
    }

    /// Work of the grains on the tire [J] and its power now [W].
    pub fn contact_work(&self) -> [f64; 2] {
        match self {
            Self::Rigid { work, .. } => *work,
            Self::Elastic(tire) => tire.contact_work(),
        }
    }

    /// The elastic tire, where it is one.
    pub fn elastic(&self) -> Option<&ElasticTire<L>> {
        match self {
            Self::Rigid { .. } => None,
            Self::Elastic(tire) => Some(tire),
        }
    }

    /// The outer surface where it is now.
    pub fn surface(&self, axle: &Axle) -> TriangleSurface {
        match self {
            Self::Rigid { contacts, .. } => contacts.surface().transformed(&axle.now().pose()),
            Self::Elastic(tire) => tire.contacts().surface().clone(),
        }
    }

    /// Time by the clock spent in the solid and in its contacts since this process began.
    pub fn spent(&self) -> [Duration; 2] {
        self.elastic().map_or([Duration::ZERO; 2], ElasticTire::spent)
    }
}

impl From<DynamicsError> for Broken {
    fn from(error: DynamicsError) -> Self {
        let remedy = match &error {
            DynamicsError::InvertedElement { .. } => {
                "take a finer or thicker tread, a higher inflation, a smaller load or a longer ramp; try `model: FiniteStrain`"
            }
            _ => "take `sub_steps: Auto`, or more of them",
        };
        Self { what: error.to_string(), remedy: remedy.into() }
    }
}

#[cfg(test)]
mod tests {
    /// I. N. Sneddon, Int. J. Engng Sci. 3 (1965): a rigid sphere of radius 1 presses a half-space of E* = 1 over a circle of
    /// radius a; indentation and force.
    fn sneddon(a: f64) -> [f64; 2] {
        let logarithm = ((1.0 + a) / (1.0 - a)).ln();
        [0.5 * a * logarithm, 0.5 * (a * a + 1.0) * logarithm - a]
    }

    #[test]
    fn hertz_is_nine_per_cent_above_the_exact_force_at_the_largest_indentation_a_scene_may_allow() {
        for (asked, over) in [(0.3, 1.031), (0.5, 1.053), (0.8, 1.087)] {
            let (mut low, mut high) = (0.1, 0.9);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                *(if sneddon(middle)[0] < asked { &mut low } else { &mut high }) = middle;
            }
            let [indentation, exact] = sneddon(low);
            let hertz = 4.0 / 3.0 * indentation.powf(1.5);
            assert!((indentation - asked).abs() < 1e-12);
            assert!((hertz / exact - over).abs() < 1e-3, "{}", hertz / exact);
        }
    }
}
