//! Shape functions of the tetrahedra of four and ten nodes, by natural (volume) coordinates.
//!
//! Natural coordinates L0…L3 sum to 1. Seen from corner 3 the corners 0, 1, 2 run anticlockwise, so that the volume
//! (x1 − x0) × (x2 − x0) · (x3 − x0) / 6 is positive.
//!
//! ```text
//!      3
//!     /|\        mid-side nodes:  4 = (0,1)  5 = (1,2)  6 = (2,0)
//!    7 9 8                        7 = (0,3)  8 = (1,3)  9 = (2,3)
//!   /  |  \
//!  0-6-2-5-1     (0-4-1 runs in front)
//! ```

use nalgebra::Matrix3;

use crate::Vec3;

/// Corner pairs of the mid-side nodes 4…9 of a ten-node tetrahedron.
pub const EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];

/// Corners of the four faces, anticlockwise seen from outside.
pub const FACE_CORNERS: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];

/// Corners and then mid-side nodes (after corner 0, 1, 2 of the face) of the four faces of a ten-node tetrahedron.
pub const FACE_NODES: [[usize; 6]; 4] =
    [[0, 2, 1, 6, 5, 4], [0, 1, 3, 4, 8, 7], [1, 2, 3, 5, 9, 8], [0, 3, 2, 7, 9, 6]];

/// Natural coordinates of the four quadrature points of degree 2, each of weight 1/4 of the volume.
pub const QUADRATURE_POINTS: [[f64; 4]; 4] = [[A, B, B, B], [B, A, B, B], [B, B, A, B], [B, B, B, A]];
const A: f64 = 0.585_410_196_624_968_5;
const B: f64 = 0.138_196_601_125_010_5;

/// Natural coordinates of the four corners.
pub const CORNERS: [[f64; 4]; 4] =
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

/// Values of the ten shape functions at natural coordinates `l`; they sum to 1.
pub fn quadratic_shape(l: [f64; 4]) -> [f64; 10] {
    let mut shape = [0.0; 10];
    for i in 0..4 {
        shape[i] = l[i] * (2.0 * l[i] - 1.0);
    }
    for (m, [i, j]) in EDGES.into_iter().enumerate() {
        shape[4 + m] = 4.0 * l[i] * l[j];
    }
    shape
}

/// Derivatives of the ten shape functions by (L1, L2, L3) at natural coordinates `l`; each column sums to 0.
pub fn quadratic_shape_derivatives(l: [f64; 4]) -> [Vec3; 10] {
    // dL0 = -(dL1 + dL2 + dL3)
    let d = [Vec3::repeat(-1.0), Vec3::x(), Vec3::y(), Vec3::z()];
    let mut derivatives = [Vec3::zeros(); 10];
    for i in 0..4 {
        derivatives[i] = d[i] * (4.0 * l[i] - 1.0);
    }
    for (m, [i, j]) in EDGES.into_iter().enumerate() {
        derivatives[4 + m] = 4.0 * (d[i] * l[j] + d[j] * l[i]);
    }
    derivatives
}

/// Derivatives of the four linear shape functions by (L1, L2, L3).
pub fn linear_shape_derivatives() -> [Vec3; 4] {
    [Vec3::repeat(-1.0), Vec3::x(), Vec3::y(), Vec3::z()]
}

/// Jacobian ∂x/∂(L1, L2, L3) [m] of nodes at `positions` with the shape functions' `derivatives`; its determinant is six
/// times the volume per natural volume.
pub fn jacobian(positions: &[Vec3], derivatives: &[Vec3]) -> Matrix3<f64> {
    positions.iter().zip(derivatives).map(|(x, d)| x * d.transpose()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shape_functions_are_one_at_their_own_node_and_zero_at_the_others() {
        let mut nodes = CORNERS.to_vec();
        for [i, j] in EDGES {
            nodes.push(std::array::from_fn(|k| (CORNERS[i][k] + CORNERS[j][k]) / 2.0));
        }
        for (n, l) in nodes.into_iter().enumerate() {
            for (m, value) in quadratic_shape(l).into_iter().enumerate() {
                assert_eq!(value, f64::from(m == n), "shape {m} at node {n}");
            }
        }
    }

    #[test]
    fn derivatives_agree_with_central_differences() {
        let l = |p: Vec3| [1.0 - p.sum(), p.x, p.y, p.z];
        let (p, h) = (Vec3::new(0.2, 0.3, 0.1), 1e-5);
        for (n, d) in quadratic_shape_derivatives(l(p)).into_iter().enumerate() {
            for axis in 0..3 {
                let step = h * Vec3::ith(axis, 1.0);
                let difference =
                    (quadratic_shape(l(p + step))[n] - quadratic_shape(l(p - step))[n]) / (2.0 * h);
                assert!((d[axis] - difference).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn faces_name_the_mid_side_nodes_between_their_corners() {
        for face in FACE_NODES {
            for k in 0..3 {
                let (a, b) = (face[k], face[(k + 1) % 3]);
                let [i, j] = EDGES[face[3 + k] - 4];
                assert!([[i, j], [j, i]].contains(&[a, b]));
            }
        }
    }
}
