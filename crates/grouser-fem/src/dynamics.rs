//! Explicit central differences (P0 Eq. 32) as velocity Verlet; numbers of `docs/theory/elastic_solids.md`.

use grouser_geometry::Vec3;
use serde::{Deserialize, Serialize};

use crate::element_state::ElementStates;
use crate::internal_force::Viscosity;
use crate::solid::{Solid, State};

/// Steps between two looks at the energy.
const WATCH_INTERVAL: u64 = 64;

/// Work and dissipation since the first step [J].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Ledger {
    /// Kinetic plus strain energy at the first step.
    pub initial: f64,
    /// Work of gravity, pressures and applied forces.
    pub external_work: f64,
    /// Work of the supports.
    pub support_work: f64,
    /// Dissipated by damping proportional to mass.
    pub mass_damping: f64,
    /// Sum of the magnitudes of all work: what the energy is held against.
    pub throughput: f64,
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
        let State { displacement, velocity, acceleration, supports, .. } = &mut self.state;
        for ((u, v), a) in displacement.iter_mut().zip(velocity.iter_mut()).zip(acceleration.iter()) {
            // 1. v(n+1/2) = v(n) + dt/2 a(n)
            *v += a * (0.5 * dt);
            // 2. u(n+1) = u(n) + dt v(n+1/2)
            *u += *v * dt;
        }
        for (&node, support) in supports.iter_mut() {
            let n = node as usize;
            for c in (0..3).filter(|&c| support.held[c]) {
                support.displacement[c] += support.velocity[c] * dt;
                displacement[n][c] = support.displacement[c];
                velocity[n][c] = support.velocity[c];
            }
        }
        self.state.time += dt;
        self.state.steps += 1;
        Ok(())
    }

    /// Steps 3 to 8: forces at t + dt, accelerations, second half of the velocity change, ledger and watch.
    ///
    /// # Errors
    /// [`DynamicsError`].
    pub fn advance_velocities(&mut self, dt: f64) -> Result<(), DynamicsError> {
        let external_power = self.accelerate()?;
        let Ledger { external_work, support_work, mass_damping, throughput, .. } = &mut self.state.ledger;
        let alpha = self.settings.mass_damping;
        // 8. Work of this step by the forces at its end and the velocity of its middle.
        let support_power: f64 = self
            .state
            .supports
            .iter()
            .zip(&self.state.reaction)
            .map(|((&n, _), r)| r.dot(&self.state.velocity[n as usize]))
            .sum();
        let damping =
            if alpha > 0.0 { 2.0 * alpha * self.mass.kinetic_energy(&self.state.velocity) } else { 0.0 };
        *external_work += external_power * dt;
        *support_work += support_power * dt;
        *mass_damping += damping * dt;
        *throughput += (external_power.abs() + support_power.abs()) * dt;
        // 7. v(n+1) = v(n+1/2) + dt/2 a(n+1)
        for (v, a) in self.state.velocity.iter_mut().zip(&self.state.acceleration) {
            *v += a * (0.5 * dt);
        }
        if self.state.steps.is_multiple_of(WATCH_INTERVAL) { self.watch(dt) } else { Ok(()) }
    }

    /// Steps 3 to 6; returns the power of the external forces [W].
    fn accelerate(&mut self) -> Result<f64, DynamicsError> {
        let mut force = std::mem::take(&mut self.force);
        force.resize(self.mesh.nodes.len(), Vec3::zeros());
        force.fill(Vec3::zeros());
        self.add_external_forces(1.0, &mut force);
        let power = force.iter().zip(&self.state.velocity).map(|(f, v)| f.dot(v)).sum();
        let beta = self.settings.stiffness_damping;
        let viscosity = (beta > 0.0).then_some(Viscosity { velocity: &self.state.velocity, beta });
        self.elements.add_forces(&self.state.displacement, viscosity, &mut force).map_err(|i| {
            DynamicsError::InvertedElement {
                element: self.mesh.element_label(i.element),
                volume_ratio: i.volume_ratio,
                time: self.state.time,
                step: self.state.steps,
            }
        })?;
        let alpha = self.settings.mass_damping;
        if alpha > 0.0 {
            let mut momentum = vec![Vec3::zeros(); force.len()];
            self.mass.multiply(&self.state.velocity, &mut momentum);
            force.iter_mut().zip(&momentum).for_each(|(f, p)| *f -= p * alpha);
        }
        // 6. a = M^-1 f; held components do not accelerate, their supports take the force.
        self.state.reaction = self.reactions_of(&force);
        self.mass.solve(&force, &self.held_mask, &mut self.state.acceleration);
        self.force = force;
        Ok(power)
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
        self.accelerate()?;
        self.is_started = true;
        self.state.ledger =
            Ledger { initial: self.kinetic_energy() + self.strain_energy(), ..Default::default() };
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

    /// Bytes that one step must move at least: the element constants once (twice with averaged pressure); for every node of every
    /// block its number, displacement, and force written and read; for every node the vectors of forces and of motion.
    pub fn bytes_per_step(&self) -> f64 {
        let passes = if self.is_pressure_averaged() { 2.0 } else { 1.0 };
        // Number 4 + displacement 24 + force out 24 and in 24 + source 8.
        let block_nodes = 84.0 * self.elements.n_block_nodes() as f64;
        // Drift: v 48, u 48, a 24; loads: force 24, applied 24, mass 8, v 24; sum: force 48; accelerate: force 24, mass 8, a 24,
        // mask 3; kick: v 48, a 24.
        let nodes = 379.0 * self.mesh.nodes.len() as f64;
        passes * self.elements.element_bytes() as f64 + block_nodes + nodes
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
