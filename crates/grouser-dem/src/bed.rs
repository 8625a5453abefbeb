//! A bed of grains: everything that one step needs, and the step.

use crate::active_zone::Zone;
use crate::force_pass::{InstructionSet, PassInput};
use crate::integrate::{Integrator, Motion, Pace, Stages, Turning};
use crate::neighbours::Neighbours;
use crate::shared_grains::SharedGrains;
use crate::sleepers::places;
use crate::sweep::{is_shared, sweep};
use crate::{BedEnergy, BedError, Domain, Failure, Grains, Plane, Rotation};
use grouser_contact::{
    ContactLaw, ContactLedger, F64, Frame, PairTable, ParameterError, Precision, Real, RotationLaw, Sphere,
    Vector,
};
use grouser_geometry::Vec3;
use serde::{Deserialize, Serialize};

/// Overlap over the smaller radius beyond which a run is given up, unless [`Bed::set_largest_overlap`] says otherwise.
pub const LARGEST_OVERLAP: f64 = 0.3;

/// What a bed is made of beside its grains.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BedSettings {
    /// The box.
    pub domain: Domain,
    /// Floors and side walls.
    pub planes: Vec<Plane>,
    /// Acceleration of gravity [m/s²].
    pub gravity: Vec3,
    /// What the rotation of grains is allowed to do.
    pub rotation: Rotation,
    /// Keep the energy ledger up to date at every step.
    pub has_ledger: bool,
}

/// Grains, their neighbours and the law between them.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound(serialize = "L: ContactLaw<P::Real>", deserialize = "L: ContactLaw<P::Real>"))]
pub struct Bed<L: ContactLaw<P::Real>, P: Precision = F64> {
    pub(crate) grains: Grains<P>,
    pub(crate) settings: BedSettings,
    pub(crate) table: PairTable<P::Real>,
    pub(crate) neighbours: Neighbours<P, L::Memory>,
    ledger: ContactLedger,
    is_too_deep: bool,
    pub(crate) law: L,
    pub(crate) zone: Option<Box<Zone<L::Memory>>>,
    /// Coefficient of the damping of absolute velocities [N·s/m], and what it has taken so far [J].
    background: [f64; 2],
    pub(crate) largest_overlap: f64,
    integrator: Integrator,
    #[serde(skip, default = "InstructionSet::detect")]
    pub(crate) set: InstructionSet,
}

impl<L: ContactLaw<P::Real>, P: Precision> Bed<L, P> {
    /// Bed of `spheres`, numbered in the order given.
    ///
    /// # Errors
    /// When there are no grains, a sphere is not finite or has no mass or radius, or a period is shorter than five
    /// grains.
    pub fn new(
        spheres: Vec<Sphere<P>>,
        settings: BedSettings,
        table: PairTable<P::Real>,
        law: L,
    ) -> Result<Self, BedError> {
        BedError::check(&spheres, &settings, table.n_materials())?;
        let mut grains = Grains::new(spheres);
        grains.inertia_ratios = law.rotation().inertia_ratios();
        if <L::Rotation as RotationLaw<P::Real>>::Frame::IS_TRACKED {
            grains.track_orientations();
        }
        let neighbours = Neighbours::new(&grains);
        let ledger = ContactLedger::default();
        let set = InstructionSet::detect();
        Ok(Self {
            grains,
            settings,
            table,
            neighbours,
            ledger,
            is_too_deep: false,
            law,
            zone: None,
            background: [0.0; 2],
            largest_overlap: LARGEST_OVERLAP,
            integrator: Integrator::default(),
            set,
        })
    }

    /// One step of `time_step` [s] without tools.
    ///
    /// # Errors
    /// When the motion has become meaningless.
    pub fn step(&mut self, time_step: f64) -> Result<(), Failure> {
        self.run(1, time_step, |_| Ok(()))
    }

    /// `n_steps` steps of `time_step` [s]; before the contacts of each one `tool_forces` adds the loads of tools.
    /// The same bytes as that many single steps, in less time: grains are corrected and predicted in one go.
    ///
    /// # Errors
    /// When the motion has become meaningless, or with the error of `tool_forces`.
    pub fn run<E: From<Failure> + Send>(
        &mut self,
        n_steps: u64,
        time_step: f64,
        tool_forces: impl FnMut(&mut Grains<P>) -> Result<(), E> + Send,
    ) -> Result<(), E> {
        if n_steps == 0 {
            return Ok(());
        }
        if is_shared(self.grains.len()) {
            // One of the pool's own threads goes through all steps: entering the pool from outside, which puts this thread
            // to sleep and wakes another, would cost tens of microseconds each step.
            rayon::scope(|_| self.run_here(n_steps, time_step, tool_forces))
        } else {
            self.run_here(n_steps, time_step, tool_forces)
        }
    }

