//! The same scenario gives the same bytes: twice, on any number of threads, from the cache, after interruptions.

use crate::{CUP, errors, grouser, interrupted};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

const FILES: [&str; 5] =
    ["scenario.ron", "plate_30mm.csv", "plate_40mm.csv", "vtk/grains_000003.vtp", "pressure_sinkage.svg"];

fn results(folder: &Path) -> Vec<Vec<u8>> {
    let read = |name: &&str| fs::read(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    FILES.iter().map(read).collect()
}

#[test]
fn threads_cache_interruptions_and_the_resolved_scenario_change_no_byte() {
    let home = tempfile::tempdir().unwrap();
    let path = |name: &str| home.path().join(name).display().to_string();
    fs::write(path("cup.ron"), CUP).unwrap();
    let run = |cache: &str, out: &str, scene: &str, more: &[&str]| {
        let (scene, out) = (path(scene), path(out));
        let arguments = [&["run", scene.as_str(), "--out", out.as_str()], more].concat();
        let output = grouser(&home.path().join(cache), &arguments);
        assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    };
    run("cache", "one", "cup.ron", &["--threads", "1"]);
    let straight = results(&home.path().join("one"));
    for name in
        ["summary.json", "report.html", "pressure_sinkage.png", "grains.pvd", "tool.pvd", "checkpoint.bin"]
    {
        assert!(home.path().join("one").join(name).is_file(), "{name}");
    }
    // From the cache on two threads; from nothing on two threads; the resolved scenario.
    run("cache", "cached", "cup.ron", &["--threads", "2"]);
    assert!(results(&home.path().join("cached")) == straight);
    run("other-cache", "two", "one/scenario.ron", &["--threads", "2"]);
    assert!(results(&home.path().join("two")) == straight);

    let n_interruptions = interrupted_again_and_again(&path("cup.ron"), &path("split"), "", 12);
    assert!(n_interruptions > 0, "no interruption came in time");
    assert!(results(&home.path().join("split")) == straight, "after {n_interruptions} interruptions");
}

/// Runs a scene to its end through `most` interruptions, in settling (unless `cache` names a folder with its bed) and in pressing,
/// on one thread and two by turns; gives how many came in time.
fn interrupted_again_and_again(scene: &str, out: &str, cache: &str, most: u64) -> u64 {
    let mut n_interruptions = 0;
    for attempt in 0..200 {
        let mut command = Command::new(env!("CARGO_BIN_EXE_grouser"));
        command.args(["run", scene, "--out", out, "--threads", if attempt % 2 == 0 { "1" } else { "2" }]);
        if Path::new(out).join("checkpoint.bin").exists() {
            command.arg("--resume");
        }
        command.env("GROUSER_CACHE", cache);
        let ended = match attempt < most {
            true => interrupted(&mut command, Duration::from_millis(37 * attempt)),
            false => command.stderr(Stdio::null()).status().unwrap().code(),
        };
        match ended {
            Some(0) => break,
            Some(130) => n_interruptions += 1,
            other => panic!("exit status {other:?}"),
        }
    }
    n_interruptions
}

#[test]
fn the_active_zone_and_every_precision_end_with_the_same_bytes_after_interruptions() {
    let home = tempfile::tempdir().unwrap();
    let path = |name: &str| home.path().join(name).display().to_string();
    for (name, dials) in [
        ("zone", "active_zone: (reach_m: 0.01)"),
        ("mixed", "precision: Mixed"),
        ("single", "precision: F32, active_zone: (reach_m: 0.01, wake: 0.5)"),
    ] {
        let scene = CUP.replace("outputs:", &format!("dials: ({dials}), outputs:"));
        // In some beds a grain in a hole at the floor spins on about the vertical, which nothing resists in a law of spheres, for seconds:
        // what the bytes are of does not matter here.
        let scene = scene.replace("depth_m: 0.04)],", "depth_m: 0.04)], settle: (energy_ratio: 1e-3),");
        assert!(scene.contains("settle:"));
        fs::write(path("cup.ron"), scene.replace("speed_m_s: 0.3", "speed_m_s: 0.1")).unwrap();
        let (straight, split) = (home.path().join(name), home.path().join(name.to_owned() + "-split"));
        let arguments = ["run", &path("cup.ron"), "--out", &straight.display().to_string(), "--threads", "2"];
        let output = grouser(&home.path().join("cache"), &arguments);
        assert_eq!(output.status.code(), Some(0), "{name}: {}", errors(&output));
        let split_path = split.display().to_string();
        let n = interrupted_again_and_again(&path("cup.ron"), &split_path, &path("cache"), 4);
        assert!(n > 0, "{name}: no interruption came in time");
        assert!(results(&split) == results(&straight), "{name}: after {n} interruptions");
        let summary = fs::read_to_string(straight.join("summary.json")).unwrap();
        assert_eq!(summary.contains("grains awake, mean share"), dials.contains("active_zone"), "{name}");
    }
}

#[test]
fn a_checkpoint_of_another_scenario_and_a_missing_one_are_refused() {
    let home = tempfile::tempdir().unwrap();
    let path = |name: &str| home.path().join(name).display().to_string();
    fs::write(path("cup.ron"), CUP).unwrap();
    let (scene, out) = (path("cup.ron"), path("out"));
    let missing = grouser(home.path(), &["run", &scene, "--out", &out, "--resume"]);
    assert_eq!(missing.status.code(), Some(2));
    assert!(errors(&missing).contains("holds no checkpoint"), "{}", errors(&missing));
    let shallow = ["--set", "motion.depth_m=0.001", "--set", "tool.diameters_m=[0.03]"];
    let first = grouser(home.path(), &[&["run", &scene, "--out", &out], &shallow[..]].concat());
    assert_eq!(first.status.code(), Some(0), "{}", errors(&first));
    let other = grouser(home.path(), &["run", &scene, "--out", &out, "--resume"]);
    assert_eq!(other.status.code(), Some(2));
    assert!(errors(&other).contains("belongs to another scenario"), "{}", errors(&other));
}
