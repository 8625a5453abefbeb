//! Classes of grain sizes: each class finds its neighbours on a grid of its own.

use grouser_contact::{Precision, Real, Sphere};
use serde::{Deserialize, Serialize};

/// Classes that sizes are first sorted into, each half as large as the one above: size ratios up to 256.
const MOST_LEVELS: usize = 8;
/// Share of the grains below which the smallest sizes are not worth a finer grid.
const WORTHWHILE: f64 = 0.05;

/// Largest radius of each level [m], rising; one entry where sizes differ by less than a factor of two.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct SizeLevels {
    largest: Vec<f64>,
}

impl SizeLevels {
    /// Levels of `spheres`, of which there is one at least.
    pub fn new<P: Precision>(spheres: &[Sphere<P>]) -> Self {
        let radii = spheres.iter().map(|sphere| sphere.radius.to_f64());
        let largest = radii.clone().fold(0.0, f64::max);
        // Class k from the top holds radii in (largest/2ᵏ⁺¹, largest/2ᵏ].
        let mut classes = [(0_usize, 0.0_f64); MOST_LEVELS];
        for radius in radii {
            let (mut class, mut half) = (0, 0.5 * largest);
            while class + 1 < MOST_LEVELS && radius <= half {
                (class, half) = (class + 1, 0.5 * half);
            }
            let (n, of_class) = &mut classes[class];
            (*n, *of_class) = (*n + 1, of_class.max(radius));
        }
        let (mut levels, mut n_below) = (Vec::new(), 0);
        for (n, of_class) in classes.into_iter().rev().filter(|(n, _)| *n > 0) {
            n_below += n;
            if n_below as f64 >= WORTHWHILE * spheres.len() as f64 {
                levels.push(of_class);
            }
        }
        Self { largest: levels }
    }

    /// Number of levels.
    pub fn n(&self) -> usize {
        self.largest.len()
    }

    /// Largest radius of `level` [m].
    pub fn largest(&self, level: usize) -> f64 {
        self.largest[level]
    }

    /// Level of a radius [m].
    pub fn of(&self, radius: f64) -> usize {
        self.largest[..self.n() - 1].partition_point(|&largest| largest < radius)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use grouser_geometry::Vec3;

    fn levels(radii: &[f64]) -> SizeLevels {
        let spheres: Vec<Sphere> =
            radii.iter().map(|&radius| crate::sphere(Vec3::zeros(), radius, 1.0, 0)).collect();
        SizeLevels::new(&spheres)
    }

    #[test]
    fn sizes_within_a_factor_of_two_share_a_level() {
        assert_eq!(levels(&[1.0, 1.5, 1.99]).n(), 1);
        let two = levels(&[1.1, 1.5, 4.0]);
        assert_eq!((two.n(), two.largest(0), two.largest(1)), (2, 1.5, 4.0));
        assert_eq!([0.5, 1.5, 1.6, 4.0].map(|radius| two.of(radius)), [0, 0, 1, 1]);
    }

    #[test]
    fn few_small_grains_get_no_grid_of_their_own_and_few_large_ones_do() {
        let mut radii = vec![1.0; 100];
        radii.extend([0.1, 0.01]);
        assert_eq!(levels(&radii).n(), 1);
        radii.push(100.0);
        let two = levels(&radii);
        assert_eq!((two.n(), two.of(0.01), two.of(1.0), two.of(100.0)), (2, 0, 0, 1));
    }
}
