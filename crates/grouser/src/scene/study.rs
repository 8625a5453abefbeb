//! A study: the same scene over every combination of some values, and what is compared.

use ron::value::RawValue;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Runs a scene once for every combination of the axes' values, each into its own folder, and compares the results.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Study {
    /// What is varied.
    pub axes: Vec<Axis>,
    /// Time series laid over each other.
    #[serde(default)]
    pub curves: Vec<Curves>,
    /// Metrics over an axis.
    #[serde(default)]
    pub trends: Vec<Trend>,
    /// Pictures of every variant that are shown one below the other: names of files without `.png`.
    #[serde(default)]
    pub pictures: Vec<String>,
    /// Metrics of the table of all variants, by the beginning of their name; all when empty.
    #[serde(default)]
    pub columns: Vec<String>,
}

/// One thing that is varied.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// Name.
    pub name: String,
    /// Its values in order. A label that is a number is the place of its value on a chart's axis.
    pub values: Vec<Choice>,
}

/// One value of an axis.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Choice {
    /// Label.
    pub label: String,
    /// What it replaces in the scene: path of a value → the value written there.
    pub set: BTreeMap<String, Box<RawValue>>,
}

/// Two columns of a time series of every variant over each other.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Curves {
    /// Heading.
    pub title: String,
    /// Name of the time series, a file without `.csv`.
    pub table: String,
    /// Column along the horizontal axis.
    pub x: String,
    /// Column along the vertical axis.
    pub y: String,
    /// Axes that tell the curves apart; over the others the mean is drawn, with the lowest and the highest.
    pub by: Vec<String>,
    /// Labels that are drawn, by axis; all of an axis that is not named.
    #[serde(default)]
    pub only: BTreeMap<String, Vec<String>>,
}

/// A metric over an axis.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Trend {
    /// Heading.
    pub title: String,
    /// Name of the metric.
    pub metric: String,
    /// Axis along the horizontal one.
    pub over: String,
    /// Axes that tell the lines apart; over the others the mean is drawn, with a ring for each.
    #[serde(default)]
    pub by: Vec<String>,
    /// Labels that are drawn, by axis; all of an axis that is not named.
    #[serde(default)]
    pub only: BTreeMap<String, Vec<String>>,
}

/// One combination.
#[derive(Debug, Clone, PartialEq)]
pub struct Variant {
    /// Label of each axis, in the order of the axes.
    pub labels: Vec<String>,
    /// What it replaces in the scene.
    pub sets: Vec<(String, String)>,
}

impl Variant {
    /// Name of its folder.
    pub fn folder(&self) -> String {
        let plain = |label: &String| -> String {
            label.chars().map(|c| if c.is_alphanumeric() || "._-".contains(c) { c } else { '_' }).collect()
        };
        self.labels.iter().map(plain).collect::<Vec<_>>().join("-")
    }
}

impl Study {
    /// Every combination; the last axis varies fastest.
    pub fn variants(&self) -> Vec<Variant> {
        let mut variants = vec![Variant { labels: Vec::new(), sets: Vec::new() }];
        for axis in &self.axes {
            let with = |variant: &Variant, choice: &Choice| {
                let mut variant = variant.clone();
                variant.labels.push(choice.label.clone());
                let sets = choice.set.iter();
                variant
                    .sets
                    .extend(sets.map(|(path, value)| (path.clone(), value.get_ron().trim().to_owned())));
                variant
            };
            variants = variants
                .iter()
                .flat_map(|variant| axis.values.iter().map(|choice| with(variant, choice)))
                .collect();
        }
        variants
    }

    /// Number of the axis called `name`.
    pub fn axis(&self, name: &str) -> Option<usize> {
        self.axes.iter().position(|axis| axis.name == name)
    }
}
