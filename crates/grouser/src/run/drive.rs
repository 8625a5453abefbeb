//! The drives of a scene: each of its sets of chains and tracks, and once more for every value of a study.

use crate::scene::{Motion, Route, Scenario, SoftGround, Soil, Tool, Vary, Vehicle};
use grouser_iscm::run::RunSettings;
use serde::{Deserialize, Serialize};

/// One drive of the scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Drive {
    /// Set of chains and tracks.
    pub equipment: String,
    /// The setting that is varied and its value, when the drive belongs to a study.
    pub varied: Option<(String, f64)>,
    /// Distance of the ground's points [m].
    pub spacing: f64,
    /// Distance between equilibria [m].
    pub run_step: f64,
    intermediate_steps: usize,
    integration_resolution: usize,
}

/// The parts of a scene that is driven.
pub struct Parts<'a> {
    pub ground: &'a SoftGround,
    pub vehicle: &'a Vehicle,
    pub route: &'a Route,
}

/// Ground, vehicle and route, where the scene has all three.
pub fn parts(scenario: &Scenario) -> Option<Parts<'_>> {
    match (&scenario.soil, &scenario.tool, &scenario.motion) {
        (Soil::PressureSinkage(ground), Some(Tool::Vehicle(vehicle)), Some(Motion::Route(route))) => {
            Some(Parts { ground, vehicle, route })
        }
        _ => None,
    }
}

impl Drive {
    /// Every drive of a scene: those with its own settings first.
    pub fn all(parts: &Parts) -> Vec<Self> {
        let (ground, route) = (parts.ground, parts.route);
        let own = |equipment: &String| Self {
            equipment: equipment.clone(),
            varied: None,
            spacing: ground.relief.spacing_m,
            run_step: route.run_step_m,
            intermediate_steps: route.intermediate_steps,
            integration_resolution: route.integration_resolution,
        };
        let driven = || route.driven(&parts.vehicle.equipment);
        let mut drives: Vec<Self> = driven().map(own).collect();
        for vary in &route.convergence {
            for own in driven().map(own) {
                let with =
                    |name: &str, value: f64| Self { varied: Some((name.into(), value)), ..own.clone() };
                match vary {
                    Vary::TerrainSpacing(values) => drives.extend(values.iter().map(|&spacing| {
                        let run_step = route.run_step_m.max(std::f64::consts::SQRT_2 * spacing);
                        Self { spacing, run_step, ..with("terrain spacing [m]", spacing) }
                    })),
                    Vary::RunStep(values) => {
                        drives.extend(
                            values
                                .iter()
                                .map(|&run_step| Self { run_step, ..with("run step [m]", run_step) }),
                        );
                    }
                    Vary::IntermediateSteps(values) => drives.extend(
                        values
                            .iter()
                            .map(|&n| Self { intermediate_steps: n, ..with("intermediate steps", n as f64) }),
                    ),
                    Vary::IntegrationResolution(values) => drives.extend(values.iter().map(|&n| Self {
                        integration_resolution: n,
                        ..with("integration resolution", n as f64)
                    })),
                }
            }
        }
        drives
    }

    /// What it is, in a few words.
    pub fn label(&self) -> String {
        match &self.varied {
            None => self.equipment.clone(),
            Some((name, value)) => format!("{}, {name} {value}", self.equipment),
        }
    }

    /// The same as a part of a file's name.
    pub fn file_name(&self) -> String {
        Self::plain(&self.label())
    }

    /// A text with nothing that a file's name must not hold.
    pub fn plain(text: &str) -> String {
        let words = text.split(|c: char| !(c.is_alphanumeric() || c == '.'));
        words.filter(|word| !word.is_empty()).collect::<Vec<_>>().join("_")
    }

    /// Settings of the run.
    pub fn settings(&self, route: &Route) -> RunSettings {
        let mut settings = route.settings();
        settings.run_step = self.run_step;
        settings.intermediate_steps = self.intermediate_steps;
        settings.search.integration_resolution = self.integration_resolution;
        settings
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_route_drives_with_all_sets_of_equipment_or_with_those_it_names() {
        let labels = |sets: &[(&str, &str)]| -> Result<Vec<String>, String> {
            let sets: Vec<_> = sets.iter().map(|&(path, value)| (path.into(), value.into())).collect();
            let text = include_str!("../../../../scenarios/forwarder.ron");
            let scenario = crate::scene::read("forwarder", text, false, &sets)
                .map_err(|errors| errors[0].to_string())?;
            Ok(Drive::all(&parts(&scenario).expect("a vehicle")).iter().map(Drive::label).collect())
        };
        assert_eq!(labels(&[]).unwrap(), ["bare", "chains and tracks", "chains and slack tracks"]);
        let some = r#"["chains and tracks"]"#;
        assert_eq!(labels(&[("motion.with_equipment", some)]).unwrap(), ["chains and tracks"]);
        let message = labels(&[("motion.with_equipment", r#"["trucks"]"#)]).unwrap_err();
        assert!(
            message.contains("no equipment \"trucks\"") && message.contains("chains and tracks"),
            "{message}"
        );
    }
}
