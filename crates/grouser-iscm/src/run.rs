//! Driving a machine over ground (P2 §2.4). Steps as in `docs/theory/iscm.md`, R1 to R5.

use grouser_geometry::Vec3;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::equilibrium::{Equilibrium, Frozen, NoEquilibrium, SearchSettings, equilibrium, start_position};
use crate::machine::Machine;
use crate::mechanism::Configuration;
use crate::rolling_resistance::{WheelResistance, foot_resistance};
use crate::route::Route;
use crate::terrain::Terrain;

/// How a machine is driven.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunSettings {
    /// Way of the first body's origin.
    pub route: Route,
    /// Distance between equilibria \[m\], at least √2 times the spacing of the terrain.
    pub run_step: f64,
    /// Simplified equilibria in between.
    pub intermediate_steps: usize,
    /// Accuracy and means of the search.
    pub search: SearchSettings,
}

/// Everything that changes while driving: what a restart needs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunState {
    /// The ground with its ruts.
    pub terrain: Terrain,
    /// Where the machine stands.
    pub configuration: Configuration,
    /// Degrees of freedom one intermediate step before; none at the start.
    pub before: Option<Vec<f64>>,
    /// Run steps done.
    pub n_steps: usize,
    /// Centres of all wheels at the last equilibrium \[m\].
    pub wheel_centres: Vec<Vec<Vec3>>,
    /// Run steps that ended above the position tolerance, as accurate as the grid allows.
    pub n_limited: usize,
}

/// What one run step found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepResult {
    /// Distance driven \[m\].
    pub distance: f64,
    /// Where the machine stands.
    pub configuration: Configuration,
    /// Rolling resistance of each wheel of each foot.
    pub wheels: Vec<Vec<WheelResistance>>,
    /// Sum over all wheels, P2 Eq. (18).
    pub total: WheelResistance,
    /// Vertical force of the ground on each foot \[N\].
    pub foot_loads: Vec<f64>,
    /// Evaluations of the ground's forces.
    pub n_evaluations: usize,
}

/// Why a run cannot start or go on.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RunError {
    /// Too short a step.
    #[error(
        "the run step of {run_step} m is below √2 times the terrain spacing, {least:.5} m: equilibria would meet no new polygons (P2 §2.4); \
         remedy: a longer step or finer terrain"
    )]
    StepTooShort {
        /// The step \[m\].
        run_step: f64,
        /// Least step \[m\].
        least: f64,
    },
    /// No way to drive.
    #[error(
        "the route has {n_points} points and a length of {length} m; expected at least two points and one run step of {run_step} m"
    )]
    Route {
        /// Points.
        n_points: usize,
        /// Length \[m\].
        length: f64,
        /// Run step \[m\].
        run_step: f64,
    },
    /// No rest.
    #[error("after {distance:.3} m: {reason}")]
    NoEquilibrium {
        /// Distance driven \[m\].
        distance: f64,
        /// Why.
        reason: NoEquilibrium,
    },
}

impl RunState {
    /// R1: sets the machine on the ground at the start of the route, finds its rest and leaves its footprint.
    pub fn start(machine: &Machine, terrain: Terrain, settings: &RunSettings) -> Result<Self, RunError> {
        let least = std::f64::consts::SQRT_2 * terrain.grid().spacing();
        let run_step = settings.run_step;
        if !(run_step >= least * (1.0 - 1e-9) && run_step.is_finite()) {
            return Err(RunError::StepTooShort { run_step, least });
        }
        let (n_points, length) = (settings.route.points.len(), settings.route.length());
        if n_points < 2 || length < run_step {
            return Err(RunError::Route { n_points, length, run_step });
        }
        let (position, _) = settings.route.at(0.0);
        let height = terrain.grid().height_at(position[0], position[1]) + 1.0;
        let configuration = machine.on_route(&settings.route, 0.0, height);
        let failed = |reason| RunError::NoEquilibrium { distance: 0.0, reason };
        let from =
            start_position(machine, &terrain, &configuration, 0.0, &settings.search).map_err(failed)?;
        let rest = equilibrium(machine, &terrain, &from, 0.0, &settings.search).map_err(failed)?;
        let mut state = Self {
            terrain,
            configuration: rest.configuration.clone(),
            before: None,
            n_steps: 0,
            wheel_centres: wheel_centres(machine, &rest.frozen),
            n_limited: 0,
        };
        rest.frozen.stamp_here(&mut state.terrain);
        Ok(state)
    }

    /// Distance driven \[m\].
    pub fn distance(&self, settings: &RunSettings) -> f64 {
        self.n_steps as f64 * settings.run_step
    }

    /// Whether another step fits on the route.
    pub fn can_go_on(&self, settings: &RunSettings) -> bool {
        (self.n_steps + 1) as f64 * settings.run_step <= settings.route.length() + 1e-9
    }

