//! Loads on a solid: gravity, spin of a body-attached frame, pressure on surfaces.

use grouser_geometry::nalgebra::Matrix3;
use grouser_geometry::{Facet, TetrahedralMesh, Vec3};
use serde::{Deserialize, Serialize};

use crate::statics::BlockMatrix;

/// Loads that act at every step beside the nodal forces that the caller applies.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Loads {
    /// Acceleration of gravity in the world frame [m/s²].
    pub gravity: Vec3,
    /// Turning of the solid's frame.
    pub spin: Spin,
    /// Pressures on surfaces.
    pub pressures: Vec<Pressure>,
}

/// How the solid's frame turns about its origin: the source of centrifugal, Euler's and Coriolis' forces.
///
/// An accelerated origin is a gravity: subtract its acceleration from [`Loads::gravity`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Spin {
    /// Angular velocity ω in the solid's frame [rad/s].
    pub angular_velocity: Vec3,
    /// Its rate of change ω' in the solid's frame [rad/s²].
    pub angular_acceleration: Vec3,
}

impl Spin {
    /// Whether there is anything to add.
    pub(crate) fn is_turning(&self) -> bool {
        self.angular_velocity != Vec3::zeros() || self.angular_acceleration != Vec3::zeros()
    }

    /// Acceleration −ω' × x − ω × (ω × x) of what rests in the frame at `x` [m/s²].
    pub fn acceleration_at(&self, x: &Vec3) -> Vec3 {
        let w = self.angular_velocity;
        -self.angular_acceleration.cross(x) - w.cross(&w.cross(x))
    }
}

/// Pressure on some facets; it follows them where the formulation rotates.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pressure {
    /// Name of the surface.
    pub surface: String,
    /// Loaded facets.
    pub facets: Vec<Facet>,
    /// Pressure against the outward normal [Pa].
    pub pressure: f64,
}

/// Quadrature of a six-node triangle, degree 4 (Dunavant 1985): natural coordinates and weights that sum to 1.
const TRIANGLE_POINTS: [([f64; 3], f64); 6] = {
    const A: f64 = 0.445_948_490_915_965;
    const B: f64 = 0.091_576_213_509_771;
    const WA: f64 = 0.223_381_589_678_011;
    const WB: f64 = 0.109_951_743_655_322;
    [
        ([A, A, 1.0 - 2.0 * A], WA),
        ([A, 1.0 - 2.0 * A, A], WA),
        ([1.0 - 2.0 * A, A, A], WA),
        ([B, B, 1.0 - 2.0 * B], WB),
        ([B, 1.0 - 2.0 * B, B], WB),
        ([1.0 - 2.0 * B, B, B], WB),
    ]
};

impl Pressure {
    /// Adds −p ∫ N_i n dA at the given nodal positions [m] to `force` [N], scaled by `factor`.
    pub(crate) fn add_forces(
        &self,
        mesh: &TetrahedralMesh,
        position: impl Fn(u32) -> Vec3,
        factor: f64,
        force: &mut [Vec3],
    ) {
        for &facet in &self.facets {
            let nodes = mesh.facet_nodes(facet);
            let x: Vec<Vec3> = nodes.iter().map(|&n| position(n)).collect();
            for_each_tangent(&x, |shape, _, weight, [a, b]| {
                let area = a.cross(&b) * weight;
                for (i, &n) in nodes.iter().enumerate() {
                    force[n as usize] -= factor * self.pressure * shape[i] * area;
                }
            });
        }
    }

    /// Adds the symmetric part of minus the derivative of the forces by the positions to a stiffness matrix.
    pub(crate) fn add_stiffness(
        &self,
        mesh: &TetrahedralMesh,
        position: impl Fn(u32) -> Vec3,
        factor: f64,
        stiffness: &mut BlockMatrix,
    ) {
        for &facet in &self.facets {
            let nodes = mesh.facet_nodes(facet);
            let x: Vec<Vec3> = nodes.iter().map(|&n| position(n)).collect();
            let n = nodes.len();
            let mut k = vec![Matrix3::zeros(); n * n];
            for_each_tangent(&x, |shape, derivatives, weight, [a, b]| {
                // f_i = -p w N_i (a x b), da = sum D_j1 dx_j, db = sum D_j2 dx_j
                for i in 0..n {
                    for j in 0..n {
                        let change =
                            a.cross_matrix() * derivatives[j][1] - b.cross_matrix() * derivatives[j][0];
                        k[i * n + j] += change * (factor * self.pressure * weight * shape[i]);
                    }
                }
            });
            for i in 0..n {
                for j in 0..n {
                    let symmetric = (k[i * n + j] + k[j * n + i].transpose()) / 2.0;
                    *stiffness.block_mut(nodes[i] as usize, nodes[j] as usize) += symmetric;
                }
            }
        }
    }
}

