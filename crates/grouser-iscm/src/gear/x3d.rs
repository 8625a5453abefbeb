//! X3D files: the geometry of a track shoe as one triangle surface.

use std::io::Read;

use grouser_geometry::{Orientation, TriangleSurface, Vec3};
use nalgebra::Matrix4;
use roxmltree::{Document, Node, ParsingOptions};
use thiserror::Error;

/// Why an X3D file could not be read.
#[derive(Debug, Error)]
pub enum X3dError {
    /// The source itself failed, or is not text.
    #[error("the X3D data could not be read: {0}")]
    Io(#[from] std::io::Error),
    /// Not XML.
    #[error("the X3D data are not valid XML: {0}; X3D in classic VRML encoding is not understood")]
    Xml(#[from] roxmltree::Error),
    /// A node that holds geometry in a form that is not read.
    #[error(
        "line {line}: the node `{node}` is not supported; expected IndexedFaceSet, IndexedTriangleSet or TriangleSet within Shape, Group \
         and Transform; remedy: export the mesh as triangles"
    )]
    Unsupported {
        /// Line, counted from 1.
        line: u32,
        /// Name of the node.
        node: String,
    },
    /// An attribute that is wrong or absent.
    #[error("line {line}: `{attribute}` of `{node}`: expected {expected}")]
    Attribute {
        /// Line, counted from 1.
        line: u32,
        /// Name of the node.
        node: String,
        /// Name of the attribute.
        attribute: &'static str,
        /// What was expected.
        expected: &'static str,
    },
    /// No triangle.
    #[error("the X3D data hold no face")]
    Empty,
}

/// Reads all faces of an X3D scene (XML encoding); nested transforms are applied.
pub fn read_x3d(mut source: impl Read) -> Result<TriangleSurface, X3dError> {
    let mut text = String::new();
    source.read_to_string(&mut text)?;
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    let document = Document::parse_with_options(&text, options)?;
    let mut surface = TriangleSurface::default();
    visit(document.root_element(), &Matrix4::identity(), &mut surface)?;
    if surface.triangles.is_empty() { Err(X3dError::Empty) } else { Ok(surface) }
}

fn visit(node: Node, to_scene: &Matrix4<f64>, surface: &mut TriangleSurface) -> Result<(), X3dError> {
    match node.tag_name().name() {
        "X3D" | "Scene" | "Group" | "Shape" | "Collision" | "Switch" => {}
        "Transform" => {
            let to_scene = to_scene * transform(node)?;
            return node.children().filter(Node::is_element).try_for_each(|n| visit(n, &to_scene, surface));
        }
        "IndexedFaceSet" => return faces(node, "coordIndex", false, to_scene, surface),
        "IndexedTriangleSet" => return faces(node, "index", true, to_scene, surface),
        "TriangleSet" => return faces(node, "", true, to_scene, surface),
        // Without geometry.
        "head" | "meta" | "Appearance" | "Viewpoint" | "NavigationInfo" | "Background" | "WorldInfo"
        | "DirectionalLight" | "PointLight" | "SpotLight" | "Fog" => return Ok(()),
        other => return Err(X3dError::Unsupported { line: line(node), node: other.into() }),
    }
    node.children().filter(Node::is_element).try_for_each(|n| visit(n, to_scene, surface))
}

fn transform(node: Node) -> Result<Matrix4<f64>, X3dError> {
    let vector = |attribute, default: Vec3| match numbers(node, attribute)?[..] {
        [] => Ok(default),
        [x, y, z] => Ok(Vec3::new(x, y, z)),
        _ => Err(bad(node, attribute, "three numbers")),
    };
    let turn = |attribute| match numbers(node, attribute)?[..] {
        [] => Ok(Orientation::identity()),
        [x, y, z, angle] => Ok(Vec3::new(x, y, z)
            .try_normalize(1e-12)
            .map_or(Orientation::identity(), |a| Orientation::new(a * angle))),
        _ => Err(bad(node, attribute, "an axis and an angle: four numbers")),
    };
    let (shift, centre) = (vector("translation", Vec3::zeros())?, vector("center", Vec3::zeros())?);
    let (scale, axes, rotation) =
        (vector("scale", Vec3::repeat(1.0))?, turn("scaleOrientation")?, turn("rotation")?);
    // T C R SR S SR⁻¹ C⁻¹ (ISO/IEC 19775-1, Transform)
    Ok(Matrix4::new_translation(&(shift + centre))
        * rotation.to_homogeneous()
        * axes.to_homogeneous()
        * Matrix4::new_nonuniform_scaling(&scale)
        * axes.inverse().to_homogeneous()
        * Matrix4::new_translation(&-centre))
}

