//! Published and closed-form cases of this crate, numbered as the tests of P2 (Appendix B), each with its own reference.

mod forces;
mod machines;
mod rolling;
mod ruts;
mod shear;

use serde::Serialize;

pub use machines::{component_vehicle, flat_ground};

/// One compared quantity.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Case.
    pub case: &'static str,
    /// Quantity.
    pub quantity: String,
    /// Value of this crate.
    pub computed: f64,
    /// Value of the reference.
    pub reference: f64,
    /// Largest allowed difference.
    pub tolerance: f64,
    /// Unit of all three.
    pub unit: &'static str,
    /// Where the reference comes from.
    pub source: &'static str,
}

impl Row {
    /// A case without a result.
    fn missing(case: &'static str, quantity: &str) -> Self {
        Self {
            case,
            quantity: quantity.into(),
            computed: f64::NAN,
            reference: 0.0,
            tolerance: 0.0,
            unit: "-",
            source: "must exist",
        }
    }

    /// Whether the difference stays within the tolerance.
    pub fn is_passed(&self) -> bool {
        (self.computed - self.reference).abs() <= self.tolerance
    }
}

/// A case: its name and the function that computes it.
pub type Case = (&'static str, fn() -> Vec<Row>);

/// All cases.
pub const CASES: &[Case] = &[
    ("P2 test 1: polygon force", forces::polygon_force_full),
    ("P2 test 2: polygon force, partial load", forces::polygon_force_partial),
    ("P2 test 9: start position", ruts::start_position_against_equilibrium),
    ("P2 test 12: rut depth, wheels on bogies", ruts::wheels_on_bogies),
    ("P2 test 13: off-centre load", ruts::off_centre_load),
    ("P2 test 16: rut depth, tracks on bogies", ruts::tracks_on_bogies),
    ("nested and fast search", ruts::nested_and_fast),
    ("P2 test 19: rolling resistance of a bogie", rolling::bogie_rolling_down),
    ("P2 test 24: spatial weights", forces::spatial_weights),
    ("P2 test 25: restart", rolling::restart),
    ("rigid wheel with shear: closed form", shear::rigid_wheel_integrals),
    ("rigid wheel with shear: grid", shear::wheel_on_the_grid),
    ("rigid wheel with shear: energy", shear::energy),
    ("driven track with shear", shear::driven_track),
];
