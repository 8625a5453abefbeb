//! Mass: M_ij = ∫ ρ N_i N_j dV (P0 Eq. 33 with the density that the print lacks), consistent or lumped.

use grouser_geometry::nalgebra::DMatrix;
use grouser_geometry::tetrahedron_shape::{jacobian, quadratic_shape, quadratic_shape_derivatives};
use grouser_geometry::{ElementOrder, TetrahedralMesh, Vec3};
use serde::{Deserialize, Serialize};

use crate::material::Material;

/// How mass is spread over the nodes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum MassKind {
    /// Diagonal: a quarter of an element's mass to each corner; ten-node elements by the diagonal of the consistent matrix
    /// (Hinton, Rock & Zienkiewicz 1976).
    #[default]
    Lumped,
    /// Full ∫ ρ N_i N_j: more accurate waves, about half the stable step, one solution with M each step.
    Consistent,
}

/// Mass matrix of a mesh; the same for the three components.
#[derive(Clone, Debug)]
pub(crate) enum Mass {
    Lumped(Vec<f64>),
    Consistent(SparseRows),
}

/// Sparse symmetric matrix by rows, with its diagonal.
#[derive(Clone, Debug)]
pub(crate) struct SparseRows {
    rows: Vec<Vec<(u32, f64)>>,
    diagonal: Vec<f64>,
}

impl Mass {
    pub fn new(mesh: &TetrahedralMesh, materials: &[Material], kind: MassKind) -> Self {
        let n = mesh.nodes.len();
        match kind {
            MassKind::Lumped => {
                let mut lumped = vec![0.0; n];
                for e in 0..mesh.n_elements() {
                    let mass = mesh.element_volume(e) * materials[mesh.region_of_element[e] as usize].density;
                    for (&node, share) in mesh.element(e).iter().zip(lumped_shares(mesh.order)) {
                        lumped[node as usize] += share * mass;
                    }
                }
                Self::Lumped(lumped)
            }
            MassKind::Consistent => {
                let mut rows: Vec<Vec<(u32, f64)>> = vec![Vec::new(); n];
                for e in 0..mesh.n_elements() {
                    let density = materials[mesh.region_of_element[e] as usize].density;
                    let m = consistent_element_mass(mesh, e) * density;
                    for (i, &a) in mesh.element(e).iter().enumerate() {
                        for (j, &b) in mesh.element(e).iter().enumerate() {
                            rows[a as usize].push((b, m[(i, j)]));
                        }
                    }
                }
                let mut diagonal = vec![0.0; n];
                for (i, row) in rows.iter_mut().enumerate() {
                    row.sort_by_key(|&(column, _)| column);
                    row.dedup_by(|next, kept| {
                        let is_same = next.0 == kept.0;
                        if is_same {
                            kept.1 += next.1;
                        }
                        is_same
                    });
                    diagonal[i] = row.iter().find(|&&(j, _)| j as usize == i).map_or(0.0, |&(_, m)| m);
                }
                Self::Consistent(SparseRows { rows, diagonal })
            }
        }
    }

    /// y = M x.
    pub fn multiply(&self, x: &[Vec3], y: &mut [Vec3]) {
        match self {
            Self::Lumped(m) => (0..x.len()).for_each(|i| y[i] = m[i] * x[i]),
            Self::Consistent(m) => m.multiply(x, y),
        }
    }

    /// ½ vᵀ M v [J].
    pub fn kinetic_energy(&self, v: &[Vec3]) -> f64 {
        match self {
            Self::Lumped(m) => m.iter().zip(v).map(|(m, v)| 0.5 * m * v.norm_squared()).sum(),
            Self::Consistent(m) => {
                let mut y = vec![Vec3::zeros(); v.len()];
                m.multiply(v, &mut y);
                v.iter().zip(&y).map(|(v, y)| 0.5 * v.dot(y)).sum()
            }
        }
    }

    /// Sum of each row [kg]: what the node weighs.
    pub fn nodal(&self) -> Vec<f64> {
        match self {
            Self::Lumped(m) => m.clone(),
            Self::Consistent(m) => m.rows.iter().map(|row| row.iter().map(|(_, m)| m).sum()).collect(),
        }
    }

    /// Solves M a = f on the components that are not held; held components of `a` become 0.
    pub fn solve(&self, f: &[Vec3], is_held: &[[bool; 3]], a: &mut [Vec3]) {
        let free = |i: usize, v: Vec3| Vec3::from_fn(|c, _| if is_held[i][c] { 0.0 } else { v[c] });
        match self {
            Self::Lumped(m) => (0..f.len()).for_each(|i| a[i] = free(i, f[i] / m[i])),
            Self::Consistent(m) => m.solve(f, free, a),
        }
    }
}

impl SparseRows {
    fn multiply(&self, x: &[Vec3], y: &mut [Vec3]) {
        for (row, y) in self.rows.iter().zip(y) {
            *y = row.iter().fold(Vec3::zeros(), |sum, &(j, m)| sum + m * x[j as usize]);
        }
    }

