//! Published and closed-form cases of this crate, numbered as the tests of P2 (Appendix B), each with its own reference.

mod component_frames;
mod forces;
mod grid_model;
mod headings;
mod machines;
mod objects;
mod plane;
mod rigid_frames;
mod rolling;
mod ruts;
mod shear;

use serde::Serialize;

use machines::{bogie, component_vehicle_with, ground, sloped_ground};
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

    fn new(
        case: &'static str,
        quantity: impl Into<String>,
        computed: f64,
        reference: f64,
        tolerance: f64,
        unit: &'static str,
        source: &'static str,
    ) -> Self {
        Self { case, quantity: quantity.into(), computed, reference, tolerance, unit, source }
    }

    /// An observed order of convergence that must reach `nominal`, within a tenth; more is no fault.
    fn order_at_least(
        case: &'static str,
        between: &str,
        observed: f64,
        nominal: f64,
        source: &'static str,
    ) -> Self {
        let quantity = format!("order {between}, at least {nominal} (observed {observed:.2})");
        Self::new(case, quantity, observed.min(nominal), nominal, 0.1, "-", source)
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
    ("P2 test 3: 3-D model to terrain grid", grid_model::model_to_grid),
    ("P2 test 4: torque of a bogie", rigid_frames::torque_of_a_bogie),
    ("P2 test 5: equilibrium of a bogie on a slope", rigid_frames::bogie_on_a_slope),
    ("P2 test 6: rut depth of a bogie", rigid_frames::rut_of_a_bogie),
    ("P2 test 7: axes and angles", component_frames::axes_and_angles),
    ("P2 test 8: drive direction", component_frames::drive_direction),
    ("P2 test 9: start position", ruts::start_position_against_equilibrium),
    ("P2 test 10: rut depth, stiff frame on wheels", rigid_frames::rut_of_a_stiff_frame),
    ("P2 test 11: rut depth, stiff frame on bogies", rigid_frames::rut_of_a_stiff_frame_on_bogies),
    ("P2 test 12: rut depth, wheels on bogies", ruts::wheels_on_bogies),
    ("P2 test 13: off-centre load", ruts::off_centre_load),
    ("P2 test 14: component vehicle on a slope", component_frames::component_vehicle_on_a_slope),
    ("P2 test 15: stiff frame on a slope", rigid_frames::stiff_frame_on_a_slope),
    ("P2 test 16: rut depth, tracks on bogies", ruts::tracks_on_bogies),
    ("P2 test 17: search at intermediate steps", component_frames::intermediate_step),
    ("P2 test 18: rigid objects", objects::rigid_objects),
    ("P2 test 19: rolling resistance of a bogie", rolling::bogie_rolling_down),
    ("P2 test 20: rolling resistance on the run", rolling::bogie_on_the_run),
    ("P2 test 21: rolling resistance of a tracked bogie", rolling::bogie_with_a_track),
    ("P2 test 22: drive direction, wheels", headings::wheeled),
    ("P2 test 23: drive direction, track", headings::tracked),
    ("P2 test 24: relationships from a data file", forces::relationships_from_a_file),
    ("P2 test 25: restart", rolling::restart),
    ("rigid wheel with shear: closed form", shear::rigid_wheel_integrals),
    ("rigid wheel with shear: grid", shear::wheel_on_the_grid),
    ("rigid wheel with shear: energy", shear::energy),
    ("driven track with shear", shear::driven_track),
    ("nested and fast search", ruts::nested_and_fast),
];
