//! `grouser verify`: every case against its reference.

use super::{FAILED, WRONG_INPUT};
use crate::output::write_atomic;
use crate::verify::{Row, cases};
use clap::Args;
use std::path::PathBuf;
use std::time::Instant;

/// Which cases, and where the results go.
#[derive(Args)]
pub(super) struct Verify {
    /// Only cases whose name contains this text
    #[arg(long, value_name = "NAME")]
    only: Option<String>,
    /// Also write all rows as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

impl Verify {
    pub fn verify(self) -> u8 {
        let is_wanted = |name: &str| self.only.as_ref().is_none_or(|only| name.contains(only.as_str()));
        let wanted: Vec<_> = cases().into_iter().filter(|case| is_wanted(case.name)).collect();
        if wanted.is_empty() {
            let names: Vec<&str> = cases().iter().map(|case| case.name).collect();
            eprintln!(
                "error: no case has this text in its name\n  expected: part of one of {}",
                names.join(", ")
            );
            return WRONG_INPUT;
        }
        let mut rows: Vec<Row> = Vec::new();
        for case in wanted {
            let begun = Instant::now();
            let new = (case.rows)();
            println!("\n{}  ({:.2} s)", case.name, begun.elapsed().as_secs_f64());
            new.iter().for_each(|row| println!("{}", row.line()));
            rows.extend(new);
        }
        let n_failed = rows.iter().filter(|row| !row.pass).count();
        println!("\n{} rows, {} failed", rows.len(), n_failed);
        if let Some(file) = &self.json {
            let text = serde_json::to_string_pretty(&rows).map_err(std::io::Error::other);
            if let Err(error) = text.and_then(|text| write_atomic(file, text.as_bytes())) {
                eprintln!("error: {error}");
                return WRONG_INPUT;
            }
        }
        if n_failed == 0 { 0 } else { FAILED }
    }
}
