//! Explicit central differences (P0 Eq. 32) as velocity Verlet; numbers of `docs/theory/elastic_solids.md`.

use grouser_geometry::Vec3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::element_state::ElementStates;
use crate::internal_force::Viscosity;
use crate::material::Formulation;
use crate::node_pass::NodePass;
use crate::solid::{Solid, State, Support};

/// Steps between two looks at the energy.
const WATCH_INTERVAL: u64 = 64;
/// Steps between two looks for inverted elements where the forces come from an assembled stiffness, which does not see them; a look
/// costs about two steps.
const INVERSION_INTERVAL: u64 = 256;

/// Work and dissipation since the first step [J], by the trapezoidal rule.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Ledger {
    /// Kinetic plus strain energy at the first step.
    pub initial: f64,
    /// Work of gravity, pressures, applied forces and the forces of a turning frame.
    pub external_work: f64,
    /// Work of the supports, also on the held nodes themselves.
    pub support_work: f64,
    /// Dissipated by damping proportional to mass.
    pub mass_damping: f64,
    /// Dissipated by damping proportional to stiffness.
    pub stiffness_damping: f64,
    /// Sum of the magnitudes of all work: what the energy is held against.
    pub throughput: f64,
    /// Power of the external forces at the end of the last step [W].
    pub external_power: f64,
    /// Power that damping takes at the end of the last step, by mass and by stiffness [W].
    pub damping_power: [f64; 2],
}

impl Ledger {
    /// Energy that should be there: what was at the start plus work minus dissipation [J].
    pub fn expected_energy(&self) -> f64 {
        self.initial + self.external_work + self.support_work - self.mass_damping - self.stiffness_damping
    }
}

/// Why a step failed; the state is then useless, return to a checkpoint.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DynamicsError {
    /// An element turned inside out.
    #[error(
        "element {element} is inverted (volume ratio {volume_ratio:.3}) at t = {time:.6e} s, step {step}: usual causes are a step beyond the stable one, a load that is too sudden, or a mesh too coarse for the deformation"
    )]
    InvertedElement {
        /// Number of the element.
        element: u64,
        /// Its volume ratio J.
        volume_ratio: f64,
        /// Time [s].
        time: f64,
        /// Step.
        step: u64,
    },
    /// A checkpoint belongs to another solid.
    #[error(
        "the checkpoint holds {found} nodes, but this solid has {expected}: it was written by another scene or mesh; resume with the scene beside the checkpoint"
    )]
    OtherSolid {
        /// Nodes of the checkpoint.
        found: usize,
        /// Nodes of the solid.
        expected: usize,
    },
    /// The kinetic energy grows out of nothing.
    #[error(
        "the step of {dt:.3e} s is unstable: kinetic energy {kinetic:.3e} J exceeds all work ever done, {budget:.3e} J, at t = {time:.6e} s, step {step}; take at most stable_time_step(), 0.9 of it for safety"
    )]
    UnstableStep {
        /// Step length [s].
        dt: f64,
        /// Kinetic energy [J].
        kinetic: f64,
        /// Energy and work that could explain it [J].
        budget: f64,
        /// Time [s].
        time: f64,
        /// Step.
        step: u64,
    },
}

impl Solid {
    /// One step of `dt` [s].
    ///
    /// # Errors
    /// [`DynamicsError`].
    pub fn step(&mut self, dt: f64) -> Result<(), DynamicsError> {
        self.advance_positions(dt)?;
        self.advance_velocities(dt)
    }

