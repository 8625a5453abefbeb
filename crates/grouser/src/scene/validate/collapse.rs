//! Checks of a column that loses its support.

use super::Check;
use crate::scene::{Collapse, Scenario, Side};

pub fn validate(check: &mut Check, scenario: &Scenario, collapse: &Collapse) {
    let Some(bed) = scenario.soil.grains() else {
        let expected = "`soil: Grains(…)`: a column is made of grains";
        return check.fail(
            "motion",
            "only a bed of grains can collapse",
            expected,
            "a soil of another scene",
        );
    };
    let column = collapse.column_m;
    let largest = bed.layers.iter().map(|layer| layer.sizes.range().1).fold(0.0, f64::max);
    let length = bed.container.size_m[0];
    check.require(
        "motion.column_m",
        column,
        column >= 8.0 * largest && column <= 0.75 * length,
        &format!("from {:.4} m, four of the largest grains, to {:.4} m, three quarters of the container: the slope needs room", 8.0 * largest, 0.75 * length),
        "millimetres where metres are asked, or the length of the container",
    );
    if bed.container.x != Side::Walled {
        let expected = "`x: Walled`: the column leans against the wall at x = 0";
        check.fail(
            "soil.container.x",
            "a column cannot lean against itself",
            expected,
            "left at its default",
        );
    }
    let ratio = collapse.energy_ratio;
    let is_ok = ratio > 0.0 && ratio < 1.0;
    check.require("motion.energy_ratio", ratio, is_ok, "in (0, 1)", "0 asks for exact rest");
    check.positive("motion.longest_s", collapse.longest_s, "a time [s]");
    if scenario.dials.active_zone.is_some() {
        let expected = "no active zone: the whole slope moves";
        check.fail("dials.active_zone", "a collapse has no tool to be near to", expected, "dials of a press");
    }
}
