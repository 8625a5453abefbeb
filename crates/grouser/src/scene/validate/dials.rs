//! Checks of forces and rotation.

use super::Check;
use crate::run::{Possible, with_law};
use crate::scene::Dials;

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
        overlap > 0.0 && overlap <= 0.5,
        "in (0, 0.5]: beyond, Hertz's force is more than 5 % off",
        "a length or a percentage; a bed that needs more is too soft for its load",
    );
}
