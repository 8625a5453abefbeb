//! What the codes cost and how far they agree, as text and as JSON.

use super::code::Outcome;
use super::{Case, Row};

/// Name, unit, and how an outcome says it.
type Quantity = (&'static str, &'static str, fn(&Outcome) -> f64);

/// The quantities that are compared.
const QUANTITIES: [Quantity; 4] = [
    ("kinetic energy", "J", |outcome| outcome.kinetic),
    ("coordination", "-", |outcome| outcome.coordination),
    ("mean overlap", "m", |outcome| outcome.overlap),
    ("mean velocity", "m/s", |outcome| outcome.velocity),
];

/// One case.
pub fn print(case: &Case, rows: &[Row]) {
    let Some((_, ours)) = rows.iter().find(|(code, _)| code.is_ours()) else { return };
    println!("\n{}, one core", case.name);
    println!("  {:<26} {:>14} {:>14}", "", "grain-steps/s", "grouser f64 is");
    for (code, outcome) in rows {
        println!("  {:<26} {:>14.3e} {:>11.2} ×", code.name, outcome.rate, ours.rate / outcome.rate);
    }
    if let Some(fastest) = fastest_peer(rows) {
        println!("  against the fastest peer: {:.2} ×", ours.rate / fastest);
    }
    println!(
        "  after the same steps{:>34} {:>14} {:>14} {:>14}",
        "E_kin [J]", "coordination", "overlap [µm]", "v_x [m/s]"
    );
    for (code, outcome) in rows.iter().filter(|(code, _)| code.is_comparable()) {
        println!(
            "  {:<38} {:>14.4e} {:>14.4} {:>14.4} {:>14.4e}",
            code.name,
            outcome.kinetic,
            outcome.coordination,
            1e6 * outcome.overlap,
            outcome.velocity
        );
    }
    if let Some((_, same)) = rows.iter().find(|(code, _)| code.name == "LAMMPS granular") {
        for (name, _, of) in QUANTITIES {
            println!("  {name}: {:+.2} % against LAMMPS granular", 100.0 * (of(ours) / of(same) - 1.0));
        }
    }
    println!();
}

/// Grain-steps per second of the fastest code that is not ours.
fn fastest_peer(rows: &[Row]) -> Option<f64> {
    rows.iter().filter(|(code, _)| !code.is_ours()).map(|(_, outcome)| outcome.rate).max_by(f64::total_cmp)
}

/// All cases, as rows of group, case, metric, value, unit and threads.
pub fn json(results: &[(&Case, Vec<Row>)]) -> String {
    let mut lines = Vec::new();
    for (case, rows) in results {
        let mut line = |metric: String, value: f64, unit: &str| {
            let case = case.name;
            lines.push(format!(
                "  {{\"group\": \"peers\", \"case\": \"{case}\", \"metric\": \"{metric}\", \"value\": {value:e}, \"unit\": \"{unit}\", \"threads\": 1}}"
            ));
        };
        for (code, outcome) in rows {
            line(format!("{}: grain-steps per second", code.name), outcome.rate, "1/s");
            if code.is_comparable() {
                for (name, unit, of) in QUANTITIES {
                    line(format!("{}: {name}", code.name), of(outcome), unit);
                }
            }
        }
        let ours = rows.iter().find(|(code, _)| code.is_ours());
        if let (Some((_, ours)), Some(fastest)) = (ours, fastest_peer(rows)) {
            line("grouser f64 over the fastest peer".into(), ours.rate / fastest, "-");
        }
    }
    format!("[\n{}\n]\n", lines.join(",\n"))
}
