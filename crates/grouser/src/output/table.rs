//! Time series: rows of numbers under named columns, written as CSV.
//!
//! Rows live in the run's state and thus in its checkpoints; the file is written whole from them. A resumed run
//! therefore continues the same table, whatever the folder held.

use serde::{Deserialize, Serialize};

/// Name and unit of a column.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Column {
    /// Name, without blanks.
    pub name: String,
    /// Unit in SI; `-` when there is none.
    pub unit: String,
}

/// Rows of numbers under named columns.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Table {
    columns: Vec<Column>,
    rows: Vec<f64>,
}

impl Table {
    /// An empty table of columns given as (name, unit).
    pub fn new(columns: &[(&str, &str)]) -> Self {
        let column = |&(name, unit): &(&str, &str)| Column { name: name.to_owned(), unit: unit.to_owned() };
        Table { columns: columns.iter().map(column).collect(), rows: Vec::new() }
    }

    /// Adds a row.
    ///
    /// # Panics
    /// When the row has another length than the columns: a mistake of the caller, not of an input.
    pub fn push(&mut self, row: &[f64]) {
        assert_eq!(row.len(), self.columns.len(), "one number a column");
        self.rows.extend_from_slice(row);
    }

    /// Rows so far.
    pub fn n_rows(&self) -> usize {
        self.rows.len() / self.columns.len()
    }

    /// Rows, in order.
    pub fn rows(&self) -> impl Iterator<Item = &[f64]> {
        self.rows.chunks_exact(self.columns.len())
    }

    /// One column's numbers. Empty when there is no such column.
    pub fn column(&self, name: &str) -> Vec<f64> {
        let at = self.columns.iter().position(|column| column.name == name);
        at.map_or(Vec::new(), |at| self.rows().map(|row| row[at]).collect())
    }

    /// Reads what [`Table::to_csv`] wrote; `None` for anything else.
    pub fn from_csv(text: &str) -> Option<Self> {
        let mut lines = text.lines();
        let column = |head: &str| match head.split_once(" [") {
            Some((name, unit)) => Column { name: name.into(), unit: unit.trim_end_matches(']').into() },
            None => Column { name: head.into(), unit: "-".into() },
        };
        let columns: Vec<Column> = lines.next()?.split(',').map(column).collect();
        let mut rows = Vec::new();
        for line in lines {
            let before = rows.len();
            for value in line.split(',') {
                rows.push(value.parse().ok()?);
            }
            if rows.len() - before != columns.len() {
                return None;
            }
        }
        Some(Self { columns, rows })
    }

    /// Name and unit of a column, as an axis is labelled: `sinkage [m]`.
    pub fn label(&self, name: &str) -> String {
        match self.columns.iter().find(|column| column.name == name) {
            Some(Column { unit, .. }) if unit != "-" => format!("{name} [{unit}]"),
            _ => name.to_owned(),
        }
    }

    /// CSV with one line `name_unit` of heads; numbers in the fewest digits that read back to the same bits.
    pub fn to_csv(&self) -> String {
        let head = |column: &Column| match column.unit.as_str() {
            "-" => column.name.clone(),
            unit => format!("{} [{unit}]", column.name),
        };
        let mut text = self.columns.iter().map(head).collect::<Vec<_>>().join(",") + "\n";
        for row in self.rows() {
            text += &row.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
            text.push('\n');
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_back_to_the_same_bits() {
        let mut table = Table::new(&[("time", "s"), ("slip", "-")]);
        let values = [0.1 + 0.2, f64::MIN_POSITIVE, -1.0 / 3.0, 1e300];
        table.push(&values[..2]);
        table.push(&values[2..]);
        let csv = table.to_csv();
        assert!(csv.starts_with("time [s],slip\n"));
        let read: Vec<f64> =
            csv.lines().skip(1).flat_map(|line| line.split(',').map(|v| v.parse().unwrap())).collect();
        assert_eq!(read, values);
        assert_eq!(Table::from_csv(&csv).as_ref(), Some(&table));
        assert!(Table::from_csv(&csv.replace(",", ",0,")).is_some_and(|other| other != table));
        assert_eq!(Table::from_csv("time [s]\n1,2\n"), None);
        assert_eq!([table.label("time"), table.label("slip")], ["time [s]", "slip"]);
        assert_eq!(table.column("slip"), [values[1], values[3]]);
        assert!(table.column("absent").is_empty());
    }
}