    fn run_here<E: From<Failure>>(
        &mut self,
        n_steps: u64,
        time_step: f64,
        mut tool_forces: impl FnMut(&mut Grains<P>) -> Result<(), E>,
    ) -> Result<(), E> {
        self.predict(time_step)?;
        for step in 1..=n_steps {
            tool_forces(&mut self.grains)?;
            if step < n_steps {
                self.contact_forces_and_advance(time_step)?;
            } else {
                self.contact_forces(time_step);
                self.correct(time_step);
            }
        }
        Ok(())
    }

    /// Moves the grains to the end of the step and renews the lists where needed. Loads are zero afterwards.
    ///
    /// # Errors
    /// When a grain is not finite, overlaps too far, or left the box.
    pub fn predict(&mut self, time_step: f64) -> Result<(), Failure> {
        let motion = self.motion(time_step, Stages::None);
        let mut pace = Pace::STILL;
        for range in self.moving() {
            pace = pace.and(motion.predict_all(&mut self.grains, range, self.set));
        }
        self.look_after(pace, time_step)
    }

    /// Adds the forces among grains and of planes.
    pub fn contact_forces(&mut self, time_step: f64) {
        self.sweep(time_step, Stages::None);
    }

    /// Corrects the velocities with all loads added by now.
    pub fn correct(&mut self, time_step: f64) {
        let motion = self.motion(time_step, Stages::None);
        for range in self.moving() {
            motion.correct_all(&mut self.grains, range, self.set);
        }
    }

    /// Ranges of grains that move: all of them, unless an active zone holds some.
    fn moving(&self) -> Vec<std::ops::Range<usize>> {
        let everybody = || std::iter::once(0..self.grains.len()).collect();
        self.zone.as_ref().map_or_else(everybody, |zone| zone.moving().collect())
    }

    /// [`Bed::contact_forces`], [`Bed::correct`] and [`Bed::predict`] in one sweep, for grains that are still in the cache.
    /// Loads of tools must have been added before.
    ///
    /// # Errors
    /// As [`Bed::predict`].
    pub fn contact_forces_and_advance(&mut self, time_step: f64) -> Result<(), Failure> {
        let pace = self.sweep(time_step, Stages::CorrectAndPredict);
        self.look_after(pace, time_step)
    }

    fn motion(&self, time_step: f64, stages: Stages) -> Motion<P::Real> {
        Motion::new(
            time_step,
            self.settings.gravity,
            self.settings.rotation,
            stages,
            Turning::new(self.grains.inertia_ratios),
            self.integrator,
        )
    }

    fn sweep(&mut self, time_step: f64, stages: Stages) -> Pace {
        let motion = self.motion(time_step, stages);
        let input = PassInput {
            grains: SharedGrains::new(&mut self.grains),
            shifts: self.settings.domain.period().shifts(),
            law: self.law,
            table: &self.table,
            time_step: P::Real::from_f64(time_step),
            has_ledger: self.settings.has_ledger,
            largest_overlap: P::Real::from_f64(self.largest_overlap),
            set: self.set,
        };
        let Neighbours { slabs, is_ring, large, .. } = &mut self.neighbours;
        // Pairs of large grains first: the last sweep moves the grains.
        let stays = Motion { stages: Stages::None, ..motion };
        for level in large.iter_mut().rev() {
            sweep(&mut level.slabs, level.is_ring, &[], &input, &stays, None);
        }
        let runs = self.zone.as_ref().map(|zone| &zone.runs[..]);
        let pace = sweep(slabs, *is_ring, &self.settings.planes, &input, &motion, runs);
        let mut pass = self.zone.as_ref().map_or_else(ContactLedger::default, |zone| zone.elastic);
        self.is_too_deep = false;
        for slab in self.neighbours.all_slabs() {
            pass += slab.sums.ledger;
            self.is_too_deep |= slab.sums.is_too_deep;
        }
        if self.settings.has_ledger {
            self.ledger.record(&pass);
        }
        pace
    }

    /// What a predictor leaves to be done: the health of the motion, the lists, and background damping.
    fn look_after(&mut self, pace: Pace, time_step: f64) -> Result<(), Failure> {
        if !pace.is_finite {
            return Err(self.first_non_finite());
        }
        if self.is_too_deep {
            let (grain, position, depth) = self.deepest_overlap();
            return Err(Failure::OverlapTooLarge { grain, position, depth });
        }
        self.grains.fastest = pace.fastest_squared.sqrt();
        let travel = self.grains.fastest * time_step * self.integrator.reach();
        let has_changed = self.zone.as_mut().is_some_and(|zone| {
            zone.look(&mut self.grains, time_step, self.settings.gravity.norm());
            zone.has_changed
        });
        if has_changed || self.neighbours.are_too_old(&self.grains, &self.settings.domain, travel, time_step)
        {
            self.renew_lists()?;
        }
        self.damp_background(time_step);
        Ok(())
    }

