//! The time step of a scene: the smallest over all criteria, all pairs, walls and tools included.

use super::Materials;
use crate::scene::{Grains, Motion, Rotation, Scenario};
use grouser_contact::{Material, PairProperties, ParameterError};
use grouser_dem::{Criterion, TimeStep};

/// Share of the Hertz collision time that a step may take: about 25 steps an impact.
pub const COLLISION_FRACTION: f64 = 0.04;
/// Share of the smallest radius that anything may travel in a step.
pub const TRAVEL_FRACTION: f64 = 0.05;

/// Share of the step of spheres that angular grains can take: their touched points vibrate faster the smaller the smallest principal
/// moment of inertia is (ω² ∝ 1 + |ℓ|²/(J/m), 7/2 for a sphere).
fn share_of_turning(scenario: &Scenario) -> f64 {
    match scenario.dials.rotation {
        Rotation::Tilting(tilting) => (3.5 / tilting.settings().mobility()).sqrt().min(1.0),
        Rotation::Free | Rotation::Fixed | Rotation::Rolling(_) => 1.0,
    }
}

/// The step and its criteria. The dial `time_step_fraction` is the share of the Rayleigh time; the other criteria have
/// fixed shares and bind only in fast or very stiff scenes.
///
/// # Errors
/// When a constant is out of range, which a checked scenario excludes.
pub fn time_step(scenario: &Scenario, soil: &Grains) -> Result<TimeStep, ParameterError> {
    let materials = &Materials::of(scenario);
    let turning = share_of_turning(scenario);
    let fraction = scenario.dials.time_step_fraction * turning;
    let gravity = scenario.gravity();
    let tool_speed = scenario.motion.as_ref().map_or(0.0, Motion::speed);
    // The fastest grain: a fall through the loose packing, or the tool.
    let depth: f64 = soil.layers.iter().map(|layer| layer.depth_m).sum();
    let fall = (2.0 * gravity * depth).sqrt();
    let speed = fall.max(tool_speed);
    let mut criteria = Vec::new();
    for (number, layer) in soil.layers.iter().enumerate() {
        let material = materials.elastic(&layer.material);
        let radius = layer.sizes.range().0;
        let place = format!("smallest grain of layer {number}, radius {radius} m, \"{}\"", layer.material);
        criteria.push(Criterion::rayleigh(&material, radius, fraction, &place));
        criteria.push(Criterion::travel(
            radius,
            speed,
            TRAVEL_FRACTION,
            format!("{place}, at {speed:.2} m/s"),
        ));
        let mass = material.density_kg_m3 * 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
        let mut partners = vec![(soil.container.material.as_str(), "the box", f64::INFINITY, fall)];
        partners.extend(
            soil.layers.iter().map(|other| (other.material.as_str(), "a grain", other.sizes.range().0, fall)),
        );
        if let Some(tool) = &scenario.tool {
            partners.push((tool.material(), "the tool", f64::INFINITY, tool_speed));
        }
        for (partner, called, its_radius, speed) in partners {
            if speed <= 0.0 {
                continue;
            }
            let pair = pair(materials, &layer.material, partner)?;
            let other: Material = materials.elastic(partner);
            let its_mass = other.density_kg_m3 * 4.0 / 3.0 * std::f64::consts::PI * its_radius.powi(3);
            let (effective_radius, effective_mass) = (harmonic(radius, its_radius), harmonic(mass, its_mass));
            let place = format!("{place}, against {called} \"{partner}\" at {speed:.2} m/s");
            criteria.push(Criterion::hertz(
                &pair,
                effective_radius,
                effective_mass,
                speed,
                COLLISION_FRACTION * turning,
                place,
            ));
        }
    }
    Ok(TimeStep::smallest(criteria).expect("a checked scene has a layer"))
}

fn pair(materials: &Materials, a: &str, b: &str) -> Result<PairProperties, ParameterError> {
    let interaction = materials.interaction(a, b);
    PairProperties::new(&materials.elastic(a), &materials.elastic(b), &interaction, materials.tail())
}

/// 1/(1/a + 1/b), also for an infinite b.
fn harmonic(a: f64, b: f64) -> f64 {
    1.0 / (1.0 / a + 1.0 / b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use grouser_contact::{GrainInertia, GrainShape, TiltingSettings};

    #[test]
    fn the_smallest_moment_of_inertia_shortens_the_step() {
        let cube = TiltingSettings::of(GrainShape::Cube);
        let rod = TiltingSettings { inertia: GrainInertia::ThinRod, ..cube };
        // 1 + 1.5/(1/3), 1 + 1.5/(1/12)
        assert!((cube.mobility() - 5.5).abs() < 1e-12 && (rod.mobility() - 19.0).abs() < 1e-12);
        let step = |rotation: &str| {
            let text = include_str!("../../../../scenarios/bevameter_angular.ron");
            assert!(text.contains("rotation: Free,"));
            let text = text.replace("rotation: Free,", &format!("rotation: {rotation},"));
            let scenario = crate::scene::read("scene", &text, false, &[]).expect("the scene is sound");
            time_step(&scenario, scenario.soil.grains().expect("grains")).expect("sound").step_s
        };
        let (free, cubes) = (step("Free"), step("Tilting(shape: Cube)"));
        let rods = step("Tilting(shape: Cube, inertia: ThinRod)");
        assert!((cubes / free - (3.5_f64 / 5.5).sqrt()).abs() < 1e-9, "{cubes} against {free}");
        assert!((rods / free - (3.5_f64 / 19.0).sqrt()).abs() < 1e-9, "{rods} against {free}");
    }
}