    /// Drives one run step.
    pub fn step(&mut self, machine: &Machine, settings: &RunSettings) -> Result<StepResult, RunError> {
        // Within the pool of threads: work for all feet begins without a change of threads.
        rayon::scope(|_| self.step_here(machine, settings))
    }

    fn step_here(&mut self, machine: &Machine, settings: &RunSettings) -> Result<StepResult, RunError> {
        let before = self.distance(settings);
        let n = settings.intermediate_steps + 1;
        let mut n_evaluations = 0;
        for k in 1..n {
            let distance = before + settings.run_step * k as f64 / n as f64;
            self.go_on(machine);
            n_evaluations += self.intermediate(machine, settings, distance)?; // R2, R3
        }
        let distance = before + settings.run_step;
        self.go_on(machine);
        let rest = self.rest(machine, settings, distance, &settings.search)?; // R4
        let mut result = self.measure(machine, distance, &rest); // R5
        result.n_evaluations += n_evaluations;
        self.configuration = rest.configuration.clone();
        self.wheel_centres = wheel_centres(machine, &rest.frozen);
        self.n_limited += usize::from(rest.last_change > settings.search.position_tolerance);
        self.n_steps += 1;
        rest.frozen.stamp_here(&mut self.terrain);
        Ok(result)
    }

    /// Moves the machine on as it went in the intermediate step before: a good place to search from.
    fn go_on(&mut self, machine: &Machine) {
        let here = machine.mechanism.dofs(&self.configuration);
        if let Some(before) = self.before.replace(here.clone()) {
            let ahead: Vec<f64> = here.iter().zip(&before).map(|(a, b)| 2.0 * a - b).collect();
            machine.mechanism.set_dofs(&mut self.configuration, &ahead);
        }
    }

    /// R2: a loose equilibrium; R3: lifted until the ground carries less than the weight; footprint.
    fn intermediate(
        &mut self,
        machine: &Machine,
        settings: &RunSettings,
        distance: f64,
    ) -> Result<usize, RunError> {
        let mut at = self.configuration.clone();
        (at.position, at.heading) = settings.route.at(distance);
        machine.steer(&settings.route, distance, &mut at);
        let failed = |reason| RunError::NoEquilibrium { distance, reason };
        let frozen = Frozen::new(machine, &self.terrain, &at, distance, settings.search.integration())
            .map_err(failed)?;
        let (lifted, n_evaluations) = frozen.settle_and_lift(machine, &self.terrain, 1e-4);
        frozen.stamp(machine, &mut self.terrain, &lifted);
        self.configuration = lifted;
        Ok(n_evaluations)
    }

    fn rest(
        &self,
        machine: &Machine,
        settings: &RunSettings,
        distance: f64,
        search: &SearchSettings,
    ) -> Result<Equilibrium, RunError> {
        let mut at = self.configuration.clone();
        (at.position, at.heading) = settings.route.at(distance);
        machine.steer(&settings.route, distance, &mut at);
        equilibrium(machine, &self.terrain, &at, distance, search)
            .map_err(|reason| RunError::NoEquilibrium { distance, reason })
    }

    fn measure(&self, machine: &Machine, distance: f64, rest: &Equilibrium) -> StepResult {
        let polygons = rest.frozen.polygons(machine, &self.terrain);
        let centres = wheel_centres(machine, &rest.frozen);
        let wheels: Vec<Vec<WheelResistance>> = (0..machine.feet.len())
            .map(|foot| {
                let moved: Vec3 =
                    centres[foot].iter().zip(&self.wheel_centres[foot]).map(|(a, b)| a - b).sum();
                let pose = &rest.frozen.poses[machine.feet[foot].body];
                let rolling = moved.try_normalize(1e-12).unwrap_or_else(|| pose.rotation * Vec3::x()); // P2 Eq. (15)
                let imprint = &rest.frozen.imprints[foot];
                foot_resistance(&machine.feet[foot], pose, distance, rolling, &polygons[foot], imprint)
            })
            .collect();
        StepResult {
            distance,
            configuration: rest.configuration.clone(),
            total: WheelResistance::total(wheels.iter().flatten()),
            wheels,
            foot_loads: rest.frozen.loads.iter().map(|l| l.wrench.force.z).collect(),
            n_evaluations: rest.n_evaluations,
        }
    }
}

fn wheel_centres(machine: &Machine, frozen: &Frozen) -> Vec<Vec<Vec3>> {
    let centre = |body: usize, c: Vec3| (frozen.poses[body] * nalgebra::Point3::from(c)).coords;
    machine.feet.iter().map(|f| f.wheels.iter().map(|w| centre(f.body, w.centre)).collect()).collect()
}