    /// Steps 1 and 2: half of the velocity change, then the displacements at t + dt. Contacts may be evaluated after it.
    ///
    /// # Errors
    /// [`DynamicsError::InvertedElement`] at the very first step, which computes the accelerations it starts from.
    pub fn advance_positions(&mut self, dt: f64) -> Result<(), DynamicsError> {
        if !self.is_started {
            self.start()?;
        }
        let is_parallel = self.elements.is_worth_threads();
        let State { displacement, velocity, acceleration, supports, .. } = &mut self.state;
        let drift = |((u, v), a): ((&mut Vec3, &mut Vec3), &Vec3)| {
            // 1. v(n+1/2) = v(n) + dt/2 a(n)
            *v += a * (0.5 * dt);
            // 2. u(n+1) = u(n) + dt v(n+1/2)
            *u += *v * dt;
        };
        if is_parallel {
            let nodes = displacement.par_iter_mut().zip(velocity.par_iter_mut()).zip(acceleration.par_iter());
            nodes.with_min_len(4096).for_each(drift);
        } else {
            displacement.iter_mut().zip(velocity.iter_mut()).zip(acceleration.iter()).for_each(drift);
        }
        let mut work = 0.0;
        for (&node, support) in supports.iter_mut() {
            let n = node as usize;
            for c in (0..3).filter(|&c| support.held[c]) {
                // What the support spends on the held node itself.
                let (before, after) = (velocity[n][c], support.velocity[c]);
                work += 0.5 * self.nodal_mass[n] * (after * after - before * before);
                support.displacement[c] += support.velocity[c] * dt;
                displacement[n][c] = support.displacement[c];
                velocity[n][c] = support.velocity[c];
            }
        }
        self.state.ledger.support_work += work;
        self.state.ledger.throughput += work.abs();
        self.state.time += dt;
        self.state.steps += 1;
        Ok(())
    }

    /// Steps 3 to 8: forces at t + dt, accelerations, second half of the velocity change, ledger and watch.
    ///
    /// # Errors
    /// [`DynamicsError`].
    pub fn advance_velocities(&mut self, dt: f64) -> Result<(), DynamicsError> {
        let before = self.accelerate(0.5 * dt)?;
        // 8. Work of this step: half of it with the forces and velocities at its start, half with those at its end.
        let State { ledger, supports, reaction, .. } = &mut self.state;
        let mean = |start: f64, end: f64| 0.5 * (start + end) * dt;
        let work = mean(before.external_power, ledger.external_power);
        let work_of =
            |((r, support), old): ((&Vec3, &Support), &Vec3)| 0.5 * dt * (r + old).dot(&support.velocity);
        let support_work: f64 =
            reaction.iter().zip(supports.values()).zip(&self.last_reaction).map(work_of).sum();
        ledger.external_work += work;
        ledger.support_work += support_work;
        ledger.throughput += work.abs() + support_work.abs();
        ledger.mass_damping += mean(before.damping_power[0], ledger.damping_power[0]);
        ledger.stiffness_damping += mean(before.damping_power[1], ledger.damping_power[1]);
        if self.state.steps.is_multiple_of(WATCH_INTERVAL) { self.watch(dt) } else { Ok(()) }
    }

