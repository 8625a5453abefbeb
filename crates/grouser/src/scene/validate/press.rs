//! Checks of plates pressed into a bed.

use super::{Check, grains, tool_room};
use crate::scene::{Grains, Plates, Press, Scenario, Tool};

pub fn validate(check: &mut Check, scenario: &Scenario, bed: &Grains, tool: &Tool, press: &Press) {
    let before = check.problems.len();
    check.material(scenario, "tool.material", tool.material());
    match tool {
        Tool::Plates(plates) => validate_plates(check, bed, plates),
        Tool::RigidWheel(_) | Tool::Vehicle(_) | Tool::Tire(_) => {}
        Tool::Mesh(mesh) => {
            check.positive(
                "tool.scale",
                mesh.scale,
                "metres for one unit of the file; 0.001 for millimetres",
            );
            if let Ok(surface) = mesh.surface() {
                let extent = surface.bounding_box().extent();
                (0..2).for_each(|axis| {
                    tool_room::validate_image(check, bed, "tool.file", axis, extent[axis]);
                });
            }
        }
    }
    check.positive("motion.speed_m_s", press.speed_m_s, "a speed downwards [m/s]");
    check.positive("motion.depth_m", press.depth_m, "a sinkage [m]");
    if press.gap_m.is_nan() || press.gap_m < 0.0 || press.gap_m.is_infinite() {
        check.push(
            "motion.gap_m",
            format!("`motion.gap_m` is {}: the tool starts inside the bed", press.gap_m),
            "zero or positive: metres between the tool and the highest grain below it",
            "a sinkage given where the start above the surface is asked",
            "the sinkage to reach is `motion.depth_m`".to_owned(),
        );
    }
    let depth: f64 = bed.layers.iter().map(|layer| layer.depth_m).sum();
    check.require(
        "motion.depth_m",
        press.depth_m,
        press.depth_m < depth,
        &format!("less than the bed's depth of {depth} m"),
        "millimetres where metres are asked",
    );
    if check.problems.len() == before && before == 0 {
        grains::carries(check, scenario, bed, largest_measured(scenario, press.depth_m), "the measured load");
    }
}

fn validate_plates(check: &mut Check, bed: &Grains, plates: &Plates) {
    check.positive("tool.thickness_m", plates.thickness_m, "a thickness [m]");
    tool_room::validate_thickness(check, bed, "tool.thickness_m", plates.thickness_m);
    let segments = plates.segments as f64;
    check.require("tool.segments", segments, plates.segments >= 3, "at least 3; 64 looks round", "");
    if plates.diameters_m.is_empty() {
        check.fail("tool.diameters_m", "there is no plate", "at least one diameter [m]", "an empty list");
    }
    let narrowest = bed.container.size_m[0].min(bed.container.size_m[1]);
    for (i, &diameter) in plates.diameters_m.iter().enumerate() {
        let path = format!("tool.diameters_m[{i}]");
        check.positive(&path, diameter, "a diameter [m]");
        check.require(&path, diameter, diameter < narrowest || diameter.is_nan(), &format!("below {narrowest} m, the narrower side of the container; a third of it keeps its sides out of the result"), "millimetres where metres are asked");
        for axis in 0..2 {
            if diameter < narrowest {
                tool_room::validate_image(check, bed, &path, axis, diameter);
            }
        }
    }
}

/// Largest measured pressure [Pa] up to a sinkage; zero without measurements.
fn largest_measured(scenario: &Scenario, depth: f64) -> f64 {
    scenario
        .reference
        .iter()
        .filter_map(|reference| reference.plates())
        .flat_map(|measured| &measured.plates)
        .flat_map(|plate| &plate.points)
        .filter(|(sinkage, _)| *sinkage <= depth)
        .map(|&(_, pressure)| pressure)
        .fold(0.0, f64::max)
}
