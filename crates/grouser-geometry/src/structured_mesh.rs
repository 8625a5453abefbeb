//! Tetrahedral meshes made from a lattice of cells: boxes, cylinders, rings, and any smooth map of a lattice.
//!
//! Every cell is cut into six tetrahedra around its diagonal (Kuhn's triangulation); neighbours match, also across the seam
//! of a lattice that closes on itself.

use std::f64::consts::TAU;

use crate::tetrahedron_shape::{jacobian, linear_shape_derivatives};
use crate::{Facet, TetrahedralMesh, Vec3};

/// The six tetrahedra of a cell by corner bits (1 = first axis, 2 = second, 4 = third), positive in a right-handed lattice.
const KUHN: [[usize; 4]; 6] =
    [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]];

/// Lattice of cells that is mapped into space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lattice {
    /// Number of cells along the three axes, each at least 1.
    pub cells: [usize; 3],
    /// Whether the last cell along the second axis touches the first one.
    pub is_closed: bool,
}

impl Lattice {
    /// Mesh of the cells for which `keep` holds: lattice point `p` (0…cells along each axis) goes to `map(p)` [m].
    ///
    /// One region `"solid"`; surfaces `first_min`, `first_max`, `second_min`, …: where the boundary lies on a side of the lattice.
    /// A map that mirrors is mended by turning all elements around.
    pub fn mesh(
        self,
        keep: impl Fn([usize; 3]) -> bool,
        map: impl Fn([usize; 3]) -> Vec3,
    ) -> TetrahedralMesh {
        let cells = self.cells;
        let points = [cells[0] + 1, if self.is_closed { cells[1] } else { cells[1] + 1 }, cells[2] + 1];
        let index = |p: [usize; 3]| (p[0] * points[1] + p[1] % points[1]) * points[2] + p[2];
        // Node number of each lattice point that a kept cell uses, in the order of first use.
        let mut node_of_point = vec![u32::MAX; points[0] * points[1] * points[2]];
        let mut mesh = TetrahedralMesh { region_names: vec!["solid".to_owned()], ..Default::default() };
        let mut lattice_of_element = Vec::new();
        for cell in iterate(cells).filter(|&c| keep(c)) {
            let corner =
                |bits: usize| [cell[0] + (bits & 1), cell[1] + (bits >> 1 & 1), cell[2] + (bits >> 2)];
            for tetrahedron in KUHN {
                for bits in tetrahedron {
                    let node = &mut node_of_point[index(corner(bits))];
                    if *node == u32::MAX {
                        *node = mesh.nodes.len() as u32;
                        mesh.nodes.push(map(corner(bits)));
                    }
                    mesh.connectivity.push(*node);
                }
                lattice_of_element.push(tetrahedron.map(corner));
            }
        }
        mesh.region_of_element = vec![0; mesh.n_elements()];
        if mesh.n_elements() > 0
            && jacobian(&mesh.element_positions(0), &linear_shape_derivatives()).determinant() < 0.0
        {
            mesh.connectivity.chunks_exact_mut(4).for_each(|nodes| nodes.swap(1, 2));
            lattice_of_element.iter_mut().for_each(|corners| corners.swap(1, 2));
        }
        let boundary = mesh.boundary().expect("a lattice shares each face between two cells at most");
        for (axis, axis_name) in ["first", "second", "third"].into_iter().enumerate() {
            for (end, side) in [(0, "min"), (cells[axis], "max")] {
                if axis == 1 && self.is_closed {
                    continue;
                }
                let is_on_side = |f: &Facet| {
                    let corners = lattice_of_element[f.element as usize];
                    crate::tetrahedron_shape::FACE_CORNERS[f.face as usize]
                        .iter()
                        .all(|&i| corners[i][axis] == end)
                };
                let facets = boundary.iter().copied().filter(is_on_side).collect();
                mesh.surfaces.insert(format!("{axis_name}_{side}"), facets);
            }
        }
        mesh
    }
}

/// Box from the origin to `size` [m], surfaces `x_min` … `z_max`.
pub fn box_mesh(size: Vec3, cells: [usize; 3]) -> TetrahedralMesh {
    let map = |p: [usize; 3]| Vec3::from_fn(|i, _| size[i] * p[i] as f64 / cells[i] as f64);
    let mut mesh = Lattice { cells, is_closed: false }.mesh(|_| true, map);
    rename(&mut mesh, ["x", "y", "z"]);
    mesh
}

/// Thick-walled cylinder around the z axis, or a sector of it from the x axis over `angle` [rad] (2π: the whole ring).
///
/// `cells` along radius, angle and axis; radii and `length` [m]; surfaces `inner`, `outer`, `z_min`, `z_max`, and for a sector
/// `angle_min` (in the plane y = 0) and `angle_max`.
pub fn hollow_cylinder(
    inner: f64,
    outer: f64,
    length: f64,
    angle: f64,
    cells: [usize; 3],
) -> TetrahedralMesh {
    let is_closed = angle >= TAU * (1.0 - 1e-12);
    let map = |p: [usize; 3]| {
        let [r, a, z] = [0, 1, 2].map(|i| p[i] as f64 / cells[i] as f64);
        let (radius, angle) = (inner + (outer - inner) * r, angle.min(TAU) * a);
        Vec3::new(radius * angle.cos(), radius * angle.sin(), length * z)
    };
    let mut mesh = Lattice { cells, is_closed }.mesh(|_| true, map);
    rename(&mut mesh, ["radius", "angle", "z"]);
    for (lattice, name) in [("radius_min", "inner"), ("radius_max", "outer")] {
        let facets = mesh.surfaces.remove(lattice).unwrap_or_default();
        mesh.surfaces.insert(name.to_owned(), facets);
    }
    mesh
}

