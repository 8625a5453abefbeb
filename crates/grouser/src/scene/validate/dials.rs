//! Checks of forces and rotation.

use super::Check;
use crate::run::{Possible, with_law};
use crate::scene::{ActiveZone, Dials, Scenario, Soil};

pub fn validate(check: &mut Check, dials: &Dials) {
    if let Err(error) = with_law(dials, Possible) {
        let path = match error.name {
            "tangential stiffness" | "normal damping" | "stick over slip friction" => "dials.forces",
            _ => "dials.rotation",
        };
        let value = if error.value.is_nan() { String::new() } else { format!(": {}", error.value) };
        check.fail(
            path,
            &format!("`{path}`: {}{value} is not possible", error.name),
            error.expected,
            "a ratio the wrong way round, a percentage, or parts of two laws",
        );
    }
    if let Err(error) = dials.integrator.validate() {
        check.fail(
            "dials.integrator",
            &format!("`dials.integrator`: {} = {} is not possible", error.name, error.value),
            error.expected,
            "the two shares the wrong way round",
        );
    }
    let damping = dials.background_damping_n_s_m;
    check.require(
        "dials.background_damping_n_s_m",
        damping,
        damping >= 0.0 && damping.is_finite(),
        "zero or a positive number [N·s/m]",
        "a sign",
    );
    let overlap = dials.largest_overlap;
    check.require(
        "dials.largest_overlap",
        overlap,
        overlap > 0.0 && overlap <= 0.8,
        "in (0, 0.8]: at 0.3, 0.5 and 0.8 Hertz's force is 3, 5 and 9 % too large",
        "a length or a percentage; a bed that needs more is too soft for its load",
    );
}

/// Checks of the active zone.
pub fn validate_zone(check: &mut Check, scenario: &Scenario, zone: &ActiveZone) {
    check.positive("dials.active_zone.reach_m", zone.reach_m, "a distance from the tool [m]");
    check.require(
        "dials.active_zone.rest",
        zone.rest,
        zone.rest > 0.0 && zone.rest < 1.0,
        "in (0, 1): a share of the tool's speed; 0.01 is a safe choice",
        "a speed in m/s, or a percentage",
    );
    check.require(
        "dials.active_zone.wake",
        zone.wake,
        zone.wake > 0.0,
        "positive: a share of the force on a sleeping block; 1 is a safe choice, `inf` wakes nobody",
        "a force in N, or a percentage",
    );
    if scenario.tool.is_none() || !matches!(scenario.soil, Soil::Grains(_)) {
        check.fail(
            "dials.active_zone",
            "an active zone around no tool among grains",
            "soil of grains, a tool and a motion",
            "the tool was deleted or commented out, or the dial was copied from another scene",
        );
    }
}
