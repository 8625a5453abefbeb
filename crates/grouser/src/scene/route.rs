//! Driving along a route, once or in a study of the numerical settings.

use grouser_iscm::equilibrium::{SearchSettings, Solver};
use grouser_iscm::polygon::PartialLoad;
use grouser_iscm::run::RunSettings;
use serde::{Deserialize, Serialize};

/// Slowly along straight lines; speed does not enter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Route {
    /// Corners of the way of the first frame's origin [m].
    pub points_m: Vec<[f64; 2]>,
    /// Sets of the vehicle's equipment to drive with; without it all of them.
    #[serde(default)]
    pub with_equipment: Vec<String>,
    /// Distance between equilibria [m], at least √2 times the distance of the ground's points.
    pub run_step_m: f64,
    /// Simplified equilibria in between.
    pub intermediate_steps: usize,
    /// Parts per side of a polygon; even.
    #[serde(default = "four")]
    pub integration_resolution: usize,
    /// How partly loaded polygons count.
    #[serde(default)]
    pub partial: PartialLoad,
    /// How equilibrium is found.
    #[serde(default)]
    pub solver: Solver,
    /// Change of position at which the search for equilibrium ends [m].
    #[serde(default = "micrometre")]
    pub position_tolerance_m: f64,
    /// Stretch of the route over which rolling resistance is evaluated: from, to [m]; without it all of it.
    #[serde(default)]
    pub rolling_section_m: Option<(f64, f64)>,
    /// Stretch of the route along which ruts are measured: from, to [m]; without it all of it.
    #[serde(default)]
    pub rut_section_m: Option<(f64, f64)>,
    /// Length of a window of which the deepest point counts as rut depth [m].
    #[serde(default = "quarter")]
    pub rut_window_m: f64,
    /// Speed that turns distance into the time of frames [m/s].
    #[serde(default = "one")]
    pub shown_speed_m_s: f64,
    /// Frames each so many run steps; zero for none.
    #[serde(default = "ten")]
    pub frames_every_steps: usize,
    /// A checkpoint each so many run steps.
    #[serde(default = "ten")]
    pub checkpoint_every_steps: usize,
    /// Values to which one setting at a time is changed, each a drive of its own.
    #[serde(default)]
    pub convergence: Vec<Vary>,
}

/// A setting and its values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Vary {
    /// Distance of the ground's points [m]; the run step is √2 times it, as long as that exceeds the route's own.
    TerrainSpacing(Vec<f64>),
    /// Run step [m].
    RunStep(Vec<f64>),
    /// Number of simplified equilibria.
    IntermediateSteps(Vec<usize>),
    /// Parts per side of a polygon.
    IntegrationResolution(Vec<usize>),
}

fn four() -> usize {
    4
}
fn ten() -> usize {
    10
}
fn micrometre() -> f64 {
    1e-6
}
fn quarter() -> f64 {
    0.25
}
fn one() -> f64 {
    1.0
}

impl Route {
    /// Length of the way [m].
    pub fn length(&self) -> f64 {
        self.way().length()
    }

    /// Those of `all` sets of equipment that are driven.
    pub fn driven<'a>(&self, all: &'a [String]) -> impl Iterator<Item = &'a String> {
        all.iter().filter(|set| self.with_equipment.is_empty() || self.with_equipment.contains(set))
    }

    /// The way.
    pub fn way(&self) -> grouser_iscm::route::Route {
        grouser_iscm::route::Route { points: self.points_m.clone() }
    }

    /// Settings of a drive.
    pub fn settings(&self) -> RunSettings {
        RunSettings {
            route: self.way(),
            run_step: self.run_step_m,
            intermediate_steps: self.intermediate_steps,
            search: SearchSettings {
                integration_resolution: self.integration_resolution,
                partial: self.partial,
                solver: self.solver,
                position_tolerance: self.position_tolerance_m,
                ..SearchSettings::default()
            },
        }
    }
}