/// Calls `at_point(shape functions, derivatives by L1 and L2, weight, tangents)`; weights sum to 1/2.
fn for_each_tangent(x: &[Vec3], mut at_point: impl FnMut(&[f64], &[[f64; 2]], f64, [Vec3; 2])) {
    let tangents = |derivatives: &[[f64; 2]]| {
        [0, 1].map(|k| x.iter().zip(derivatives).fold(Vec3::zeros(), |sum, (x, d)| sum + x * d[k]))
    };
    if x.len() == 3 {
        let derivatives = [[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]];
        return at_point(&[1.0 / 3.0; 3], &derivatives, 0.5, tangents(&derivatives));
    }
    for (l, weight) in TRIANGLE_POINTS {
        let [l0, l1, l2] = l;
        let shape = [
            l0 * (2.0 * l0 - 1.0),
            l1 * (2.0 * l1 - 1.0),
            l2 * (2.0 * l2 - 1.0),
            4.0 * l0 * l1,
            4.0 * l1 * l2,
            4.0 * l2 * l0,
        ];
        let derivatives = [
            [1.0 - 4.0 * l0, 1.0 - 4.0 * l0],
            [4.0 * l1 - 1.0, 0.0],
            [0.0, 4.0 * l2 - 1.0],
            [4.0 * (l0 - l1), -4.0 * l1],
            [4.0 * l2, 4.0 * l1],
            [-4.0 * l2, 4.0 * (l0 - l2)],
        ];
        at_point(&shape, &derivatives, 0.5 * weight, tangents(&derivatives));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use grouser_geometry::box_mesh;

    #[test]
    fn pressure_on_a_side_gives_force_and_moment_of_the_textbook_and_its_stiffness_by_differences() {
        let linear = box_mesh(Vec3::new(1.0, 2.0, 3.0), [1, 2, 2]);
        for mesh in [linear.to_quadratic(), linear] {
            let facets = mesh.facets("x_max").unwrap().to_vec();
            let load = Pressure { surface: "x_max".into(), facets, pressure: 5.0 };
            let mut force = vec![Vec3::zeros(); mesh.nodes.len()];
            load.add_forces(&mesh, |n| mesh.nodes[n as usize], 1.0, &mut force);
            let total: Vec3 = force.iter().sum();
            let moment: Vec3 = force.iter().zip(&mesh.nodes).map(|(f, x)| x.cross(f)).sum();
            assert!((total - Vec3::new(-30.0, 0.0, 0.0)).norm() < 1e-12);
            // Acts at the middle (1, 1, 1.5): r x F.
            assert!((moment - Vec3::new(1.0, 1.0, 1.5).cross(&total)).norm() < 1e-12);
        }
    }

    #[test]
    fn closed_surface_under_pressure_has_the_stiffness_found_by_differences() {
        let mesh = box_mesh(Vec3::new(1.0, 2.0, 3.0), [1, 1, 1]).to_quadratic();
        let load = Pressure { surface: String::new(), facets: mesh.boundary().unwrap(), pressure: 5.0 };
        let n = mesh.nodes.len();
        let all: Vec<u32> = (0..n as u32).collect();
        let mut stiffness = BlockMatrix::with_pattern(n, std::iter::once(&all[..]));
        let position = |n: u32| mesh.nodes[n as usize];
        load.add_stiffness(&mesh, position, 1.0, &mut stiffness);
        let h = 1e-5;
        for (node, axis) in [(0, 0), (n - 1, 1), (n / 2, 2)] {
            let forces = |d: f64| {
                let mut force = vec![Vec3::zeros(); n];
                let moved = |m: u32| {
                    position(m) + if m as usize == node { Vec3::ith(axis, d) } else { Vec3::zeros() }
                };
                load.add_forces(&mesh, moved, 1.0, &mut force);
                force
            };
            let (ahead, behind) = (forces(h), forces(-h));
            for i in 0..n {
                let difference = (ahead[i] - behind[i]) / (2.0 * h);
                let column = stiffness.block_mut(i, node).column(axis).into_owned();
                assert!((column + difference).norm() < 1e-8, "{i} {node}: {column} {difference}");
            }
        }
    }
}
