//! Checks of a study.

use super::Check;
use crate::scene::Study;

pub fn validate(check: &mut Check, study: &Study) {
    if study.axes.is_empty() {
        check.fail("study.axes", "nothing is varied", "at least one axis", "all axes were deleted");
    }
    for (i, axis) in study.axes.iter().enumerate() {
        let path = format!("study.axes[{i}].values");
        if axis.values.is_empty() {
            check.fail(&path, "the axis has no value", "at least one value", "all values were deleted");
        }
        for (j, choice) in axis.values.iter().enumerate() {
            if axis.values[..j].iter().any(|other| other.label == choice.label) {
                let what = format!("the label \"{}\" is there twice", choice.label);
                check.fail(&format!("{path}[{j}].label"), &what, "a label of its own", "a copied line");
            }
        }
    }
    for (i, name) in study.pictures.iter().enumerate() {
        if name.is_empty() || name.contains(['/', '\\', '.']) {
            let what = format!("\"{name}\" is no name of a picture");
            let expected = "the name of a file that every variant leaves, without folder and without .png";
            check.fail(&format!("study.pictures[{i}]"), &what, expected, "a path");
        }
    }
    let names: Vec<&str> = study.axes.iter().map(|axis| axis.name.as_str()).collect();
    let by_curves =
        study.curves.iter().enumerate().map(|(i, c)| (format!("study.curves[{i}].by"), c.by.clone()));
    let by_trends = study
        .trends
        .iter()
        .enumerate()
        .map(|(i, t)| (format!("study.trends[{i}].over"), [t.by.clone(), vec![t.over.clone()]].concat()));
    let only_curves =
        study.curves.iter().enumerate().map(|(i, c)| (format!("study.curves[{i}].only"), &c.only));
    let only_trends =
        study.trends.iter().enumerate().map(|(i, t)| (format!("study.trends[{i}].only"), &t.only));
    let only: Vec<_> = only_curves.chain(only_trends).collect();
    for (path, labels) in &only {
        for (name, asked) in labels.iter() {
            let Some(axis) = study.axis(name) else { continue };
            let known: Vec<&str> = study.axes[axis].values.iter().map(|v| v.label.as_str()).collect();
            if !asked.iter().any(|label| known.contains(&label.as_str())) {
                let what = format!("none of these labels is on the axis \"{name}\"");
                check.fail(path, &what, &format!("one of {}", known.join(", ")), "a misspelt label");
            }
        }
    }
    let by_only = only.iter().map(|(path, labels)| (path.clone(), labels.keys().cloned().collect()));
    for (path, asked) in by_curves.chain(by_trends).chain(by_only) {
        for name in asked.iter().filter(|name| !names.contains(&name.as_str())) {
            let what = format!("there is no axis \"{name}\"");
            check.fail(&path, &what, &format!("one of {}", names.join(", ")), "a misspelt name");
        }
    }
}
