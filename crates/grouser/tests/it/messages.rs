//! Every wrong input is named with its place, what was expected and the usual cause; numerical failure with step, time,
//! grain and remedy.

use crate::{CUP, errors, grouser};
use std::fs;

/// Runs `check` on the cup with one text replaced; returns exit status and message.
fn check(from: &str, to: &str) -> (Option<i32>, String) {
    let home = tempfile::tempdir().unwrap();
    let scene = home.path().join("cup.ron");
    assert!(CUP.contains(from), "{from}");
    fs::write(&scene, CUP.replacen(from, to, 1)).unwrap();
    let output = grouser(home.path(), &["check", &scene.display().to_string()]);
    (output.status.code(), errors(&output))
}

#[test]
fn wrong_scenarios_are_refused_with_line_column_expectation_and_cause() {
    let cases = [
        ("restitution: 0.3", "restitutoin: 0.3", "cup.ron:4:", "unknown key `restitutoin`"),
        ("young_pa: 1e7", "young_pa: \"1e7\"", "cup.ron:4:", "this value is"),
        ("radius_m: (0.0045, 0.0055)", "radius_m: (-0.0045, 0.0055)", "cup.ron:9:", "is -0.0045"),
        ("restitution: 0.3", "restitution: 1.2", "cup.ron:4:", "is 1.2"),
        ("restitution: 0.3", "restitution: 0", "cup.ron:4:", "is 0"),
        ("depth_m: 0.04", "depth_m: 0.004", "cup.ron:9:", "the bed would be empty"),
        (
            "layers: [(material: \"sand\", sizes: Uniform(radius_m: (0.0045, 0.0055)), depth_m: 0.04)]",
            "layers: []",
            "cup.ron:9:",
            "the bed is empty",
        ),
        (
            "thickness_m: 0.01",
            "thickness_m: 0.001",
            "cup.ron:11:",
            "grains may pass through a plate that thin",
        ),
        ("[0.03, 0.04]", "[0.03, 0.075]", "cup.ron:11:", "meets its own image"),
        (
            "Uniform(radius_m: (0.0045, 0.0055))",
            "Graded(radius_m: (0.00004, 0.0055))",
            "cup.ron:9:",
            "is 0.0055",
        ),
        (
            "outputs:",
            "dials: (active_zone: (reach_m: 0.02, wake: 0)), outputs:",
            "cup.ron:13:",
            "`dials.active_zone.wake` is 0",
        ),
        ("gap_m: 0.001", "gap_m: -0.001", "cup.ron:12:", "the tool starts inside the bed"),
        ("young_pa: 1e7", "young_pa: 1e3", "cup.ron:4:", "the bed cannot carry its own weight"),
        ("material: \"steel\")", "material: \"steal\")", "cup.ron:11:", "there is no material \"steal\""),
        ("poisson: 0.25", "poisson: 0.7", "cup.ron:4:", "is 0.7"),
        ("title: \"A cup of sand\",", "title: \"A cup of sand\"", "cup.ron:3:", "this is not a scenario"),
    ];
    for (from, to, place, what) in cases {
        let (status, message) = check(from, to);
        assert_eq!(status, Some(2), "{to}: {message}");
        assert!(message.contains(place) && message.contains(what), "{to}: {message}");
        assert!(message.contains("expected:") && message.contains("usual cause:"), "{to}: {message}");
    }
}

#[test]
fn tilting_grains_rougher_than_sixty_degrees_and_thinner_than_a_twentieth_are_refused_where_spheres_are_not()
{
    let check = |friction: &str, rotation: &str| {
        let home = tempfile::tempdir().unwrap();
        let scene = CUP.replacen("friction: 0.5", &format!("friction: {friction}"), 1).replacen(
            "outputs:",
            &format!("dials: (rotation: {rotation}), outputs:"),
            1,
        );
        fs::write(home.path().join("cup.ron"), scene).unwrap();
        let output = grouser(home.path(), &["check", &home.path().join("cup.ron").display().to_string()]);
        (output.status.code(), errors(&output))
    };
    for (friction, rotation) in [
        ("1.732", "Tilting(shape: Cube)"),
        ("0", "Tilting(shape: Angular(aspect_ratio: 0.05))"),
        ("1.9", "Free"),
    ] {
        let (status, message) = check(friction, rotation);
        assert_eq!(status, Some(0), "{friction} {rotation}: {message}");
    }
    for (friction, rotation, what) in [
        ("1.74", "Tilting(shape: Cube)", "`materials.sand.friction` is 1.74"),
        ("0.5", "Tilting(shape: Angular(aspect_ratio: 0.04))", "aspect ratio: 0.04 is not possible"),
    ] {
        let (status, message) = check(friction, rotation);
        assert_eq!(status, Some(2), "{friction} {rotation}: {message}");
        assert!(message.contains(what), "{message}");
    }
}

