//! Checks of a bed of grains.

use super::Check;
use crate::scene::{Grains, Scenario, Side, Sizes};

/// Overlap over radius above which Hertz's contact and the packing itself lose their meaning.
pub const LARGEST_OVERLAP_RATIO: f64 = 0.10;

pub fn validate(check: &mut Check, scenario: &Scenario, bed: &Grains) {
    for (axis, &size) in bed.container.size_m.iter().enumerate() {
        check.positive(&format!("soil.container.size_m[{axis}]"), size, "a length [m]");
    }
    check.material(scenario, "soil.container.material", &bed.container.material);
    if bed.layers.is_empty() {
        check.fail(
            "soil.layers",
            "the bed is empty",
            "at least one layer of grains",
            "all layers were deleted",
        );
    }
    for (i, layer) in bed.layers.iter().enumerate() {
        let path = |field: &str| format!("soil.layers[{i}].{field}");
        check.material(scenario, &path("material"), &layer.material);
        check.positive(&path("depth_m"), layer.depth_m, "the layer's height once settled [m]");
        match layer.sizes {
            Sizes::Monodisperse { radius_m } => {
                check.positive(&path("sizes.radius_m"), radius_m, "a radius [m]")
            }
            Sizes::Uniform { radius_m: (low, high) } | Sizes::Graded { radius_m: (low, high) } => {
                check.positive(&path("sizes.radius_m[0]"), low, "the smallest radius [m]");
                check.require(
                    &path("sizes.radius_m[1]"),
                    high,
                    high >= low && high.is_finite(),
                    "at least the smallest radius",
                    "the two ends were exchanged",
                );
                check.require(
                    &path("sizes.radius_m[1]"),
                    high,
                    high.is_nan() || high <= 100.0 * low || low <= 0.0,
                    "at most a hundred times the smallest radius: the grids that find neighbours go no further",
                    "the smallest sizes of a measured grading curve, which no resolved bed can hold",
                );
            }
        }
    }
    if !check.problems.is_empty() {
        return;
    }
    room(check, bed);
    settle(check, scenario, bed);
    own_weight(check, scenario, bed);
}

fn room(check: &mut Check, bed: &Grains) {
    let largest = bed.layers.iter().map(|layer| layer.sizes.range().1).fold(0.0, f64::max);
    let sides = [("x", bed.container.x), ("y", bed.container.y)];
    for (axis, (name, side)) in sides.into_iter().enumerate() {
        let least = largest * if side == Side::Periodic { 10.0 } else { 4.0 };
        let size = bed.container.size_m[axis];
        check.require(
            &format!("soil.container.size_m[{axis}]"),
            size,
            size >= least,
            &format!(
                "at least {least:.4} m along {name}, {} radii of the largest grain",
                if side == Side::Periodic { 10 } else { 4 }
            ),
            "grains in millimetres and the box in metres, or a box for another grain size",
        );
    }
    let depth: f64 = bed.layers.iter().map(|layer| layer.depth_m).sum();
    let height = bed.container.size_m[2];
    check.require(
        "soil.container.size_m[2]",
        height,
        height >= 2.0 * depth,
        &format!(
            "at least {:.4} m: the loose packing takes twice the height of the settled layers",
            2.0 * depth
        ),
        "the container's height was taken for the depth of the bed",
    );
    let thinnest = bed.layers.iter().position(|layer| layer.depth_m < 2.0 * layer.sizes.range().1);
    if let Some(i) = thinnest {
        check.fail(
            &format!("soil.layers[{i}].depth_m"),
            "the layer is thinner than one of its grains: the bed would be empty",
            "a depth of at least the largest grain's diameter",
            "a diameter given as radius, or millimetres given as metres",
        );
    }
}

fn settle(check: &mut Check, scenario: &Scenario, bed: &Grains) {
    let ratio = bed.settle.energy_ratio;
    check.require(
        "soil.settle.energy_ratio",
        ratio,
        ratio > 0.0 && ratio < 1.0,
        "in (0, 1)",
        "0 asks for exact rest, which a sum of rounded numbers never reaches",
    );
    if let Some(friction) = bed.settle.friction {
        check.friction("soil.settle.friction", friction);
    }
    check.positive("soil.settle.longest_s", bed.settle.longest_s, "a time [s]");
    let factor = bed.settle.time_step_factor;
    check.require(
        "soil.settle.time_step_factor",
        factor,
        factor > 0.0 && factor <= 10.0 && factor * scenario.dials.time_step_fraction <= 1.0,
        "in (0, 10], and at most 1 times `dials.time_step_fraction`",
        "a step in seconds where the ratio of two steps is asked",
    );
}

/// A bed so soft that it cannot carry itself.
fn own_weight(check: &mut Check, scenario: &Scenario, bed: &Grains) {
    let gravity = scenario.gravity();
    let pressure: f64 = bed
        .layers
        .iter()
        .map(|layer| 0.6 * scenario.materials[&layer.material].density_kg_m3 * gravity * layer.depth_m)
        .sum();
    carries(check, scenario, bed, pressure, "its own weight");
}

/// Refuses materials whose grains overlap too far under a mean pressure [Pa].
pub fn carries(check: &mut Check, scenario: &Scenario, bed: &Grains, pressure: f64, load: &str) {
    for layer in &bed.layers {
        let name = &layer.material;
        let material = &scenario.materials[name];
        let ratio = overlap_ratio(pressure, material.young_pa, material.poisson);
        if ratio > LARGEST_OVERLAP_RATIO {
            let enough = material.young_pa * (ratio / LARGEST_OVERLAP_RATIO).powf(1.5);
            check.push(
                &format!("materials.{name}.young_pa"),
                format!(
                    "the bed cannot carry {load}: under {:.3} kPa grains of \"{name}\" overlap by {:.0} % of their radius",
                    pressure / 1e3,
                    100.0 * ratio
                ),
                &format!("at most {:.0} %", 100.0 * LARGEST_OVERLAP_RATIO),
                "Young's modulus in MPa or kPa where Pa is asked, or softened too far to save time",
                format!("a Young's modulus of at least {enough:.2e} Pa"),
            );
        }
    }
}

/// Overlap over radius of equal spheres in a square packing under a mean pressure: each carries p (2R)².
pub fn overlap_ratio(pressure: f64, young: f64, poisson: f64) -> f64 {
    // Hertz: F = 4/3 E* √R* δ^1.5 with E* = E/(2(1-ν²)), R* = R/2, F = 4 p R²
    let effective_young = young / (2.0 * (1.0 - poisson * poisson));
    (3.0 * pressure * 2.0_f64.sqrt() / effective_young).powf(2.0 / 3.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn overlap_ratio_obeys_hertz_for_two_spheres() {
        let (pressure, young, poisson, radius) = (20e3, 5e6, 0.3, 0.004);
        let overlap = radius * overlap_ratio(pressure, young, poisson);
        let effective_young = young / (2.0 * (1.0 - poisson * poisson));
        let force = 4.0 / 3.0 * effective_young * (radius / 2.0_f64).sqrt() * overlap.powf(1.5);
        assert!((force / (pressure * 4.0 * radius * radius) - 1.0).abs() < 1e-12);
    }
}
