//! A vehicle over soft ground: the same bytes on any number of threads and after interruptions.

use crate::{errors, grouser, interrupted};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

/// The shipped scene over its first 2 m of level ground.
fn arguments<'a>(scene: &'a str, out: &'a str) -> Vec<&'a str> {
    vec![
        "run",
        scene,
        "--out",
        out,
        "--set",
        "motion.points_m=[(0.0, 0.0), (2.0, 0.0)]",
        "--set",
        "motion.rolling_section_m=(0.0, 2.0)",
        "--set",
        "motion.rut_section_m=(0.0, 2.0)",
        "--set",
        "motion.intermediate_steps=2",
        "--set",
        "motion.checkpoint_every_steps=1",
    ]
}

#[test]
fn a_drive_split_by_interruptions_ends_with_the_bytes_of_the_straight_one_on_any_threads() {
    let home = tempfile::tempdir().unwrap();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/stump.ron").display().to_string();
    let path = |name: &str| home.path().join(name).display().to_string();
    let [straight, split] = ["straight", "split"].map(path);
    let output = grouser(home.path(), &[&arguments(&scene, &straight)[..], &["--threads", "2"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));

    let mut n_interruptions = 0;
    for attempt in 0..200 {
        let mut command = Command::new(env!("CARGO_BIN_EXE_grouser"));
        command.args(arguments(&scene, &split)).args(["--threads", "1"]);
        if Path::new(&split).join("checkpoint.bin").exists() {
            command.arg("--resume");
        }
        let ended = match attempt < 6 {
            true => interrupted(&mut command, Duration::from_millis(90 * attempt)),
            false => command.stderr(Stdio::null()).status().unwrap().code(),
        };
        match ended {
            Some(0) => break,
            Some(130) => n_interruptions += 1,
            other => panic!("exit status {other:?}"),
        }
    }
    assert!(n_interruptions > 0, "the drive ended before any interruption");
    for name in ["bare.csv", "ruts_bare.asc", "scenario.ron", "rolling_resistance.svg"] {
        let read = |folder: &String| fs::read(Path::new(folder).join(name)).unwrap();
        assert!(read(&straight) == read(&split), "{name}");
    }
}
