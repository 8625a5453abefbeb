//! Forces of contacts spread over a surface, so that a mesh finer than a contact gives Hertz's force (`docs/theory/coupling.md`,
//! local indentation).

use crate::Mirror;
use grouser_geometry::nalgebra::Matrix3;
use grouser_geometry::{TriangleSurface, Vec3};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Cosine of the angle between the normals of vertices that are still one neighbourhood: 45°. A force does not spread around a lug's edge.
const ONE_NEIGHBOURHOOD: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// How the forces of contacts are spread: each vertex of a mirrored surface follows the nodes around it, weighed by
/// K(r) = 3/(π b²) (1 − r²/b²)² within b, and gives them its forces by the same weights.
///
/// A half-space yields to such a force by F C_b, as far as its mesh resolves b. The law holds the solid's whole share of Hertz's
/// indentation, so C_b F is taken from it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// Radius b [m]. The correction is exact up to a contact radius of 0.33 b E'/E*, three times less than b on a solid much softer than the grain.
    pub radius: f64,
    /// Plane modulus E/(1 − ν²) of the solid [Pa].
    pub plane_modulus: f64,
}

impl Spread {
    /// C_b [m/N], the mean displacement by K under a force spread by K: 1/(π E') ∫ K̂(k)² dk = 1179648/155925 / (π² E' b), where
    /// K̂(k) = 48 J₃(kb)/(kb)³.
    pub fn compliance(&self) -> f64 {
        let pi = std::f64::consts::PI;
        1_179_648.0 / 155_925.0 / (pi * pi * self.plane_modulus * self.radius)
    }
}

/// Hertz's contact without the share C F of its approach that a mesh yields by itself.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Remainder {
    /// C [m/N].
    pub compliance: f64,
    /// K of F = K δ^(3/2) [N/m^(3/2)].
    pub stiffness: f64,
}

/// Hertz's whole approach at an overlap, and what is less stored than Hertz's energy there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Approach {
    /// δ [m].
    pub whole: f64,
    /// Energy that the mesh holds instead of the contact [J].
    pub held_by_mesh: f64,
}

impl Remainder {
    /// Solves δ − C F(δ) = `overlap` [m]. Past δ*, where the left side rises by one half of δ, it goes on rising by that, so that no
    /// contact is more than twice as stiff as Hertz's.
    pub fn approach(&self, overlap: f64) -> Approach {
        let Self { compliance, stiffness } = *self;
        let softened = compliance * stiffness;
        let force = |delta: f64| stiffness * delta * delta.sqrt();
        let energy = |delta: f64| 0.4 * force(delta) * delta;
        // δ* by C F'(δ*) = 1/2; there C F = δ*/3.
        let limit = (1.0 / (3.0 * softened)).powi(2);
        let held = |delta: f64| 0.5 * compliance * force(delta).powi(2);
        if overlap >= limit * 2.0 / 3.0 {
            let whole = limit + 2.0 * (overlap - limit * 2.0 / 3.0);
            let held_by_mesh = held(limit) + 0.5 * (energy(whole) - energy(limit));
            return Approach { whole, held_by_mesh };
        }
        // Newton for s = √δ on s² − C K s³, which is convex and rises up to √δ*: from above it never overshoots.
        let mut root = (1.5 * overlap.max(0.0)).sqrt();
        for _ in 0..5 {
            let slope = root * (2.0 - 3.0 * softened * root);
            if slope > 0.0 {
                root -= (root * root * (1.0 - softened * root) - overlap) / slope;
            }
        }
        let whole = root * root;
        Approach { whole, held_by_mesh: held(whole) }
    }
}

impl Mirror {
    /// The same triangles, each vertex following the nodes around it by the weights of [`Spread`]; nodes at `reference(node)` [m].
    ///
    /// Weights of a vertex sum to 1 and are corrected so that motions linear in the tangent plane are followed exactly. A curved surface
    /// is seen lower by some κ b²/8. Vertices without enough neighbours within `radius` [m] follow their own nodes.
    pub fn spread_over(&self, radius: f64, reference: impl Fn(u32) -> Vec3) -> Self {
        let vertices: Vec<Vec3> = (0..self.n_vertices()).map(|v| self.at_vertex(v, &reference)).collect();
        let surface = TriangleSurface { vertices, triangles: self.triangles().to_vec() };
        let mut areas = vec![Vec3::zeros(); surface.vertices.len()];
        for (number, triangle) in surface.triangles.iter().enumerate() {
            triangle.iter().for_each(|&v| areas[v as usize] += surface.area_vector(number) / 3.0);
        }
        let cell = |place: &Vec3| [0, 1, 2].map(|k| (place[k] / radius).floor() as i64);
        let mut cells: BTreeMap<[i64; 3], Vec<usize>> = BTreeMap::new();
        (surface.vertices.iter().enumerate()).for_each(|(v, at)| cells.entry(cell(at)).or_default().push(v));
        let weights_of = |vertex: usize| {
            let (at, normal) = (surface.vertices[vertex], areas[vertex].normalize());
            let [i, j, k] = cell(&at);
            let mut near = Vec::new();
            for shift in 0..27 {
                let key = [i + shift / 9 - 1, j + shift / 3 % 3 - 1, k + shift % 3 - 1];
                for &other in cells.get(&key).map_or(&[][..], Vec::as_slice) {
                    let share = 1.0 - (surface.vertices[other] - at).norm_squared() / (radius * radius);
                    if share > 0.0 && areas[other].normalize().dot(&normal) > ONE_NEIGHBOURHOOD {
                        near.push((other, areas[other].norm() * share * share));
                    }
                }
            }
            let place = |other: usize| (surface.vertices[other] - at) / radius;
            linear_in_the_plane(near, &normal, place).unwrap_or_else(|| vec![(vertex, 1.0)])
        };
        self.followed((0..self.n_vertices()).map(weights_of))
    }
}