    /// Damps the absolute velocity of every grain with `coefficient` k_h [N·s/m], as P1 does for stability; zero is off.
    pub fn set_background_damping(&mut self, coefficient: f64) {
        self.background[0] = coefficient;
    }

    /// Overlap over the smaller radius beyond which the run is given up [-]; [`LARGEST_OVERLAP`] by default.
    pub fn set_largest_overlap(&mut self, ratio: f64) {
        self.largest_overlap = ratio;
    }

    fn damp_background(&mut self, time_step: f64) {
        let [coefficient, taken] = &mut self.background;
        if *coefficient == 0.0 {
            return;
        }
        let n_listed = self.zone.as_ref().map_or(self.grains.len(), |zone| zone.n_listed());
        for (sphere, load) in self.grains.spheres[..n_listed].iter().zip(&mut self.grains.loads) {
            load.force -= sphere.velocity * P::Real::from_f64(*coefficient);
            *taken += *coefficient * sphere.velocity.norm_squared().to_f64() * time_step;
        }
    }

    /// The grains.
    pub fn grains(&self) -> &Grains<P> {
        &self.grains
    }

    /// The grains, for tools that add loads or for setting initial velocities. Changing positions or the order of
    /// grains needs [`Bed::renew_lists`] afterwards.
    pub fn grains_mut(&mut self) -> &mut Grains<P> {
        &mut self.grains
    }

    /// The contact law.
    pub fn law(&self) -> &L {
        &self.law
    }

    /// Box, planes, gravity and switches.
    pub fn settings(&self) -> &BedSettings {
        &self.settings
    }

    /// Constants of every pair of materials.
    pub fn pair_table(&self) -> &PairTable<P::Real> {
        &self.table
    }

    /// Grains go on by `integrator` from now on; Verlet's scheme is the default.
    ///
    /// # Errors
    /// When a share is outside the range in which Newmark's scheme is stable.
    pub fn set_integrator(&mut self, integrator: Integrator) -> Result<(), ParameterError> {
        integrator.validate()?;
        self.integrator = integrator;
        Ok(())
    }

    /// Replaces the constants of every pair of materials; what contacts remember stays.
    ///
    /// # Errors
    /// When a grain's material has no row.
    pub fn set_pair_table(&mut self, table: PairTable<P::Real>) -> Result<(), BedError> {
        BedError::check(&self.grains.spheres, &self.settings, table.n_materials())?;
        self.table = table;
        Ok(())
    }

    /// Grains turn, or are held, from now on; held ones lose their spin.
    pub fn set_rotation(&mut self, rotation: Rotation) {
        self.settings.rotation = rotation;
        if rotation == Rotation::Fixed {
            for (sphere, accelerations) in self.grains.spheres.iter_mut().zip(&mut self.grains.accelerations)
            {
                sphere.spin = Vector::ZERO;
                accelerations[1] = Vector::ZERO;
            }
        }
    }

    /// Turns the ledger on or off; turned on, it begins with nothing spent and with what the contacts store by now.
    pub fn keep_ledger(&mut self, has_ledger: bool) {
        self.settings.has_ledger = has_ledger;
        // A pass over no time on a copy finds the stored energy and changes nothing here.
        let mut copy = self.clone();
        if has_ledger {
            copy.contact_forces(0.0);
        }
        self.ledger = copy.ledger.restarted();
    }

    /// Computes contacts with `set` instead of the widest instruction set of this machine; the bytes stay the same.
    pub fn use_instruction_set(&mut self, set: InstructionSet) {
        self.set = set;
    }

    /// Number of touching pairs of grains at the last force pass.
    pub fn n_contacts(&self) -> usize {
        let listed: usize = self.neighbours.all_slabs().map(|slab| slab.n_touching()).sum();
        listed + self.zone.as_ref().map_or(0, |zone| zone.sleepers.n_contacts())
    }

    /// Touching pairs of the last force pass, as places in [`Grains::spheres`].
    pub fn contacts(&self) -> impl Iterator<Item = [u32; 2]> {
        let place = self.zone.as_ref().map(|_| places(&self.grains.ids));
        let asleep = self.zone.iter().flat_map(move |zone| {
            let place = place.clone().unwrap_or_default();
            zone.sleepers.contacts().map(move |pair| pair.map(|id| place[id as usize]))
        });
        let listed = self.neighbours.all_slabs().flat_map(|slab| {
            slab.pairs
                .iter()
                .enumerate()
                .filter(|(place, _)| slab.has_touched(*place))
                .map(|(_, pair)| pair.grains())
        });
        listed.chain(asleep)
    }

