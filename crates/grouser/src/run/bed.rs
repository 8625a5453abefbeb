//! From the scenario's soil to a loose bed of grains, and to the key under which its settled form is kept.

use super::{Law, LawBed, Materials, SetupError};
use crate::scene::{Grains, Rotation, Scenario, Side, Sizes};
use grouser_contact::Real;
use grouser_dem::{Bed, BedSettings, Domain, Layer, Plane, RadiusDistribution, random_packing};
use grouser_geometry::Vec3;
use serde::Serialize;
use std::borrow::Cow;

/// Solid share of the volume that a settled bed is taken to have when its layers are filled [-].
pub const SETTLED_SOLID_FRACTION: f64 = 0.60;

/// The layers of a soil as the packing wants them.
pub fn layers(soil: &Grains, materials: &Materials) -> Vec<Layer> {
    let area = soil.container.size_m[0] * soil.container.size_m[1];
    let of = |layer: &crate::scene::Layer| Layer {
        radii: match layer.sizes {
            Sizes::Monodisperse { radius_m } => RadiusDistribution::Monodisperse(radius_m),
            Sizes::Uniform { radius_m: (from_m, to_m) } => RadiusDistribution::Uniform { from_m, to_m },
            Sizes::Graded { radius_m: (from_m, to_m) } => RadiusDistribution::Graded { from_m, to_m },
        },
        n_grains: (SETTLED_SOLID_FRACTION * area * layer.depth_m / layer.sizes.mean_volume()).round()
            as usize,
        density: materials.elastic(&layer.material).density_kg_m3,
        material: materials.number(&layer.material),
    };
    soil.layers.iter().map(of).collect()
}

/// The scene while its bed settles, where the soil asks for something else meanwhile.
fn settling<'a>(scenario: &'a Scenario, soil: &Grains) -> Cow<'a, Scenario> {
    let mut settling = Cow::Borrowed(scenario);
    if let Some(friction) = soil.settle.friction {
        let scenario = settling.to_mut();
        scenario.materials.values_mut().for_each(|m| m.friction = m.friction.min(friction));
        scenario.pairs.iter_mut().for_each(|pair| pair.friction = pair.friction.min(friction));
    }
    if soil.settle.is_turning && scenario.dials.rotation == Rotation::Fixed {
        settling.to_mut().dials.rotation = Rotation::Free;
    }
    settling
}

/// A settled bed with the friction and the rotation of the scene from now on.
///
/// # Errors
/// When a constant is out of range, which a checked scenario excludes.
pub fn in_use<L: Law>(mut bed: LawBed<L>, scenario: &Scenario) -> Result<LawBed<L>, SetupError> {
    bed.set_pair_table(Materials::of(scenario).table()?)?;
    bed.set_rotation(rotation(scenario));
    Ok(bed)
}

fn rotation(scenario: &Scenario) -> grouser_dem::Rotation {
    match scenario.dials.rotation {
        Rotation::Fixed => grouser_dem::Rotation::Fixed,
        _ => grouser_dem::Rotation::Free,
    }
}

/// A loose packing in its box, about to fall.
///
/// # Errors
/// When the packing or the bed is refused.
pub fn loose_bed<L: Law>(scenario: &Scenario, soil: &Grains, law: L) -> Result<LawBed<L>, SetupError> {
    let scenario = &*settling(scenario, soil);
    let materials = Materials::of(scenario);
    let wall = materials.number(&soil.container.material);
    let size = Vec3::from(soil.container.size_m);
    let sides = [soil.container.x, soil.container.y];
    let mut domain = Domain {
        lower: Vec3::zeros(),
        upper: size,
        is_periodic: [sides[0] == Side::Periodic, sides[1] == Side::Periodic, false],
    };
    let mut planes = vec![Plane { point: Vec3::zeros(), normal: Vec3::z(), material: wall }];
    for (axis, side) in sides.into_iter().enumerate() {
        if side == Side::Walled {
            let normal = Vec3::ith(axis, 1.0);
            planes.push(Plane { point: Vec3::zeros(), normal, material: wall });
            planes.push(Plane { point: size, normal: -normal, material: wall });
        }
    }
    let spheres = random_packing::<L::Precision>(&domain, &layers(soil, &materials), soil.seed)?;
    // The loose packing may stand higher than the box; nothing is lost at its open top.
    domain.upper.z = spheres
        .iter()
        .fold(size.z, |top, sphere| top.max(sphere.position.z.to_f64() + sphere.radius.to_f64()));
    let settings = BedSettings {
        domain,
        planes,
        gravity: Vec3::from(scenario.gravity_m_s2),
        rotation: rotation(scenario),
        has_ledger: false,
    };
    let table = materials.table_with_friction_up_to(soil.settle.friction.unwrap_or(f64::INFINITY))?;
    let mut bed = Bed::new(spheres, settings, table, law)?;
    bed.set_largest_overlap(scenario.dials.largest_overlap);
    bed.set_integrator(scenario.dials.integrator)?;
    bed.set_background_damping(scenario.dials.background_damping_n_s_m);
    // Angular grains lie in any direction; the same seed gives the same ones.
    if bed.grains().orientations.is_some() {
        bed.grains_mut().turn_randomly(soil.seed);
    }
    Ok(bed)
}

/// Everything that a settled bed depends on, as a text: beds with the same key have the same bytes.
pub fn key(scenario: &Scenario, soil: &Grains, time_step: f64) -> String {
    let scenario = &*settling(scenario, soil);
    #[derive(Serialize)]
    struct Key<'a> {
        version: &'a str,
        soil: &'a Grains,
        materials: &'a std::collections::BTreeMap<String, crate::scene::Material>,
        pairs: &'a [crate::scene::Pair],
        gravity_m_s2: [f64; 3],
        dials: crate::scene::Dials,
        time_step: f64,
    }
    let key = Key {
        version: env!("CARGO_PKG_VERSION"),
        soil,
        materials: &scenario.materials,
        pairs: &scenario.pairs,
        gravity_m_s2: scenario.gravity_m_s2,
        // Every grain of a settling bed is awake.
        dials: crate::scene::Dials { active_zone: None, ..scenario.dials.clone() },
        time_step,
    };
    crate::scene::dialect().to_string(&key).expect("a scenario holds nothing RON cannot write")
}
