//! Gmsh and Abaqus files: what is written is read back; damage is named with line or number; no damage ends in a panic.

use std::fmt::Write;

use grouser_geometry::abaqus::read_abaqus;
use grouser_geometry::gmsh::read_gmsh;
use grouser_geometry::{
    ElementOrder, MeshError, MeshFileError, QualityReport, TetrahedralMesh, Vec3, box_mesh,
};
use proptest::prelude::*;

/// Box of two materials, linear or quadratic, with a surface and a node set.
fn sample(is_quadratic: bool) -> TetrahedralMesh {
    let mut mesh = box_mesh(Vec3::new(1.0, 0.7, 0.3), [2, 1, 1]);
    mesh.region_names = vec!["carcass".to_owned(), "tread of rubber".to_owned()];
    (6..12).for_each(|e| mesh.region_of_element[e] = 1);
    mesh.element_labels = (0..12).map(|e| 101 + 2 * e).collect();
    let mut mesh = if is_quadratic { mesh.to_quadratic() } else { mesh };
    mesh.surfaces.retain(|name, _| name == "x_max" || name == "z_min");
    mesh.node_sets.insert("corner".to_owned(), vec![0, 3]);
    mesh
}

/// Node order of Gmsh's ten-node tetrahedron.
fn gmsh_order(nodes: &[u32]) -> Vec<u32> {
    let mut nodes: Vec<u32> = nodes.iter().map(|n| 10 + n).collect();
    if nodes.len() == 10 {
        nodes.swap(8, 9);
    }
    nodes
}

fn join(numbers: &[u32], separator: &str) -> String {
    numbers.iter().map(u32::to_string).collect::<Vec<_>>().join(separator)
}

const NAMES: &str = "$PhysicalNames\n5\n3 1 \"carcass\"\n3 2 \"tread of rubber\"\n2 3 \"x_max\"\n2 4 \"z_min\"\n0 5 \"corner\"\n$EndPhysicalNames\n";

fn gmsh_2(mesh: &TetrahedralMesh) -> String {
    let mut text = format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Comments\nby hand\n$EndComments\n{NAMES}");
    // A node that no tetrahedron uses, as programs leave behind.
    write!(text, "$Nodes\n{}\n9 5 5 5\n", mesh.nodes.len() + 1).unwrap();
    for (i, x) in mesh.nodes.iter().enumerate() {
        writeln!(text, "{} {} {} {}", 10 + i, x.x, x.y, x.z).unwrap();
    }
    let mut elements = vec!["1 15 2 5 1 10".to_owned(), "2 15 2 5 1 13".to_owned()];
    let triangle = if mesh.order == ElementOrder::Linear { 2 } else { 9 };
    for (tag, name) in [(3, "x_max"), (4, "z_min")] {
        for &facet in mesh.facets(name).unwrap() {
            let nodes: Vec<u32> = mesh.facet_nodes(facet).iter().map(|n| 10 + n).collect();
            elements.push(format!("{} {triangle} 2 {tag} 7 {}", 500 + elements.len(), join(&nodes, " ")));
        }
    }
    let tetrahedron = if mesh.order == ElementOrder::Linear { 4 } else { 11 };
    for e in 0..mesh.n_elements() {
        let (label, region) = (mesh.element_label(e), mesh.region_of_element[e] + 1);
        elements
            .push(format!("{label} {tetrahedron} 2 {region} 1 {}", join(&gmsh_order(mesh.element(e)), " ")));
    }
    write!(text, "$EndNodes\n$Elements\n{}\n{}\n$EndElements\n", elements.len(), elements.join("\n"))
        .unwrap();
    text
}

