//! Every kind of damage is found, and named with its number and place.

use grouser_geometry::generate::{cuboid, plane};
use grouser_geometry::mesh_doctor::{Closedness, Finding, examine};
use grouser_geometry::{TriangleSurface, Vec3};

fn unit_box() -> TriangleSurface {
    cuboid(Vec3::repeat(1.0)).unwrap()
}

#[test]
fn vertex_that_is_not_a_number_is_named() {
    let mut surface = unit_box();
    surface.vertices[5].y = f64::NAN;
    let findings = examine(&surface, Closedness::Optional);
    assert!(matches!(findings[..], [Finding::NonFiniteVertex { vertex: 5, .. }]), "{findings:?}");
    assert!(
        findings[0]
            .to_string()
            .starts_with("vertex 5 at (0.500000, NaN, 1.000000) is not finite; usual cause")
    );
}

#[test]
fn vertex_number_beyond_the_end_is_named() {
    let mut surface = unit_box();
    surface.triangles[3][1] = 8;
    let findings = examine(&surface, Closedness::Optional);
    assert_eq!(findings, [Finding::VertexOutOfRange { triangle: 3, vertex: 8, n_vertices: 8 }]);
    assert!(findings[0].to_string().contains("only 8 (0 to 7)"));
}

#[test]
fn needles_and_points_have_no_area() {
    for third in [Vec3::new(0.5, 1e-12, 0.0), Vec3::zeros()] {
        let surface = TriangleSurface {
            vertices: vec![Vec3::zeros(), Vec3::x(), Vec3::y(), third],
            triangles: vec![[0, 1, 2], [0, 1, 3]],
        };
        // Both triangles border the edge 0–1 in the same direction as well.
        let findings = examine(&surface, Closedness::Optional);
        assert!(matches!(findings[0], Finding::ZeroArea { triangle: 1, .. }), "{findings:?}");
    }
}

#[test]
fn hole_is_reported_only_where_a_closed_surface_is_needed() {
    let mut surface = unit_box();
    surface.triangles.remove(0);
    assert_eq!(examine(&surface, Closedness::Optional), []);
    let findings = examine(&surface, Closedness::Required);
    assert_eq!(findings.len(), 3);
    assert!(findings.iter().all(|f| matches!(f, Finding::OpenEdge { .. })), "{findings:?}");
}

#[test]
fn third_triangle_on_an_edge_is_reported_for_solids() {
    let mut surface = unit_box();
    surface.vertices.push(Vec3::new(0.0, 0.0, 3.0));
    surface.triangles.push([0, 1, 8]);
    let findings = examine(&surface, Closedness::Required);
    assert!(
        findings.iter().any(
            |f| matches!(f, Finding::NonManifoldEdge { vertices: [0, 1], triangles, .. } if triangles.len() == 3)
        ),
        "{findings:?}"
    );
}

#[test]
fn turned_triangle_contradicts_its_three_neighbours() {
    let mut surface = unit_box();
    surface.triangles[0].swap(0, 1);
    let findings = examine(&surface, Closedness::Optional);
    assert_eq!(findings.len(), 3);
    assert!(
        findings.iter().all(|f| matches!(f, Finding::InconsistentWinding { triangles: [0, _], .. })),
        "{findings:?}"
    );
}

#[test]
fn box_turned_inside_out_is_recognised() {
    let findings = examine(&unit_box().flipped(), Closedness::Required);
    assert!(
        matches!(findings[..], [Finding::InsideOut { volume }] if (volume + 1.0).abs() < 1e-12),
        "{findings:?}"
    );
}

#[test]
fn repeated_triangle_is_named_with_its_double() {
    let mut surface = plane(1.0, 1.0, 2, 2).unwrap();
    let [a, b, c] = surface.triangles[6];
    surface.triangles.push([b, c, a]);
    let findings = examine(&surface, Closedness::Optional);
    assert!(
        findings.iter().any(|f| matches!(f, Finding::DuplicateTriangle { triangle: 8, first: 6, .. })),
        "{findings:?}"
    );
}

#[test]
fn surface_without_triangles_is_refused() {
    assert_eq!(
        examine(&TriangleSurface::default(), Closedness::Optional),
        [Finding::Empty { n_vertices: 0 }]
    );
}
