//! STL and OBJ: what is written is read back; damage is named with line and column.

use grouser_geometry::TriangleSurface;
use grouser_geometry::generate::icosphere;
use grouser_geometry::mesh_doctor::{Closedness, examine};
use grouser_geometry::obj::read_obj;
use grouser_geometry::stl::{read_stl, write_binary_stl, write_text_stl};
use proptest::prelude::*;

/// Whether both have the same triangles with the same corner positions, within `tolerance` [m].
fn is_same_shape(a: &TriangleSurface, b: &TriangleSurface, tolerance: f64) -> bool {
    a.triangles.len() == b.triangles.len()
        && (0..a.triangles.len()).all(|t| {
            let (a, b) = (a.corners(t), b.corners(t));
            (0..3).all(|k| (a[k] - b[k]).norm() <= tolerance)
        })
}

#[test]
fn text_stl_comes_back_with_every_digit_and_with_its_neighbours() {
    let sphere = icosphere(0.3, 2).unwrap();
    let mut bytes = Vec::new();
    write_text_stl(&sphere, &mut bytes).unwrap();
    let back = read_stl(&bytes[..]).unwrap();
    assert!(is_same_shape(&sphere, &back, 0.0));
    assert_eq!(examine(&back, Closedness::Required), []);
}

#[test]
fn binary_stl_comes_back_to_single_precision_even_if_its_header_says_solid() {
    let sphere = icosphere(0.3, 2).unwrap();
    let mut bytes = Vec::new();
    write_binary_stl(&sphere, &mut bytes).unwrap();
    bytes[..5].copy_from_slice(b"solid");
    let back = read_stl(&bytes[..]).unwrap();
    assert!(is_same_shape(&sphere, &back, 3e-8) && !is_same_shape(&sphere, &back, 0.0));
    assert_eq!(examine(&back, Closedness::Required), []);
}

#[test]
fn damaged_stl_is_refused_with_place_and_cause() {
    let bytes = [7u8; 100];
    assert!(read_stl(&bytes[..]).unwrap_err().to_string().starts_with("not an STL file: 100 bytes"));
    let text = "solid a\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 x 0\n";
    assert!(
        read_stl(text.as_bytes()).unwrap_err().to_string().starts_with(
            "line 5, column 13: expected a coordinate (three numbers after `vertex`), found `x`"
        )
    );
    let text = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\n";
    assert!(
        read_stl(text.as_bytes())
            .unwrap_err()
            .to_string()
            .contains("line 6, column 1: expected exactly three")
    );
}

#[test]
fn obj_keeps_double_precision_and_cuts_polygons_into_fans() {
    let text = "# pyramid\nmtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.123456789012345 0.5 1e0 # tip\nvn 0 0 1\n\
                f 4//1 3//1 2//1 1//1\nf 1/1 2/1 5/1\nf 2 3 5\nf -3 -2 -1\nf 4 1 5\n";
    let surface = read_obj(text.as_bytes()).unwrap();
    assert_eq!(surface.vertices[4].x, 0.123456789012345);
    assert_eq!(surface.triangles[..2], [[3, 2, 1], [3, 1, 0]]);
    assert_eq!(examine(&surface, Closedness::Required), []);
    assert!((surface.volume() - 1.0 / 3.0).abs() < 1e-15);
}

#[test]
fn polygons_that_are_not_convex_are_cut_without_overlap() {
    // A star of ten corners seen from below: fans from any corner would overlap.
    let star: String = (0..10)
        .map(|i| {
            let (angle, r) =
                (-std::f64::consts::TAU * f64::from(i) / 10.0, if i % 2 == 0 { 1.0 } else { 0.2 });
            format!("v {} {} 0\n", r * angle.cos(), r * angle.sin())
        })
        .collect();
    let surface = read_obj(format!("{star}f 1 2 3 4 5 6 7 8 9 10\n").as_bytes()).unwrap();
    assert_eq!(surface.triangles.len(), 8);
    let exact = 10.0 * 0.5 * 0.2 * (std::f64::consts::TAU / 10.0).sin();
    assert!((surface.area() - exact).abs() < 1e-15);
    assert!((0..8).all(|t| surface.normal(t).z < -0.99));
}

#[test]
fn polygon_that_crosses_itself_is_refused() {
    let bow_tie = "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 2 0\nf 1 2 3 4\n";
    let message = read_obj(bow_tie.as_bytes()).unwrap_err().to_string();
    assert!(message.starts_with("line 5: the face of 4 corners crosses itself"), "{message}");
}

#[test]
fn damaged_obj_is_refused_with_line_and_column() {
    for (text, start) in [
        ("v 0 0\n", "line 1, column 6: expected a coordinate (three numbers after `v`), found `end of line`"),
        ("v 0 0 zero\n", "line 1, column 7: expected a coordinate (three numbers after `v`), found `zero`"),
        ("v 0 0 0\nf 1 2 3\n", "line 2, column 5: the face names vertex 2, but 1 vertices precede it"),
        ("v 0 0 0\nf 1 1 0\n", "line 2, column 7: the face names vertex 0"),
        ("v 0 0 0\nf 1 1\n", "line 2, column 6: expected at least three vertex numbers"),
        ("v 0 0 0\nf 1 a 1\n", "line 2, column 5: expected a vertex number"),
    ] {
        let message = read_obj(text.as_bytes()).unwrap_err().to_string();
        assert!(message.starts_with(start), "{message}");
    }
}

proptest! {
    #[test]
    fn readers_return_from_any_bytes_without_panic(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        let _ = (read_stl(&bytes[..]).is_ok(), read_obj(&bytes[..]).is_ok());
        let text: String = bytes.iter().map(|b| ["v ", "f ", "1 ", "-2 ", "3/4 ", "\n", "vertex ", "solid "][*b as usize % 8]).collect();
        let _ = (read_stl(text.as_bytes()).is_ok(), read_obj(text.as_bytes()).is_ok());
    }
}
