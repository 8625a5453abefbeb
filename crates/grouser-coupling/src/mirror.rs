//! The surface of a solid as the grains see it: flat triangles whose vertices follow the solid's nodes.

use grouser_geometry::Vec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use thiserror::Error;

/// How the vertices of a triangle surface follow the nodes of a solid, x_v = Σ_i N_i(L_v) x_i, and how forces on vertices go
/// back to the nodes, f_i = Σ_v N_i(L_v) f_v (P0 Eq. 42).
///
/// One set of weights serves both ways, and the weights of a vertex sum to 1: force, moment and power are the same on both
/// sides.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Mirror {
    triangles: Vec<[u32; 3]>,
    /// First entry of each vertex, and the number of entries at the end.
    first: Vec<u32>,
    /// Node and its weight N_i.
    entries: Vec<(u32, f64)>,
}

/// Why a surface cannot be mirrored.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum MirrorError {
    /// A face is no triangle of three or six nodes.
    #[error(
        "face {face} has {n_nodes} nodes; expected 3 corners, or 3 corners and the 3 nodes in the middle of its sides: hand over the \
         faces of tetrahedra of four or ten nodes"
    )]
    Nodes {
        /// Number of the face.
        face: usize,
        /// Its nodes.
        n_nodes: usize,
    },
    /// No face, or no piece of one.
    #[error("the surface has {n_faces} faces, each side cut in {divisions}: expected at least one of both")]
    Empty {
        /// Faces given.
        n_faces: usize,
        /// Pieces of each side asked for.
        divisions: u32,
    },
}

impl Mirror {
    /// Mirror of `faces`, each with 3 nodes (anticlockwise seen from outside) or 6 (those, then the nodes in the middle of sides
    /// (0,1), (1,2), (2,0)). The sides of six-node faces are cut into `divisions` pieces, so that triangles follow their
    /// curvature; two pieces put the vertices on the nodes themselves. Faces of three nodes are flat and stay whole.
    ///
    /// # Errors
    /// [`MirrorError`].
    pub fn new<F: AsRef<[u32]>>(faces: &[F], divisions: u32) -> Result<Self, MirrorError> {
        if faces.is_empty() || divisions == 0 {
            return Err(MirrorError::Empty { n_faces: faces.len(), divisions });
        }
        let mut mirror = Self { first: vec![0], ..Self::default() };
        let mut known = BTreeMap::new();
        for (number, face) in faces.iter().enumerate() {
            match *face.as_ref() {
                [a, b, c] => {
                    let corner = |node| mirror.vertex(&mut known, vec![(node, 1)], 1);
                    let triangle = [a, b, c].map(corner);
                    mirror.triangles.push(triangle);
                }
                [a, b, c, ab, bc, ca] => mirror.cut(&mut known, [a, b, c, ab, bc, ca], divisions),
                ref other => return Err(MirrorError::Nodes { face: number, n_nodes: other.len() }),
            }
        }
        Ok(mirror)
    }

