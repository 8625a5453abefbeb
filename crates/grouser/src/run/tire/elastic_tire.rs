//! An elastic tread on its rim among grains, in the coupled step of `docs/theory/coupling.md`.

use super::axle::{Axle, Place};
use super::body::StepInput;
use super::traction::Traction;
use super::tread::{Tread, TreadError};
use crate::run::Law;
use grouser_coupling::{DeformingContacts, Margin, Mirror, MovedGrains, Step, SteppedSolid, coupled_step};
use grouser_dem::Grains;
use grouser_fem::DynamicsError;
use grouser_geometry::Vec3;
use serde::{Deserialize, Serialize};
use std::time::{Duration, Instant};

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

/// The tread on its axle within a step.
struct Carried<'a> {
    tread: &'a mut Tread,
    axle: &'a Axle,
    gravity: Vec3,
    /// Time by the clock spent in the solid.
    spent: Duration,
}

impl Carried<'_> {
    fn timed<T>(&mut self, work: impl FnOnce(&mut Tread) -> T) -> T {
        let begun = Instant::now();
        let result = work(self.tread);
        self.spent += begun.elapsed();
        result
    }
}

impl SteppedSolid for Carried<'_> {
    type Error = DynamicsError;

    fn carry(&mut self, share: f64, h: f64) {
        let (place, accelerations, gravity) = (self.axle.at(share), self.axle.accelerations(), self.gravity);
        self.timed(|tread| tread.carry(&place, accelerations, gravity, h));
    }
    fn advance_positions(&mut self, h: f64) -> Result<(), DynamicsError> {
        self.timed(|tread| tread.solid.advance_positions(h))
    }
    fn advance_velocities(&mut self, h: f64) -> Result<(), DynamicsError> {
        self.timed(|tread| tread.solid.advance_velocities(h))
    }
    fn place(&self, node: u32) -> Vec3 {
        self.tread.place(node)
    }
    fn clear_forces(&mut self) {
        self.tread.solid.state.applied.fill(Vec3::zeros());
    }
    fn add_force(&mut self, node: u32, force: Vec3) {
        let in_frame = self.tread.to_frame(force);
        self.tread.solid.state.applied[node as usize] += in_frame;
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
        let mut contacts = DeformingContacts::new(mirror, |n| tread.place(n), material, margin);
        if let Some(spread) = tread.spec.spread() {
            contacts = contacts.with_spread(spread, |n| tread.solid.mesh().nodes[n as usize]);
        }
        let contacts = contacts.with_nodal_masses(mass);
        Ok(Self { tread, contacts, sub_steps, contact_work: [0.0; 2], spent: [Duration::ZERO; 2] })
    }

    /// One coupled step of `dt` [s]; the bed has moved its grains to its end.
    ///
    /// # Errors
    /// When an element turns inside out or the motion grows out of nothing.
    pub fn coupled_step(
        &mut self,
        axle: &mut Axle,
        grains: &mut Grains<L::Precision>,
        StepInput { law, table, gravity, dt, .. }: StepInput<L>,
        traction: &mut Traction,
    ) -> Result<(), DynamicsError> {
        let begun = Instant::now();
        axle.predict(dt);
        let step = Step { law, table, time_step: dt, fastest: grains.fastest() };
        let Grains { spheres, ids, loads, orientations, .. } = grains;
        let moved = MovedGrains { spheres, ids, loads, orientations: orientations.as_deref() };
        let mut carried = Carried { tread: &mut self.tread, axle, gravity, spent: Duration::ZERO };
        let centre = axle.now().position;
        coupled_step(&mut carried, &mut self.contacts, moved, &step, self.sub_steps, |seen| {
            traction.add(&seen, &centre);
        })?;
        let of_solid = carried.spent;
        // C8. The axle receives what the rim bears.
        axle.receive(self.tread.force_on_rim().z, traction.last().z);
        self.count_work(axle.now(), dt);
        self.spent[0] += of_solid;
        self.spent[1] += begun.elapsed() - of_solid;
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
