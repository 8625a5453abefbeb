//! Surfaces made of triangles, and the integrals over them.

use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

use crate::{BoundingBox, Pose, Vec3};

/// Surface made of triangles.
///
/// Corners of a triangle run anticlockwise seen from outside (from where the grains are): its normal points outwards.
/// The readers and generators of this crate give such surfaces; [`crate::mesh_doctor`] checks the others.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TriangleSurface {
    /// Positions of the vertices [m].
    pub vertices: Vec<Vec3>,
    /// Three vertex numbers per triangle, counted from 0.
    pub triangles: Vec<[u32; 3]>,
}

/// What a solid of uniform density 1 kg/m³ inside a closed surface weighs and how it resists rotation.
///
/// Multiply `volume` and `inertia` by the density to obtain mass [kg] and inertia [kg·m²].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SolidProperties {
    /// Enclosed volume [m³]; negative where the triangles face inwards.
    pub volume: f64,
    /// Centre of mass [m].
    pub centroid: Vec3,
    /// Inertia tensor about the centre of mass, axes parallel to the surface's frame, per unit density [m⁵].
    pub inertia: Matrix3<f64>,
}

impl TriangleSurface {
    /// Positions of the three corners of triangle `t` [m].
    #[inline]
    pub fn corners(&self, t: usize) -> [Vec3; 3] {
        self.triangles[t].map(|v| self.vertices[v as usize])
    }

    /// Vector along the outward normal of triangle `t`, as long as the triangle is large [m²].
    #[inline]
    pub fn area_vector(&self, t: usize) -> Vec3 {
        let [a, b, c] = self.corners(t);
        (b - a).cross(&(c - a)) / 2.0
    }

    /// Outward unit normal of triangle `t`; zero for a triangle without area.
    #[inline]
    pub fn normal(&self, t: usize) -> Vec3 {
        self.area_vector(t).try_normalize(0.0).unwrap_or_else(Vec3::zeros)
    }

    /// Centroid of triangle `t` [m].
    #[inline]
    pub fn triangle_center(&self, t: usize) -> Vec3 {
        let [a, b, c] = self.corners(t);
        (a + b + c) / 3.0
    }

    /// Total area [m²].
    pub fn area(&self) -> f64 {
        (0..self.triangles.len()).map(|t| self.area_vector(t).norm()).sum()
    }

    /// Box around all vertices.
    pub fn bounding_box(&self) -> BoundingBox {
        BoundingBox::of(&self.vertices)
    }

    /// Volume inside the surface [m³], which must be closed; negative where the triangles face inwards.
    pub fn volume(&self) -> f64 {
        let center = self.bounding_box().center();
        (0..self.triangles.len()).map(|t| self.signed_volume_seen_from(&center, t)).sum()
    }

    /// Volume, centre of mass and inertia of the solid inside the surface, which must be closed.
    ///
    /// Sum over the tetrahedra between each triangle and one point, with signs. For a tetrahedron with one corner at
    /// the origin, the others at a, b, c and s = a + b + c: ∫x dV = V s/4 and ∫x xᵀ dV = V (aaᵀ + bbᵀ + ccᵀ + ssᵀ)/20
    /// (exact integration of second-degree polynomials over a simplex).
    pub fn solid_properties(&self) -> SolidProperties {
        let reference = self.bounding_box().center();
        let (mut volume, mut first, mut second) = (0.0, Vec3::zeros(), Matrix3::zeros());
        for t in 0..self.triangles.len() {
            let [a, b, c] = self.corners(t).map(|p| p - reference);
            let s = a + b + c;
            let v = a.dot(&b.cross(&c)) / 6.0;
            volume += v;
            first += s * (v / 4.0);
            second +=
                (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose()) * (v / 20.0);
        }
        let offset = first / volume;
        let central = second - offset * offset.transpose() * volume;
        let inertia = Matrix3::identity() * central.trace() - central;
        SolidProperties { volume, centroid: reference + offset, inertia }
    }

    /// The same surface moved rigidly.
    pub fn transformed(&self, pose: &Pose) -> Self {
        let vertices = self.vertices.iter().map(|v| pose.rotation * v + pose.translation.vector).collect();
        Self { vertices, triangles: self.triangles.clone() }
    }

