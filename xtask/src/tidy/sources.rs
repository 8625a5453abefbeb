//! Rules of single files.

use super::File;

/// Longer files are two files.
const LONGEST: usize = 800;
/// Names that say nothing.
const VAGUE: [&str; 4] = ["utils.rs", "types.rs", "common.rs", "helpers.rs"];
/// What unfinished work looks like, split so that this list does not find itself.
const UNFINISHED: [(&str, &str); 6] = [
    ("todo", "!("),
    ("unimplemented", "!("),
    ("dbg", "!("),
    ("#[ign", "ore"),
    ("```ign", "ore"),
    ("//! TO", "DO"),
];
/// Places that only one machine has.
const PLACES: [(&str, &str); 5] =
    [("/ho", "me/"), ("/ro", "ot/"), ("/wo", "rk/"), ("/Us", "ers/"), ("../sh", "ared")];

/// What is wrong with a file.
pub fn breaches(file: &File) -> Vec<String> {
    let File { path, text } = file;
    let mut breaches = Vec::new();
    let name = path.rsplit('/').next().unwrap_or(path);
    let is_text = [".rs", ".md", ".ron", ".toml", ".css"].iter().any(|end| path.ends_with(end));
    let n_lines = text.lines().count();
    if is_text && n_lines > LONGEST {
        breaches.push(format!("{path}: {n_lines} lines, at most {LONGEST}"));
    }
    if VAGUE.contains(&name) {
        breaches.push(format!("{path}: a name that says nothing; name the concept"));
    }
    for (number, line) in text.lines().enumerate().filter(|_| is_text) {
        let finds = |(a, b): &&(&str, &str)| line.contains(&format!("{a}{b}"));
        if path.ends_with(".rs")
            && let Some((a, b)) = UNFINISHED.iter().find(finds)
        {
            breaches.push(format!("{path}:{}: `{a}{b}` is unfinished work", number + 1));
        }
        if let Some((a, b)) = PLACES.iter().find(finds) {
            breaches.push(format!("{path}:{}: `{a}{b}` exists on one machine only", number + 1));
        }
    }
    if path.starts_with("crates/") && path.ends_with("/src/lib.rs") && !has_doc_test(text) {
        breaches.push(format!("{path}: its front page has no example that is a doc-test"));
    }
    breaches
}

/// True when the front page has a block of code that rustdoc runs.
fn has_doc_test(text: &str) -> bool {
    let page = text.lines().map_while(|line| line.strip_prefix("//!"));
    let mut is_open = false;
    for fence in page.filter_map(|line| line.trim().strip_prefix("```")) {
        if !is_open && (fence.is_empty() || fence == "rust") {
            return true;
        }
        is_open = !is_open;
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(path: &str, text: &str) -> Vec<String> {
        breaches(&File { path: path.into(), text: text.into() })
    }

    #[test]
    fn each_rule_finds_its_breach_and_spares_good_files() {
        assert_eq!(of("crates/a/src/lib.rs", "//! Page.\n//! ```\n//! assert!(true);\n//! ```\n"), [""; 0]);
        for (path, text, part) in [
            ("crates/a/src/b.rs", "x\n".repeat(801), "801 lines"),
            ("crates/a/src/utils.rs", String::new(), "says nothing"),
            ("crates/a/src/b.rs", format!("fn f() {{ {}!() }}", "todo"), "b.rs:1"),
            ("docs/a.md", format!("see /{}/someone/file", "home"), "one machine"),
            ("crates/a/src/lib.rs", "//! ```text\n//! drawing\n//! ```\n".into(), "doc-test"),
        ] {
            let found = of(path, &text);
            assert!(found.len() == 1 && found[0].contains(part), "{path}: {found:?}");
        }
    }
}
