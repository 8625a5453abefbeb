//! Checks of vehicles driven over soft ground.

use super::Check;
use crate::scene::{Route, SoftGround, Vehicle};

pub fn validate(check: &mut Check, ground: &SoftGround, vehicle: &Vehicle, route: &Route) {
    terrain(check, ground);
    if vehicle.equipment.is_empty() {
        check.fail(
            "tool.equipment",
            "the vehicle is never driven",
            "at least one name, such as \"bare\"",
            "an empty list",
        );
    }
    for equipment in &vehicle.equipment {
        if let Err(error) = vehicle.machine(equipment) {
            check.push(
                "tool",
                format!("with \"{equipment}\": {error}"),
                "a machine that can stand",
                "a part left out, or a value in another unit",
                String::new(),
            );
            break;
        }
    }
    for (f, frame) in vehicle.frames.iter().enumerate() {
        for (a, axle) in frame.axles.iter().enumerate() {
            for (b, belt) in axle.belts.iter().enumerate() {
                if !vehicle.equipment.contains(&belt.equipment) {
                    check.push(
                        &format!("tool.frames[{f}].axles[{a}].belts[{b}].equipment"),
                        format!("no drive has \"{}\" on", belt.equipment),
                        "one of the names in tool.equipment",
                        "a misspelt name",
                        String::new(),
                    );
                }
            }
        }
    }
    way(check, ground, route);
}

/// The ground alone.
pub fn terrain(check: &mut Check, ground: &SoftGround) {
    check.positive("soil.relief.spacing_m", ground.relief.spacing_m, "a distance [m]");
    for (k, size) in ground.relief.size_m.iter().enumerate() {
        check.positive(&format!("soil.relief.size_m[{k}]"), *size, "a length [m]");
    }
    let n_nodes = ground.relief.size_m[0] * ground.relief.size_m[1] / ground.relief.spacing_m.powi(2);
    check.require(
        "soil.relief.spacing_m",
        ground.relief.spacing_m,
        n_nodes.is_finite() && n_nodes < 2e7,
        "at most 20 million points of ground",
        "millimetres where metres are asked",
    );
    if check.problems.is_empty()
        && let Err((path, error)) = ground.terrain(ground.relief.spacing_m)
    {
        check.push(
            &format!("soil.{path}"),
            error,
            "ground that can be made",
            "a value in another unit, or two parts at one place",
            String::new(),
        );
    }
}

fn way(check: &mut Check, ground: &SoftGround, route: &Route) {
    check.positive("motion.run_step_m", route.run_step_m, "a distance [m]");
    check.positive("motion.position_tolerance_m", route.position_tolerance_m, "a distance [m]");
    check.positive("motion.rut_window_m", route.rut_window_m, "a length [m]");
    check.positive("motion.shown_speed_m_s", route.shown_speed_m_s, "a speed [m/s]");
    let least = std::f64::consts::SQRT_2 * ground.relief.spacing_m;
    check.require(
        "motion.run_step_m",
        route.run_step_m,
        route.run_step_m >= least * (1.0 - 1e-9) || route.run_step_m <= 0.0,
        &format!("at least {least:.5} m, √2 times soil.relief.spacing_m: equilibria else meet no new ground"),
        "a finer step with the same ground; remedy: a smaller spacing_m or a longer step",
    );
    let resolution = route.integration_resolution;
    check.require(
        "motion.integration_resolution",
        resolution as f64,
        (1..=64).contains(&resolution),
        "1 to 64; 4 is converged",
        "a number of triangles where parts of a side are asked",
    );
    if route.points_m.len() < 2 || route.length() < route.run_step_m {
        check.fail(
            "motion.points_m",
            "the route is shorter than a run step",
            "at least two points",
            "a point left out",
        );
    }
    let [corner, size] = [ground.relief.corner_m, ground.relief.size_m];
    for (n, point) in route.points_m.iter().enumerate() {
        for k in 0..2 {
            check.require(
                &format!("motion.points_m[{n}][{k}]"),
                point[k],
                point[k] >= corner[k] && point[k] <= corner[k] + size[k],
                &format!("on the terrain, {} to {} m", corner[k], corner[k] + size[k]),
                "a longer route than the ground; remedy: larger soil.relief.size_m",
            );
        }
    }
}
