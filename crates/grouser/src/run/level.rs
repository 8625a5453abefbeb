//! Where the surface of a bed is.

use grouser_contact::{Precision, Real, Sphere};

/// Highest points [m] over square cells two mean grain diameters wide, row by row along x; −∞ where no grain's centre lies.
pub struct Tops {
    /// Number of cells along x and y.
    pub counts: [usize; 2],
    heights: Vec<f64>,
}

impl Tops {
    /// Of grains in a box of the edges `size` [m].
    pub fn of<P: Precision>(spheres: &[Sphere<P>], size: [f64; 2]) -> Self {
        let mean_radius =
            spheres.iter().map(|sphere| sphere.radius.to_f64()).sum::<f64>() / spheres.len() as f64;
        let counts = size.map(|length| ((length / (4.0 * mean_radius)) as usize).max(1));
        let mut heights = vec![f64::NEG_INFINITY; counts[0] * counts[1]];
        for sphere in spheres {
            let cell = |along: f64, axis: usize| {
                ((along / size[axis] * counts[axis] as f64).max(0.0) as usize).min(counts[axis] - 1)
            };
            let place = cell(sphere.position.y.to_f64(), 1) * counts[0] + cell(sphere.position.x.to_f64(), 0);
            heights[place] = f64::max(heights[place], top_of(sphere));
        }
        Self { counts, heights }
    }

    /// Mean over the cells that hold grains, of all or of one slice across x [m]; `None` where there is none.
    pub fn mean(&self, slice: Option<usize>) -> Option<f64> {
        let (first, step) = slice.map_or((0, 1), |slice| (slice, self.counts[0]));
        let filled = self.heights.iter().skip(first).step_by(step).filter(|top| top.is_finite());
        let (sum, n) = filled.fold((0.0, 0), |(sum, n), top| (sum + top, n + 1));
        (n > 0).then(|| sum / f64::from(n))
    }
}

/// Mean height of the bed's surface [m]: the mean, over square cells two mean grain diameters wide, of the highest point of
/// any grain whose centre lies in the cell.
pub fn surface_level<P: Precision>(spheres: &[Sphere<P>], size: [f64; 2]) -> f64 {
    Tops::of(spheres, size).mean(None).unwrap_or(f64::NAN)
}

/// Highest point of any grain that a disc of `radius` around (`x`, `y`) would meet on its way down [m].
pub fn highest_below_disc<P: Precision>(spheres: &[Sphere<P>], [x, y]: [f64; 2], radius: f64) -> f64 {
    let is_below = |sphere: &&Sphere<P>| {
        let (dx, dy) = (sphere.position.x.to_f64() - x, sphere.position.y.to_f64() - y);
        dx.hypot(dy) < radius + sphere.radius.to_f64()
    };
    spheres.iter().filter(is_below).fold(0.0, |top, sphere| top.max(top_of(sphere)))
}

fn top_of<P: Precision>(sphere: &Sphere<P>) -> f64 {
    sphere.position.z.to_f64() + sphere.radius.to_f64()
}

/// Highest point of any grain that a box around (`x`, `y`) with these half edges would meet on its way down [m].
pub fn highest_below_box<P: Precision>(spheres: &[Sphere<P>], [x, y]: [f64; 2], half: [f64; 2]) -> f64 {
    let is_below = |sphere: &&Sphere<P>| {
        let reach = half.map(|edge| edge + sphere.radius.to_f64());
        (sphere.position.x.to_f64() - x).abs() < reach[0] && (sphere.position.y.to_f64() - y).abs() < reach[1]
    };
    spheres.iter().filter(is_below).fold(0.0, |top, sphere| top.max(top_of(sphere)))
}

/// Mass of the grains over the volume between floor and surface [kg/m³].
pub fn bulk_density<P: Precision>(spheres: &[Sphere<P>], size: [f64; 2], level: f64) -> f64 {
    spheres.iter().map(|sphere| sphere.mass.to_f64()).sum::<f64>() / (size[0] * size[1] * level)
}

#[cfg(test)]
mod tests {
    use super::*;
    use grouser_dem::sphere;
    use grouser_geometry::Vec3;

    #[test]
    fn a_layer_of_equal_grains_is_level_with_their_tops() {
        let place = |i: usize| Vec3::new(0.01 + 0.02 * (i % 10) as f64, 0.01 + 0.02 * (i / 10) as f64, 0.01);
        let mut spheres: Vec<Sphere> = (0..100).map(|i| sphere(place(i), 0.01, 1000.0, 0)).collect();
        assert!((surface_level(&spheres, [0.2001, 0.2001]) - 0.02).abs() < 1e-15);
        assert!((highest_below_disc(&spheres, [0.1, 0.1], 0.05) - 0.02).abs() < 1e-15);
        spheres[0].position.z = 0.03;
        assert!((highest_below_disc(&spheres, [0.1, 0.1], 0.05) - 0.02).abs() < 1e-15);
        assert!((highest_below_disc(&spheres, [0.0, 0.0], 0.05) - 0.04).abs() < 1e-15);
        assert!((surface_level(&spheres, [0.2001, 0.2001]) - (0.02 + 0.02 / 25.0)).abs() < 1e-15);
    }
}
