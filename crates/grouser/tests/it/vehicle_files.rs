//! Ground, soil and shoes from files beside a scenario: what is read is what is driven on, and what is wrong is named with its line.

use crate::{errors, grouser};
use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::Path;

/// A cart of four wheels; `RELIEF`, `PRESSURE` and `BELTS` are replaced.
const CART: &str = r#"(
    title: "A cart",
    soil: PressureSinkage(
        relief: (corner_m: (-1.6, -1.2), size_m: (3.2, 2.4), spacing_m: 0.08, RELIEF),
        pressure: PRESSURE,
        max_sinkage_m: 0.3,
    ),
    tool: Vehicle(
        equipment: ["own"],
        frames: [(
            name: "cart", mass_kg: 900, centre_of_mass_m: (0.0, 0.0, 0.2),
            axles: [
                (along_m: 0.6, half_track_m: 0.5, mass_kg: 80, wheel_radius_m: 0.35, wheel_width_m: 0.3, BELTS),
                (along_m: -0.6, half_track_m: 0.5, mass_kg: 80, wheel_radius_m: 0.35, wheel_width_m: 0.3),
            ],
        )],
    ),
    motion: Route(
        points_m: [(-0.2, 0.0), (0.2, 0.0)],
        run_step_m: 0.12,
        intermediate_steps: 2,
        frames_every_steps: 0,
    ),
)"#;
const SHAPES: &str = "shapes: [Sine(amplitude: 0.06, wavelength: 2.0, heading: 0.4, phase: 0.2)]";
const LINEAR: &str = "Uniform(Linear(stiffness: 8.0e5))";

fn cart(relief: &str, pressure: &str, belts: &str) -> String {
    CART.replace("RELIEF", relief).replace("PRESSURE", pressure).replace("BELTS", belts)
}

/// The height that [`SHAPES`] gives.
fn height(x: f64, y: f64) -> f64 {
    let s = x * 0.4_f64.cos() + y * 0.4_f64.sin();
    0.06 * (std::f64::consts::TAU * s / 2.0 + 0.2).sin()
}

/// Nodes of the cart's ground, a row of them after the other from the south.
fn nodes() -> Vec<[f64; 3]> {
    let at = |i: usize, j: usize| [-1.6 + 0.08 * i as f64, -1.2 + 0.08 * j as f64];
    (0..31).flat_map(|j| (0..41).map(move |i| at(i, j))).map(|[x, y]| [x, y, height(x, y)]).collect()
}

/// Runs a scene and returns the sinkage that it leaves.
fn sinkage(home: &Path, scene: &str) -> Vec<f64> {
    let path = home.join("cart.ron");
    fs::write(&path, scene).unwrap();
    let out = home.join("out").display().to_string();
    let output = grouser(home, &["run", &path.display().to_string(), "--out", &out, "--threads", "1"]);
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    let grid = fs::read_to_string(Path::new(&out).join("ruts_own.asc")).unwrap();
    grid.lines().skip(5).flat_map(str::split_whitespace).map(|word| word.parse().unwrap()).collect()
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn ground_from_grid_text_and_images_is_the_ground_that_shapes_make() {
    let home = tempfile::tempdir().unwrap();
    let shaped = sinkage(home.path(), &cart(SHAPES, LINEAR, ""));
    assert!(shaped.iter().fold(0.0_f64, |a, b| a.max(*b)) > 0.02);
    let mut grid = String::from("ncols 41\nnrows 31\nxllcenter 399\nyllcenter 699\ncellsize 0.08\n");
    for row in nodes().chunks(41).rev() {
        row.iter().for_each(|p| write!(grid, "{} ", p[2] + 100.0).unwrap());
        grid.push('\n');
    }
    let mut text = String::from("# x y z\n");
    nodes().iter().for_each(|p| writeln!(text, "{} {} {}", p[0], p[1], p[2]).unwrap());
    let mut image = b"P5 41 31 65535\n".to_vec();
    for row in nodes().chunks(41).rev() {
        for p in row {
            image.extend((((p[2] + 0.1) / 0.2 * 65535.0).round() as u16).to_be_bytes());
        }
    }
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, 41, 31);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Sixteen);
    encoder.write_header().unwrap().write_image_data(&image[image.len() - 2 * 41 * 31..]).unwrap();
    let scale = "lower_left_m: (-1.6, -1.2), image: (pixel_m: 0.08, black_m: -0.1, white_m: 0.1)";
    // Heights that are known to a micrometre leave ruts that are known to a little more.
    for (name, bytes, more, within) in [
        ("hill.asc", grid.as_bytes(), "lower_left_m: (-1.6, -1.2), datum_m: 100", 1e-6),
        ("hill.xyz", text.as_bytes(), "", 1e-6),
        ("hill.pgm", &image, scale, 2e-5),
        ("hill.png", &png, scale, 2e-5),
    ] {
        fs::write(home.path().join(name), bytes).unwrap();
        let relief = format!("file: (file: \"{name}\", {more})");
        let read = sinkage(home.path(), &cart(&relief, LINEAR, ""));
        let difference = largest_difference(&shaped, &read);
        assert!(difference < within, "{name}: {difference}");
    }
}

