//! Which triangles share an edge, and how sharply the surface folds there.

use serde::{Deserialize, Serialize};

use crate::{TriangleSurface, Vec3};

/// Edges of a triangle surface and the triangles on both of their sides.
///
/// Two triangles are neighbours if they share two vertex *numbers*; weld the vertices of a triangle soup first
/// ([`TriangleSurface::welded`]).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SurfaceTopology {
    edges: Vec<Edge>,
    uses: Vec<EdgeUse>,
    edges_of_triangle: Vec<[u32; 3]>,
}

/// An edge between two vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Edge {
    /// Vertex numbers, the smaller first.
    pub vertices: [u32; 2],
    first_use: u32,
    n_uses: u32,
}

/// One triangle that borders an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct EdgeUse {
    /// Number of the triangle.
    pub triangle: u32,
    /// Whether the triangle runs through the edge from the smaller to the larger vertex number.
    pub is_forward: bool,
}

impl SurfaceTopology {
    /// Finds the edges of `surface`, whose vertex numbers must all exist (see the mesh doctor).
    pub fn new(surface: &TriangleSurface) -> Self {
        let mut sides: Vec<([u32; 2], u32, u8, bool)> = Vec::with_capacity(3 * surface.triangles.len());
        for (t, corners) in surface.triangles.iter().enumerate() {
            for k in 0..3 {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                sides.push(([a.min(b), a.max(b)], t as u32, k as u8, a < b));
            }
        }
        sides.sort_unstable();
        let mut topology = Self {
            edges: Vec::with_capacity(sides.len() / 2),
            uses: Vec::with_capacity(sides.len()),
            edges_of_triangle: vec![[0; 3]; surface.triangles.len()],
        };
        for (vertices, triangle, k, is_forward) in sides {
            if topology.edges.last().is_none_or(|e| e.vertices != vertices) {
                topology.edges.push(Edge { vertices, first_use: topology.uses.len() as u32, n_uses: 0 });
            }
            topology.uses.push(EdgeUse { triangle, is_forward });
            let number = topology.edges.len() - 1;
            topology.edges[number].n_uses += 1;
            topology.edges_of_triangle[triangle as usize][k as usize] = number as u32;
        }
        topology
    }

    /// All edges, sorted by their vertex numbers.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// Edge numbers of triangle `t`: entry `k` joins its corners `k` and `k + 1`.
    #[inline]
    pub fn edges_of_triangle(&self, t: usize) -> [u32; 3] {
        self.edges_of_triangle[t]
    }

    /// The triangles that border edge `e`, sorted by number: one at a rim, two inside a surface, more where sheets meet.
    #[inline]
    pub fn uses(&self, e: usize) -> &[EdgeUse] {
        let edge = self.edges[e];
        &self.uses[edge.first_use as usize..(edge.first_use + edge.n_uses) as usize]
    }

    /// The neighbour of triangle `t` across each of its edges, where there is exactly one.
    pub fn neighbours(&self, t: usize) -> [Option<u32>; 3] {
        self.edges_of_triangle(t).map(|e| match self.uses(e as usize) {
            [a, b] => Some(if a.triangle == t as u32 { b.triangle } else { a.triangle }),
            _ => None,
        })
    }

    /// Angle by which the surface folds along edge `e` \[rad\]: 0 where both triangles lie in one plane, positive up to π
    /// on a ridge (convex edge), negative down to −π in a valley; `None` unless exactly two triangles meet.
    ///
    /// The interior dihedral angle is π minus this angle.
    pub fn fold_angle(&self, surface: &TriangleSurface, e: usize) -> Option<f64> {
        let [a, b] = self.uses(e) else { return None };
        let n_a = surface.normal(a.triangle as usize);
        // Where the winding of the second triangle contradicts the first, the first decides which side is out.
        let n_b = surface.normal(b.triangle as usize) * if a.is_forward == b.is_forward { -1.0 } else { 1.0 };
        let [v, w] = self.edges[e].vertices.map(|v| surface.vertices[v as usize]);
        let along: Vec3 = (w - v).normalize() * if a.is_forward { 1.0 } else { -1.0 };
        Some(n_a.cross(&n_b).dot(&along).atan2(n_a.dot(&n_b)))
    }

    /// Whether every edge lies between exactly two triangles of consistent winding: the surface encloses a volume.
    pub fn is_closed(&self) -> bool {
        (0..self.edges.len()).all(|e| matches!(self.uses(e), [a, b] if a.is_forward != b.is_forward))
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use approx::assert_relative_eq;

    use super::*;

    /// Two triangles over the edge 0–1, the second one turned about it by `angle` (positive: away from +z, a ridge).
    fn hinge(angle: f64) -> TriangleSurface {
        TriangleSurface {
            vertices: vec![Vec3::zeros(), Vec3::y(), -Vec3::x(), Vec3::new(angle.cos(), 0.5, -angle.sin())],
            triangles: vec![[0, 1, 2], [1, 0, 3]],
        }
    }

    #[test]
    fn fold_angle_is_positive_on_ridges_and_negative_in_valleys() {
        for angle in [-3.0, -FRAC_PI_2, -0.1, 0.0, 0.1, FRAC_PI_2, 3.0] {
            let surface = hinge(angle);
            let topology = SurfaceTopology::new(&surface);
            let shared = topology.edges().iter().position(|e| e.vertices == [0, 1]).unwrap();
            assert_relative_eq!(topology.fold_angle(&surface, shared).unwrap(), angle, epsilon = 1e-14);
            // The same hinge with one triangle wound the wrong way folds by the same angle.
            let mut crossed = surface.clone();
            crossed.triangles[1] = [0, 1, 3];
            assert_relative_eq!(
                SurfaceTopology::new(&crossed).fold_angle(&crossed, shared).unwrap(),
                angle,
                epsilon = 1e-14
            );
        }
    }

    #[test]
    fn hinge_has_one_inner_edge_and_four_rim_edges() {
        let surface = hinge(0.3);
        let topology = SurfaceTopology::new(&surface);
        let n_uses: Vec<usize> = (0..topology.edges().len()).map(|e| topology.uses(e).len()).collect();
        assert_eq!(n_uses, [2, 1, 1, 1, 1]);
        assert_eq!(topology.neighbours(0), [Some(1), None, None]);
        assert_eq!(topology.fold_angle(&surface, 1), None);
        assert!(!topology.is_closed());
    }
}
