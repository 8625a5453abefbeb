//! One scene over several values: each variant in its folder, all of them compared, nothing done twice.

use crate::{errors, grouser};
use std::fs;

const SCENE: &str = r#"(
    title: "Friction and depth",
    materials: {
        "sand": (young_pa: 1e7, poisson: 0.25, density_kg_m3: 2500, restitution: 0.3, friction: 0.5),
    },
    soil: Grains(
        container: (size_m: (0.06, 0.06, 0.10), material: "sand"),
        layers: [(material: "sand", sizes: Uniform(radius_m: (0.0045, 0.0055)), depth_m: 0.02)],
    ),
    study: (
        axes: [
            (name: "friction", values: [
                (label: "0.1", set: {"materials.sand.friction": 0.1}),
                (label: "0.9", set: {"materials.sand.friction": 0.9}),
            ]),
            (name: "seed", values: [(label: "1", set: {"soil.seed": 1}), (label: "2", set: {"soil.seed": 2})]),
        ],
        trends: [(title: "Packing", metric: "solid fraction", over: "friction")],
        columns: ["solid fraction", "bed depth"],
    ),
)"#;

#[test]
fn variants_lie_in_their_folders_are_compared_and_not_run_twice() {
    let home = tempfile::tempdir().unwrap();
    let path = |name: &str| home.path().join(name).display().to_string();
    fs::write(path("study.ron"), SCENE).unwrap();
    let output = grouser(home.path(), &["run", &path("study.ron"), "--out", &path("out")]);
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    let summary: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(path("out/summary.json")).unwrap()).unwrap();
    let solid = |label: &str| {
        let metrics = summary["metrics"].as_array().unwrap();
        let metric = metrics.iter().find(|m| m["name"] == format!("{label}: solid fraction")).unwrap();
        metric["value"].as_f64().unwrap()
    };
    // Smooth grains pack more densely than rough ones, whatever the seed.
    for seed in ["1", "2"] {
        assert!(solid(&format!("0.1, {seed}")) > solid(&format!("0.9, {seed}")), "{summary}");
    }
    assert_ne!(solid("0.1, 1"), solid("0.1, 2"));
    assert!(fs::metadata(path("out/trend_1.svg")).is_ok());
    assert_eq!(summary["is_quick"], false);

    // Taken up again with one variant missing, only that one is run.
    let kept = fs::metadata(path("out/0.1-1/summary.json")).unwrap().modified().unwrap();
    fs::remove_dir_all(path("out/0.9-2")).unwrap();
    let output = grouser(home.path(), &["run", &path("study.ron"), "--out", &path("out"), "--resume"]);
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    assert_eq!(fs::metadata(path("out/0.1-1/summary.json")).unwrap().modified().unwrap(), kept);
    assert!(fs::metadata(path("out/0.9-2/summary.json")).is_ok());

    // A value that no scene can have is refused before anything runs.
    fs::write(path("bad.ron"), SCENE.replace("friction\": 0.9", "friction\": -0.9")).unwrap();
    let output = grouser(home.path(), &["run", &path("bad.ron"), "--out", &path("bad")]);
    let message = errors(&output);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("materials.sand.friction") && message.contains("0.9"), "{message}");
    assert!(fs::metadata(path("bad")).is_err());
    // So is a picture that lies elsewhere.
    fs::write(path("bad.ron"), SCENE.replace("columns:", "pictures: [\"../ruts\"], columns:")).unwrap();
    let output = grouser(home.path(), &["run", &path("bad.ron"), "--out", &path("bad")]);
    let message = errors(&output);
    assert!(output.status.code() == Some(2) && message.contains("is no name of a picture"), "{message}");
}