fn gmsh_4(mesh: &TetrahedralMesh) -> String {
    let mut text = format!("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n{NAMES}");
    text += "$Entities\n1 0 2 2\n1 0 0 0 1 5\n7 1 0 0 1 1 1 1 3 0\n8 0 0 0 1 1 0 1 4 1 -3\n1 0 0 0 1 1 1 1 1 2 7 8\n2 0 0 0 1 1 1 1 2 0\n$EndEntities\n";
    let n = mesh.nodes.len();
    let half = n / 2;
    write!(text, "$Nodes\n2 {n} 10 {}\n", 9 + n).unwrap();
    for (range, entity) in [(0..half, 1), (half..n, 2)] {
        writeln!(text, "3 {entity} 0 {}", range.len()).unwrap();
        range.clone().for_each(|i| writeln!(text, "{}", 10 + i).unwrap());
        mesh.nodes[range].iter().for_each(|x| writeln!(text, "{} {} {}", x.x, x.y, x.z).unwrap());
    }
    let (triangle, tetrahedron) = if mesh.order == ElementOrder::Linear { (2, 4) } else { (9, 11) };
    let mut blocks = vec!["0 1 15 2\n1 10\n2 13".to_owned()];
    for (entity, name) in [(7, "x_max"), (8, "z_min")] {
        let facets = mesh.facets(name).unwrap();
        let mut block = format!("2 {entity} {triangle} {}", facets.len());
        for (k, &facet) in facets.iter().enumerate() {
            let nodes: Vec<u32> = mesh.facet_nodes(facet).iter().map(|n| 10 + n).collect();
            write!(block, "\n{} {}", 500 + 100 * entity + k, join(&nodes, " ")).unwrap();
        }
        blocks.push(block);
    }
    for region in 0..2 {
        let own: Vec<usize> =
            (0..mesh.n_elements()).filter(|&e| mesh.region_of_element[e] == region).collect();
        let mut block = format!("3 {} {tetrahedron} {}", region + 1, own.len());
        for e in own {
            write!(block, "\n{} {}", mesh.element_label(e), join(&gmsh_order(mesh.element(e)), " ")).unwrap();
        }
        blocks.push(block);
    }
    write!(text, "$EndNodes\n$Elements\n{} 99 1 999\n{}\n$EndElements\n", blocks.len(), blocks.join("\n"))
        .unwrap();
    text
}

fn abaqus(mesh: &TetrahedralMesh) -> String {
    let mut text =
        "*Heading\nby hand, of no meaning\n** comment\n*Node, nset=all\n9, 5., 5., 5.\n".to_owned();
    for (i, x) in mesh.nodes.iter().enumerate() {
        writeln!(text, "{}, {}, {}, {}", 10 + i, x.x, x.y, x.z).unwrap();
    }
    let kind = if mesh.order == ElementOrder::Linear { "C3D4" } else { "C3D10M" };
    for region in 0..2u32 {
        writeln!(text, "*Element, type={kind},\n elset=\"Set {region}\"").unwrap();
        for e in (0..mesh.n_elements()).filter(|&e| mesh.region_of_element[e] == region) {
            let nodes: Vec<u32> = mesh.element(e).iter().map(|n| 10 + n).collect();
            // In two lines, the way long elements are written.
            writeln!(
                text,
                "{}, {},\n{}",
                mesh.element_label(e),
                join(&nodes[..3], ", "),
                join(&nodes[3..], ", ")
            )
            .unwrap();
        }
    }
    text += "*Element, type=T3D2\n1, 10, 11\n*Elset, elset=carcass, generate\n101, 111, 2\n";
    text += "*Elset, elset=tread of rubber\nSET 1\n*Nset, nset=corner\n10, part.13\n";
    text += "*Solid section, elset=carcass, material=a\n*Solid section, elset=tread of rubber, material=b\n";
    let faces = |name: &str| -> Vec<String> {
        let line = |f: &grouser_geometry::Facet| {
            format!("{}, S{}", mesh.element_label(f.element as usize), f.face + 1)
        };
        mesh.facets(name).unwrap().iter().map(line).collect()
    };
    write!(text, "*Surface, type=element, name=x_max\n{}\n", faces("x_max").join("\n")).unwrap();
    // The other surface as Gmsh writes it: triangles in a set.
    text += "*Element, type=CPS3, elset=z_min\n";
    for (k, &facet) in mesh.facets("z_min").unwrap().iter().enumerate() {
        writeln!(text, "{}, {}", 900 + k, join(&mesh.facet_corners(facet).map(|n| 10 + n), ", ")).unwrap();
    }
    text + "*Material, name=a\n*Elastic\n1., 0.3\n"
}

type Read = fn(&[u8]) -> Result<TetrahedralMesh, MeshFileError>;

