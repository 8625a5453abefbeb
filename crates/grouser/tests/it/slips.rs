//! The wheel predicted from plates, as a user runs it.

use crate::{errors, grouser};
use std::fs;

/// The shipped scene.
fn scene() -> String {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/wheel_plate_sand.ron");
    fs::read_to_string(path).expect("the scene is part of the repository")
}

#[test]
fn the_wheel_is_predicted_from_plates_and_its_numbers_do_not_depend_on_threads() {
    let home = tempfile::tempdir().unwrap();
    let file = home.path().join("wheel.ron");
    fs::write(&file, scene()).unwrap();
    let run = |name: &str, threads: &str| {
        let out = home.path().join(name);
        let arguments = [
            "run",
            &file.display().to_string(),
            "--quick",
            "--threads",
            threads,
            "--out",
            &out.display().to_string(),
        ];
        let output = grouser(home.path(), &arguments);
        assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
        let summary = fs::read_to_string(out.join("summary.json")).unwrap();
        (fs::read(out.join("slips.csv")).unwrap(), summary)
    };
    let (one, summary) = run("one", "1");
    let (two, _) = run("two", "2");
    assert_eq!(one, two);
    // Both fidelities within a millimetre of the measured sinkage at zero slip.
    let text = String::from_utf8(one).unwrap();
    let at_zero: Vec<f64> = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect::<Vec<f64>>())
        .filter(|row| row[1] == -0.001 && row[0] < 2.0)
        .map(|row| row[3])
        .collect();
    assert_eq!(at_zero.len(), 2);
    assert!(at_zero.iter().all(|sinkage| (sinkage - 0.01443).abs() < 1e-3), "{at_zero:?}");
    assert!(summary.contains("drawbar pull over load at slip 0.5, grid"));
}

#[test]
fn wheels_without_plates_or_with_impossible_values_are_refused() {
    let home = tempfile::tempdir().unwrap();
    let cases = [
        ("friction_angle_deg: 29", "friction_angle_deg: 129", "is 129"),
        ("slip: -0.25, load_n", "slip: 25, load_n", "is 25"),
        ("radius_m: 0.0625", "radius_m: 0", "is 0"),
        ("load_n: 23.72", "load_n: -1", "is -1"),
        ("cells_per_radius: 64", "cells_per_radius: 2", "is 2"),
        ("c_1: 0.18", "c_1: 0.98", "soil.peak"),
        (
            "tool: RigidWheel(radius_m: 0.0625, width_m: 0.060)",
            "tool: Plates(diameters_m: [0.1], thickness_m: 0.01, material: \"a\")",
            "no experiment",
        ),
        ("motion: Slips(", "motion: Rolls(", "unknown choice `Rolls`"),
    ];
    for (from, to, what) in cases {
        let file = home.path().join("wheel.ron");
        assert!(scene().contains(from), "{from}");
        fs::write(&file, scene().replacen(from, to, 1)).unwrap();
        let output = grouser(home.path(), &["check", &file.display().to_string()]);
        assert_eq!(output.status.code(), Some(2), "{to}: {}", errors(&output));
        assert!(
            errors(&output).contains(what) && errors(&output).contains("wheel.ron:"),
            "{to}: {}",
            errors(&output)
        );
    }
    // A wheel that the ground cannot carry is named when the scene begins.
    let file = home.path().join("wheel.ron");
    fs::write(&file, scene().replace("load_n: 24.58", "load_n: 24580")).unwrap();
    let out = home.path().join("out");
    let output =
        grouser(home.path(), &["run", &file.display().to_string(), "--out", &out.display().to_string()]);
    assert_ne!(output.status.code(), Some(0));
    assert!(errors(&output).contains("the ground carries"), "{}", errors(&output));
}
