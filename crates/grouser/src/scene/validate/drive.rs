//! Checks of vehicles driven over soft ground.

use super::{Check, Problem};
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
        if let Err((path, message)) = vehicle.machine(equipment) {
            let path = if path.is_empty() { "tool".to_owned() } else { format!("tool.{path}") };
            check.found(&path, message);
            break;
        }
    }
    for (n, set) in route.with_equipment.iter().enumerate() {
        if !vehicle.equipment.contains(set) {
            check.push(
                &format!("motion.with_equipment[{n}]"),
                format!("the vehicle has no equipment \"{set}\""),
                &format!("one of {:?}", vehicle.equipment),
                "a misspelt name",
                String::new(),
            );
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
                        "a misspelt name, or a set taken out of the list",
                        "keep the list; name the sets to drive with in motion.with_equipment".into(),
                    );
                }
            }
        }
    }
    way(check, ground, vehicle, route);
}

/// An odd number of parts, which the step function of the source does not integrate exactly.
pub fn advice(route: &Route) -> Option<Problem> {
    route.settings().search.advice().map(|what| Problem {
        path: "motion.integration_resolution".into(),
        what,
        expected: "an even number of parts per side; 4 is converged".into(),
        usual_cause: "a resolution that was raised by one".into(),
        remedy: format!("integration_resolution: {}", route.integration_resolution + 1),
    })
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
        && let Err((path, message)) = ground.terrain(ground.relief.spacing_m)
    {
        check.found(&format!("soil.{path}"), message);
    }
}

fn way(check: &mut Check, ground: &SoftGround, vehicle: &Vehicle, route: &Route) {
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
    if check.problems.is_empty() {
        on_the_terrain(check, ground, vehicle, route);
    }
}

/// Every wheel must stand on the terrain wherever the machine goes: it reaches behind and beside the route.
fn on_the_terrain(check: &mut Check, ground: &SoftGround, vehicle: &Vehicle, route: &Route) {
    let Some(Ok(machine)) = vehicle.equipment.first().map(|equipment| vehicle.machine(equipment)) else {
        return;
    };
    let way = route.way();
    let [corner, size] = [ground.relief.corner_m, ground.relief.size_m];
    let n_places = (route.length() / 0.1).ceil() as usize;
    for n in 0..=n_places {
        let distance = route.length() * n as f64 / n_places.max(1) as f64;
        let poses = machine.mechanism.poses(&machine.on_route(&way, distance, 0.0));
        let centres = machine.feet.iter().flat_map(|foot| {
            foot.wheels.iter().map(|wheel| poses[foot.body].transform_point(&wheel.centre.into()))
        });
        for p in centres {
            let is_on = (0..2).all(|k| p[k] >= corner[k] && p[k] <= corner[k] + size[k]);
            if !is_on {
                let far = [corner[0] + size[0], corner[1] + size[1]];
                check.push(
                    "motion.points_m",
                    format!(
                        "the route leads off the terrain: after {distance:.2} m a wheel stands at ({:.2}, {:.2}) m",
                        p.x, p.y
                    ),
                    &format!("all wheels within x {} to {} m, y {} to {} m", corner[0], far[0], corner[1], far[1]),
                    "a route longer than the ground, or one that begins closer to its edge than the machine is long",
                    "a larger soil.relief.size_m, or corner_m further back; or a shorter route".into(),
                );
                return;
            }
        }
    }
}
