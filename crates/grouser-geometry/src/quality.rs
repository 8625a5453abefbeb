//! Quality of the tetrahedra of a mesh: volumes, dihedral angles, shape.

use serde::{Deserialize, Serialize};

use crate::tetrahedron_shape::{EDGES, FACE_CORNERS};
use crate::{TetrahedralMesh, Vec3};

/// Worst and mean figures of a mesh, with the elements that set them (corners only).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct QualityReport {
    /// Number of elements.
    pub n_elements: usize,
    /// Number of nodes.
    pub n_nodes: usize,
    /// Total volume [m³].
    pub volume: f64,
    /// Smallest angle between two faces of an element [rad]; 70.5° is regular, below 10° a sliver.
    pub smallest_dihedral_angle: f64,
    /// Largest angle between two faces of an element [rad]; above 165° a sliver.
    pub largest_dihedral_angle: f64,
    /// Smallest shape figure 12 (3V)^(2/3) / Σ edge²: 1 for a regular tetrahedron, 0 for a flat one.
    pub smallest_shape: f64,
    /// Ten-node elements whose curved sides fold over at a corner; harmless with lumped mass, straighten them otherwise.
    pub n_folded_corners: usize,
    /// Mean shape figure.
    pub mean_shape: f64,
    /// Element of the smallest shape figure.
    pub worst_element: u64,
}

impl QualityReport {
    /// Report on a mesh; inverted elements count with shape 0.
    pub fn of(mesh: &TetrahedralMesh) -> Self {
        let n_elements = mesh.n_elements();
        let mut report = Self {
            n_elements,
            n_nodes: mesh.nodes.len(),
            volume: mesh.volume(),
            smallest_dihedral_angle: f64::INFINITY,
            largest_dihedral_angle: 0.0,
            smallest_shape: f64::INFINITY,
            n_folded_corners: (0..n_elements).filter(|&e| mesh.is_folded(e)).count(),
            mean_shape: 0.0,
            worst_element: 0,
        };
        for e in 0..n_elements {
            let x = mesh.element_positions(e);
            let normals = FACE_CORNERS.map(|[a, b, c]| (x[b] - x[a]).cross(&(x[c] - x[a])).normalize());
            for i in 0..4 {
                for j in 0..i {
                    let angle = (-normals[i].dot(&normals[j])).clamp(-1.0, 1.0).acos();
                    report.smallest_dihedral_angle = report.smallest_dihedral_angle.min(angle);
                    report.largest_dihedral_angle = report.largest_dihedral_angle.max(angle);
                }
            }
            let shape = shape_figure(&x);
            report.mean_shape += shape / n_elements as f64;
            if shape < report.smallest_shape {
                report.smallest_shape = shape;
                report.worst_element = mesh.element_label(e);
            }
        }
        report
    }
}

/// Shape figure 12 (3V)^(2/3) / Σ edge² of the corners of an element: 1 if regular, 0 if flat or inverted.
pub(crate) fn shape_figure(x: &[Vec3]) -> f64 {
    let volume = (x[1] - x[0]).cross(&(x[2] - x[0])).dot(&(x[3] - x[0])) / 6.0;
    let edges: f64 = EDGES.iter().map(|&[i, j]| (x[i] - x[j]).norm_squared()).sum();
    12.0 * (3.0 * volume.max(0.0)).powf(2.0 / 3.0) / edges
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::box_mesh;

    #[test]
    fn a_regular_tetrahedron_is_perfect() {
        let mesh = TetrahedralMesh {
            nodes: vec![
                Vec3::new(1.0, 1.0, 1.0),
                Vec3::new(-1.0, 1.0, -1.0),
                Vec3::new(1.0, -1.0, -1.0),
                Vec3::new(-1.0, -1.0, 1.0),
            ],
            connectivity: vec![0, 1, 2, 3],
            region_of_element: vec![0],
            region_names: vec!["solid".into()],
            ..Default::default()
        };
        mesh.validate().unwrap();
        let report = QualityReport::of(&mesh);
        assert!((report.smallest_shape - 1.0).abs() < 1e-12);
        assert!((report.smallest_dihedral_angle.to_degrees() - 70.528_779).abs() < 1e-6);
    }

    #[test]
    fn cells_cut_in_six_have_angles_between_45_and_90_degrees() {
        let report = QualityReport::of(&box_mesh(Vec3::repeat(1.0), [2, 2, 2]));
        assert!((report.smallest_dihedral_angle.to_degrees() - 45.0).abs() < 1e-9);
        assert!((report.largest_dihedral_angle.to_degrees() - 90.0).abs() < 1e-9);
    }
}
