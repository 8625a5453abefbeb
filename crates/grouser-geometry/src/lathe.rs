//! Solids of revolution: a wheel from the cross-section of its rim and tire.

use std::f64::consts::TAU;

use thiserror::Error;

use crate::{TriangleSurface, Vec3};

/// Why a cross-section cannot be turned.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum LatheError {
    /// Too few points.
    #[error("the cross-section has {n_points} points, expected at least 2 as (lateral position, radius) [m]")]
    TooFewPoints {
        /// Points given.
        n_points: usize,
    },
    /// A point that has no place.
    #[error(
        "point {point} of the cross-section is ({lateral}, {radius}) m; expected finite numbers and a radius of zero or more"
    )]
    BadPoint {
        /// Point, counted from 1.
        point: usize,
        /// Lateral position \[m\].
        lateral: f64,
        /// Radius \[m\].
        radius: f64,
    },
    /// Too few sectors.
    #[error(
        "{n_sectors} sectors make no wheel; expected at least 3 (64 keep a wheel round to 0.12 % of its radius)"
    )]
    TooFewSectors {
        /// Sectors given.
        n_sectors: usize,
    },
}

/// Turns a cross-section of points (lateral position y, radius) \[m\] around the y axis in `n_sectors` flat sectors.
///
/// The points run from the left (+y) flank over the tread to the right (−y) flank; normals point away from the axle.
/// The first vertices lie straight below the axle.
pub fn lathe(cross_section: &[[f64; 2]], n_sectors: usize) -> Result<TriangleSurface, LatheError> {
    if cross_section.len() < 2 {
        return Err(LatheError::TooFewPoints { n_points: cross_section.len() });
    }
    if n_sectors < 3 {
        return Err(LatheError::TooFewSectors { n_sectors });
    }
    for (n, &[lateral, radius]) in cross_section.iter().enumerate() {
        if !(lateral.is_finite() && radius.is_finite() && radius >= 0.0) {
            return Err(LatheError::BadPoint { point: n + 1, lateral, radius });
        }
    }
    let n_ring = cross_section.len();
    let mut surface = TriangleSurface::default();
    for sector in 0..n_sectors {
        let (sin, cos) = (TAU * sector as f64 / n_sectors as f64).sin_cos();
        for &[lateral, radius] in cross_section {
            surface.vertices.push(Vec3::new(radius * sin, lateral, -radius * cos));
        }
    }
    for sector in 0..n_sectors {
        let (a, b) = (sector * n_ring, (sector + 1) % n_sectors * n_ring);
        for k in 0..n_ring - 1 {
            let [p, q, r, s] = [a + k, a + k + 1, b + k + 1, b + k].map(|v| v as u32);
            let on_axis = |point: usize| cross_section[point][1] == 0.0;
            if !on_axis(k + 1) {
                surface.triangles.push([p, r, q]);
            }
            if !on_axis(k) {
                surface.triangles.push([p, s, r]);
            }
        }
    }
    Ok(surface)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_disc_has_outward_normals_and_the_volume_of_its_prism() {
        let (r, w, n) = (0.5, 0.3, 24);
        let disc = lathe(&[[w / 2.0, 0.0], [w / 2.0, r], [-w / 2.0, r], [-w / 2.0, 0.0]], n).unwrap();
        let exact = w * n as f64 / 2.0 * r * r * (TAU / n as f64).sin();
        assert!((disc.solid_properties().volume - exact).abs() < 1e-12, "{}", disc.solid_properties().volume);
    }

    #[test]
    fn bad_cross_sections_are_refused() {
        assert!(matches!(lathe(&[[0.0, 1.0]], 8), Err(LatheError::TooFewPoints { .. })));
        assert!(matches!(lathe(&[[0.0, 1.0], [0.0, -1.0]], 8), Err(LatheError::BadPoint { point: 2, .. })));
        assert!(matches!(lathe(&[[0.1, 1.0], [0.0, 1.0]], 2), Err(LatheError::TooFewSectors { .. })));
    }
}