    /// The same surface, lengths multiplied by `factor` about the origin.
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            vertices: self.vertices.iter().map(|v| v * factor).collect(),
            triangles: self.triangles.clone(),
        }
    }

    /// The same surface with its outside and inside exchanged.
    pub fn flipped(&self) -> Self {
        let triangles = self.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
        Self { vertices: self.vertices.clone(), triangles }
    }

    /// Adds the triangles of `other`; vertices are not merged.
    pub fn append(&mut self, other: &Self) {
        let offset = self.vertices.len() as u32;
        self.vertices.extend_from_slice(&other.vertices);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|v| v + offset)));
    }

    /// The same surface with vertices closer than `tolerance` [m] merged into the one of lowest number, and triangles
    /// that thereby lost their area removed.
    ///
    /// STL files store every corner by itself: without welding no two of their triangles are neighbours.
    pub fn welded(&self, tolerance: f64) -> Self {
        let mut order: Vec<usize> = (0..self.vertices.len()).collect();
        order.sort_by(|&i, &j| self.vertices[i].x.total_cmp(&self.vertices[j].x).then(i.cmp(&j)));
        let mut representative: Vec<usize> = (0..self.vertices.len()).collect();
        for (rank, &i) in order.iter().enumerate() {
            for &j in &order[rank + 1..] {
                if self.vertices[j].x - self.vertices[i].x > tolerance {
                    break;
                }
                if (self.vertices[j] - self.vertices[i]).norm() <= tolerance {
                    let (a, b) = (root(&representative, i), root(&representative, j));
                    representative[a.max(b)] = a.min(b);
                }
            }
        }
        let mut number = vec![u32::MAX; self.vertices.len()];
        let mut vertices = Vec::new();
        for i in 0..self.vertices.len() {
            let r = root(&representative, i);
            if number[r] == u32::MAX {
                number[r] = vertices.len() as u32;
                vertices.push(self.vertices[r]);
            }
            number[i] = number[r];
        }
        let triangles = self
            .triangles
            .iter()
            .map(|t| t.map(|v| number[v as usize]))
            .filter(|[a, b, c]| a != b && b != c && c != a)
            .collect();
        Self { vertices, triangles }
    }

    fn signed_volume_seen_from(&self, point: &Vec3, t: usize) -> f64 {
        let [a, b, c] = self.corners(t).map(|p| p - point);
        a.dot(&b.cross(&c)) / 6.0
    }
}

fn root(representative: &[usize], mut i: usize) -> usize {
    while representative[i] != i {
        i = representative[i];
    }
    i
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    /// A tetrahedron with corners at the origin and at 1 on each axis.
    fn unit_tetrahedron() -> TriangleSurface {
        TriangleSurface {
            vertices: vec![Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()],
            triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
        }
    }

    #[test]
    fn tetrahedron_has_the_integrals_of_the_textbook() {
        let surface = unit_tetrahedron();
        assert_relative_eq!(surface.area(), 1.5 + 3f64.sqrt() / 2.0, epsilon = 1e-15);
        assert_relative_eq!(surface.volume(), 1.0 / 6.0, epsilon = 1e-15);
        let solid = surface.solid_properties();
        assert_relative_eq!(solid.centroid, Vec3::repeat(0.25), epsilon = 1e-15);
        // ∫(y² + z²) dV = 2 · 1/60 about the corner; minus V (1/16 + 1/16) about the centroid.
        assert_relative_eq!(solid.inertia[(0, 0)], 1.0 / 30.0 - 1.0 / 48.0, epsilon = 1e-15);
        // −∫xy dV = −1/120; plus V/16.
        assert_relative_eq!(solid.inertia[(0, 1)], -1.0 / 120.0 + 1.0 / 96.0, epsilon = 1e-15);
    }

    #[test]
    fn integrals_turn_with_the_surface() {
        let pose = Pose::new(Vec3::new(10.0, -3.0, 2.0), Vec3::new(0.3, 1.1, -0.7));
        let (still, moved) =
            (unit_tetrahedron().solid_properties(), unit_tetrahedron().transformed(&pose).solid_properties());
        let r = pose.rotation.to_rotation_matrix();
        assert_relative_eq!(moved.volume, still.volume, epsilon = 1e-14);
        assert_relative_eq!(
            moved.centroid,
            pose * nalgebra::Point3::from(still.centroid) - nalgebra::Point3::origin(),
            epsilon = 1e-13
        );
        assert_relative_eq!(
            moved.inertia,
            r.matrix() * still.inertia * r.matrix().transpose(),
            epsilon = 1e-13
        );
    }

    #[test]
    fn scaling_and_flipping_act_on_the_volume_as_expected() {
        assert_relative_eq!(unit_tetrahedron().scaled(2.0).volume(), 8.0 / 6.0, epsilon = 1e-14);
        assert_relative_eq!(unit_tetrahedron().flipped().volume(), -1.0 / 6.0, epsilon = 1e-15);
    }

    #[test]
    fn welding_joins_the_corners_of_a_triangle_soup() {
        let whole = unit_tetrahedron();
        let mut soup = TriangleSurface::default();
        for t in 0..4 {
            let offset = soup.vertices.len() as u32;
            soup.vertices.extend(whole.corners(t).map(|p| p + Vec3::repeat(1e-9 * t as f64)));
            soup.triangles.push([offset, offset + 1, offset + 2]);
        }
        let welded = soup.welded(1e-6);
        assert_eq!((soup.vertices.len(), welded.vertices.len(), welded.triangles.len()), (12, 4, 4));
        assert_relative_eq!(welded.volume(), whole.volume(), epsilon = 1e-7);
    }
}
