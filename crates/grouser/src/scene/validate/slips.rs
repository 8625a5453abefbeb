//! Checks of a single wheel on ground known from plate tests.

use super::Check;
use crate::scene::{PlateTested, RigidWheel, Scenario, Slips};
use grouser_iscm::wheel::PressurePeak;

pub fn validate(
    check: &mut Check,
    scenario: &Scenario,
    soil: &PlateTested,
    wheel: &RigidWheel,
    slips: &Slips,
) {
    check.positive("soil.fit_to_m", soil.fit_to_m, "a sinkage of the plates [m]");
    let k = soil.shear_deformation_modulus_m;
    check.positive("soil.shear_deformation_modulus_m", k, "a length [m]; sand has 0.01 to 0.025");
    let c = soil.cohesion_pa;
    check.require(
        "soil.cohesion_pa",
        c,
        c >= 0.0 && c.is_finite(),
        "zero or positive [Pa]",
        "kPa, or a sign",
    );
    let phi = soil.friction_angle_deg;
    check.require(
        "soil.friction_angle_deg",
        phi,
        (0.0..90.0).contains(&phi),
        "0 to below 90 [°]",
        "radians, or a coefficient of friction",
    );
    if let PressurePeak::WongReece { c_1, c_2 } = soil.peak {
        let is_ok = c_1 >= 0.0 && c_2 >= 0.0 && c_1 + c_2 < 1.0;
        check.require("soil.peak", c_1 + c_2, is_ok, "c_1 + c_2 below 1, both zero or positive", "degrees");
    }
    check.positive("tool.radius_m", wheel.radius_m, "a radius [m]");
    check.positive("tool.width_m", wheel.width_m, "a width [m]");
    if slips.points.is_empty() {
        check.fail("motion.points", "there is no slip", "at least one (slip, load)", "an empty list");
    }
    for (n, point) in slips.points.iter().enumerate() {
        check.require(
            &format!("motion.points[{n}].slip"),
            point.slip,
            point.slip >= -10.0 && point.slip <= 1.0,
            "−10 to 1: (ωR − v)/(ωR)",
            "per cent, or a slip that refers to the larger of the two speeds: braked wheels then differ",
        );
        check.positive(&format!("motion.points[{n}].load_n"), point.load_n, "a load [N]");
    }
    let cells = slips.cells_per_radius;
    check.require(
        "motion.cells_per_radius",
        cells,
        (8.0..=400.0).contains(&cells),
        "8 to 400",
        "a spacing in metres",
    );
    if scenario.reference.iter().all(|reference| reference.plates().is_none()) {
        check.fail(
            "soil",
            "no measured plates to fit the ground to",
            "`reference: [PressureSinkage(…)]` with at least two plates",
            "the reference was deleted or commented out",
        );
    }
}