    /// Triangles of a face of six nodes.
    fn cut(&mut self, known: &mut BTreeMap<Vec<(u32, i64)>, u32>, nodes: [u32; 6], divisions: u32) {
        let n = i64::from(divisions);
        // Vertex at L = (n − i − j, i, j)/n; its six shape functions times n² are whole numbers, equal from both sides of an edge.
        let mut at = |i: i64, j: i64| {
            let l = [n - i - j, i, j];
            let shape = [
                l[0] * (2 * l[0] - n),
                l[1] * (2 * l[1] - n),
                l[2] * (2 * l[2] - n),
                4 * l[0] * l[1],
                4 * l[1] * l[2],
                4 * l[2] * l[0],
            ];
            let key = nodes.into_iter().zip(shape).filter(|&(_, weight)| weight != 0).collect();
            self.vertex(known, key, n * n)
        };
        let mut triangles = Vec::new();
        for j in 0..n {
            for i in 0..n - j {
                triangles.push([at(i, j), at(i + 1, j), at(i, j + 1)]);
                if i + j + 1 < n {
                    triangles.push([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
        self.triangles.extend(triangles);
    }

    /// Number of the vertex with these weights times `scale`.
    fn vertex(
        &mut self,
        known: &mut BTreeMap<Vec<(u32, i64)>, u32>,
        mut key: Vec<(u32, i64)>,
        scale: i64,
    ) -> u32 {
        key.sort_unstable();
        if let [(_, weight)] = &mut key[..] {
            *weight = 1;
        }
        if let Some(&vertex) = known.get(&key) {
            return vertex;
        }
        let scale = if key.len() == 1 { 1.0 } else { scale as f64 };
        self.entries.extend(key.iter().map(|&(node, weight)| (node, weight as f64 / scale)));
        self.first.push(self.entries.len() as u32);
        let vertex = self.first.len() as u32 - 2;
        known.insert(key, vertex);
        vertex
    }

    /// The same triangles, each vertex following what others of this mirror do, by `weights` of pairs of a vertex and its share.
    pub(crate) fn followed(&self, weights: impl Iterator<Item = Vec<(usize, f64)>>) -> Self {
        let mut followed = Self { triangles: self.triangles.clone(), first: vec![0], entries: Vec::new() };
        for of_vertices in weights {
            let mut of_nodes: BTreeMap<u32, f64> = BTreeMap::new();
            for (vertex, share) in of_vertices {
                let entries = self.entries_of(vertex).iter();
                entries.for_each(|&(node, weight)| *of_nodes.entry(node).or_default() += share * weight);
            }
            followed.entries.extend(of_nodes);
            followed.first.push(followed.entries.len() as u32);
        }
        followed
    }

    /// Triangles, as numbers of vertices.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Number of vertices.
    pub fn n_vertices(&self) -> usize {
        self.first.len() - 1
    }

    /// What vertex `vertex` takes of a field of the nodes: Σ N_i of_node(i).
    #[inline]
    pub fn at_vertex(&self, vertex: usize, of_node: impl Fn(u32) -> Vec3) -> Vec3 {
        match self.entries_of(vertex) {
            &[(node, _)] => of_node(node),
            several => {
                several.iter().fold(Vec3::zeros(), |sum, &(node, weight)| sum + of_node(node) * weight)
            }
        }
    }

    /// Inverse of the mass that a force on vertex `vertex` moves [1/kg]: Σ N_i² / m_i.
    pub fn inverse_mass(&self, vertex: usize, mass_of_node: impl Fn(u32) -> f64) -> f64 {
        self.entries_of(vertex).iter().map(|&(node, weight)| weight * weight / mass_of_node(node)).sum()
    }

    /// Shares the forces of the vertices out: calls `add(node, force)`, in the order of the vertices.
    pub fn spread(&self, of_vertices: &[Vec3], mut add: impl FnMut(u32, Vec3)) {
        for (vertex, force) in of_vertices.iter().enumerate().filter(|(_, force)| **force != Vec3::zeros()) {
            self.entries_of(vertex).iter().for_each(|&(node, weight)| add(node, force * weight));
        }
    }

    fn entries_of(&self, vertex: usize) -> &[(u32, f64)] {
        &self.entries[self.first[vertex] as usize..self.first[vertex + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A curved face of six nodes and a neighbour along the side from node 1 to node 2.
    const FACES: [[u32; 6]; 2] = [[0, 1, 2, 3, 4, 5], [2, 1, 6, 4, 7, 8]];

    fn node(n: u32) -> Vec3 {
        let v = Vec3::new;
        let flat = [
            v(0.0, 0.0, 0.0),
            v(1.0, 0.0, 0.0),
            v(0.0, 1.0, 0.0),
            v(0.5, 0.0, 0.0),
            v(0.5, 0.5, 0.0),
            v(0.0, 0.5, 0.0),
            v(1.0, 1.0, 0.0),
            v(1.0, 0.5, 0.0),
            v(0.5, 1.0, 0.0),
        ][n as usize];
        flat + Vec3::z() * (flat.x * flat.x + flat.x * flat.y - 0.5 * flat.y * flat.y)
    }

    #[test]
    fn vertices_of_a_quadratic_face_lie_on_it_and_shared_sides_share_them() {
        for divisions in [1, 2, 3, 4] {
            let mirror = Mirror::new(&FACES, divisions).unwrap();
            let n = divisions as usize;
            assert_eq!((mirror.triangles().len(), mirror.n_vertices()), (2 * n * n, (n + 1) * (n + 1)));
            for vertex in 0..mirror.n_vertices() {
                let x = mirror.at_vertex(vertex, node);
                assert!((x.z - (x.x * x.x + x.x * x.y - 0.5 * x.y * x.y)).abs() < 1e-14, "{divisions}: {x}");
            }
        }
    }

    #[test]
    fn spread_forces_keep_force_moment_and_power() {
        let mirror = Mirror::new(&FACES, 3).unwrap();
        let of_vertices: Vec<Vec3> = (0..mirror.n_vertices())
            .map(|v| Vec3::new((v as f64).sin(), (2.0 * v as f64).cos(), 1.0 + v as f64))
            .collect();
        let velocity = |n: u32| Vec3::new(f64::from(n).cos(), 0.3 * f64::from(n), f64::from(n).sin());
        let mut sums = [Vec3::zeros(); 4];
        let mut powers = [0.0; 2];
        for (vertex, force) in of_vertices.iter().enumerate() {
            sums[0] += force;
            sums[1] += mirror.at_vertex(vertex, node).cross(force);
            powers[0] += mirror.at_vertex(vertex, velocity).dot(force);
        }
        mirror.spread(&of_vertices, |n, force| {
            sums[2] += force;
            sums[3] += node(n).cross(&force);
            powers[1] += velocity(n).dot(&force);
        });
        assert!((sums[0] - sums[2]).norm() < 1e-12 && (sums[1] - sums[3]).norm() < 1e-12);
        assert!((powers[0] - powers[1]).abs() < 1e-12 * powers[0].abs());
    }

    #[test]
    fn faces_of_other_elements_are_refused_by_number() {
        let message = Mirror::new(&[vec![0, 1, 2], vec![0, 1, 2, 3]], 1).unwrap_err().to_string();
        assert!(message.contains("face 1 has 4 nodes"), "{message}");
        assert!(Mirror::new::<[u32; 3]>(&[], 1).is_err());
    }
}
