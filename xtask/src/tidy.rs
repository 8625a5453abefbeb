//! The repository's rules.

mod manifests;
mod sources;

use crate::process::root;
use std::path::{Path, PathBuf};

/// Every file of the repository that is text: its path from the root, and what it holds.
pub struct File {
    /// Path from the root, with `/`.
    pub path: String,
    /// Contents.
    pub text: String,
}

/// What may stand at the top.
const TOP: [&str; 17] = [
    ".cargo",
    ".ci",
    ".git",
    ".gitattributes",
    ".gitignore",
    "ARCHITECTURE.md",
    "CHANGELOG.md",
    "Cargo.lock",
    "Cargo.toml",
    "LICENSE",
    "README.md",
    "benches",
    "crates",
    "docs",
    "rustfmt.toml",
    "scenarios",
    "xtask",
];
/// What must stand there.
const REQUIRED: [&str; 5] = ["README.md", "ARCHITECTURE.md", "CHANGELOG.md", "LICENSE", "docs/notation.md"];
/// What tools leave there and no version control takes.
const LEFT: [&str; 2] = ["target", "out"];

/// Prints every breach. True when there is none.
pub fn report() -> bool {
    let root = root();
    let mut files = Vec::new();
    collect(&root, &root, &mut files);
    let breaches = breaches(&files, |path| root.join(path).exists());
    breaches.iter().for_each(|breach| println!("  {breach}"));
    println!("tidy: {} files, {} breaches", files.len(), breaches.len());
    breaches.is_empty()
}

fn breaches(files: &[File], exists: impl Fn(&str) -> bool) -> Vec<String> {
    let mut breaches: Vec<String> =
        REQUIRED.iter().filter(|path| !exists(path)).map(|path| format!("{path} is missing")).collect();
    let mut tops: Vec<&str> = files.iter().filter_map(|file| file.path.split('/').next()).collect();
    tops.dedup();
    let grown = tops.iter().filter(|top| !TOP.contains(top));
    breaches.extend(grown.map(|top| format!("{top}: nothing else grows at the top of the repository")));
    breaches.extend(files.iter().flat_map(sources::breaches));
    breaches.extend(manifests::breaches(files));
    breaches
}

fn collect(root: &Path, folder: &Path, files: &mut Vec<File>) {
    let mut paths: Vec<PathBuf> =
        std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    paths.sort();
    for path in paths {
        let name = path.strip_prefix(root).unwrap_or(&path).to_string_lossy().replace('\\', "/");
        if LEFT.contains(&name.as_str()) || name == ".git" {
            continue;
        }
        if path.is_dir() {
            collect(root, &path, files);
        } else if let Ok(text) = std::fs::read_to_string(&path) {
            files.push(File { path: name, text });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_and_foreign_files_at_the_top_are_named() {
        let file = |path: &str| File { path: path.into(), text: String::new() };
        let found = breaches(&[file("notes.txt"), file("docs/theory/x.md")], |path| path != "CHANGELOG.md");
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(found[0].contains("CHANGELOG.md is missing") && found[1].contains("notes.txt"));
    }
}