fn faces(
    node: Node,
    index_attribute: &'static str,
    is_triangles: bool,
    to_scene: &Matrix4<f64>,
    surface: &mut TriangleSurface,
) -> Result<(), X3dError> {
    let Some(coordinate) = node.children().find(|n| n.has_tag_name("Coordinate")) else {
        return Err(bad(node, "Coordinate", "a Coordinate child with points"));
    };
    let points = numbers(coordinate, "point")?;
    if points.is_empty() || points.len() % 3 != 0 {
        return Err(bad(coordinate, "point", "three numbers per point"));
    }
    let (first, n) = (surface.vertices.len() as u32, points.len() / 3);
    let place = |p: &[f64]| to_scene.transform_point(&nalgebra::Point3::new(p[0], p[1], p[2])).coords;
    surface.vertices.extend(points.chunks(3).map(place));
    let indices: Vec<i64> = match index_attribute {
        "" => (0..n as i64).collect(),
        attribute => numbers(node, attribute)?.iter().map(|&v| v as i64).collect(),
    };
    if indices.iter().any(|&v| v >= n as i64) {
        return Err(bad(
            node,
            if is_triangles { "index" } else { "coordIndex" },
            "numbers below the number of points",
        ));
    }
    let is_mirrored = to_scene.fixed_view::<3, 3>(0, 0).determinant() < 0.0;
    let is_inward = (node.attribute("ccw") == Some("false")) != is_mirrored;
    let mut push = |a: i64, b: i64, c: i64| {
        let [a, b, c] = [a, b, c].map(|v| first + v as u32);
        surface.triangles.push(if is_inward { [a, c, b] } else { [a, b, c] });
    };
    if is_triangles {
        indices.chunks_exact(3).for_each(|t| push(t[0], t[1], t[2]));
    } else {
        for face in indices.split(|&v| v < 0) {
            for k in 2..face.len() {
                push(face[0], face[k - 1], face[k]);
            }
        }
    }
    Ok(())
}

fn numbers(node: Node, attribute: &'static str) -> Result<Vec<f64>, X3dError> {
    let text = node.attribute(attribute).unwrap_or("");
    let words = text.split([' ', ',', '\n', '\t', '\r']).filter(|w| !w.is_empty());
    words.map(|w| w.parse().map_err(|_| bad(node, attribute, "numbers"))).collect()
}

fn bad(node: Node, attribute: &'static str, expected: &'static str) -> X3dError {
    X3dError::Attribute { line: line(node), node: node.tag_name().name().into(), attribute, expected }
}

fn line(node: Node) -> u32 {
    node.document().text_pos_at(node.range().start).row
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHOE: &str = r#"<?xml version="1.0"?>
<!DOCTYPE X3D PUBLIC "ISO//Web3D//DTD X3D 3.0//EN" "http://www.web3d.org/specifications/x3d-3.0.dtd">
<X3D><Scene>
<Transform translation="0 0 -0.02" rotation="0 0 1 1.5707963267948966" scale="2 1 1"><Shape>
<IndexedFaceSet coordIndex="0 1 2 3 -1"><Coordinate point="0 0 0, 1 0 0, 1 1 0, 0 1 0"/></IndexedFaceSet>
</Shape></Transform></Scene></X3D>"#;

    #[test]
    fn faces_are_read_through_their_transforms() {
        let surface = read_x3d(SHOE.as_bytes()).unwrap();
        assert_eq!((surface.vertices.len(), surface.triangles.len()), (4, 2));
        assert!((surface.vertices[1] - Vec3::new(0.0, 2.0, -0.02)).norm() < 1e-12);
        assert!((surface.area() - 2.0).abs() < 1e-12);
    }

    #[test]
    fn an_unsupported_node_is_named_with_its_line() {
        let text = SHOE.replace("IndexedFaceSet", "Extrusion");
        let error = read_x3d(text.as_bytes()).unwrap_err();
        assert!(matches!(error, X3dError::Unsupported { line: 5, .. }), "{error}");
        let text = SHOE.replace("2 3 -1", "2 7 -1");
        assert!(matches!(read_x3d(text.as_bytes()), Err(X3dError::Attribute { .. })));
    }
}