#[test]
fn a_missing_file_and_a_wrong_override_are_refused() {
    let home = tempfile::tempdir().unwrap();
    let absent = grouser(home.path(), &["check", "nowhere.ron"]);
    assert_eq!(absent.status.code(), Some(2));
    assert!(errors(&absent).contains("nowhere.ron") && errors(&absent).contains("usual cause"));
    let scene = home.path().join("cup.ron");
    fs::write(&scene, CUP).unwrap();
    let scene = scene.display().to_string();
    let output = grouser(home.path(), &["check", &scene, "--set", "soil.layers[0].depht_m=0.1"]);
    assert_eq!(output.status.code(), Some(2), "{}", errors(&output));
    let output = grouser(home.path(), &["check", &scene, "--set", "dials.rotation=Spinning"]);
    assert_eq!(output.status.code(), Some(2), "{}", errors(&output));
    assert!(errors(&output).contains("`Fixed`"), "{}", errors(&output));
}

#[test]
fn nothing_is_left_behind_by_a_refused_scenario() {
    let home = tempfile::tempdir().unwrap();
    let scene = home.path().join("cup.ron");
    fs::write(&scene, CUP.replace("poisson: 0.25", "poisson: 7")).unwrap();
    let out = home.path().join("out");
    let arguments = ["run", &scene.display().to_string(), "--out", &out.display().to_string()];
    assert_eq!(grouser(home.path(), &arguments).status.code(), Some(2));
    assert!(!out.exists());
}

#[test]
fn a_tool_too_fast_for_its_bed_fails_with_step_time_grain_and_remedy_and_keeps_a_checkpoint() {
    let home = tempfile::tempdir().unwrap();
    let scene = home.path().join("cup.ron");
    fs::write(&scene, CUP.replace("speed_m_s: 0.3", "speed_m_s: 60")).unwrap();
    let out = home.path().join("out");
    let output =
        grouser(home.path(), &["run", &scene.display().to_string(), "--out", &out.display().to_string()]);
    let message = errors(&output);
    assert_eq!(output.status.code(), Some(3), "{message}");
    for part in ["grain ", "(step ", " s, 30 mm plate)", "remedy: ", "checkpoint was kept"] {
        assert!(message.contains(part), "{part} is not in: {message}");
    }
    // The very step that failed, not the sample or look before it.
    assert!(!message.contains("(step 0,"), "{message}");
    assert!(out.join("checkpoint.bin").is_file());
    let summary = fs::read_to_string(out.join("summary.json")).unwrap();
    assert!(summary.contains("\"status\": \"failed\"") && summary.contains("\"error\""));
}

#[test]
fn a_mesh_that_is_no_body_is_refused_at_its_line_and_a_good_one_is_pressed() {
    let home = tempfile::tempdir().unwrap();
    let path = |name: &str| home.path().join(name).display().to_string();
    let scene = CUP
        .replace(
            "tool: Plates(diameters_m: [0.03, 0.04], thickness_m: 0.01",
            "tool: Mesh(file: \"wedge.obj\", scale: 0.001",
        )
        .replace("depth_m: 0.012", "depth_m: 0.004");
    fs::write(path("cup.ron"), scene).unwrap();
    // A roof 30 mm long with its ridge downwards, in millimetres.
    let wedge = "v 0 0 0\nv 30 0 0\nv 30 -8 10\nv 0 -8 10\nv 30 8 10\nv 0 8 10\n\
                 f 1 2 3\nf 1 3 4\nf 1 5 2\nf 1 6 5\nf 4 3 5\nf 4 5 6\nf 2 5 3\nf 1 4 6\n";
    for (mesh, part) in [
        (wedge.replace("v 30 8 10", "v 30 nan 10"), "not finite"),
        (wedge.replace("v 30 8 10", "v 30 0 0"), "no area"),
        (wedge.replace("f 1 4 6\n", ""), "hole"),
        (wedge.replace("f 1 4 6", "f 1 4 60"), "line 14"),
    ] {
        fs::write(path("wedge.obj"), mesh).unwrap();
        let output = grouser(home.path(), &["run", &path("cup.ron"), "--out", &path("out")]);
        let message = errors(&output);
        assert_eq!(output.status.code(), Some(2), "{message}");
        for part in [part, "cup.ron:11:", "usual cause: "] {
            assert!(message.contains(part), "{part} is not in: {message}");
        }
        assert!(!home.path().join("out").exists());
    }
    fs::write(path("wedge.obj"), wedge).unwrap();
    let output = grouser(home.path(), &["run", &path("cup.ron"), "--out", &path("out")]);
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    let rows = fs::read_to_string(home.path().join("out/tool.csv")).unwrap();
    let last: Vec<f64> = rows.lines().last().unwrap().split(',').map(|v| v.parse().unwrap()).collect();
    // It carries load, and its mean pressure is over 30 mm × 16 mm as seen from below.
    let (pressure, force_z) = (last[2], last[5]);
    assert!(force_z > 0.0 && (pressure * 0.03 * 0.016 / force_z - 1.0).abs() < 1e-9, "{rows}");
}

