//! Wheels: perfect cylinders, or turned from a cross-section with tread elements on top.

use grouser_geometry::lathe::{LatheError, lathe};
use grouser_geometry::{Orientation, Pose, TriangleSurface, Vec3};
use serde::{Deserialize, Serialize};

use super::{GearError, positive};
use crate::imprint::Imprint;

/// Outer surface of a wheel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum WheelShape {
    /// Perfect cylinder of this width \[m\].
    Cylinder {
        /// Width \[m\].
        width: f64,
    },
    /// Triangles around the axle y; vertices in metres from the centre.
    Surface(TriangleSurface),
}

/// A wheel on a body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Wheel {
    /// Centre in the body's frame \[m\]; the axle is the body's y.
    pub centre: Vec3,
    /// Rolling radius \[m\].
    pub radius: f64,
    /// Outer surface.
    pub shape: WheelShape,
}

impl Wheel {
    /// A perfect cylinder.
    pub fn cylinder(centre: Vec3, radius: f64, width: f64) -> Self {
        Self { centre, radius, shape: WheelShape::Cylinder { width } }
    }

    pub(super) fn check(&self) -> Result<(), GearError> {
        positive("wheel", "radius", self.radius)?;
        positive("wheel", "width", 2.0 * self.half_width())
    }

    /// Half of the width \[m\].
    pub fn half_width(&self) -> f64 {
        match &self.shape {
            WheelShape::Cylinder { width } => width / 2.0,
            WheelShape::Surface(surface) => surface.vertices.iter().map(|v| v.y.abs()).fold(0.0, f64::max),
        }
    }

    /// Largest distance of the surface from the axle \[m\].
    pub fn outer_radius(&self) -> f64 {
        match &self.shape {
            WheelShape::Cylinder { .. } => self.radius,
            WheelShape::Surface(surface) => {
                surface.vertices.iter().map(|v| v.x.hypot(v.z)).fold(0.0, f64::max)
            }
        }
    }

    pub(super) fn draw(&self, body: &Pose, travel: f64, imprint: &mut Imprint, owner: u16) {
        let centre = (body * nalgebra::Point3::from(self.centre)).coords;
        match &self.shape {
            WheelShape::Cylinder { width } => {
                imprint.draw_cylinder(centre, body.rotation * Vec3::y(), self.radius, *width, owner);
            }
            WheelShape::Surface(surface) => {
                // Rolling forward turns the wheel about +y.
                let spin = Orientation::from_axis_angle(&Vec3::y_axis(), travel / self.radius);
                imprint.draw_surface(&Pose::from_parts(centre.into(), body.rotation * spin), surface, owner);
            }
        }
    }
}

/// Tread elements on a tire.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TreadPattern {
    /// Elements around the tire.
    pub n_elements: usize,
    /// Height of an element \[m\].
    pub height: f64,
    /// Length of an element along the tire, as a share of their distance (0…1).
    pub length_share: f64,
    /// Width of the tread as a share of the widest cross-section (0…1).
    pub width_share: f64,
}

/// A wheel from cross-sections.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TreadedWheel {
    /// Rim and tire as points (lateral position, radius) \[m\], from the left over the tread to the right.
    pub cross_section: Vec<[f64; 2]>,
    /// Flat sectors around the wheel.
    pub n_sectors: usize,
    /// Tread elements.
    pub tread: Option<TreadPattern>,
}

/// Turns the cross-section and raises the tread elements on the surface so obtained.
///
/// Each tread element follows the tire's points below it, so that carcass and tread stay linked.
pub fn treaded_wheel(wheel: &TreadedWheel) -> Result<TriangleSurface, LatheError> {
    let mut surface = lathe(&wheel.cross_section, wheel.n_sectors)?;
    let Some(tread) = wheel.tread else { return Ok(surface) };
    let widest = wheel.cross_section.iter().map(|p| p[0].abs()).fold(0.0, f64::max) * tread.width_share;
    let crown = wheel.cross_section.iter().map(|p| p[1]).fold(0.0, f64::max);
    // Cross-section of the tread: the tire's own outer points within its width, raised.
    let raised: Vec<[f64; 2]> = wheel
        .cross_section
        .iter()
        .filter(|p| p[0].abs() <= widest + 1e-12 && p[1] > 0.5 * crown)
        .map(|p| [p[0], p[1] + tread.height])
        .collect();
    if raised.len() < 2 {
        return Ok(surface);
    }
    let step = std::f64::consts::TAU / tread.n_elements.max(1) as f64;
    for element in 0..tread.n_elements {
        let from = step * element as f64;
        let base = surface.vertices.len() as u32;
        let n_facets = 2;
        for facet in 0..=n_facets {
            let (sin, cos) =
                (from + step * tread.length_share * f64::from(facet) / f64::from(n_facets)).sin_cos();
            surface.vertices.extend(raised.iter().map(|p| Vec3::new(p[1] * sin, p[0], -p[1] * cos)));
        }
        let n_ring = raised.len() as u32;
        for facet in 0..n_facets {
            for k in 0..n_ring - 1 {
                let [a, b] = [facet, facet + 1].map(|f| base + f * n_ring + k);
                surface.triangles.extend([[a, b + 1, a + 1], [a, b, b + 1]]);
            }
        }
    }
    Ok(surface)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tread_rises_above_the_tire_by_its_height() {
        let cross_section = vec![[0.2, 0.3], [0.2, 0.48], [0.1, 0.5], [-0.1, 0.5], [-0.2, 0.48], [-0.2, 0.3]];
        let tread = TreadPattern { n_elements: 20, height: 0.03, length_share: 0.4, width_share: 0.8 };
        let surface =
            treaded_wheel(&TreadedWheel { cross_section, n_sectors: 48, tread: Some(tread) }).unwrap();
        let wheel = Wheel { centre: Vec3::zeros(), radius: 0.5, shape: WheelShape::Surface(surface) };
        assert!((wheel.outer_radius() - 0.53).abs() < 1e-12 && (wheel.half_width() - 0.2).abs() < 1e-12);
    }
}