    /// Number of listed pairs, touching or near.
    pub fn n_listed(&self) -> usize {
        self.neighbours.all_slabs().map(|slab| slab.pairs.len()).sum()
    }

    /// How often the lists were made.
    pub fn n_rebuilds(&self) -> u64 {
        self.neighbours.n_rebuilds
    }

    /// Mean gap up to which a pair is listed now [m].
    pub fn skin(&self) -> f64 {
        self.neighbours.skin()
    }

    /// Memory held by grains and lists [bytes].
    pub fn bytes(&self) -> usize {
        let per_grain = size_of::<Sphere<P>>() + 16 * size_of::<P::Real>() + 4;
        let of_zone = self.zone.as_ref().map_or(0, |zone| zone.bytes());
        self.grains.len() * per_grain + self.neighbours.bytes() + of_zone
    }

    /// Force of the grains on plane `plane` at the last force pass [N].
    pub fn plane_force(&self, plane: usize) -> Vec3 {
        let lists = self.neighbours.slabs.iter().filter_map(|slab| slab.planes.get(plane));
        let asleep = self.zone.iter().filter_map(|zone| zone.plane_forces.get(plane)).sum::<Vec3>();
        lists.map(|list| list.force).sum::<Vec3>() + asleep
    }

    /// Energies at this instant; contact terms are zero without a ledger.
    pub fn energy(&self) -> BedEnergy {
        let [kinetic, rotational] = self.grains.kinetic_energy();
        let mut gravitational = 0.0;
        for sphere in &self.grains.spheres {
            let height = crate::cell_grid::to_f64(sphere).dot(&self.settings.gravity);
            gravitational -= sphere.mass.to_f64() * height;
        }
        BedEnergy {
            kinetic,
            rotational,
            gravitational,
            contacts: self.ledger,
            background_damping: self.background[1],
            fallen_asleep: self.zone.as_ref().map_or(0.0, |zone| zone.account.energy_taken),
        }
    }

    /// Sorts the grains and makes the lists anew.
    ///
    /// # Errors
    /// When a grain is not finite or has left the box.
    pub fn renew_lists(&mut self) -> Result<(), Failure> {
        let (grains, domain) = (&mut self.grains, &self.settings.domain);
        let n_listed = self.zone.as_ref().map_or(grains.len(), |zone| zone.n_listed());
        grains.wrap(domain, n_listed);
        for (sphere, &grain) in grains.spheres[..n_listed].iter().zip(&grains.ids) {
            if !sphere.is_finite() {
                return Err(Failure::NonFinite { grain });
            }
            let position = crate::cell_grid::to_f64(sphere);
            if domain.has_lost(position, 2.0 * grains.largest_radius) {
                return Err(Failure::Lost { grain, position });
            }
        }
        // Grains that are about to fall asleep come into no sleeping block.
        if let Some(zone) = self.zone.as_mut().filter(|zone| !zone.has_changed) {
            zone.wake_where_grains_came(grains);
        }
        let has_changed = self.zone.as_ref().is_some_and(|zone| zone.has_changed);
        self.neighbours.rebuild(grains, domain, &self.settings.planes, self.zone.as_deref_mut());
        if has_changed {
            self.weigh_sleepers();
        }
        Ok(())
    }

    fn first_non_finite(&self) -> Failure {
        let bad = self.grains.spheres.iter().position(|sphere| !sphere.is_finite());
        Failure::NonFinite { grain: self.grains.ids[bad.unwrap_or(0)] }
    }

    /// The grain with the largest overlap over the smaller radius: its permanent number, place [m], and that ratio [-].
    pub fn deepest_overlap(&self) -> (u32, Vec3, f64) {
        let (spheres, period) = (&self.grains.spheres, self.settings.domain.period::<P::Coordinate>());
        let of_pairs = self.contacts().map(|[i, j]| {
            let (a, b) = (&spheres[i as usize], &spheres[j as usize]);
            let distance = period.nearest(a.position - b.position).0.norm();
            (i as usize, ((a.radius + b.radius - distance) / a.radius.min(b.radius)).to_f64())
        });
        let of_planes = spheres.iter().enumerate().flat_map(|(index, sphere)| {
            let height = |plane: &Plane| plane.height(crate::cell_grid::to_f64(sphere));
            let planes = self.settings.planes.iter();
            planes.map(move |plane| (index, 1.0 - height(plane) / sphere.radius.to_f64()))
        });
        let (index, depth) = of_pairs
            .chain(of_planes)
            .fold((0, 0.0), |worst, next| if next.1 > worst.1 { next } else { worst });
        (self.grains.ids[index], crate::cell_grid::to_f64(&spheres[index]), depth)
    }
}