#[test]
fn wrong_tires_are_refused_with_line_and_remedy() {
    const TIRE: &str = include_str!("../../../../scenarios/tire.ron");
    let cases = [
        ("gap_m: 0.001", "gap_m: -0.02", "the tire starts inside the bed"),
        ("Alternating(lugs: 20)", "Alternating(lugs: 20, land: 50)", "lugs cover 50 of the pitch"),
        ("size: \"165/65R13\"", "size: \"165x65\"", "is not understood"),
        ("rim_width_m: 0.127", "rim_width_m: 5.0", "rim width 5 m"),
        ("n_elements: 24000", "n_elements: 900", "too few"),
        ("wall_thickness_m: 0.016", "wall_thickness_m: 0.0002", "slivers"),
        ("inflation_pa: 1.4e5", "inflation_pa: -1.4e5", "is -140000"),
        ("poisson: 0.45", "poisson: 0.5", "is 0.5"),
        ("refit_margin: 0.25", "contact_spread_m: 0.002", "is 0.002"),
        ("slip: 0.05", "slip: 5.0", "is 5"),
        ("travel_m: 0.45", "travel_m: 4.5", "is 4.5"),
        ("y: Walled", "y: Periodic", "a tire meets no images"),
        ("largest_overlap: 0.8", "largest_overlap: 80", "is 80"),
        ("friction: 0.02", "friction: -0.02", "is -0.02"),
    ];
    let home = tempfile::tempdir().unwrap();
    let scene = home.path().join("tire.ron");
    for (from, to, what) in cases {
        assert!(TIRE.contains(from), "{from}");
        fs::write(&scene, TIRE.replacen(from, to, 1)).unwrap();
        let output = grouser(home.path(), &["check", &scene.display().to_string()]);
        let message = errors(&output);
        assert_eq!(output.status.code(), Some(2), "{to}: {message}");
        assert!(message.contains("tire.ron:") && message.contains(what), "{to}: {message}");
        assert!(message.contains("expected:"), "{to}: {message}");
    }
}

#[test]
fn a_tread_that_turns_inside_out_fails_with_element_step_time_and_remedy_and_keeps_a_checkpoint() {
    // A rim that is faster than the waves of a very soft rubber.
    const TIRE: &str = include_str!("../../../../scenarios/tire.ron");
    const SETS: &str = r#"soil.container.size_m=(0.7, 0.34, 0.3)
        soil.layers=[(material: "soil", sizes: Uniform(radius_m: (0.019, 0.021)), depth_m: 0.06)]
        materials.rubber.young_pa=1e5|tool.n_elements=5760|tool.tread=Smooth|tool.model=FiniteStrain|tool.inflation_pa=0
        motion.load_n=20|motion.sinking_speed_m_s=5|motion.speed_m_s=60|motion.ramp_s=1e-4|motion.travel_m=0.2
        motion.gap_m=0.0005|outputs.checkpoint_every_s=1e-3|outputs.sample_every_s=5e-4"#;
    let home = tempfile::tempdir().unwrap();
    let (scene, out) = (home.path().join("tire.ron"), home.path().join("out"));
    fs::write(&scene, TIRE).unwrap();
    let (scene, folder) = (scene.display().to_string(), out.display().to_string());
    let mut arguments = vec!["run", &scene, "--quick", "--out", &folder];
    SETS.split(['\n', '|']).for_each(|set| arguments.extend(["--set", set.trim()]));
    let first = grouser(home.path(), &arguments);
    arguments.push("--resume");
    // The checkpoint leads to the same end.
    for output in [first, grouser(home.path(), &arguments)] {
        let message = errors(&output);
        assert_eq!(output.status.code(), Some(3), "{message}");
        for part in ["element ", "is inverted", "(step ", " s, travelling", "remedy: ", "checkpoint was kept"]
        {
            assert!(message.contains(part), "{part} is not in: {message}");
        }
        assert!(out.join("checkpoint.bin").is_file());
        // What was measured until then is not lost.
        let rows = fs::read_to_string(out.join("tire.csv")).unwrap();
        assert!(rows.lines().count() > 2, "{rows}");
    }
}
