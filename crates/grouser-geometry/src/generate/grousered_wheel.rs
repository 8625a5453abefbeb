use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::{ShapeError, counted, positive};
use crate::{TriangleSurface, Vec3};

/// Measures of a rigid wheel with straight grousers (cleats across the whole width).
///
/// ```text
///        ┌─┐ thickness
///        │ │ height          z
///     ___│ │___              ▲
///   ⌒          ⌒            │   y (axle) points into the page
///  (   radius→  )            └──► x (rolls along)
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GrouseredWheel {
    /// Radius of the rim, without grousers [m].
    pub radius: f64,
    /// Width along the axle [m].
    pub width: f64,
    /// Number of grousers; 0 makes a smooth wheel.
    pub n_grousers: usize,
    /// How far a grouser stands out from the rim [m].
    pub grouser_height: f64,
    /// Thickness of a grouser in the direction of travel [m].
    pub grouser_thickness: f64,
    /// Flat pieces of rim between two grousers, or around the whole smooth wheel.
    pub n_rim_segments: usize,
}

/// Closed surface of a wheel: its cross-section in the x–z plane, drawn out along y from −width/2 to width/2.
pub fn grousered_wheel(wheel: &GrouseredWheel) -> Result<TriangleSurface, ShapeError> {
    check(wheel)?;
    let section = cross_section(wheel);
    let n = section.len() as u32;
    let mut vertices = Vec::with_capacity(2 * section.len() + 2);
    for y in [-wheel.width / 2.0, wheel.width / 2.0] {
        vertices.extend(section.iter().map(|&[x, z]| Vec3::new(x, y, z)));
    }
    vertices.extend([Vec3::new(0.0, -wheel.width / 2.0, 0.0), Vec3::new(0.0, wheel.width / 2.0, 0.0)]);
    let (near, far) = (2 * n, 2 * n + 1);
    // The section runs from x towards z: anticlockwise for a viewer at negative y.
    let triangles = (0..n)
        .flat_map(|i| {
            let j = (i + 1) % n;
            [[near, i, j], [far, n + j, n + i], [i, n + i, j], [j, n + i, n + j]]
        })
        .collect();
    Ok(TriangleSurface { vertices, triangles })
}

fn check(wheel: &GrouseredWheel) -> Result<(), ShapeError> {
    let shape = "grousered wheel";
    positive(shape, &[("radius", wheel.radius), ("width", wheel.width)])?;
    counted(shape, "number of grousers", wheel.n_grousers, 0, 1_000)?;
    let least = if wheel.n_grousers == 0 { 3 } else { 1 };
    counted(shape, "number of rim segments", wheel.n_rim_segments, least, 10_000)?;
    if wheel.n_grousers > 0 {
        positive(
            shape,
            &[("grouser height", wheel.grouser_height), ("grouser thickness", wheel.grouser_thickness)],
        )?;
        let half_angle = (wheel.grouser_thickness / 2.0 / wheel.radius).asin(); // NaN if thicker than the wheel
        let (needed, available) =
            (2.0 * half_angle * wheel.radius * wheel.n_grousers as f64, TAU * wheel.radius);
        let has_room = needed < available && (wheel.n_grousers > 1 || wheel.n_rim_segments > 1);
        if !has_room {
            let (n_grousers, thickness) = (wheel.n_grousers, wheel.grouser_thickness);
            return Err(ShapeError::GrousersTouch { n_grousers, thickness, needed, available });
        }
    }
    Ok(())
}

/// Corners (x, z) of the cross-section, angles rising from the x axis towards z; it is star-shaped about the axle.
fn cross_section(wheel: &GrouseredWheel) -> Vec<[f64; 2]> {
    let radius = wheel.radius;
    let on_rim = |angle: f64| [radius * angle.cos(), radius * angle.sin()];
    if wheel.n_grousers == 0 {
        let n = wheel.n_rim_segments;
        return (0..n).map(|i| on_rim(TAU * i as f64 / n as f64)).collect();
    }
    let half = wheel.grouser_thickness / 2.0;
    let (half_angle, pitch) = ((half / radius).asin(), TAU / wheel.n_grousers as f64);
    let mut section = Vec::new();
    for k in 0..wheel.n_grousers {
        let angle = pitch * k as f64;
        let (sin, cos) = angle.sin_cos();
        let on_top = |side: f64| {
            let r = radius + wheel.grouser_height;
            [r * cos - side * half * sin, r * sin + side * half * cos]
        };
        section.extend([on_rim(angle - half_angle), on_top(-1.0), on_top(1.0)]);
        let gap = pitch - 2.0 * half_angle;
        section.extend(
            (0..wheel.n_rim_segments)
                .map(|i| on_rim(angle + half_angle + gap * i as f64 / wheel.n_rim_segments as f64)),
        );
    }
    section
}
