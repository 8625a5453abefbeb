//! One contact for each smooth neighbourhood of a surface (`docs/theory/surfaces.md`).

use crate::{Feature, closest_point};
use grouser_geometry::{TriangleSurface, Vec3};

/// Two faces that meet at a flatter fold than this belong to one smooth neighbourhood [rad]: 30°.
pub const SMOOTH_ANGLE: f64 = std::f64::consts::FRAC_PI_6;
/// A point lies on a triangle when it is closer to it than this share of the sphere's radius.
const ON_SURFACE: f64 = 1e-6;

/// Where a sphere touches a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// Number of the triangle.
    pub triangle: u32,
    /// Closest point of the triangle [m].
    pub point: Vec3,
    /// Part of the triangle that the point lies on.
    pub feature: Feature,
    /// Distance of the point from the centre [m].
    pub distance: f64,
}

/// A touch, and the triangles that it speaks for.
#[derive(Clone, Debug)]
struct Group {
    touch: Touch,
    triangles: Vec<u32>,
}

/// Contacts of a sphere with the triangles `candidates` of `surface`: every touched triangle belongs to one contact.
///
/// 1. Touched triangles, nearest first; at one distance face before edge before vertex; then by number. So whoever
///    holds the closest point of a triangle further away has had its turn before.
/// 2. One whose closest point lies on a triangle of an earlier contact belongs to that contact.
/// 3. A face that meets a face of an earlier contact at a fold flatter than [`SMOOTH_ANGLE`] belongs to it too.
/// 4. Any other one is a contact of its own.
pub fn touches(surface: &TriangleSurface, candidates: &[u32], centre: &Vec3, radius: f64) -> Vec<Touch> {
    let touch = |&triangle: &u32| {
        let (point, feature) = closest_point(centre, &surface.corners(triangle as usize));
        let distance = (centre - point).norm();
        (distance < radius).then_some(Touch { triangle, point, feature, distance })
    };
    let mut touched: Vec<Touch> = candidates.iter().filter_map(touch).collect();
    if touched.len() <= 1 {
        return touched;
    }
    let order = |a: &Touch, b: &Touch| {
        a.distance.total_cmp(&b.distance).then(a.feature.cmp(&b.feature)).then(a.triangle.cmp(&b.triangle))
    };
    touched.sort_by(order);
    let mut groups: Vec<Group> = Vec::new();
    for touch in touched {
        let tolerance = ON_SURFACE * radius;
        match groups.iter_mut().find(|group| group.speaks_for(&touch, surface, tolerance)) {
            Some(group) => group.triangles.push(touch.triangle),
            None => groups.push(Group { touch, triangles: vec![touch.triangle] }),
        }
    }
    groups.into_iter().map(|group| group.touch).collect()
}

impl Group {
    fn speaks_for(&self, touch: &Touch, surface: &TriangleSurface, tolerance: f64) -> bool {
        self.triangles.iter().any(|&triangle| {
            let corners = surface.corners(triangle as usize);
            let lies_on = |point: &Vec3| (closest_point(point, &corners).0 - point).norm() < tolerance;
            if lies_on(&touch.point) {
                return true;
            }
            let its_corners = surface.corners(touch.triangle as usize);
            let is_flat = || {
                let normals = [triangle, touch.triangle].map(|t| surface.normal(t as usize));
                normals[0].dot(&normals[1]) > SMOOTH_ANGLE.cos()
            };
            let meets = || {
                let lies_on_it =
                    |point: &Vec3| (closest_point(point, &its_corners).0 - point).norm() < tolerance;
                its_corners.iter().any(lies_on) || corners.iter().any(lies_on_it)
            };
            touch.feature == Feature::Face && is_flat() && meets()
        })
    }
}
