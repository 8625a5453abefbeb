//! Criterion benches and throughput figures.
//!
//! A group is a name: `benches/benches/<group>.rs` is its criterion bench, `benches/src/bin/<group>_throughput.rs` the
//! program that measures whole beds or scenes. Either may be absent.

use crate::process::{cargo, root, succeeds};
use std::path::Path;

/// Runs a group, or all of them. What follows the group goes to its throughput program.
pub fn bench(arguments: &[String]) -> bool {
    let (group, rest) = match arguments.split_first() {
        Some((group, rest)) if !group.starts_with('-') => (Some(group.as_str()), rest),
        _ => (None, arguments),
    };
    let mut groups: Vec<String> = names(&root().join("benches/benches"), "");
    groups.extend(names(&root().join("benches/src/bin"), "_throughput"));
    groups.sort();
    groups.dedup();
    if let Some(group) = group {
        if !groups.iter().any(|known| known == group) {
            eprintln!("error: there is no group `{group}`\n  expected: one of {}", groups.join(", "));
            return false;
        }
        groups = vec![group.to_owned()];
    }
    // All of them, whatever fails.
    groups.iter().filter(|group| !bench_group(group, rest)).count() == 0
}

fn bench_group(group: &str, arguments: &[String]) -> bool {
    let benches = root().join("benches");
    let mut is_ok = true;
    if benches.join(format!("src/bin/{group}_throughput.rs")).is_file() {
        let program = format!("{group}_throughput");
        let mut command =
            cargo(&["run", "--quiet", "--release", "--package", "benches", "--bin", &program, "--"]);
        is_ok &= succeeds(command.args(arguments));
    }
    if benches.join(format!("benches/{group}.rs")).is_file() {
        is_ok &= succeeds(&mut cargo(&["bench", "--quiet", "--package", "benches", "--bench", group]));
    }
    is_ok
}

/// Names of the Rust files of a folder that end in `suffix`, without it.
fn names(folder: &Path, suffix: &str) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let name = |entry: std::fs::DirEntry| {
        Some(entry.file_name().to_str()?.strip_suffix(".rs")?.strip_suffix(suffix)?.to_owned())
    };
    entries.filter_map(name).collect()
}
