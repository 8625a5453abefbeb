//! A rigid circular plate, driven straight down, in contact with grains.

use super::{Law, SetupError};
use crate::scene::Plates;
use grouser_contact::{ContactLedger, PairTable};
use grouser_coupling::{Step, SurfaceContacts};
use grouser_dem::{Failure, Grains, LARGEST_OVERLAP};
use grouser_geometry::generate::disc_plate;
use grouser_geometry::{Pose, TriangleSurface, Vec3, Wrench};
use grouser_rigid::{BodySpec, Degree, Freedom, RigidBody, VelocityProfile};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// A plate on its way.
#[derive(Clone, Serialize, Deserialize)]
#[serde(bound = "L: Law")]
pub struct Plate<L: Law> {
    body: RigidBody,
    contacts: SurfaceContacts<L::Memory>,
}

impl<L: Law> Plate<L> {
    /// A plate of `diameter` [m] whose lower face is centred at `lowest_point`, about to move down at `speed` [m/s].
    ///
    /// # Errors
    /// When the shape or the motion is refused.
    pub fn new(
        plates: &Plates,
        diameter: f64,
        lowest_point: Vec3,
        speed: f64,
        material: u32,
    ) -> Result<Self, SetupError> {
        // The polygon has the circle's area: n/2 sin(2π/n) R² = π r².
        let n = plates.segments as f64;
        let corner_radius = diameter / 2.0 * (TAU / (n * (TAU / n).sin())).sqrt();
        let surface = disc_plate(corner_radius, plates.thickness_m, plates.segments)?;
        let down = Freedom::Prescribed(VelocityProfile::constant(-speed));
        let body = RigidBody::new(BodySpec::driven(lowest_point).with(Degree::Z, down))?;
        Ok(Self { body, contacts: SurfaceContacts::new(surface, material) })
    }

    /// One step: the plate moves, meets the grains, and both receive their forces. Returns the force on the plate and
    /// its moment about the centre of the lower face.
    ///
    /// # Errors
    /// When a grain is pressed further than the contact law means.
    pub fn step(
        &mut self,
        grains: &mut Grains<grouser_contact::F64>,
        law: &L,
        table: &PairTable,
        time_step: f64,
    ) -> Result<Wrench, Failure> {
        self.body.predict(time_step);
        let step = Step { law, table, time_step, fastest: grains.fastest() };
        let Grains { spheres, ids, loads, .. } = grains;
        let load = self.contacts.forces(self.body.motion(), (spheres, ids), loads, &step);
        self.body.correct(&load, time_step);
        match self.contacts.deepest() {
            Some(deepest) if deepest.depth > LARGEST_OVERLAP => {
                let grouser_coupling::Deepest { grain, position, depth } = deepest;
                Err(Failure::OverlapTooLarge { grain, position, depth })
            }
            _ => Ok(load),
        }
    }

    /// Height of the lower face [m].
    pub fn lowest_point(&self) -> f64 {
        self.body.motion().position.z
    }

    /// Power of the grains on the plate [W]; negative while the plate works on them.
    pub fn applied_power(&self) -> f64 {
        self.body.applied_power()
    }

    /// Work that the plate has done on the grains [J].
    pub fn work_on_grains(&self) -> f64 {
        -self.body.work().applied
    }

    /// Number of contacts of the last step.
    pub fn n_contacts(&self) -> usize {
        self.contacts.n_contacts()
    }

    /// Energy of the plate's contacts since the beginning.
    pub fn ledger(&self) -> &ContactLedger {
        self.contacts.ledger()
    }

    /// The plate where it is now.
    pub fn surface_in_place(&self) -> TriangleSurface {
        let motion = self.body.motion();
        let pose = Pose::from_parts(motion.position.into(), motion.orientation);
        self.contacts.surface().transformed(&pose)
    }
}