/// Solid cylinder around the z axis from z = 0 to `length` [m]: a square of `2 n` × `2 n` cells pressed into the circle.
///
/// Surfaces `side`, `z_min`, `z_max`.
pub fn cylinder(radius: f64, length: f64, n: usize, n_axial: usize) -> TetrahedralMesh {
    let cells = [2 * n, 2 * n, n_axial];
    let map = |p: [usize; 3]| {
        let [x, y] = [0, 1].map(|i| p[i] as f64 / n as f64 - 1.0);
        // Rings of the square become circles, the more so the further out.
        let ring = x.abs().max(y.abs());
        let circle = if ring == 0.0 { 1.0 } else { ring / x.hypot(y) };
        let scale = radius * ((1.0 - ring) * 0.75 + ring * circle);
        Vec3::new(scale * x, scale * y, length * p[2] as f64 / n_axial as f64)
    };
    let mut mesh = Lattice { cells, is_closed: false }.mesh(|_| true, map);
    rename(&mut mesh, ["x", "y", "z"]);
    let side = ["x_min", "x_max", "y_min", "y_max"]
        .into_iter()
        .flat_map(|s| mesh.surfaces.remove(s).unwrap_or_default());
    let mut side: Vec<Facet> = side.collect();
    side.sort_unstable();
    mesh.surfaces.insert("side".to_owned(), side);
    mesh
}

fn rename(mesh: &mut TetrahedralMesh, axes: [&str; 3]) {
    for (lattice, axis) in ["first", "second", "third"].into_iter().zip(axes) {
        for side in ["min", "max"] {
            if let Some(facets) = mesh.surfaces.remove(&format!("{lattice}_{side}")) {
                mesh.surfaces.insert(format!("{axis}_{side}"), facets);
            }
        }
    }
}

fn iterate(cells: [usize; 3]) -> impl Iterator<Item = [usize; 3]> {
    (0..cells[0]).flat_map(move |i| (0..cells[1]).flat_map(move |j| (0..cells[2]).map(move |k| [i, j, k])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn area(mesh: &TetrahedralMesh, name: &str) -> f64 {
        let (surface, _) = mesh.triangle_surface(mesh.facets(name).unwrap());
        (0..surface.triangles.len()).map(|t| surface.area_vector(t).norm()).sum()
    }

    #[test]
    fn a_box_has_its_volume_and_its_sides_face_outwards() {
        let mesh = box_mesh(Vec3::new(1.0, 2.0, 3.0), [2, 3, 4]);
        mesh.validate().unwrap();
        assert!((mesh.volume() - 6.0).abs() < 1e-12);
        assert!((area(&mesh, "x_max") - 6.0).abs() < 1e-12);
        let (surface, _) = mesh.triangle_surface(mesh.facets("x_max").unwrap());
        assert!((surface.normal(0) - Vec3::x()).norm() < 1e-12);
        let quadratic = mesh.to_quadratic();
        quadratic.validate().unwrap();
        assert!((quadratic.volume() - 6.0).abs() < 1e-12);
        let (surface, _) = quadratic.triangle_surface(quadratic.facets("z_min").unwrap());
        assert!((0..surface.triangles.len()).all(|t| (surface.normal(t) + Vec3::z()).norm() < 1e-12));
    }

    #[test]
    fn rings_and_cylinders_approach_their_volume_at_second_order() {
        let ring = |n| hollow_cylinder(0.1, 0.2, 0.3, TAU, [2, n, 1]);
        let solid = |n| cylinder(0.2, 0.3, n, 1);
        for mesh in [ring(12), solid(3)] {
            mesh.validate().unwrap();
        }
        assert!((area(&ring(200), "inner") - TAU * 0.1 * 0.3).abs() < 1e-4);
        let ring_error = |n| 1.0 - ring(n).volume() / (PI * 0.03 * 0.3);
        let solid_error = |n| 1.0 - solid(n).volume() / (PI * 0.04 * 0.3);
        assert!((ring_error(20) / ring_error(40) - 4.0).abs() < 0.1);
        assert!((solid_error(8) / solid_error(16) - 4.0).abs() < 0.3);
    }

    #[test]
    fn cells_left_out_leave_no_nodes_behind() {
        let lattice = Lattice { cells: [3, 3, 1], is_closed: false };
        let mesh = lattice.mesh(|c| c != [1, 1, 0], |p| Vec3::new(p[0] as f64, p[1] as f64, p[2] as f64));
        mesh.validate().unwrap();
        assert!((mesh.volume() - 8.0).abs() < 1e-12);
        assert_eq!(mesh.nodes.len(), 32);
    }
}
