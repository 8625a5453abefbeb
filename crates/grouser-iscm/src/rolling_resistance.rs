//! Rolling resistance from the vectors of the polygon forces (P2 §2.3.4, Eqs. (13)–(18)).
//!
//! Steps as in `docs/theory/iscm.md`, W1 to W4.

use grouser_geometry::{Pose, Vec3};
use serde::{Deserialize, Serialize};

use crate::contact::{FootImprint, LoadedPolygon};
use crate::gear::{Fit, Foot, Hull};
use crate::mechanism::GRAVITY;
use crate::track::forces_on_wheels;

/// Rolling resistance of one wheel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WheelResistance {
    /// Force that keeps the wheel rolling F_R \[N\], positive when the ground resists; P2 Eq. (17).
    pub force: f64,
    /// Norm of the total force of the ground \[N\], P2 Eq. (14).
    pub normal_force: f64,
    /// Its vertical part \[N\].
    pub vertical_force: f64,
}

impl WheelResistance {
    /// Coefficient with the norm of the total force, P2 Eq. (13); zero for a wheel in the air.
    pub fn coefficient(&self) -> f64 {
        if self.normal_force > 0.0 { self.force / self.normal_force } else { 0.0 }
    }

    /// Coefficient with the vertical force; zero for a wheel in the air.
    pub fn coefficient_of_vertical(&self) -> f64 {
        if self.vertical_force > 0.0 { self.force / self.vertical_force } else { 0.0 }
    }

    /// Sums over wheels, P2 Eq. (18).
    pub fn total<'a>(wheels: impl IntoIterator<Item = &'a Self>) -> Self {
        wheels.into_iter().fold(Self::default(), |sum, w| Self {
            force: sum.force + w.force,
            normal_force: sum.normal_force + w.normal_force,
            vertical_force: sum.vertical_force + w.vertical_force,
        })
    }
}

/// F_R of forces at points around a wheel (P2 Eqs. (15)–(17)): centre, direction of rolling (unit vector), radius \[m\].
pub fn rolling_force(forces: &[(Vec3, Vec3)], centre: Vec3, rolling: Vec3, radius: f64) -> f64 {
    // Positive = resisting iff u_A = up × r_d.
    let u_a = Vec3::z().cross(&rolling).try_normalize(1e-12).unwrap_or_else(Vec3::y);
    let r_pivot = centre + u_a.cross(&rolling) * radius;
    forces.iter().map(|(f_p, r_p)| f_p.cross(&(r_p - r_pivot)).dot(&u_a)).sum::<f64>() / radius
}

/// Rolling resistance of every wheel of a foot on a body at `pose`, whose centre moved along `rolling` (unit vector).
///
/// `polygons` are the loaded polygons of the foot on its `imprint`.
pub fn foot_resistance(
    foot: &Foot,
    pose: &Pose,
    travel: f64,
    rolling: Vec3,
    polygons: &[LoadedPolygon],
    imprint: &FootImprint,
) -> Vec<WheelResistance> {
    let n_layers = imprint.layers.len();
    let mut forces: Vec<Vec<(Vec3, Vec3)>> = vec![Vec::new(); foot.wheels.len()];
    // W1: polygons under the wheels themselves.
    for p in polygons.iter().filter(|p| p.layer + 1 == n_layers) {
        forces[p.owner as usize].push((p.force, p.position));
    }
    // W2: shoes with their weight; those on a wheel act on it, those between wheels hang on both ends.
    let (mut first, mut tracks) = (0, imprint.tracks.iter());
    for belt in &foot.belts {
        let mut on_shoe = vec![Vec3::new(0.0, 0.0, -belt.shoe.mass * GRAVITY); belt.n_shoes];
        for p in polygons.iter().filter(|p| p.layer + 1 < n_layers) {
            if let Some(shoe) = (p.owner as usize).checked_sub(first).filter(|&shoe| shoe < belt.n_shoes) {
                on_shoe[shoe] += p.force;
            }
        }
        first += belt.n_shoes;
        if belt.fit == Fit::Slack
            && let Some(track) = tracks.next()
        {
            forces_on_wheels(belt, &foot.wheels, track, pose, &on_shoe, &mut forces);
            continue;
        }
        let circles = belt.circles(&foot.wheels);
        let (hull, y) = (Hull::around(&circles), belt.lateral(&foot.wheels));
        let world = |[x, z]: [f64; 2]| (pose * nalgebra::Point3::new(x, y, z)).coords;
        let pitch = hull.length() / belt.n_shoes as f64;
        for (k, force) in on_shoe.iter().enumerate() {
            let middle = hull.at((k as f64 + 0.5) * pitch - travel);
            let distance = |c: &[f64; 3]| (middle.position[0] - c[0]).hypot(middle.position[1] - c[1]) - c[2];
            if middle.radius.is_finite() {
                let nearest = (0..circles.len())
                    .min_by(|&a, &b| distance(&circles[a]).total_cmp(&distance(&circles[b])));
                forces[belt.wheels[nearest.unwrap_or(0)]].push((*force, world(middle.position)));
                continue;
            }
            // Both ends of a taut span pull along the same line: equal vertical parts, equal shares.
            let normal = [middle.direction.sin(), -middle.direction.cos()];
            let support = |c: &[f64; 3]| {
                (c[0] - middle.position[0]) * normal[0] + (c[1] - middle.position[1]) * normal[1] + c[2]
            };
            let touching: Vec<usize> =
                (0..circles.len()).filter(|&w| support(&circles[w]).abs() < 1e-9).collect();
            let along =
                |w: usize| circles[w][0] * middle.direction.cos() + circles[w][1] * middle.direction.sin();
            let here =
                middle.position[0] * middle.direction.cos() + middle.position[1] * middle.direction.sin();
            let behind = touching
                .iter()
                .copied()
                .filter(|&w| along(w) <= here)
                .max_by(|&a, &b| along(a).total_cmp(&along(b)));
            let ahead = touching
                .iter()
                .copied()
                .filter(|&w| along(w) > here)
                .min_by(|&a, &b| along(a).total_cmp(&along(b)));
            for w in [behind, ahead].into_iter().flatten() {
                let c = circles[w];
                let end = [c[0] + c[2] * normal[0], c[1] + c[2] * normal[1]];
                forces[belt.wheels[w]].push((force / 2.0, world(end)));
            }
        }
    }
    // W3, W4
    let wheels = foot.wheels.iter().zip(&forces).map(|(wheel, forces)| {
        let centre = (pose * nalgebra::Point3::from(wheel.centre)).coords;
        let total: Vec3 = forces.iter().map(|f| f.0).sum();
        WheelResistance {
            force: rolling_force(forces, centre, rolling, wheel.radius),
            normal_force: total.norm(),
            vertical_force: total.z,
        }
    });
    wheels.collect()
}
