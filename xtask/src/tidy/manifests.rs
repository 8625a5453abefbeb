//! Who may depend on whom.

use super::File;

/// Crate → what it must not depend on, not even through others.
const FORBIDDEN: [(&str, &[&str]); 8] = [
    ("grouser-geometry", &["grouser-", "rayon"]),
    (
        "grouser-contact",
        &["grouser-dem", "grouser-fem", "grouser-coupling", "grouser-iscm", "grouser-rigid", "rayon"],
    ),
    ("grouser-dem", &["grouser-fem", "grouser-coupling", "grouser-iscm", "grouser-rigid", "ron"]),
    ("grouser-fem", &["grouser-dem", "grouser-coupling", "grouser-iscm", "grouser-contact", "ron"]),
    ("grouser-rigid", &["grouser-dem", "grouser-fem", "grouser-coupling", "grouser-iscm", "ron"]),
    ("grouser-coupling", &["grouser-dem", "grouser-fem", "grouser-iscm", "grouser-rigid", "ron"]),
    (
        "grouser-iscm",
        &["grouser-dem", "grouser-fem", "grouser-coupling", "grouser-contact", "parry3d", "faer", "ron"],
    ),
    ("xtask", &["grouser"]),
];

/// Every forbidden dependency, with the way that leads to it.
pub fn breaches(files: &[File]) -> Vec<String> {
    let manifest = |name: &str| {
        let is_its = |file: &&File| {
            file.path == format!("crates/{name}/Cargo.toml") || file.path == format!("{name}/Cargo.toml")
        };
        files.iter().find(is_its).map(|file| dependencies(&file.text))
    };
    let mut breaches = Vec::new();
    for (name, forbidden) in FORBIDDEN {
        let mut ways = vec![vec![name.to_owned()]];
        let mut seen = vec![name.to_owned()];
        while let Some(way) = ways.pop() {
            for next in manifest(&way[way.len() - 1]).unwrap_or_default() {
                if forbidden.iter().any(|start| next.starts_with(start)) {
                    breaches.push(format!("{} → {next}: {name} must not depend on {next}", way.join(" → ")));
                } else if !seen.contains(&next) {
                    seen.push(next.clone());
                    ways.push([&way[..], &[next]].concat());
                }
            }
        }
    }
    breaches
}

/// Names in the `[dependencies]` section; those of tests do not count.
fn dependencies(manifest: &str) -> Vec<String> {
    let section = manifest.lines().skip_while(|line| line.trim() != "[dependencies]").skip(1);
    section
        .take_while(|line| !line.trim_start().starts_with('['))
        .filter_map(|line| line.split(['.', '=', ' ']).next())
        .filter(|name| !name.is_empty() && !name.starts_with('#'))
        .map(str::to_owned)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn manifest(name: &str, dependencies: &str) -> File {
        let text = format!(
            "[package]\nname = \"{name}\"\n\n[dependencies]\n{dependencies}\n[dev-dependencies]\nron = \"1\"\n"
        );
        File { path: format!("crates/{name}/Cargo.toml"), text }
    }

    #[test]
    fn a_forbidden_dependency_is_found_through_another_crate() {
        let iscm = manifest("grouser-iscm", "serde.workspace = true\ngrouser-geometry.workspace = true\n");
        let good = manifest("grouser-geometry", "nalgebra = { version = \"1\" }\n");
        let bad = manifest("grouser-geometry", "parry3d-f64 = \"0.31\"\n");
        assert_eq!(breaches(&[iscm, good]), [""; 0]);
        let iscm = manifest("grouser-iscm", "grouser-geometry.workspace = true\n");
        let found = breaches(&[iscm, bad]);
        assert_eq!(found.len(), 1);
        assert!(found[0].starts_with("grouser-iscm → grouser-geometry → parry3d-f64"), "{found:?}");
    }
}
