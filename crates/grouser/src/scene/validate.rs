//! Physics that a scene must obey, refused before anything is computed.

mod collapse;
mod dials;
mod drive;
mod grains;
mod press;
mod slips;
mod study;
mod tire;
mod tool_room;

use super::{Motion, Outputs, Rotation, Scenario, Soil, Tool};
use crate::diagnostic::Diagnostic;

/// A value that cannot be, with its path in the scenario.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// Path of the value.
    pub path: String,
    /// What is wrong.
    pub what: String,
    /// What would be right.
    pub expected: String,
    /// How this usually comes about.
    pub usual_cause: String,
    /// What to do.
    pub remedy: String,
}

impl From<Problem> for Diagnostic {
    fn from(problem: Problem) -> Self {
        Diagnostic {
            what: problem.what,
            place: None,
            expected: problem.expected,
            usual_cause: problem.usual_cause,
            remedy: problem.remedy,
        }
    }
}

/// Every problem of a scenario, in the order of its parts.
pub fn validate(scenario: &Scenario) -> Vec<Problem> {
    let mut check = Check::default();
    materials(&mut check, scenario);
    if let Some(bed) = scenario.soil.grains() {
        grains::validate(&mut check, scenario, bed);
    }
    match (&scenario.tool, &scenario.motion) {
        (Some(tool), Some(motion)) => match (&scenario.soil, tool, motion) {
            (Soil::Grains(bed), Tool::Plates(_) | Tool::Mesh(_), Motion::Press(press)) => {
                press::validate(&mut check, scenario, bed, tool, press);
            }
            (Soil::PlateTested(soil), Tool::RigidWheel(wheel), Motion::Slips(slips)) => {
                slips::validate(&mut check, scenario, soil, wheel, slips);
            }
            (Soil::PressureSinkage(ground), Tool::Vehicle(vehicle), Motion::Route(route)) => {
                drive::validate(&mut check, ground, vehicle, route);
            }
            (Soil::Grains(bed), Tool::Tire(tire), Motion::Roll(roll)) => {
                tire::validate(&mut check, scenario, bed, (tire, roll));
            }
            _ => check.fail(
                "motion",
                "no experiment puts this soil, tool and motion together",
                "Grains with Plates or Mesh and Press, or with Tire and Roll, or with Collapse and no tool; PlateTested with RigidWheel and Slips; PressureSinkage with Vehicle and Route",
                "a tool or a motion of another kind of scene",
            ),
        },
        (Some(_), None) => check.fail(
            "tool",
            "the scene has a tool but no motion",
            "`motion: Press(…)`",
            "the motion was deleted or commented out",
        ),
        (None, Some(Motion::Collapse(collapse))) => collapse::validate(&mut check, scenario, collapse),
        (None, Some(_)) => check.fail(
            "motion",
            "the scene has a motion but no tool",
            "`tool: Plates(…)`",
            "the tool was deleted or commented out",
        ),
        (None, None) => {
            if let Soil::PlateTested(_) = &scenario.soil {
                check.fail(
                    "soil",
                    "ground known from plate tests has nothing to show alone",
                    "`tool: RigidWheel(…)` and `motion: Slips(…)`",
                    "tool and motion were deleted or commented out",
                );
            }
            if let Soil::PressureSinkage(_) = &scenario.soil {
                check.fail(
                    "soil",
                    "soft ground has nothing to show alone",
                    "`tool: Vehicle(…)` and `motion: Route(…)`",
                    "tool and motion were deleted or commented out",
                );
            }
        }
    }
    dials::validate(&mut check, &scenario.dials);
    if let Some(zone) = &scenario.dials.active_zone {
        dials::validate_zone(&mut check, scenario, zone);
    }
    let fraction = scenario.dials.time_step_fraction;
    check.require(
        "dials.time_step_fraction",
        fraction,
        fraction > 0.0 && fraction <= 1.0,
        "in (0, 1]",
        "a percentage; above 1 the integration is unstable, 0.2 is a safe choice",
    );
    let Outputs { sample_every_s, vtk_every_s, checkpoint_every_s } = scenario.outputs;
    check.positive("outputs.sample_every_s", sample_every_s, "a time [s]");
    check.positive("outputs.vtk_every_s", vtk_every_s, "a time [s]");
    check.positive("outputs.checkpoint_every_s", checkpoint_every_s, "a time [s]");
    references(&mut check, scenario);
    if let Some(study) = &scenario.study {
        study::validate(&mut check, study);
    }
    check.problems
}

/// What is legal but unwise.
pub fn advice(scenario: &Scenario) -> Vec<Problem> {
    match &scenario.motion {
        Some(Motion::Route(route)) => drive::advice(route).into_iter().collect(),
        _ => Vec::new(),
    }
}