/// `near`, pairs of a vertex and its weight, with weights corrected to sum to 1 and to have their centre at the origin of `place` in the
/// plane of `normal`; none where they do not span that plane.
fn linear_in_the_plane(
    mut near: Vec<(usize, f64)>,
    normal: &Vec3,
    place: impl Fn(usize) -> Vec3,
) -> Option<Vec<(usize, f64)>> {
    let along = normal.cross(&Vec3::ith(normal.iamin(), 1.0)).normalize();
    let across = normal.cross(&along);
    let basis = |vertex: usize| {
        let at = place(vertex);
        Vec3::new(1.0, at.dot(&along), at.dot(&across))
    };
    let total: f64 = near.iter().map(|(_, weight)| weight).sum();
    let moments: Matrix3<f64> =
        near.iter().map(|&(v, weight)| basis(v) * basis(v).transpose() * (weight / total)).sum();
    // The plane counts as spanned where weights scatter by more than a hundredth of the radius.
    let least = moments.symmetric_eigenvalues().min();
    let factors = moments.try_inverse().filter(|_| least > 1e-4)?.column(0).into_owned();
    near.iter_mut().for_each(|(v, weight)| *weight *= basis(*v).dot(&factors) / total);
    Some(near)
}

#[cfg(test)]
mod tests {
    use super::*;
    use grouser_geometry::generate::plane;

    #[test]
    fn the_remainder_and_the_mesh_share_hertzs_approach_and_energy() {
        let remainder = Remainder { compliance: 1e-6, stiffness: 2e7 };
        let limit = (1.0_f64 / (3.0 * 20.0)).powi(2);
        for delta in [1e-3, 0.1, 0.5, 0.999, 1.0].map(|share| share * limit) {
            let force = 2e7 * delta * delta.sqrt();
            let approach = remainder.approach(delta - 1e-6 * force);
            assert!((approach.whole - delta).abs() < 1e-9 * delta, "{delta:e} {approach:?}");
            assert!((approach.held_by_mesh - 0.5e-6 * force * force).abs() < 1e-8 * force * delta);
        }
    }

    #[test]
    fn the_force_is_the_slope_of_the_stored_energy_on_both_sides_of_the_limit() {
        let remainder = Remainder { compliance: 1e-6, stiffness: 2e7 };
        let limit = (1.0_f64 / (3.0 * 20.0)).powi(2) * 2.0 / 3.0;
        let stored = |overlap: f64| {
            let Approach { whole, held_by_mesh } = remainder.approach(overlap);
            0.4 * 2e7 * whole.powf(2.5) - held_by_mesh
        };
        for overlap in [0.1, 0.7, 1.5, 4.0].map(|share| share * limit) {
            let step = 1e-4 * overlap;
            let slope = (stored(overlap + step) - stored(overlap - step)) / (2.0 * step);
            let force = 2e7 * remainder.approach(overlap).whole.powf(1.5);
            assert!((slope / force - 1.0).abs() < 1e-6, "{overlap:e}: {slope} {force}");
        }
    }

    #[test]
    fn spread_weights_sum_to_one_and_follow_linear_motions_up_to_the_rim() {
        let surface = plane(1.0, 1.0, 20, 17).unwrap();
        let node = |n: u32| surface.vertices[n as usize];
        let mirror = Mirror::new(&surface.triangles, 1).unwrap();
        let spread = mirror.spread_over(0.16, node);
        let moved = |x: Vec3| Vec3::new(0.3 + x.x - 0.2 * x.y, x.y + 0.1 * x.x, 0.5 * x.x - 0.7 * x.y + 2.0);
        for vertex in 0..spread.n_vertices() {
            let (own, followed) =
                (mirror.at_vertex(vertex, node), spread.at_vertex(vertex, |n| moved(node(n))));
            assert!((followed - moved(own)).norm() < 1e-12, "{own}: {followed}");
        }
        // Curved motions are smoothed: K's second moment is b²/4.
        let bent = spread.at_vertex(9 * 21 + 10, |n| Vec3::z() * node(n).x.powi(2));
        let (x, expected) = (mirror.at_vertex(9 * 21 + 10, node).x, 0.16_f64.powi(2) / 8.0);
        assert!((bent.z - x * x - expected).abs() < 0.1 * expected, "{} {expected}", bent.z - x * x);
    }
}
