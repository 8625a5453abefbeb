//! The point of a triangle that is closest to a place, and what part of the triangle it lies on.

use grouser_geometry::Vec3;

/// Part of a triangle; a face goes before an edge, an edge before a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Feature {
    /// Inside.
    Face,
    /// On one of the three edges.
    Edge,
    /// At one of the three corners.
    Vertex,
}

/// Closest point to `place` on the triangle `[a, b, c]`, and the part it lies on: by the Voronoi region that the place falls into.
///
/// ```
/// # use grouser_coupling::{Feature, closest_point};
/// # use grouser_geometry::Vec3;
/// let triangle = [Vec3::zeros(), Vec3::x(), Vec3::y()];
/// let (point, feature) = closest_point(&Vec3::new(0.2, 0.3, 5.0), &triangle);
/// assert!((point - Vec3::new(0.2, 0.3, 0.0)).norm() < 1e-15 && feature == Feature::Face);
/// assert_eq!(closest_point(&Vec3::new(-1.0, -1.0, 1.0), &triangle).1, Feature::Vertex);
/// ```
pub fn closest_point(place: &Vec3, [a, b, c]: &[Vec3; 3]) -> (Vec3, Feature) {
    let (ab, ac) = (b - a, c - a);
    let from_a = place - a;
    let (a1, a2) = (ab.dot(&from_a), ac.dot(&from_a));
    if a1 <= 0.0 && a2 <= 0.0 {
        return (*a, Feature::Vertex);
    }
    let from_b = place - b;
    let (b1, b2) = (ab.dot(&from_b), ac.dot(&from_b));
    if b1 >= 0.0 && b2 <= b1 {
        return (*b, Feature::Vertex);
    }
    let weight_c = a1 * b2 - b1 * a2;
    if weight_c <= 0.0 && a1 >= 0.0 && b1 <= 0.0 {
        return (a + ab * (a1 / (a1 - b1)), Feature::Edge);
    }
    let from_c = place - c;
    let (c1, c2) = (ab.dot(&from_c), ac.dot(&from_c));
    if c2 >= 0.0 && c1 <= c2 {
        return (*c, Feature::Vertex);
    }
    let weight_b = c1 * a2 - a1 * c2;
    if weight_b <= 0.0 && a2 >= 0.0 && c2 <= 0.0 {
        return (a + ac * (a2 / (a2 - c2)), Feature::Edge);
    }
    let weight_a = b1 * c2 - c1 * b2;
    if weight_a <= 0.0 && b2 - b1 >= 0.0 && c1 - c2 >= 0.0 {
        return (b + (c - b) * ((b2 - b1) / ((b2 - b1) + (c1 - c2))), Feature::Edge);
    }
    let whole = weight_a + weight_b + weight_c;
    (a + ab * (weight_b / whole) + ac * (weight_c / whole), Feature::Face)
}

/// Natural coordinates (L_a, L_b, L_c) of a `point` of the triangle `[a, b, c]`, which sum to 1: point = L_a a + L_b b + L_c c.
/// A triangle without area counts as its first corner.
///
/// ```
/// # use grouser_coupling::natural_coordinates;
/// # use grouser_geometry::Vec3;
/// let [a, b, c] = natural_coordinates(&Vec3::new(0.2, 0.3, 0.0), &[Vec3::zeros(), Vec3::x(), Vec3::y()]);
/// assert!((a - 0.5).abs() < 1e-15 && (b - 0.2).abs() < 1e-15 && (c - 0.3).abs() < 1e-15);
/// ```
pub fn natural_coordinates(point: &Vec3, [a, b, c]: &[Vec3; 3]) -> [f64; 3] {
    let (ab, ac, from_a) = (b - a, c - a, point - a);
    // Normal equations of from_a = L_b ab + L_c ac.
    let (bb, bc, cc) = (ab.dot(&ab), ab.dot(&ac), ac.dot(&ac));
    let (pb, pc) = (from_a.dot(&ab), from_a.dot(&ac));
    let determinant = bb * cc - bc * bc;
    if determinant <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let (l_b, l_c) = ((cc * pb - bc * pc) / determinant, (bb * pc - bc * pb) / determinant);
    [1.0 - l_b - l_c, l_b, l_c]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_point_of_a_fine_raster_is_closer() {
        let triangle = [Vec3::new(0.1, 0.2, 0.0), Vec3::new(1.1, 0.0, 0.3), Vec3::new(0.4, 0.9, -0.2)];
        let n = 60;
        for seed in 0..200 {
            let along = |k: f64| 3.0 * (k * (f64::from(seed) + 0.37)).sin();
            let place = Vec3::new(along(12.9), along(78.2), along(37.7));
            let found = (closest_point(&place, &triangle).0 - place).norm();
            for i in 0..=n {
                for j in 0..=n - i {
                    let (u, v) = (f64::from(i) / f64::from(n), f64::from(j) / f64::from(n));
                    let point = triangle[0] * (1.0 - u - v) + triangle[1] * u + triangle[2] * v;
                    assert!(found <= (point - place).norm() + 1e-12);
                }
            }
        }
    }
}
