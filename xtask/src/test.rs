//! The test command: everything that must hold, and what each part takes.

use crate::process::{cargo, root, succeeds};
use crate::{grouser, tidy};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

/// Runs every part, whatever fails, and sums up. True when all of them hold.
pub fn test() -> bool {
    let mut parts = Parts::default();
    parts.run("format", || succeeds(&mut cargo(&["fmt", "--all", "--check"])));
    parts.run("tidy", tidy::report);
    parts.run("lints", || {
        succeeds(&mut cargo(&["clippy", "--quiet", "--workspace", "--all-targets", "--", "-D", "warnings"]))
    });
    // A crate that fails does not hide the tests of those after it.
    parts.run("tests", || succeeds(&mut cargo(&["test", "--quiet", "--workspace", "--no-fail-fast"])));
    let mut program = None;
    parts.run("build", || {
        program = grouser::build();
        program.is_some()
    });
    if let Some(program) = program {
        parts.run("verify", || succeeds(Command::new(&program).arg("verify")));
        for scene in scenes() {
            let name = scene.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            parts.run(&format!("scene {name}"), || run_quick(&program, &scene, &name));
        }
    }
    parts.sum_up()
}

/// The crates' documentation, warnings being errors.
pub fn docs() -> bool {
    succeeds(cargo(&["doc", "--workspace", "--no-deps"]).env("RUSTDOCFLAGS", "-D warnings"))
}

fn scenes() -> Vec<PathBuf> {
    let entries = std::fs::read_dir(root().join("scenarios")).into_iter().flatten().flatten();
    let mut scenes: Vec<PathBuf> = entries
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|e| e == "ron"))
        .collect();
    scenes.sort();
    scenes
}

/// Runs a scene's quick version from an empty cache into the build folder, and looks at what it leaves.
fn run_quick(program: &Path, scene: &Path, name: &str) -> bool {
    let folder = program.with_file_name("scenes").join(name);
    let _ = std::fs::remove_dir_all(&folder);
    let mut command = Command::new(program);
    command.arg("run").arg(scene).arg("--quick").arg("--out").arg(&folder).env("GROUSER_CACHE", "");
    let leaves = ["scenario.ron", "summary.json", "report.html"];
    let missing = |name: &&str| !folder.join(name).is_file();
    if !succeeds(&mut command) {
        return false;
    }
    let missing: Vec<&str> = leaves.into_iter().filter(missing).collect();
    if !missing.is_empty() {
        eprintln!("error: the run left no {}", missing.join(", "));
    }
    missing.is_empty()
}

/// Parts of the test with their results.
#[derive(Default)]
struct Parts {
    results: Vec<(String, bool, Duration)>,
}

impl Parts {
    fn run(&mut self, name: &str, part: impl FnOnce() -> bool) {
        println!("── {name}");
        let begun = Instant::now();
        let is_ok = part();
        self.results.push((name.to_owned(), is_ok, begun.elapsed()));
    }

    fn sum_up(&self) -> bool {
        println!("── summary");
        for (name, is_ok, took) in &self.results {
            println!(
                "  {}  {name:<24} {:>7.1} s",
                if *is_ok { "ok    " } else { "FAILED" },
                took.as_secs_f64()
            );
        }
        let total: f64 = self.results.iter().map(|(.., took)| took.as_secs_f64()).sum();
        let failed: Vec<&str> =
            self.results.iter().filter(|(_, is_ok, _)| !is_ok).map(|(name, ..)| name.as_str()).collect();
        if failed.is_empty() {
            println!("all {} parts passed in {total:.0} s", self.results.len());
        } else {
            println!(
                "{} of {} parts FAILED in {total:.0} s: {}",
                failed.len(),
                self.results.len(),
                failed.join(", ")
            );
        }
        failed.is_empty()
    }
}
