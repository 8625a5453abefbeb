//! An elastic tread on its rim among grains: the coupled step of P0 Fig. 8, numbered as in `docs/theory/coupling.md`.

use super::axle::{Axle, Place};
use super::traction::Traction;
use crate::run::Law;
use crate::run::law::RealOf;
use grouser_contact::{ContactLedger, PairTable};
use grouser_coupling::{Deepest, DeformingContacts, Margin, Mirror, MirrorError, Step};
use grouser_dem::Grains;
use grouser_fem::{
    DynamicsError, Formulation, LinearSolver, Material, Settings, Solid, SolidError, State, StaticError,
    StaticOptions, VolumetricTreatment,
};
use grouser_geometry::{TireError, TireTread, Vec3};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error as _};
use std::time::{Duration, Instant};

/// Everything that a tread is made from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TreadSpec {
    /// Shape and mesh.
    pub tread: TireTread,
    /// Rubber of wall and lugs.
    pub rubber: Material,
    /// How it is computed.
    pub formulation: Formulation,
    /// Where its pressure comes from.
    pub volumetric: VolumetricTreatment,
    /// Inflation [Pa].
    pub inflation: f64,
}

/// Why a tread cannot be built.
#[derive(Debug, thiserror::Error)]
pub enum TreadError {
    /// Shape or mesh.
    #[error(transparent)]
    Tire(#[from] TireError),
    /// The solid.
    #[error(transparent)]
    Solid(#[from] SolidError),
    /// The inflated state.
    #[error(transparent)]
    Static(#[from] StaticError),
    /// The mirrored surface.
    #[error(transparent)]
    Mirror(#[from] MirrorError),
    /// Sub-steps longer than the stable one.
    #[error(
        "{sub_steps} sub-steps of {sub_step_s:.2e} s are unstable: element {element} allows {stable_s:.2e} s; expected at least \
         {least} sub-steps; usual cause: a finer tread or stiffer rubber than the sub-steps were chosen for; remedy: \
         `sub_steps: Auto`"
    )]
    Unstable {
        /// Sub-steps asked for.
        sub_steps: u32,
        /// Their length [s].
        sub_step_s: f64,
        /// Element that binds.
        element: u64,
        /// Stable step [s].
        stable_s: f64,
        /// Sub-steps needed.
        least: u32,
    },
}

/// Share of the stable step that `SubSteps::Auto` takes.
const SAFETY: f64 = 0.8;

/// The inflated tread; its surface's contacts with grains.
#[derive(Clone, Serialize, Deserialize)]
#[serde(bound = "L: Law")]
pub struct ElasticTire<L: Law> {
    tread: Tread,
    contacts: DeformingContacts<L::Memory>,
    sub_steps: u32,
    /// Work of the grains on the tread [J], and its power at the end of the last step [W].
    contact_work: [f64; 2],
    /// Time by the clock spent in the solid and in contacts since this process began.
    #[serde(skip)]
    spent: [Duration; 2],
}

/// The solid with what it was made from, so that a checkpoint can make it again.
pub struct Tread {
    /// What it was made from.
    pub spec: TreadSpec,
    /// The elastic solid.
    pub solid: Solid,
    rim: Vec<u32>,
    surface: Vec<u32>,
    /// Where the origin of the undeformed mesh was at the start [m].
    origin: Vec3,
}

impl Tread {
    fn build(spec: TreadSpec, origin: Vec3) -> Result<Self, SolidError> {
        let mut mesh = spec.tread.mesh().expect("shapes are checked before");
        // One rubber: the regions share it.
        let materials = vec![spec.rubber; mesh.region_names.len()];
        mesh.element_labels.clear();
        let rim = mesh.nodes_of("rim")?;
        let surface = mesh.nodes_of("outer")?;
        let settings =
            Settings { formulation: spec.formulation, volumetric: spec.volumetric, ..Settings::default() };
        let mut solid = Solid::new(mesh, materials, settings)?;
        solid.fix("rim")?;
        if spec.inflation != 0.0 {
            solid.inflate("inner", spec.inflation)?;
        }
        Ok(Self { spec, solid, rim, surface, origin })
    }

    /// Whether displacements lead from the frame of the rim.
    pub fn is_attached(&self) -> bool {
        self.spec.formulation == Formulation::BodyAttached
    }

    /// Carries the rim to `place` in a sub-step of `dt` [s] whose accelerations are `acceleration`.
    fn carry(&mut self, place: &Place, (linear, angular): (Vec3, f64), gravity: Vec3, dt: f64) {
        let mut pose = place.pose();
        if self.is_attached() {
            self.solid.state.frame = pose;
            self.solid.loads.gravity = gravity - linear;
            self.solid.loads.spin.angular_velocity = Vec3::y() * place.spin;
            self.solid.loads.spin.angular_acceleration = Vec3::y() * angular;
        } else {
            pose.translation.vector -= self.origin;
            self.solid.carry(&self.rim, &pose, dt);
        }
    }

    /// Place of a node in the world [m].
    pub fn place(&self, node: u32) -> Vec3 {
        let x = self.solid.position(node);
        if self.is_attached() {
            let frame = &self.solid.state.frame;
            frame.translation.vector + frame.rotation * x
        } else {
            self.origin + x
        }
    }

    /// Velocity of a node in the world [m/s]; `axle` is where the frame is.
    fn velocity(&self, node: u32, axle: &Place) -> Vec3 {
        let v = self.solid.state.velocity[node as usize];
        if self.is_attached() {
            let arm = self.place(node) - axle.position;
            axle.velocity + (Vec3::y() * axle.spin).cross(&arm) + self.solid.state.frame.rotation * v
        } else {
            v
        }
    }

    fn to_frame(&self, v: Vec3) -> Vec3 {
        if self.is_attached() { self.solid.state.frame.rotation.inverse() * v } else { v }
    }

    /// Force of the tread on the rim in the world [N].
    fn force_on_rim(&self) -> Vec3 {
        let sum: Vec3 = self.solid.state.reaction.iter().sum();
        if self.is_attached() { -(self.solid.state.frame.rotation * sum) } else { -sum }
    }

    /// Radius of the inflated tread [m].
    pub fn largest_radius(&self) -> f64 {
        let radius = |&n: &u32| {
            let x = self.solid.position(n);
            x.x.hypot(x.z)
        };
        self.surface.iter().map(radius).fold(0.0, f64::max)
    }
}

impl Clone for Tread {
    fn clone(&self) -> Self {
        let mut copy = Self::build(self.spec.clone(), self.origin).expect("it was built before");
        copy.solid.loads = self.solid.loads.clone();
        copy.solid.resume(self.solid.state.clone()).expect("the same mesh");
        copy
    }
}

impl Serialize for Tread {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        (&self.spec, &self.origin, &self.solid.loads, &self.solid.state).serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Tread {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let (spec, origin, loads, state): (TreadSpec, Vec3, grouser_fem::Loads, State) =
            Deserialize::deserialize(deserializer)?;
        let mut tread = Self::build(spec, origin).map_err(D::Error::custom)?;
        tread.solid.loads = loads;
        tread.solid.resume(state).map_err(D::Error::custom)?;
        Ok(tread)
    }
}

impl TreadSpec {
    /// The tread inflated at rest on a held rim, around the origin.
    ///
    /// # Errors
    /// [`TreadError`].
    pub fn inflated(&self) -> Result<Tread, TreadError> {
        self.tread.mesh()?;
        let mut tread = Tread::build(self.clone(), Vec3::zeros())?;
        let options =
            StaticOptions { solver: LinearSolver::SparseCholesky, load_steps: 4, ..StaticOptions::default() };
        tread.solid.solve_statics(&options)?;
        Ok(tread)
    }
}

impl<L: Law> ElasticTire<L> {
    /// The inflated `tread` with its axle at `at`, of row `material` of the material table, stepped `sub_steps` times in each step
    /// of `dt` [s] of the grains; `None` takes as few as are stable.
    ///
    /// # Errors
    /// [`TreadError::Unstable`], [`TreadError::Mirror`].
    pub fn new(
        mut tread: Tread,
        at: &Place,
        material: u32,
        margin: Margin,
        sub_steps: Option<u32>,
        dt: f64,
    ) -> Result<Self, TreadError> {
        let stable = tread.solid.stable_time_step();
        let least = (dt / stable.dt).ceil() as u32;
        let sub_steps = sub_steps.unwrap_or((dt / (SAFETY * stable.dt)).ceil() as u32).max(1);
        if sub_steps < least {
            return Err(TreadError::Unstable {
                sub_steps,
                sub_step_s: dt / f64::from(sub_steps),
                element: stable.element,
                stable_s: stable.dt,
                least,
            });
        }
        tread.origin = at.position;
        if tread.is_attached() {
            tread.solid.state.frame = at.pose();
        } else {
            tread.solid.state.velocity.fill(at.velocity);
        }
        let facets = tread.solid.mesh().facets("outer").expect("treads have an outer surface");
        let faces: Vec<Vec<u32>> = facets.iter().map(|&f| tread.solid.mesh().facet_nodes(f)).collect();
        let mirror = Mirror::new(&faces, 2)?;
        let is_held = |n: u32| tread.rim.binary_search(&n).is_ok();
        let mass = |n: u32| if is_held(n) { f64::INFINITY } else { tread.solid.nodal_mass()[n as usize] };
        let contacts =
            DeformingContacts::new(mirror, |n| tread.place(n), material, margin).with_nodal_masses(mass);
        Ok(Self { tread, contacts, sub_steps, contact_work: [0.0; 2], spent: [Duration::ZERO; 2] })
    }

    /// One coupled step of `dt` [s]: P0 Fig. 8, where the bed has moved its grains to the end of the step.
    ///
    /// # Errors
    /// When an element turns inside out or the motion grows out of nothing.
    pub fn coupled_step(
        &mut self,
        axle: &mut Axle,
        grains: &mut Grains<L::Precision>,
        (law, table): (&L, &PairTable<RealOf<L>>),
        gravity: Vec3,
        dt: f64,
        traction: &mut Traction,
    ) -> Result<(), DynamicsError> {
        let (n, h, begun) = (self.sub_steps, dt / f64::from(self.sub_steps), Instant::now());
        // C2. The axle moves and carries the rim.
        axle.predict(dt);
        let share = |k: u32| axle.at(f64::from(k) / f64::from(n));
        // C3. The solid follows in n sub-steps, all but the last one without contacts.
        self.tread.solid.state.applied.fill(Vec3::zeros());
        for k in 1..n {
            self.tread.carry(&share(k), axle.accelerations(), gravity, h);
            self.tread.solid.step(h)?;
        }
        self.tread.carry(&share(n), axle.accelerations(), gravity, h);
        self.tread.solid.advance_positions(h)?;
        let solid_done = Instant::now();
        // C4. Its displaced surface is mirrored.
        let (tread, place) = (&self.tread, axle.now());
        self.contacts.follow(|node| tread.place(node), |node| tread.velocity(node, place));
        // C5. Pairs, and the forces between them; the grains receive theirs.
        let step = Step { law, table, time_step: dt, fastest: grains.fastest() };
        let Grains { spheres, ids, loads, .. } = grains;
        self.contacts.forces((spheres, ids), loads, &step, |seen| traction.add(&seen, &place.position));
        // C6. The nodes receive theirs, as the impulse of the whole step at its end.
        let mut applied = std::mem::take(&mut self.tread.solid.state.applied);
        self.contacts
            .spread(|node, force| applied[node as usize] += self.tread.to_frame(force) * f64::from(n));
        self.tread.solid.state.applied = applied;
        let contacts_done = Instant::now();
        // C7. The solid's accelerations and velocities at the end of the step.
        self.tread.solid.advance_velocities(h)?;
        // C8. The axle receives what the rim bears.
        axle.receive(self.tread.force_on_rim().z, traction.last().z);
        self.count_work(axle.now(), dt);
        self.spent[0] += (solid_done - begun) + contacts_done.elapsed();
        self.spent[1] += contacts_done - solid_done;
        Ok(())
    }

    /// Work of the grains on the tread: mean of the powers at both ends of the step.
    fn count_work(&mut self, place: &Place, dt: f64) {
        let mut power = 0.0;
        let tread = &self.tread;
        self.contacts.spread(|node, force| power += force.dot(&tread.velocity(node, place)));
        let [work, before] = &mut self.contact_work;
        *work += 0.5 * (*before + power) * dt;
        *before = power;
    }

    /// The tread.
    pub fn tread(&self) -> &Tread {
        &self.tread
    }

    /// Contacts of the tread.
    pub fn contacts(&self) -> &DeformingContacts<L::Memory> {
        &self.contacts
    }

    /// The deepest contact of the last step.
    pub fn deepest(&self) -> Option<Deepest> {
        self.contacts.deepest()
    }

    /// Energy of the tread's contacts since the beginning.
    pub fn contact_ledger(&self) -> &ContactLedger {
        self.contacts.ledger()
    }

    /// Work of the grains on the tread since the beginning [J], and its power now [W].
    pub fn contact_work(&self) -> [f64; 2] {
        self.contact_work
    }

    /// Sub-steps of the solid in each step.
    pub fn sub_steps(&self) -> u32 {
        self.sub_steps
    }

    /// Time by the clock spent in the solid and in contacts.
    pub fn spent(&self) -> [Duration; 2] {
        self.spent
    }
}