fn materials(check: &mut Check, scenario: &Scenario) {
    for (axis, value) in scenario.gravity_m_s2.iter().enumerate() {
        check.finite(&format!("gravity_m_s2[{axis}]"), *value);
    }
    for (name, material) in &scenario.materials {
        let path = |field: &str| format!("materials.{name}.{field}");
        check.positive(&path("young_pa"), material.young_pa, "a stiffness [Pa]; 57 MPa is 57e6");
        check.positive(&path("density_kg_m3"), material.density_kg_m3, "a density [kg/m³]; quartz has 2650");
        let poisson = material.poisson;
        check.require(
            &path("poisson"),
            poisson,
            poisson > -1.0 && poisson <= 0.5,
            "in (-1, 0.5]",
            "a Poisson's ratio derived from E and G that do not belong together: ν = E/(2G) - 1",
        );
        check.restitution(&path("restitution"), material.restitution);
        check.friction(&path("friction"), material.friction);
    }
    for (i, pair) in scenario.pairs.iter().enumerate() {
        check.material(scenario, &format!("pairs[{i}].between[0]"), &pair.between.0);
        check.material(scenario, &format!("pairs[{i}].between[1]"), &pair.between.1);
        check.restitution(&format!("pairs[{i}].restitution"), pair.restitution);
        check.friction(&format!("pairs[{i}].friction"), pair.friction);
    }
    if let Rotation::Tilting(_) = scenario.dials.rotation {
        for (name, material) in &scenario.materials {
            check.friction_of_tilting(&format!("materials.{name}.friction"), material.friction);
        }
        for (i, pair) in scenario.pairs.iter().enumerate() {
            check.friction_of_tilting(&format!("pairs[{i}].friction"), pair.friction);
        }
    }
}

fn references(check: &mut Check, scenario: &Scenario) {
    for (i, reference) in scenario.reference.iter().enumerate() {
        if reference.source().trim().is_empty() {
            check.fail(
                &format!("reference[{i}].source"),
                "a measurement without a source",
                "who measured it and where it is published",
                "left empty while drafting",
            );
        }
        for (j, point) in reference.wheel().iter().flat_map(|wheel| &wheel.points).enumerate() {
            for (field, value) in [
                ("slip", point.slip),
                ("sinkage_m", point.sinkage_m),
                ("pull_over_load", point.pull_over_load),
            ] {
                check.finite(&format!("reference[{i}].points[{j}].{field}"), value);
            }
        }
        for (j, plate) in reference.plates().iter().flat_map(|measured| &measured.plates).enumerate() {
            let path = format!("reference[{i}].plates[{j}]");
            check.positive(&format!("{path}.diameter_m"), plate.diameter_m, "a diameter [m]");
            for (k, &(sinkage, pressure)) in plate.points.iter().enumerate() {
                let previous = if k == 0 { 0.0 } else { plate.points[k - 1].0 };
                let ok = sinkage > previous && sinkage.is_finite();
                check.require(
                    &format!("{path}.points[{k}][0]"),
                    sinkage,
                    ok,
                    "positive and rising [m]",
                    "millimetres, or points out of order",
                );
                check.finite(&format!("{path}.points[{k}][1]"), pressure);
            }
        }
    }
}

/// Collects problems.
#[derive(Default)]
pub(super) struct Check {
    problems: Vec<Problem>,
}

impl Check {
    fn push(&mut self, path: &str, what: String, expected: &str, usual_cause: &str, remedy: String) {
        self.problems.push(Problem {
            path: path.to_owned(),
            what,
            expected: expected.to_owned(),
            usual_cause: usual_cause.to_owned(),
            remedy,
        });
    }

    /// A problem that was found and described elsewhere.
    fn found(&mut self, path: &str, message: Diagnostic) {
        let Diagnostic { what, expected, usual_cause, remedy, .. } = message;
        self.problems.push(Problem { path: path.to_owned(), what, expected, usual_cause, remedy });
    }

    fn fail(&mut self, path: &str, what: &str, expected: &str, usual_cause: &str) {
        self.push(path, what.to_owned(), expected, usual_cause, String::new());
    }

    fn require(&mut self, path: &str, value: f64, is_ok: bool, expected: &str, usual_cause: &str) {
        if !is_ok {
            self.push(path, format!("`{path}` is {value}"), expected, usual_cause, String::new());
        }
    }

    fn positive(&mut self, path: &str, value: f64, meaning: &str) {
        let is_ok = value > 0.0 && value.is_finite();
        self.require(
            path,
            value,
            is_ok,
            &format!("a positive number: {meaning}"),
            "a sign, a unit (values are SI), or a placeholder that was never filled in",
        );
    }

    fn finite(&mut self, path: &str, value: f64) {
        self.require(
            path,
            value,
            value.is_finite(),
            "a finite number",
            "inf or NaN written by another program",
        );
    }

    fn restitution(&mut self, path: &str, value: f64) {
        self.require(
            path,
            value,
            value > 0.0 && value <= 1.0,
            "in (0, 1]: 1 loses nothing",
            "a percentage, or 0 for \"no bounce\": 0.05 is the practical smallest",
        );
    }

    fn friction(&mut self, path: &str, value: f64) {
        self.require(
            path,
            value,
            value >= 0.0 && value.is_finite(),
            "zero or positive: tan of the angle",
            "an angle in degrees: 30° is 0.577",
        );
    }

    /// The law of tilting grains has been tested up to a friction angle of 60°.
    fn friction_of_tilting(&mut self, path: &str, value: f64) {
        self.require(
            path,
            value,
            value.atan().to_degrees() <= 60.0 + 1e-9,
            "at most 1.732, an angle of 60°, where grains tilt: beyond, their arms are loaded mainly sideways and no soil is known",
            "an angle in degrees: 30° is 0.577",
        );
    }

    fn material(&mut self, scenario: &Scenario, path: &str, name: &str) {
        if !scenario.materials.contains_key(name) {
            let known =
                scenario.materials.keys().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
            let expected = format!("one of {known}");
            self.push(
                path,
                format!("there is no material \"{name}\""),
                &expected,
                "a misspelt name",
                String::new(),
            );
        }
    }
}