#[test]
fn relationships_from_a_file_are_those_of_the_scene() {
    let home = tempfile::tempdir().unwrap();
    let mut file = String::from("# name x y sinkage pressure\n");
    let mut laws = String::new();
    for (name, x, stiffness) in [("soft", -0.6, 5e5), ("hard", 0.8, 2e6)] {
        writeln!(file, "{name} {x} 0.1 0.1 {}\n{name} {x} 0.1 0.3 {}", stiffness * 0.1, stiffness * 0.3)
            .unwrap();
        write!(
            laws,
            "(position: ({x}, 0.1), law: Table(points: [(0.1, {}), (0.3, {})])), ",
            stiffness * 0.1,
            stiffness * 0.3
        )
        .unwrap();
    }
    fs::write(home.path().join("soil.txt"), file).unwrap();
    let own = format!("Located(standard_deviation: 0.5, laws: [{laws}])");
    let own = sinkage(home.path(), &cart(SHAPES, &own, ""));
    let measured = "Measured(file: \"soil.txt\", standard_deviation: 0.5)";
    assert_eq!(own, sinkage(home.path(), &cart(SHAPES, measured, "")));
    assert_ne!(own, sinkage(home.path(), &cart(SHAPES, LINEAR, "")));
}

/// A box 80 mm along, 300 mm across, 20 mm deep, in millimetres, its top at z = 0: as OBJ, and as X3D.
fn boxes() -> (String, String) {
    let corners: Vec<[f64; 3]> = (0..8_usize)
        .map(|k| [[-40.0, 40.0][k & 1], [-150.0, 150.0][k >> 1 & 1], [-20.0, 0.0][k >> 2 & 1]])
        .collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let (mut obj, mut points, mut index) = (String::new(), String::new(), String::new());
    for [x, y, z] in &corners {
        writeln!(obj, "v {x} {y} {z}").unwrap();
        write!(points, "{x} {y} {z}, ").unwrap();
    }
    for face in &faces {
        let [a, b, c, d] = face.map(|v: usize| v + 1);
        writeln!(obj, "f {a} {b} {c} {d}").unwrap();
        let [a, b, c, d] = face;
        write!(index, "{a} {b} {c} {d} -1 ").unwrap();
    }
    let x3d = format!(
        "<X3D><Scene><Shape>\n<IndexedFaceSet coordIndex='{index}'><Coordinate point='{points}'/></IndexedFaceSet>\n\
         </Shape></Scene></X3D>"
    );
    (obj, x3d)
}

fn chain(shoe: &str) -> String {
    format!("belts: [(equipment: \"own\", wheels: [0], n_shoes: 20, shoe_mass_kg: 2, shoe: {shoe})]")
}