/// All formats with the sample written in them.
fn all(mesh: &TetrahedralMesh) -> [(&'static str, String, Read); 3] {
    [
        ("Gmsh 2.2", gmsh_2(mesh), |bytes| read_gmsh(bytes)),
        ("Gmsh 4.1", gmsh_4(mesh), |bytes| read_gmsh(bytes)),
        ("Abaqus", abaqus(mesh), |bytes| read_abaqus(bytes)),
    ]
}

#[test]
fn meshes_of_both_orders_come_back_with_regions_surfaces_and_sets_from_every_format() {
    for is_quadratic in [false, true] {
        let mesh = sample(is_quadratic);
        for (format, text, read) in all(&mesh) {
            let mut back = read(text.as_bytes()).unwrap_or_else(|e| panic!("{format}: {e}"));
            if format == "Abaqus" {
                assert_eq!(back.node_sets.remove("all").unwrap().len(), mesh.nodes.len());
            }
            assert_eq!(back, mesh, "{format}");
        }
    }
}

#[test]
fn damage_is_named_with_its_line_or_number() {
    let refusal = |format: &str, from: &str, to: &str| {
        let (_, text, read) = all(&sample(false)).into_iter().find(|(name, ..)| *name == format).unwrap();
        assert!(text.contains(from), "{format} {from}");
        read(text.replacen(from, to, 1).as_bytes()).unwrap_err().to_string()
    };
    let cases = [
        ("Gmsh 2.2", "2.2 0 8", "2.2 1 8", "line 2: a binary file"),
        ("Gmsh 2.2", "2.2 0 8", "3 0 8", "line 2: format 3"),
        ("Gmsh 2.2", "$MeshFormat\n", "solid\n", "line 1: `solid`"),
        ("Gmsh 2.2", "\n10 0 0 0\n", "\n10 0 zero 0\n", "found `zero`"),
        ("Gmsh 2.2", "\n11 ", "\n10 ", "node 10 is defined a second time, first in line 18"),
        ("Gmsh 2.2", "101 4 2 1 1 10", "101 4 2 1 1 77", "element 101 names node 77"),
        ("Gmsh 2.2", "103 4 2", "101 4 2", "element 101 is defined a second time"),
        ("Gmsh 2.2", "103 4 2 1 1 10", "103 5 2 1 1 10", "element 103 of type 5"),
        ("Gmsh 2.2", "101 4 2 1 1 10", "101 4 2 1 1", "as many node numbers"),
        ("Gmsh 2.2", "103 4 2", "103 4 -2", "found `-2`"),
        ("Gmsh 2.2", "$EndElements", "", "found `end of file`"),
        ("Gmsh 2.2", "$Nodes\n13", "$Nodes\n99999999999999", "expected a node"),
        ("Gmsh 2.2", "$Nodes\n13", "$Nodes\n12", "$EndNodes"),
        ("Gmsh 4.1", "3 2 0", "3 2", "a block of nodes"),
        ("Gmsh 4.1", "1 1 1 1 3 0", "1 1 1 9 3 0", "an entity"),
        ("Abaqus", "*Node", "*Nood", "names node 10"),
        ("Abaqus", "type=C3D4", "type=C3D8", "an element of type C3D8"),
        ("Abaqus", "113, S", "112, S", "names element 112"),
        ("Abaqus", "SET 1", "SET 7", "found `SET 7`"),
        ("Abaqus", "101, 111, 2", "101, 999999999999, 2", "GENERATE"),
        ("Abaqus", "part.13", "part.7777", "names node 7777"),
        ("Abaqus", "*Elset", "*Include, input=x\n*Elset", "an included file"),
        ("Abaqus", "*Heading", "*Heading\n*Instance, name=a, part=b\n1, 2, 3", "an instance that is moved"),
    ];
    for (format, from, to, part) in cases {
        let message = refusal(format, from, to);
        assert!(message.contains(part), "{format}, {from} -> {to}: {message}");
    }
    let mixed = gmsh_2(&sample(false)).replacen("103 4 2 1 1 10", "103 11 2 1 1 10 10 10 10 10 10 10", 1);
    assert!(
        read_gmsh(mixed.as_bytes())
            .unwrap_err()
            .to_string()
            .contains("has 10 nodes, but those before it have 4")
    );
}

#[test]
fn inverted_flat_sliver_unconnected_and_foreign_parts_are_refused_by_number() {
    let mesh = sample(false);
    let mut mirrored = mesh.clone();
    mirrored.connectivity[4 * 5..4 * 6].swap(0, 1);
    let message = read_gmsh(gmsh_2(&mirrored).as_bytes()).unwrap_err().to_string();
    assert!(message.contains("first element 111"), "{message}");
    let mut sliver = mesh.clone();
    // A corner that lies almost in the plane of its opposite face.
    let [a, b, c, d] = <[u32; 4]>::try_from(sliver.element(3)).unwrap().map(|n| n as usize);
    let (pa, pb, pc) = (sliver.nodes[a], sliver.nodes[b], sliver.nodes[c]);
    let normal = (pb - pa).cross(&(pc - pa)).normalize();
    sliver.nodes[d] = (pa + pb + pc) / 3.0 + normal * 1e-5;
    let refused = sliver.validate().unwrap_err();
    assert!(matches!(refused, MeshError::Inverted { .. } | MeshError::Sliver { .. }), "{refused}");
    let single = TetrahedralMesh {
        nodes: vec![Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::new(0.3, 0.3, 1e-5)],
        connectivity: vec![0, 1, 2, 3],
        region_of_element: vec![0],
        region_names: vec!["solid".to_owned()],
        element_labels: vec![42],
        ..Default::default()
    };
    let message = single.validate().unwrap_err().to_string();
    assert!(message.contains("sliver") && message.contains("42"), "{message}");
    let mut unused = mesh.clone();
    unused.nodes.push(Vec3::x());
    assert!(matches!(unused.validate(), Err(MeshError::UnusedNode { node: 12 })));
    let text = gmsh_2(&mesh);
    let triangle = text.lines().find(|line| line.contains(" 2 2 3 7 ")).unwrap();
    let no_face = text.replacen(triangle, "502 2 2 3 7 10 11 20", 1);
    let message = read_gmsh(no_face.as_bytes()).unwrap_err().to_string();
    assert!(message.contains("surface 'x_max' is no face"), "{message}");
}

#[test]
fn quality_report_names_the_worst_element_by_its_number_in_the_file() {
    let mut mesh = sample(false);
    let flat = mesh.element(7)[0] as usize;
    mesh.nodes[flat] += Vec3::new(0.0, 0.02, 0.02);
    let report = QualityReport::of(&mesh);
    assert!(report.smallest_shape < report.mean_shape && report.worst_element >= 101);
    assert_eq!((report.n_elements, report.n_nodes), (12, 12));
}

#[test]
fn a_real_tractor_wheel_of_ten_node_tetrahedra_is_read_whole() {
    // From Project Chrono's data, where a folder of reference data lies beside the repository.
    let beside = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(3).unwrap().join("shared");
    let path = beside.join("data/chrono/models/tractor_wheel/tractor_wheel_coarse.INP");
    if !path.is_file() {
        eprintln!("skipped: no tractor wheel of Project Chrono beside the repository");
        return;
    }
    let mesh = read_abaqus(std::fs::File::open(path).unwrap()).unwrap();
    assert_eq!((mesh.n_elements(), mesh.nodes.len(), mesh.order), (11_171, 21_359, ElementOrder::Quadratic));
    let report = QualityReport::of(&mesh);
    assert_eq!(report.n_folded_corners, 96);
    assert!(report.smallest_dihedral_angle > 5f64.to_radians(), "{report:?}");
    assert_eq!(mesh.region_names, ["PART1_EG1"]);
    let (rim, surface) = (&mesh.node_sets["BC_RIMTIRE"], &mesh.node_sets["BC_SURF"]);
    assert!(!rim.is_empty() && !surface.is_empty(), "{} {}", rim.len(), surface.len());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn no_mutation_of_a_mesh_file_ends_in_a_panic(
        places in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0u8..5), 1..8),
        is_quadratic in any::<bool>(),
    ) {
        for (_, text, read) in all(&sample(is_quadratic)) {
            let mut bytes = text.into_bytes();
            for (place, byte, kind) in &places {
                let at = place.index(bytes.len());
                match kind {
                    0 => bytes[at] = b"0123456789-.e, \n$*\"S"[*byte as usize % 20],
                    1 => bytes[at] = *byte,
                    2 if bytes.len() > 1 => { bytes.remove(at); }
                    3 => bytes.insert(at, b'9'),
                    _ => bytes.truncate(at.max(1)),
                }
            }
            if let Ok(mesh) = read(&bytes) {
                // What is accepted is sound.
                prop_assert!(mesh.validate().is_ok());
            }
        }
    }
}