    /// Steps 3 to 7; returns the ledger as it was before.
    fn accelerate(&mut self, half_step: f64) -> Result<Ledger, DynamicsError> {
        let before = self.state.ledger;
        // 3. to 5. Forces of the elements.
        let beta = self.settings.stiffness_damping;
        let viscosity = (beta > 0.0).then_some(Viscosity { velocity: &self.state.velocity, beta });
        let displacement = &self.state.displacement;
        let mut forces = self.elements.update(displacement, viscosity);
        if self.state.steps.is_multiple_of(INVERSION_INTERVAL) {
            forces = forces.and_then(|power| self.elements.refuse_inversion(displacement).map(|()| power));
        }
        let viscous_power = forces.map_err(|i| DynamicsError::InvertedElement {
            element: self.mesh.element_label(i.element),
            volume_ratio: i.volume_ratio,
            time: self.state.time,
            step: self.state.steps,
        })?;
        let mut distributed = std::mem::take(&mut self.force);
        let has_distributed = !self.loads.pressures.is_empty() || self.loads.spin.is_turning();
        if has_distributed {
            distributed.resize(self.mesh.nodes.len(), Vec3::zeros());
            distributed.fill(Vec3::zeros());
            self.add_distributed_forces(1.0, &mut distributed);
        }
        let is_attached = self.settings.formulation == Formulation::BodyAttached;
        let State { velocity, acceleration, applied, supports, reaction, frame, .. } = &mut self.state;
        let gravity = self.loads.gravity;
        let pass = NodePass {
            internal: self.elements.node_forces(),
            applied,
            distributed: has_distributed.then_some(&distributed[..]),
            nodal_mass: &self.nodal_mass,
            gravity: if is_attached { frame.rotation.inverse() * gravity } else { gravity },
            spin: self.loads.spin.is_turning().then_some(self.loads.spin),
            alpha: self.settings.mass_damping,
            is_held: &self.held_mask,
            is_parallel: self.elements.is_worth_threads(),
        };
        // 6. a = M^-1 f, 7. v(n+1) = v(n+1/2) + dt/2 a(n+1)
        let power = pass.run(&self.mass, half_step, velocity, acceleration);
        // Held components do not accelerate, their supports take the force.
        std::mem::swap(&mut self.last_reaction, reaction);
        reaction.clear();
        reaction.extend(supports.iter().map(|(&n, support)| {
            let force = pass.unbalanced(n as usize, &velocity[n as usize]);
            Vec3::from_fn(|c, _| if support.held[c] { -force[c] } else { 0.0 })
        }));
        self.last_reaction.resize(reaction.len(), Vec3::zeros());
        self.force = distributed;
        self.state.ledger.external_power = power.external;
        self.state.ledger.damping_power = [power.mass_damping, viscous_power];
        Ok(before)
    }

    /// Goes on from a checkpoint of a solid of the same mesh, materials, settings and loads.
    ///
    /// # Errors
    /// [`DynamicsError::OtherSolid`] where the state has another number of nodes.
    pub fn resume(&mut self, state: State) -> Result<(), DynamicsError> {
        let (found, expected) = (state.displacement.len(), self.mesh.nodes.len());
        if found != expected {
            return Err(DynamicsError::OtherSolid { found, expected });
        }
        self.is_started = state.steps > 0;
        self.state = state;
        self.held_mask = self.held_components();
        Ok(())
    }

    fn start(&mut self) -> Result<(), DynamicsError> {
        self.held_mask = self.held_components();
        self.accelerate(0.0)?;
        self.is_started = true;
        let Ledger { external_power, damping_power, .. } = self.state.ledger;
        let initial = self.kinetic_energy() + self.strain_energy();
        self.state.ledger = Ledger { initial, external_power, damping_power, ..Default::default() };
        Ok(())
    }

    fn watch(&self, dt: f64) -> Result<(), DynamicsError> {
        let (kinetic, ledger) = (self.kinetic_energy(), self.state.ledger);
        let budget = ledger.initial + ledger.throughput;
        // Turned so that NaN counts as unstable.
        if kinetic <= 4.0 * budget + f64::MIN_POSITIVE {
            return Ok(());
        }
        Err(DynamicsError::UnstableStep {
            dt,
            kinetic,
            budget,
            time: self.state.time,
            step: self.state.steps,
        })
    }

    /// Bytes that one step must move at least: those of the forces, and for every node the vectors of loads and of motion.
    pub fn bytes_per_step(&self) -> f64 {
        // Drift: v 48, u 48, a 24; node pass: start 4, applied 24, mass 8, v 48, a 24, mask 3.
        self.elements.bytes_per_step(self.is_pressure_averaged()) + 231.0 * self.mesh.nodes.len() as f64
    }

    /// Kinetic energy in the solid's frame [J].
    pub fn kinetic_energy(&self) -> f64 {
        self.mass.kinetic_energy(&self.state.velocity)
    }

    /// Stored elastic energy [J].
    pub fn strain_energy(&self) -> f64 {
        let states =
            ElementStates::new(&self.mesh, &self.laws, &self.state.displacement, self.is_pressure_averaged());
        (0..self.mesh.n_elements()).map(|e| states.energy(e)).sum()
    }
}
