use std::f64::consts::TAU;

use super::{ShapeError, counted, positive};
use crate::{TriangleSurface, Vec3};

/// Closed circular plate: a short [`cylinder`] of `n_segments` sides whose lower face lies on z = 0.
pub fn disc_plate(radius: f64, thickness: f64, n_segments: usize) -> Result<TriangleSurface, ShapeError> {
    positive("disc plate", &[("radius", radius), ("thickness", thickness)])?;
    counted("disc plate", "number of segments", n_segments, 3, 100_000)?;
    cylinder(radius, thickness, n_segments)
}

/// Closed cylinder from z = 0 to `height` [m] with `n_segments` sides, 4 triangles each.
pub fn cylinder(radius: f64, height: f64, n_segments: usize) -> Result<TriangleSurface, ShapeError> {
    positive("cylinder", &[("radius", radius), ("height", height)])?;
    counted("cylinder", "number of segments", n_segments, 3, 100_000)?;
    let n = n_segments as u32;
    let mut vertices = ring(radius, 0.0, n_segments);
    vertices.extend(ring(radius, height, n_segments));
    vertices.extend([Vec3::zeros(), Vec3::new(0.0, 0.0, height)]);
    let (bottom, top) = (2 * n, 2 * n + 1);
    let triangles = (0..n)
        .flat_map(|i| {
            let j = (i + 1) % n;
            [[bottom, j, i], [i, j, n + j], [i, n + j, n + i], [top, n + i, n + j]]
        })
        .collect();
    Ok(TriangleSurface { vertices, triangles })
}

/// Closed cone with `n_sides` sides, tip at the origin and pointing down, base of `radius` [m] at z = `height` [m]:
/// a penetrometer. The half angle of its tip is arctan(radius/height).
pub fn cone(radius: f64, height: f64, n_sides: usize) -> Result<TriangleSurface, ShapeError> {
    positive("cone", &[("radius", radius), ("height", height)])?;
    counted("cone", "number of sides", n_sides, 3, 100_000)?;
    let n = n_sides as u32;
    let mut vertices = ring(radius, height, n_sides);
    vertices.extend([Vec3::zeros(), Vec3::new(0.0, 0.0, height)]);
    let triangles = (0..n)
        .flat_map(|i| {
            let j = (i + 1) % n;
            [[n, j, i], [n + 1, i, j]]
        })
        .collect();
    Ok(TriangleSurface { vertices, triangles })
}

fn ring(radius: f64, z: f64, n: usize) -> Vec<Vec3> {
    let at = |i: usize| {
        let (sin, cos) = (TAU * i as f64 / n as f64).sin_cos();
        Vec3::new(radius * cos, radius * sin, z)
    };
    (0..n).map(at).collect()
}
