//! Power may fail at any moment: what lies in the folder then is whole, and the run can be taken up again.

use crate::{CUP, errors, grouser};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

fn wait_for(path: &Path) {
    let begun = Instant::now();
    while !path.exists() {
        assert!(begun.elapsed() < Duration::from_secs(60), "no {} within a minute", path.display());
        std::thread::sleep(Duration::from_millis(2));
    }
}

#[test]
fn a_killed_run_is_taken_up_again_and_ends_with_the_bytes_of_the_straight_one() {
    let home = tempfile::tempdir().unwrap();
    let path = |name: &str| home.path().join(name).display().to_string();
    fs::write(path("cup.ron"), CUP).unwrap();
    let cache = home.path().join("cache");
    let run = |out: &str, more: &[&str]| {
        let (scene, out) = (path("cup.ron"), path(out));
        let output = grouser(&cache, &[&["run", scene.as_str(), "--out", out.as_str()], more].concat());
        assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    };
    run("straight", &[]);
    for moment_ms in [0, 20, 90] {
        let out = path(&format!("killed_{moment_ms}"));
        let mut child = Command::new(env!("CARGO_BIN_EXE_grouser"))
            .args(["run", &path("cup.ron"), "--out", &out])
            .env("GROUSER_CACHE", &cache)
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        wait_for(&Path::new(&out).join("checkpoint.bin"));
        std::thread::sleep(Duration::from_millis(moment_ms));
        child.kill().unwrap();
        let _ = child.wait();
        run(&format!("killed_{moment_ms}"), &["--resume"]);
        for name in ["scenario.ron", "plate_30mm.csv", "plate_40mm.csv", "grains.pvd", "pressure_sinkage.svg"]
        {
            let of = |folder: &str| fs::read(home.path().join(folder).join(name)).unwrap();
            assert!(of("straight") == of(&format!("killed_{moment_ms}")), "{name} after {moment_ms} ms");
        }
    }
}
