//! An elastic tread on its rim among grains: the coupled step of P0 Fig. 8, numbered as in `docs/theory/coupling.md`.

use super::axle::{Axle, Place};
use super::body::StepInput;
use super::traction::Traction;
use super::tread::{Tread, TreadError};
use crate::run::Law;
use grouser_coupling::{DeformingContacts, Margin, Mirror, Step};
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
    /// Contact forces on the nodes in the last step, as impulses at its end [N].
    #[serde(skip)]
    impulsive: Vec<Vec3>,
    /// Work of the grains on the tread [J], and its power at the end of the last step [W].
    contact_work: [f64; 2],
    /// Time by the clock spent in the solid and in contacts since this process began.
    #[serde(skip)]
    spent: [Duration; 2],
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
        Ok(Self {
            tread,
            contacts,
            sub_steps,
            impulsive: Vec::new(),
            contact_work: [0.0; 2],
            spent: [Duration::ZERO; 2],
        })
    }

    /// One coupled step of `dt` [s]: P0 Fig. 8, where the bed has moved its grains to the end of the step.
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
        let (n, h, begun) = (self.sub_steps, dt / f64::from(self.sub_steps), Instant::now());
        // C2. The axle moves and carries the rim.
        axle.predict(dt);
        let share = |k: u32| axle.at(f64::from(k) / f64::from(n));
        // C3. The solid follows in n sub-steps, all but the last one without contacts.
        self.impulsive.clone_from(&self.tread.solid.state.applied);
        self.tread.solid.state.applied.fill(Vec3::zeros());
        if n == 1 {
            // The accelerations hold the contacts' share already.
            self.impulsive.fill(Vec3::zeros());
        }
        for k in 1..n {
            self.tread.carry(&share(k), axle.accelerations(), gravity, h);
            self.tread.solid.step(h)?;
        }
        self.tread.carry(&share(n), axle.accelerations(), gravity, h);
        self.tread.solid.advance_positions(h)?;
        let solid_done = Instant::now();
        // C4. Its displaced surface is mirrored.
        let (tread, place) = (&self.tread, axle.now());
        let ahead = |node| tread.velocity_ahead(node, place, 0.5 * h, &self.impulsive);
        self.contacts.follow(|node| tread.place(node), ahead);
        // C5. Pairs, and the forces between them; the grains receive theirs.
        let step = Step { law, table, time_step: dt, fastest: grains.fastest() };
        let Grains { spheres, ids, loads, orientations, .. } = grains;
        let grains = (&spheres[..], &ids[..], orientations.as_deref());
        self.contacts.forces_on_turned(grains, loads, &step, |seen| traction.add(&seen, &place.position));
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
