//! Single spheres for the cases: places, default steps, and the course of an impact.

use grouser_contact::{ContactLaw, Material, PairProperties, Sphere};
use grouser_dem::{Bed, BedSettings, Criterion, Domain, Plane, Rotation, TimeStep};
use grouser_geometry::Vec3;

/// Free space without gravity.
pub fn space() -> BedSettings {
    BedSettings {
        domain: Domain { lower: Vec3::repeat(-100.0), upper: Vec3::repeat(100.0), is_periodic: [false; 3] },
        planes: Vec::new(),
        gravity: Vec3::zeros(),
        rotation: Rotation::Free,
        has_ledger: false,
    }
}

/// A wall at z = 0 made of material number `material`, without gravity.
pub fn wall(material: u32) -> BedSettings {
    BedSettings { planes: vec![Plane { point: Vec3::zeros(), normal: Vec3::z(), material }], ..space() }
}

/// Share of the collision time that a step takes in these cases: 1000 steps an impact, so that the differences which remain
/// are the law's and not the step's. The default of scenes is forty times coarser ([`crate::run::COLLISION_FRACTION`]).
pub const IMPACT_FRACTION: f64 = 0.001;

/// A step that resolves this impact [s].
pub fn impact_step(
    material: &Material,
    radius: f64,
    pair: &PairProperties,
    (effective_radius, effective_mass): (f64, f64),
    speed: f64,
) -> f64 {
    step_of(IMPACT_FRACTION, material, radius, pair, (effective_radius, effective_mass), speed)
}

/// A step of a share of the collision time, or of Rayleigh's time where that is less [s].
pub fn step_of(
    fraction: f64,
    material: &Material,
    radius: f64,
    pair: &PairProperties,
    (effective_radius, effective_mass): (f64, f64),
    speed: f64,
) -> f64 {
    let rayleigh = Criterion::rayleigh(material, radius, 0.2, "");
    let hertz = Criterion::hertz(pair, effective_radius, effective_mass, speed, fraction, "");
    TimeStep::smallest(vec![rayleigh, hertz]).map_or(0.0, |step| step.step_s)
}

/// How an impact went.
pub struct Impact {
    /// Largest normal force, by a parabola through the three highest samples [N].
    pub peak_force: f64,
    /// Time during which the bodies overlapped, to a fraction of a step [s].
    pub contact_time: f64,
    /// The bodies after it, by number.
    pub bodies: Vec<Sphere>,
}

/// Steps bodies that touch at the start until they have parted. Along z the first body presses on the second, or on a wall.
pub fn step_until_parted<L: ContactLaw<f64>>(mut bed: Bed<L>, dt: f64) -> Impact {
    let overlap = |bed: &Bed<L>| {
        let spheres = &bed.grains().spheres;
        let heights: Vec<f64> = spheres.iter().map(|sphere| sphere.position.z).collect();
        match heights[..] {
            [height] => spheres[0].radius - height,
            _ => spheres[0].radius + spheres[1].radius - (heights[0] - heights[1]).abs(),
        }
    };
    let mut forces = Vec::new();
    let (mut before, mut contact_time) = (0.0, 0.0);
    // Many thousands of steps at the default step mean that the bodies stick.
    for _ in 0..1_000_000 {
        bed.step(dt).expect("an impact of two bodies is well behaved");
        let now = overlap(&bed);
        if now <= 0.0 {
            contact_time += dt * before / (before - now);
            break;
        }
        forces.push(bed.grains().loads[0].force.z.abs());
        (before, contact_time) = (now, contact_time + dt);
    }
    // A few more steps let the last force act.
    for _ in 0..3 {
        bed.step(dt).expect("free flight is well behaved");
    }
    let top = (0..forces.len()).max_by(|&a, &b| forces[a].total_cmp(&forces[b])).unwrap_or(0);
    let at = |k: usize| forces.get(k).copied().unwrap_or(0.0);
    let (left, middle, right) = (at(top.wrapping_sub(1)), at(top), at(top + 1));
    let peak_force = middle + (left - right).powi(2) / (8.0 * (2.0 * middle - left - right));
    let mut bodies: Vec<(u32, Sphere)> =
        bed.grains().ids.iter().copied().zip(bed.grains().spheres.iter().copied()).collect();
    bodies.sort_by_key(|&(id, _)| id);
    Impact { peak_force, contact_time, bodies: bodies.into_iter().map(|(_, body)| body).collect() }
}
