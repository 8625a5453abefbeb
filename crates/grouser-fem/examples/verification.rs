//! Lists computed values beside closed forms: `cargo run --release -p grouser-fem --example verification`.

fn main() {
    let start = std::time::Instant::now();
    let rows = match grouser_fem::verification::all() {
        Ok(rows) => rows,
        Err(error) => return eprintln!("error: {error}"),
    };
    for row in &rows {
        let verdict = if row.is_pass() { "pass" } else { "FAIL" };
        println!(
            "{verdict}  {} · {}: {:.6e} against {:.6e} ± {:.1e} {}",
            row.case, row.quantity, row.computed, row.reference, row.tolerance, row.unit
        );
    }
    println!("{} rows in {:.1} s", rows.len(), start.elapsed().as_secs_f64());
}
