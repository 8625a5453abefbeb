//! Checks of the active zone.

use super::Check;
use crate::scene::{ActiveZone, Scenario};

pub fn validate(check: &mut Check, scenario: &Scenario, zone: &ActiveZone) {
    check.positive("dials.active_zone.reach_m", zone.reach_m, "a distance from the tool [m]");
    check.require(
        "dials.active_zone.calm",
        zone.calm,
        zone.calm > 0.0 && zone.calm < 1.0,
        "in (0, 1): a share of the tool's speed; 0.02 is a safe choice",
        "a speed in m/s, or a percentage",
    );
    check.require(
        "dials.active_zone.imbalance",
        zone.imbalance,
        zone.imbalance > 0.0 && zone.imbalance <= 1.0,
        "in (0, 1]: a share of what a grain carries; 0.3 is a safe choice",
        "a force in N, or a percentage",
    );
    if scenario.tool.is_none() {
        check.fail(
            "dials.active_zone",
            "an active zone around no tool",
            "a scene with a tool and a motion",
            "the tool was deleted or commented out",
        );
    }
}
