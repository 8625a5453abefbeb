//! Figures of a bench: printed as a table, and written as `{group, case, metric, value, unit, threads}`.

use std::error::Error;
use std::path::Path;

/// One figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// What was measured on: a bed, a scene.
    pub case: String,
    /// What was measured.
    pub metric: &'static str,
    /// The number.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
}

/// Figures of one group.
#[derive(Clone, Debug)]
pub struct Figures {
    group: &'static str,
    threads: usize,
    figures: Vec<Figure>,
}

impl Figures {
    /// No figures yet of `group`, measured with `threads` threads.
    pub fn new(group: &'static str, threads: usize) -> Self {
        Self { group, threads, figures: Vec::new() }
    }

    /// Adds a figure and prints it.
    pub fn push(&mut self, case: &str, metric: &'static str, value: f64, unit: &'static str) {
        let is_plain = (1e-2..1e7).contains(&value.abs()) || value == 0.0;
        let number = if is_plain { format!("{value:.3}") } else { format!("{value:.3e}") };
        println!("  {case:<36} {metric:<40} {number:>12} {unit}");
        self.figures.push(Figure { case: case.to_owned(), metric, value, unit });
    }

    /// Writes the figures as JSON where a path is given.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write(&self, path: Option<&Path>) -> Result<(), Box<dyn Error>> {
        let Some(path) = path else { return Ok(()) };
        let row = |figure: &Figure| {
            serde_json::json!({
                "group": self.group, "case": figure.case, "metric": figure.metric, "value": figure.value,
                "unit": figure.unit, "threads": self.threads,
            })
        };
        let rows: Vec<_> = self.figures.iter().map(row).collect();
        Ok(std::fs::write(path, serde_json::to_string_pretty(&rows)? + "\n")?)
    }
}
