//! A rigid tool in contact with grains.

use super::law::RealOf;
use super::{Law, SetupError};
use grouser_contact::{ContactLedger, PairTable};
use grouser_coupling::{Step, SurfaceContacts};
use grouser_dem::{Failure, Grains};
use grouser_geometry::{Pose, TriangleSurface, Vec3, Wrench};
use grouser_rigid::{BodySpec, Degree, Freedom, RigidBody, VelocityProfile};
use serde::{Deserialize, Serialize};

/// A rigid tool on its way.
#[derive(Clone, Serialize, Deserialize)]
#[serde(bound = "L: Law")]
pub struct RigidTool<L: Law> {
    body: RigidBody,
    contacts: SurfaceContacts<L::Memory>,
}

impl<L: Law> RigidTool<L> {
    /// A tool whose surface's origin is at `position`, about to move as `body` says.
    pub fn new(body: RigidBody, surface: TriangleSurface, material: u32) -> Self {
        Self { body, contacts: SurfaceContacts::new(surface, material) }
    }

    /// A tool that moves straight down from `lowest_point` at `speed` [m/s].
    ///
    /// # Errors
    /// When the motion is refused.
    pub fn pressed(
        surface: TriangleSurface,
        lowest_point: Vec3,
        speed: f64,
        material: u32,
    ) -> Result<Self, SetupError> {
        let down = Freedom::Prescribed(VelocityProfile::constant(-speed));
        let body = RigidBody::new(BodySpec::driven(lowest_point).with(Degree::Z, down))?;
        Ok(Self::new(body, surface, material))
    }

    /// One step: the tool moves, meets the grains, and both receive their forces. Returns the force on the tool and
    /// its moment about the origin of its surface.
    ///
    /// # Errors
    /// When a grain is pressed further than `largest_overlap` times its radius.
    pub fn step(
        &mut self,
        grains: &mut Grains<L::Precision>,
        law: &L,
        table: &PairTable<RealOf<L>>,
        time_step: f64,
        largest_overlap: f64,
    ) -> Result<Wrench, Failure> {
        self.body.predict(time_step);
        let step = Step { law, table, time_step, fastest: grains.fastest() };
        let Grains { spheres, ids, loads, orientations, .. } = grains;
        let seen = (&spheres[..], &ids[..], orientations.as_deref());
        let load = self.contacts.forces_on_turned(self.body.motion(), seen, loads, &step, |_| ());
        self.body.correct(&load, time_step);
        match self.contacts.deepest() {
            Some(deepest) if deepest.depth > largest_overlap => {
                let grouser_coupling::Deepest { grain, position, depth } = deepest;
                Err(Failure::OverlapTooLarge { grain, position, depth })
            }
            _ => Ok(load),
        }
    }

    /// Height of the origin of its surface [m].
    pub fn height(&self) -> f64 {
        self.body.motion().position.z
    }

    /// Power of the grains on the tool [W]; negative while the tool works on them.
    pub fn applied_power(&self) -> f64 {
        self.body.applied_power()
    }

    /// Work that the tool has done on the grains [J].
    pub fn work_on_grains(&self) -> f64 {
        -self.body.work().applied
    }

    /// Number of contacts of the last step.
    pub fn n_contacts(&self) -> usize {
        self.contacts.n_contacts()
    }

    /// Energy of the tool's contacts since the beginning.
    pub fn ledger(&self) -> &ContactLedger {
        self.contacts.ledger()
    }

    /// The tool where it is now.
    pub fn surface_in_place(&self) -> TriangleSurface {
        let motion = self.body.motion();
        let pose = Pose::from_parts(motion.position.into(), motion.orientation);
        self.contacts.surface().transformed(&pose)
    }
}