    /// Conjugate gradients scaled by the diagonal: M is well conditioned, some twenty rounds give full precision.
    fn solve(&self, f: &[Vec3], free: impl Fn(usize, Vec3) -> Vec3, a: &mut [Vec3]) {
        let n = f.len();
        let dot = |a: &[Vec3], b: &[Vec3]| -> f64 { a.iter().zip(b).map(|(a, b)| a.dot(b)).sum() };
        let scaled = |r: &[Vec3]| -> Vec<Vec3> { (0..n).map(|i| r[i] / self.diagonal[i]).collect() };
        a.fill(Vec3::zeros());
        let mut r: Vec<Vec3> = (0..n).map(|i| free(i, f[i])).collect();
        let mut z = scaled(&r);
        let (mut p, mut q) = (z.clone(), vec![Vec3::zeros(); n]);
        let mut rz = dot(&r, &z);
        let target = 1e-30 * rz;
        for _ in 0..200 {
            // Also ends on NaN, which the caller finds in the velocities.
            if !(rz > target) {
                break;
            }
            self.multiply(&p, &mut q);
            (0..n).for_each(|i| q[i] = free(i, q[i]));
            let alpha = rz / dot(&p, &q);
            for i in 0..n {
                a[i] += alpha * p[i];
                r[i] -= alpha * q[i];
            }
            z = scaled(&r);
            let before = std::mem::replace(&mut rz, dot(&r, &z));
            for i in 0..n {
                p[i] = z[i] + rz / before * p[i];
            }
        }
    }
}

/// Share of each node in the mass of an element.
pub(crate) fn lumped_shares(order: ElementOrder) -> Vec<f64> {
    match order {
        ElementOrder::Linear => vec![0.25; 4],
        ElementOrder::Quadratic => [vec![1.0 / 36.0; 4], vec![4.0 / 27.0; 6]].concat(),
    }
}

/// ∫ N_i N_j dV of element `e` [m³].
pub(crate) fn consistent_element_mass(mesh: &TetrahedralMesh, e: usize) -> DMatrix<f64> {
    match mesh.order {
        ElementOrder::Linear => {
            let volume = mesh.element_volume(e);
            DMatrix::from_fn(4, 4, |i, j| volume / if i == j { 10.0 } else { 20.0 })
        }
        ElementOrder::Quadratic => {
            let positions = mesh.element_positions(e);
            let mut mass = DMatrix::zeros(10, 10);
            for (l, weight) in collapsed_gauss_points() {
                let volume = weight * jacobian(&positions, &quadratic_shape_derivatives(l)).determinant();
                let n = quadratic_shape(l);
                for i in 0..10 {
                    for j in 0..10 {
                        mass[(i, j)] += volume * n[i] * n[j];
                    }
                }
            }
            mass
        }
    }
}

/// Points and weights of degree 5 (exact for N_i N_j of straight-sided elements): a 4 × 4 × 4 Gauss rule of the cube pressed
/// into the tetrahedron. Weights sum to 1/6.
fn collapsed_gauss_points() -> impl Iterator<Item = ([f64; 4], f64)> {
    const GAUSS: [(f64, f64); 4] = [
        (0.069_431_844_202_973_71, 0.173_927_422_568_726_9),
        (0.330_009_478_207_571_9, 0.326_072_577_431_273_1),
        (0.669_990_521_792_428_1, 0.326_072_577_431_273_1),
        (0.930_568_155_797_026_3, 0.173_927_422_568_726_9),
    ];
    GAUSS.into_iter().flat_map(|(a, wa)| {
        GAUSS.into_iter().flat_map(move |(b, wb)| {
            GAUSS.into_iter().map(move |(c, wc)| {
                let (l1, l2, l3) = (a, b * (1.0 - a), c * (1.0 - a) * (1.0 - b));
                ([1.0 - l1 - l2 - l3, l1, l2, l3], wa * wb * wc * (1.0 - a).powi(2) * (1.0 - b))
            })
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use grouser_geometry::box_mesh;

    #[test]
    fn both_kinds_hold_the_whole_mass_for_both_orders() {
        let linear = box_mesh(Vec3::new(1.0, 2.0, 0.5), [2, 2, 1]);
        for mesh in [linear.to_quadratic(), linear] {
            for kind in [MassKind::Lumped, MassKind::Consistent] {
                let mass = Mass::new(&mesh, &[Material::hooke(1200.0, 1e6, 0.3)], kind);
                let total: f64 = mass.nodal().iter().sum();
                assert!((total - 1200.0).abs() < 1e-9, "{total}");
                let speed = vec![Vec3::new(2.0, 0.0, 0.0); mesh.nodes.len()];
                assert!((mass.kinetic_energy(&speed) - 2400.0).abs() < 1e-8);
            }
        }
    }

    #[test]
    fn ten_node_lumping_follows_the_diagonal_of_the_consistent_matrix() {
        let mesh = box_mesh(Vec3::repeat(1.0), [1, 1, 1]).to_quadratic();
        let m = consistent_element_mass(&mesh, 0);
        let trace: f64 = (0..10).map(|i| m[(i, i)]).sum();
        for (i, share) in lumped_shares(ElementOrder::Quadratic).into_iter().enumerate() {
            assert!((m[(i, i)] / trace - share).abs() < 1e-12);
        }
    }

    #[test]
    fn solving_with_the_consistent_mass_undoes_its_product() {
        let mesh = box_mesh(Vec3::repeat(1.0), [2, 2, 2]);
        let mass = Mass::new(&mesh, &[Material::hooke(1200.0, 1e6, 0.3)], MassKind::Consistent);
        let x: Vec<Vec3> = mesh.nodes.iter().map(|p| Vec3::new(p.x.sin(), p.y * p.z, 1.0 - p.x)).collect();
        let (mut f, mut a) = (x.clone(), x.clone());
        mass.multiply(&x, &mut f);
        mass.solve(&f, &vec![[false; 3]; x.len()], &mut a);
        assert!(a.iter().zip(&x).all(|(a, x)| (a - x).norm() < 1e-12));
    }
}
