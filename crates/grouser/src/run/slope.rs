//! The slope of a heap's surface.

use super::level::Tops;
use grouser_contact::{Precision, Sphere};

/// Lowest and highest share of the heap's height between which its slope is taken [-]: neither toe nor crest.
const WINDOW: [f64; 2] = [0.15, 0.85];

/// Height of the surface [m] over x [m]: in slices two mean grain diameters wide the mean, over cells as long along y, of the
/// highest point of any grain. Slices without grains are left out.
pub fn profile<P: Precision>(spheres: &[Sphere<P>], size: [f64; 2]) -> Vec<(f64, f64)> {
    let tops = Tops::of(spheres, size);
    let width = size[0] / tops.counts[0] as f64;
    let point = |slice: usize| Some(((slice as f64 + 0.5) * width, tops.mean(Some(slice))?));
    (0..tops.counts[0]).filter_map(point).collect()
}

/// A straight line through a surface that falls along x.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Slope {
    /// Angle to the horizontal, positive where the surface falls [°].
    pub angle_deg: f64,
    /// Standard error of the fit [°].
    pub error_deg: f64,
    /// Height of the line at x = 0 [m].
    pub height: f64,
}

/// The line of least squares through the points of `profile` that lie between 15 and 85 % of the heap's height over `base` [m].
/// Where fewer than three do: through those of the step that crosses these heights, as at a column that stands; through all where none
/// does, as on a flat bed.
pub fn slope(profile: &[(f64, f64)], base: f64) -> Slope {
    let top = profile.iter().fold(base, |top, point| top.max(point.1));
    let window = WINDOW.map(|share| base + share * (top - base));
    let inside = |&&(_, height): &&(f64, f64)| (window[0]..=window[1]).contains(&height);
    let mut points: Vec<(f64, f64)> = profile.iter().filter(inside).copied().collect();
    if points.len() < 3 {
        points = across(profile, window).to_vec();
    }
    let n = points.len() as f64;
    let (x, z) = points.iter().fold((0.0, 0.0), |sum, point| (sum.0 + point.0 / n, sum.1 + point.1 / n));
    let (mut xx, mut xz) = (0.0, 0.0);
    for point in &points {
        xx += (point.0 - x).powi(2);
        xz += (point.0 - x) * (point.1 - z);
    }
    if xx == 0.0 {
        return Slope { height: z, ..Slope::default() };
    }
    let fall = -xz / xx;
    let square: f64 = points.iter().map(|point| (point.1 - z + fall * (point.0 - x)).powi(2)).sum();
    let error = (square / (n - 2.0).max(1.0) / xx).sqrt();
    // d(arctan t) = dt/(1 + t²)
    let angle_deg = fall.atan().to_degrees();
    Slope { angle_deg, error_deg: (error / (1.0 + fall * fall)).to_degrees(), height: z + fall * x }
}

/// From the last point above the window to the first one below it; all points where the surface does not cross it.
fn across(profile: &[(f64, f64)], window: [f64; 2]) -> &[(f64, f64)] {
    let crossing = || {
        let below = profile.iter().position(|point| point.1 < window[0])?;
        let above = profile[..below].iter().rposition(|point| point.1 > window[1])?;
        Some(&profile[above..=below])
    };
    crossing().unwrap_or(profile)
}

#[cfg(test)]
mod tests {
    use super::*;
    use grouser_dem::sphere;
    use grouser_geometry::Vec3;

    #[test]
    fn a_wedge_has_its_angle_and_a_flat_bed_none() {
        for degrees in [10.0_f64, 25.0, 45.0] {
            let fall = degrees.to_radians().tan();
            let heap: Vec<(f64, f64)> = (0..60)
                .map(|i| 0.01 * f64::from(i))
                .map(|x| (x, 0.008 + (0.1 - fall * x).max(0.0)))
                .collect();
            let found = slope(&heap, 0.008);
            assert!((found.angle_deg - degrees).abs() < 1e-9 && found.error_deg < 1e-9, "{found:?}");
            assert!((found.height - 0.108).abs() < 1e-12);
        }
        let flat: Vec<(f64, f64)> =
            (0..40).map(|i| (0.01 * f64::from(i), 0.02 + 1e-4 * f64::from(i % 2))).collect();
        assert!(slope(&flat, 0.008).angle_deg.abs() < 0.05);
        // A column that stands is as steep as slices can tell.
        let cliff: Vec<(f64, f64)> =
            (0..20).map(|i| (0.01 * f64::from(i), if i < 8 { 0.05 } else { 0.01 })).collect();
        assert!((slope(&cliff, 0.01).angle_deg - 4_f64.atan().to_degrees()).abs() < 1e-9);
    }

    #[test]
    fn the_profile_of_stairs_is_their_steps() {
        let place = |i: u32, k: u32, j: u32| {
            Vec3::new(f64::from(i), f64::from(j), f64::from(k)) * 0.02 + Vec3::repeat(0.01)
        };
        let stairs = |i: u32| (0..2).flat_map(move |j| (0..8 - i / 2).map(move |k| place(i, k, j)));
        let spheres: Vec<Sphere> = (0..16).flat_map(stairs).map(|at| sphere(at, 0.01, 1.0, 0)).collect();
        let profile = profile(&spheres, [0.3201, 0.0401]);
        assert_eq!(profile.len(), 8);
        for (step, (x, height)) in profile.into_iter().enumerate() {
            assert!((x - (0.02 + 0.04 * step as f64)).abs() < 1e-3, "{x}");
            assert!((height - 0.02 * (8 - step) as f64).abs() < 1e-12, "{height}");
        }
    }
}