#[test]
fn a_shoe_from_a_file_presses_like_the_plate_that_it_is() {
    let home = tempfile::tempdir().unwrap();
    let (obj, x3d) = boxes();
    fs::write(home.path().join("shoe.obj"), obj).unwrap();
    fs::write(home.path().join("shoe.x3d"), x3d).unwrap();
    // On ground fine enough for shoes of 8 cm.
    let short = |scene: String| {
        scene.replace("(0.2, 0.0)]", "(0.04, 0.0)]").replace("spacing_m: 0.08", "spacing_m: 0.02")
    };
    let drive = |shoe: &str| sinkage(home.path(), &short(cart(SHAPES, LINEAR, &chain(shoe))));
    let pitch = std::f64::consts::TAU * 0.35 / 20.0;
    let plates = |depth: f64| {
        let share = 0.08 / pitch;
        drive(&format!("Plates(width_m: 0.3, plate_share: {share}, plate_depth_m: {depth})"))
    };
    let from_obj = drive("Surface(file: \"shoe.obj\", scale: 0.001)");
    assert_eq!(from_obj, drive("Surface(file: \"shoe.x3d\", scale: 0.001)"));
    // With its middle 20 mm below the wheel's edge the box reaches as deep as a plate of 40 mm.
    let lower = drive("Surface(file: \"shoe.obj\", scale: 0.001, along: MinusX, on_wheel: (0, 0, 20))");
    let [plate, thick] = [0.02, 0.04].map(plates);
    // Covered shares of a surface are sampled, those of a plate are exact; a box that stands askew shows its ends from below as well.
    for (surface, plate) in [(&from_obj, &plate), (&lower, &thick)] {
        let [surface, plate] = [surface, plate].map(|sinkage| sinkage.iter().sum::<f64>());
        assert!((surface / plate - 1.0).abs() < 0.01, "{surface} {plate}");
    }
    let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum::<f64>();
    assert!(apart(&lower, &thick) < 0.3 * apart(&lower, &from_obj));
    assert!(apart(&from_obj, &plate) < 0.3 * apart(&from_obj, &thick));
    let bare = sinkage(home.path(), &short(cart(SHAPES, LINEAR, "")));
    assert!(largest_difference(&plate, &bare) > 0.005);
    let deepest = |sinkage: &[f64]| sinkage.iter().fold(0.0_f64, |a, b| a.max(*b));
    // 5 mm deeper and not 20, since the wheel goes on carrying between the shoes; with plates it is 6 mm.
    let [of_boxes, of_plates] = [[&lower, &from_obj], [&thick, &plate]].map(|[a, b]| deepest(a) - deepest(b));
    assert!(of_boxes > 0.004 && (of_boxes - of_plates).abs() < 2e-3, "{of_boxes} {of_plates}");
}

