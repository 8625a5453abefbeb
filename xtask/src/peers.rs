//! The same bed in grouser and in other codes, alternating in one run: `cargo xtask peers`.
//!
//! Each round runs every code once; the fastest of its rounds counts. A code that is not installed is named, with how to
//! install it, and left out. States are measured by one program, whatever code they come from.

mod code;
mod table;

use crate::process::{cargo, root, succeeds};
use code::{CODES, Code, Outcome};
use std::path::PathBuf;
use std::process::Command;

/// A bed and the gravity on it.
pub struct Case {
    name: &'static str,
    state: &'static str,
    /// Start at rest.
    still: bool,
    slope_deg: f64,
    /// The peers' fastest neighbour margin [m].
    skin: f64,
}

const CASES: [Case; 2] = [
    Case { name: "settled bed", state: "bed20k", still: true, slope_deg: 0.0, skin: 8e-4 },
    Case { name: "flowing bed", state: "flow20k", still: false, slope_deg: 30.0, skin: 1.6e-3 },
];
const ROUNDS: usize = 3;

/// Best outcome of each code that ran, in the order of [`CODES`].
pub type Row = (&'static Code, Outcome);

/// Runs all cases. False when a code that is there fails.
pub fn peers(arguments: &[String]) -> bool {
    let json = match arguments {
        [] => None,
        [flag, path] if flag == "--json" => Some(PathBuf::from(path)),
        _ => {
            eprintln!("error: expected `cargo xtask peers [--json FILE]`");
            return false;
        }
    };
    let mut build = cargo(&["build", "--quiet", "--release", "--package", "benches", "--bin", "peer_bed"]);
    if !succeeds(&mut build) {
        return false;
    }
    let (is_there, missing): (Vec<&Code>, Vec<&Code>) = CODES.iter().partition(|code| code.is_installed());
    for code in missing {
        println!("{}: `{}` is not installed ({}); left out", code.name, code.program, code.install);
    }
    let (mut is_ok, mut results) = (true, Vec::new());
    for case in &CASES {
        let mut best: Vec<Row> = Vec::new();
        if let Err(message) = export(case) {
            eprintln!("error: {message}");
            return false;
        }
        for round in 1..=ROUNDS {
            for code in is_there.iter().filter(|code| round <= code.n_rounds()) {
                match code.run(case) {
                    Err(message) => {
                        eprintln!("error: {}: {message}", code.name);
                        is_ok = false;
                    }
                    Ok(outcome) => {
                        println!(
                            "{}, round {round}: {:<26} {:.3e} grain-steps/s",
                            case.name, code.name, outcome.rate
                        );
                        match best.iter_mut().find(|(known, _)| known.name == code.name) {
                            Some((_, known)) if known.rate >= outcome.rate => {}
                            Some((_, known)) => *known = outcome,
                            None => best.push((code, outcome)),
                        }
                    }
                }
            }
        }
        table::print(case, &best);
        results.push((case, best));
    }
    if let Some(path) = json
        && let Err(error) = std::fs::write(&path, table::json(&results))
    {
        eprintln!("error: {}: {error}", path.display());
        return false;
    }
    is_ok
}

impl Case {
    /// Gravity along x and z [m/s²].
    fn gravity(&self) -> [f64; 2] {
        let slope = self.slope_deg.to_radians();
        [9.81 * slope.sin(), -9.81 * slope.cos()]
    }

    fn state_file(&self) -> PathBuf {
        root().join(format!("benches/peers/{}.txt.gz", self.state))
    }

    /// Scratch file of this case.
    fn scratch(&self, ending: &str) -> PathBuf {
        root().join("target/peers").join(format!("{}.{ending}", self.state))
    }
}

/// The program that runs and measures beds here.
fn peer_bed() -> Command {
    let mut command = Command::new(root().join("target/release/peer_bed"));
    command.current_dir(root());
    command
}

/// Writes the bed as the peers read it.
fn export(case: &Case) -> Result<(), String> {
    let folder = root().join("target/peers");
    std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut command = peer_bed();
    command.arg("export").arg("--state").arg(case.state_file()).arg("--to").arg(case.scratch("data"));
    if case.still {
        command.arg("--still");
    }
    if succeeds(&mut command) { Ok(()) } else { Err("the bed could not be written".into()) }
}
