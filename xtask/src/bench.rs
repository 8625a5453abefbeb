//! Criterion benches and throughput figures.
//!
//! A group is a name: `benches/benches/<group>.rs` is its criterion bench, `benches/src/bin/<group>_throughput.rs` the
//! program that measures whole beds or scenes. Either may be absent.

use crate::process::{cargo, root, succeeds};
use std::path::{Path, PathBuf};

/// Runs a group, or all of them. What follows the group goes to its throughput program, except `--json FILE`: one array with the
/// figures of all programs and criterion benches.
pub fn bench(arguments: &[String]) -> bool {
    let (group, rest) = match arguments.split_first() {
        Some((group, rest)) if !group.starts_with('-') => (Some(group.as_str()), rest),
        _ => (None, arguments),
    };
    let mut rest = rest.to_vec();
    let json = match rest.iter().position(|argument| argument == "--json") {
        Some(place) if place + 1 < rest.len() => {
            let file = rest.remove(place + 1);
            rest.remove(place);
            Some(PathBuf::from(file))
        }
        Some(_) => {
            eprintln!("error: `--json` names no file\n  expected: `--json FILE`");
            return false;
        }
        None => None,
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
    let mut rows = Vec::new();
    // All of them, whatever fails.
    let n_failed =
        groups.iter().filter(|group| !bench_group(group, &rest, json.is_some(), &mut rows)).count();
    let is_written = json.is_none_or(|file| match std::fs::write(&file, joined(&rows)) {
        Ok(()) => true,
        Err(error) => {
            eprintln!("error: {}: {error}", file.display());
            false
        }
    });
    n_failed == 0 && is_written
}

/// One array of several.
fn joined(arrays: &[String]) -> String {
    let inner = |array: &String| {
        let array = array.trim();
        let inner = array.strip_prefix('[').and_then(|array| array.strip_suffix(']')).unwrap_or(array);
        inner.trim().to_owned()
    };
    let rows: Vec<String> = arrays.iter().map(inner).filter(|rows| !rows.is_empty()).collect();
    format!("[\n  {}\n]\n", rows.join(",\n  "))
}

fn bench_group(group: &str, arguments: &[String], wants_rows: bool, rows: &mut Vec<String>) -> bool {
    let benches = root().join("benches");
    let mut is_ok = true;
    if benches.join(format!("src/bin/{group}_throughput.rs")).is_file() {
        println!("── {group}");
        let program = format!("{group}_throughput");
        let mut command =
            cargo(&["run", "--quiet", "--release", "--package", "benches", "--bin", &program, "--"]);
        command.args(arguments);
        let file = std::env::temp_dir().join(format!("{program}-{}.json", std::process::id()));
        if wants_rows {
            command.arg("--json").arg(&file);
        }
        is_ok &= succeeds(&mut command);
        if wants_rows {
            rows.extend(std::fs::read_to_string(&file));
            let _ = std::fs::remove_file(&file);
        }
    }
    if benches.join(format!("benches/{group}.rs")).is_file() {
        is_ok &= succeeds(&mut cargo(&["bench", "--quiet", "--package", "benches", "--bench", group]));
        if wants_rows {
            criterion_rows(&root().join("target/criterion"), rows);
        }
    }
    is_ok
}

/// A row for each criterion bench below `folder`: elements per second by its median.
fn criterion_rows(folder: &Path, rows: &mut Vec<String>) {
    let mut below: Vec<PathBuf> =
        std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    below.sort();
    for path in below.into_iter().filter(|path| path.is_dir()) {
        if !path.ends_with("new") {
            criterion_rows(&path, rows);
            continue;
        }
        let text = |name: &str| std::fs::read_to_string(path.join(name)).unwrap_or_default();
        rows.extend(criterion_row(&text("benchmark.json"), &text("estimates.json")));
    }
}

fn criterion_row(benchmark: &str, estimates: &str) -> Option<String> {
    let name = |key: &str| benchmark.split_once(&format!("\"{key}\":\""))?.1.split('"').next();
    let number = |text: &str, key: &str| {
        let after = text.split_once(&format!("\"{key}\":"))?.1;
        after[..after.find([',', '}'])?].trim().parse::<f64>().ok()
    };
    let median_ns = number(estimates.split_once("\"median\"")?.1, "point_estimate")?;
    let (group, case) = (name("group_id")?, name("function_id")?);
    let (metric, value, unit) = match number(benchmark, "Elements") {
        Some(elements) => ("throughput", 1e9 * elements / median_ns, "1/s"),
        None => ("time", 1e-9 * median_ns, "s"),
    };
    Some(format!(
        "{{\"group\": \"{group}\", \"case\": \"{case}\", \"metric\": \"{metric}\", \"value\": {value}, \"unit\": \"{unit}\", \
         \"threads\": 1}}"
    ))
}

/// Names of the Rust files of a folder that end in `suffix`, without it.
fn names(folder: &Path, suffix: &str) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let name = |entry: std::fs::DirEntry| {
        Some(entry.file_name().to_str()?.strip_suffix(".rs")?.strip_suffix(suffix)?.to_owned())
    };
    entries.filter_map(name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_criterion_bench_becomes_its_throughput() {
        let benchmark = r#"{"group_id":"pass","function_id":"forces","throughput":{"Elements":500}}"#;
        let estimates = r#"{"mean":{"point_estimate":9.0},"median":{"confidence_interval":{"lower_bound":1.0},"point_estimate":2000.0}}"#;
        let row = criterion_row(benchmark, estimates).unwrap();
        let expected = r#"{"group":"pass","case":"forces","metric":"throughput","value":250000000,"unit":"1/s","threads":1}"#;
        assert_eq!(row.split_whitespace().collect::<String>(), expected);
    }

    #[test]
    fn arrays_of_several_programs_become_one() {
        let arrays = ["[\n  {\"a\": 1}\n]\n", "[]", "[{\"b\": [2]}, {\"c\": 3}]"].map(str::to_owned);
        let text = joined(&arrays).split_whitespace().collect::<String>();
        assert_eq!(text, r#"[{"a":1},{"b":[2]},{"c":3}]"#);
    }
}