#[test]
fn wrong_ground_soil_and_shoes_are_refused_with_line_and_remedy() {
    let home = tempfile::tempdir().unwrap();
    let put = |name: &str, text: &str| fs::write(home.path().join(name), text).unwrap();
    put("hole.asc", "ncols 2\nnrows 2\nxllcorner -2\nyllcorner -2\ncellsize 4\nnodata_value -9\n0 0\n0 -9\n");
    put("small.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n0 0\n0 0\n");
    put("gap.xyz", "0 0 0\n1 0 0\n0 1 0\n");
    put("photo.pgm", "P2 2 2 255 0 0 0 0");
    put("twice.txt", "a 0 0 0.3 1e5\nb 0 0 0.3 2e5\n");
    put("short.txt", "a 0 0 0.3\n");
    put("shoe.x3d", "<X3D><Scene>\n<Shape><Sphere radius='1'/></Shape></Scene></X3D>");
    put("up.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n");
    let twice = "Located(standard_deviation: 0.5, laws: [\n(position: (1, 0), law: Linear(stiffness: 1e6)),\n\
                 (position: (1, 0), law: Linear(stiffness: 2e6))])";
    let table = "Uniform(Table(points: [(0.1, 1e5), (0.2, 3e5)]))";
    let file = |name: &str| format!("file: (file: \"{name}\")");
    let cases: Vec<(String, &str, &[&str])> = vec![
        (cart(&file("hole.asc"), LINEAR, ""), "4:", &["line 8, row 2, column 2", "hole"]),
        (cart(&file("small.asc"), LINEAR, ""), "4:", &["end before the ground", "lower_left_m"]),
        (cart(&file("gap.xyz"), LINEAR, ""), "4:", &["no point at (1, 1)"]),
        (cart(&file("photo.pgm"), LINEAR, ""), "4:", &["says nothing about lengths", "pixel_m"]),
        (cart(&file("none.asc"), LINEAR, ""), "4:", &["none.asc", "misspelt path"]),
        (cart(&file("twice.txt"), LINEAR, ""), "4:", &["line 1", "three numbers"]),
        (cart(&file("cart.ron"), LINEAR, ""), "4:", &["there is no reader for `.ron`", "ESRI ASCII"]),
        (cart(SHAPES, twice, ""), "7:", &["relationships 1 and 2 both lie at (1, 0) m"]),
        (
            cart(SHAPES, "Measured(file: \"twice.txt\", standard_deviation: 1)", ""),
            "5:",
            &["both lie at (0, 0) m"],
        ),
        (
            cart(SHAPES, "Measured(file: \"short.txt\", standard_deviation: 1)", ""),
            "5:",
            &["line 1: expected `name"],
        ),
        (cart(SHAPES, table, ""), "6:", &["sinkage of 0.3 m lies beyond the table", "max_sinkage_m: 0.2"]),
        (
            cart(SHAPES, LINEAR, &chain("Surface(file: \"shoe.x3d\")")),
            "13:",
            &["line 2", "`Sphere` is not supported"],
        ),
        (cart(SHAPES, LINEAR, &chain("Surface(file: \"up.obj\")")), "13:", &["nowhere reaches outside"]),
        (cart(SHAPES, LINEAR, &chain("Surface(file: \"up.obj\", up: X)")), "13:", &["lie on one line"]),
        (
            cart(SHAPES, LINEAR, "").replace("(0.2, 0.0)", "(1.5, 0.0)"),
            "19:",
            &["leads off the terrain", "after 1.3", "soil.relief.size_m"],
        ),
        (
            cart(SHAPES, LINEAR, "").replace("run_step_m: 0.12", "run_step_m: 0.11"),
            "20:",
            &["0.11314", "smaller spacing"],
        ),
    ];
    for (scene, place, parts) in cases {
        let path = home.path().join("cart.ron");
        fs::write(&path, &scene).unwrap();
        let out = home.path().join("out");
        let arguments = ["run", &path.display().to_string(), "--out", &out.display().to_string()];
        let message = errors(&grouser(home.path(), &arguments));
        let status = grouser(home.path(), &arguments).status.code();
        assert_eq!(status, Some(2), "{parts:?}: {message}");
        assert!(message.contains(&format!("cart.ron:{place}")), "{place} is not in: {message}");
        for part in parts.iter().chain(&["expected:", "usual cause:"]) {
            assert!(message.contains(part), "{part} is not in: {message}");
        }
        assert!(!out.exists());
    }
    // Legal but unwise: taken, with advice that points to its line.
    let odd = cart(SHAPES, LINEAR, "")
        .replace("intermediate_steps: 2,", "intermediate_steps: 2, integration_resolution: 3,");
    let path = home.path().join("cart.ron");
    fs::write(&path, odd).unwrap();
    let output = grouser(home.path(), &["check", &path.display().to_string()]);
    let message = errors(&output);
    assert_eq!(output.status.code(), Some(0), "{message}");
    for part in
        ["advice: integration resolution 3 is odd", "cart.ron:21:", "remedy: integration_resolution: 4"]
    {
        assert!(message.contains(part), "{part} is not in: {message}");
    }
}

/// Files of other projects, where somebody has them: a grey height map of natural ground, and a track shoe.
#[test]
fn a_height_map_and_a_shoe_of_another_project_are_driven() {
    let Some(folder) = std::env::var_os("GROUSER_CHRONO_DATA").map(std::path::PathBuf::from) else {
        // Past the harness, which would keep it to itself.
        let _ = writeln!(
            std::io::stderr(),
            "SKIPPED: a_height_map_and_a_shoe_of_another_project_are_driven; set GROUSER_CHRONO_DATA to Chrono's folder `data`"
        );
        return;
    };
    let home = tempfile::tempdir().unwrap();
    let map = folder.join("vehicle/terrain/height_maps/terrain3.bmp").display().to_string();
    let shoe = folder.join("models/bulldozer/shoe_collision.obj").display().to_string();
    // 400 samples a centimetre apart, 30 of 256 greys over 12 cm.
    let relief = format!(
        "file: (file: \"{map}\", lower_left_m: (-2.0, -2.0), image: (pixel_m: 0.01, black_m: -0.8, white_m: 0.22))"
    );
    let shoe = chain(&format!(
        "Surface(file: \"{shoe}\", along: X, up: MinusY, scale: 0.4, on_wheel: (0.124, 0.03, 0))"
    ));
    let left = sinkage(home.path(), &cart(&relief, LINEAR, &shoe));
    let deepest = left.iter().fold(0.0_f64, |a, b| a.max(*b));
    assert!(deepest > 0.02 && deepest < 0.3, "{deepest}");
}
