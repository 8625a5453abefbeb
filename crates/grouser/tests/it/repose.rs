//! A column that loses its support: without friction it flows until it is nearly flat, with more friction it stands steeper.

use crate::{errors, grouser};
use std::fs;

/// A slice of some 500 grains, settled without friction so that all three share their packing.
const COLUMN: &str = r#"(
    title: "A column collapses",
    materials: {
        "grain": (young_pa: 1e7, poisson: 0.3, density_kg_m3: 2600, restitution: 0.3, friction: 0.5),
        "smooth": (young_pa: 1e7, poisson: 0.3, density_kg_m3: 2600, restitution: 0.3, friction: 0.0),
    },
    pairs: [(between: ("grain", "smooth"), restitution: 0.3, friction: 0.0)],
    soil: Grains(
        container: (size_m: (0.20, 0.045, 0.13), x: Walled, material: "smooth"),
        layers: [(material: "grain", sizes: Uniform(radius_m: (0.0040, 0.0044)), depth_m: 0.05)],
        settle: (energy_ratio: 1e-3, longest_s: 2.0, friction: 0.0, is_turning: true),
    ),
    motion: Collapse(column_m: 0.07, energy_ratio: 1e-5, longest_s: 3.0),
    outputs: (sample_every_s: 0.01, vtk_every_s: 1.0, checkpoint_every_s: 1.0),
    study: (axes: [(name: "friction", values: [
        (label: "0", set: {"materials.grain.friction": 0.0}),
        (label: "0.3", set: {"materials.grain.friction": 0.3}),
        (label: "0.9", set: {"materials.grain.friction": 0.9, "dials.rotation": Fixed}),
    ])]),
)"#;

#[test]
fn a_heap_without_friction_lies_nearly_flat_and_its_angle_rises_with_friction() {
    let home = tempfile::tempdir().unwrap();
    let path = |name: &str| home.path().join(name).display().to_string();
    fs::write(path("column.ron"), COLUMN).unwrap();
    let angles = ["1", "2", "3"].map(|seed| {
        let (set, out) = (format!("soil.seed={seed}"), path(seed));
        let output = grouser(home.path(), &["run", &path("column.ron"), "--set", &set, "--out", &out]);
        assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
        let summary: serde_json::Value =
            serde_json::from_str(&fs::read_to_string(path(seed) + "/summary.json").unwrap()).unwrap();
        ["0", "0.3", "0.9"].map(|label| {
            let metric = |name: &str| {
                let metrics = summary["metrics"].as_array().unwrap();
                let metric = metrics.iter().find(|m| m["name"] == format!("{label}: {name}")).unwrap();
                metric["value"].as_f64().unwrap()
            };
            // What contacts store when the column is cut out is no gain: it would be 0.5 % of the height's energy without friction.
            assert!(metric("energy residual over the energy of the height").abs() < 0.002, "{summary}");
            metric("angle of repose")
        })
    });
    let median = |k: usize| {
        let mut of_seeds = angles.map(|of_seed| of_seed[k]);
        of_seeds.sort_by(f64::total_cmp);
        of_seeds[1]
    };
    let [flat, gentle, steep] = [0, 1, 2].map(median);
    // Frictionless packings hold 5.8° in bulk (Peyneau & Roux, Phys. Rev. E 78 (2008) 011307), four layers on a bumpy floor some more:
    // 8.7 to 12.7° over ten beds.
    assert!(flat > 0.0 && flat < 12.0, "{angles:?}");
    // Rough grains that cannot turn stand as a cliff: seven to eight beds of ten at 63 to 67°, the others have lost its edge (49°).
    assert!(gentle > flat + 6.0 && gentle < 30.0 && steep > 60.0, "{angles:?}");

    let bad = COLUMN.replace("column_m: 0.07", "column_m: 0.17").replace("x: Walled, ", "");
    fs::write(path("bad.ron"), bad).unwrap();
    let output = grouser(home.path(), &["run", &path("bad.ron"), "--out", &path("bad")]);
    let message = errors(&output);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(
        message.contains("motion.column_m") && message.contains("a column cannot lean against itself"),
        "{message}"
    );
}
