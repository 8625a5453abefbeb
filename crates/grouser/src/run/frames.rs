//! Grains and surfaces as ParaView sees them.

use super::{Law, LawBed};
use crate::output::{PointField, PolyData};
use grouser_contact::Real;
use grouser_geometry::TriangleSurface;

/// Centres of all grains with radius, velocity, spin and number.
pub fn grains_frame<L: Law>(bed: &LawBed<L>) -> PolyData<'static> {
    let grains = bed.grains();
    let spheres = &grains.spheres;
    PolyData {
        time: 0.0,
        points: spheres.iter().map(|sphere| sphere.position.cast().to_array()).collect(),
        triangles: Vec::new(),
        fields: vec![
            ("radius", PointField::Scalar(spheres.iter().map(|sphere| sphere.radius.to_f64()).collect())),
            ("velocity", PointField::Vector(spheres.iter().map(|s| s.velocity.cast().to_array()).collect())),
            ("spin", PointField::Vector(spheres.iter().map(|s| s.spin.cast().to_array()).collect())),
            ("id", PointField::Id(grains.ids.iter().map(|&id| i64::from(id)).collect())),
        ],
    }
}

/// A surface.
pub fn surface_frame(surface: TriangleSurface) -> PolyData<'static> {
    PolyData {
        time: 0.0,
        points: surface.vertices.iter().map(|v| [v.x, v.y, v.z]).collect(),
        triangles: surface.triangles,
        fields: Vec::new(),
    }
}
