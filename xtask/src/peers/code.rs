//! A code that can run the bed, how it is called, and what it says.

use super::{Case, peer_bed};
use crate::process::root;
use std::process::Command;

/// A code, or one of its contact laws.
pub struct Code {
    pub name: &'static str,
    /// What is looked for on the path.
    pub program: &'static str,
    pub install: &'static str,
    /// Timed steps.
    pub steps: u64,
    kind: Kind,
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// With the precision that is named.
    Grouser(&'static str),
    /// With the pair style that is named.
    Lammps(&'static str),
    Liggghts,
    Yade,
}

/// What a run cost and how it ended.
#[derive(Clone, Copy)]
pub struct Outcome {
    /// Grain-steps per second on one core.
    pub rate: f64,
    /// Contacts a grain, both sides counted.
    pub coordination: f64,
    /// Mean overlap of two grains [m].
    pub overlap: f64,
    /// Translational kinetic energy [J].
    pub kinetic: f64,
    /// Mean velocity along x [m/s].
    pub velocity: f64,
}

const STEPS: u64 = 500;
const WARM: u64 = 200;
const DEBIAN: &str = "on Debian or Ubuntu: apt-get install lammps liggghts yade";

pub const CODES: [Code; 7] = [
    Code { name: "grouser f64", program: "", install: "", steps: STEPS, kind: Kind::Grouser("f64") },
    Code {
        name: "LAMMPS granular",
        program: "lmp",
        install: DEBIAN,
        steps: STEPS,
        kind: Kind::Lammps("granular"),
    },
    Code {
        name: "LAMMPS gran/hertz/history",
        program: "lmp",
        install: DEBIAN,
        steps: STEPS,
        kind: Kind::Lammps("hertz"),
    },
    Code { name: "LIGGGHTS", program: "liggghts", install: DEBIAN, steps: STEPS, kind: Kind::Liggghts },
    Code { name: "Yade", program: "yade", install: DEBIAN, steps: 60, kind: Kind::Yade },
    Code { name: "grouser mixed", program: "", install: "", steps: STEPS, kind: Kind::Grouser("mixed") },
    Code { name: "grouser f32", program: "", install: "", steps: STEPS, kind: Kind::Grouser("f32") },
];

impl Code {
    /// The program is on the path.
    pub fn is_installed(&self) -> bool {
        self.program.is_empty() || on_path(self.program)
    }

    /// Rounds in which it runs: one where it takes ten times as long as the others.
    pub fn n_rounds(&self) -> usize {
        if self.kind == Kind::Yade { 1 } else { super::ROUNDS }
    }

    /// The state at the end can be compared: as many steps as the others.
    pub fn is_comparable(&self) -> bool {
        self.steps == STEPS
    }

    /// It is one of ours.
    pub fn is_ours(&self) -> bool {
        matches!(self.kind, Kind::Grouser(_))
    }

    /// One run on one core.
    pub fn run(&self, case: &Case) -> Result<Outcome, String> {
        let peers = root().join("benches/peers");
        let [gx, gz] = case.gravity().map(|g| g.to_string());
        let end = case.scratch("end");
        let mut command;
        match self.kind {
            Kind::Grouser(precision) => {
                let bed = peer_bed();
                command = pinned(&bed.get_program().to_string_lossy());
                command.arg("run").arg("--state").arg(case.state_file());
                command.args(["--precision", precision, "--repeats", "1", "--warm", &WARM.to_string()]);
                command.args([
                    "--steps",
                    &self.steps.to_string(),
                    "--slope-deg",
                    &case.slope_deg.to_string(),
                ]);
                if case.still {
                    command.arg("--still");
                }
                return outcome(&output(command)?, None);
            }
            Kind::Lammps(_) | Kind::Liggghts => {
                command = pinned(self.program);
                let deck = if self.kind == Kind::Liggghts { "bed.liggghts" } else { "bed.lmp" };
                command.args(["-log", "none", "-in"]).arg(peers.join(deck));
                command.arg("-var").arg("data").arg(case.scratch("data"));
                command.arg("-var").arg("end").arg(&end);
                command.args(["-var", "warm", &WARM.to_string(), "-var", "steps", &self.steps.to_string()]);
                command.args(["-var", "skin", &case.skin.to_string(), "-var", "gx", &gx, "-var", "gz", &gz]);
                if let Kind::Lammps(model) = self.kind {
                    command.args(["-var", "model", model]);
                }
            }
            Kind::Yade => {
                command = pinned(self.program);
                command.args(["-x", "-n", "-j1"]).arg(peers.join("bed_yade.py"));
                command.env("STATE", case.scratch("txt")).env("END", &end);
                command.env("STEPS", self.steps.to_string()).env("WARM", "20");
                command.env("GX", gx).env("GZ", gz);
            }
        }
        let text = output(command)?;
        let seconds = seconds_of_last_loop(&text).ok_or("it did not say how long it took")?;
        let mut measure = peer_bed();
        measure.arg("measure").arg("--state").arg(&end);
        outcome(&output(measure)?, Some((self.steps, seconds)))
    }
}

/// What the measuring program says, with the time of a code that it did not run itself.
fn outcome(json: &str, timed: Option<(u64, f64)>) -> Result<Outcome, String> {
    let of = |key: &str| number(json, key).ok_or(format!("no `{key}` in {json:?}"));
    let rate = match timed {
        Some((steps, seconds)) => of("grains")? * steps as f64 / seconds,
        None => of("grain_steps_per_second")?,
    };
    Ok(Outcome {
        rate,
        coordination: of("coordination")?,
        overlap: of("mean_overlap")?,
        kinetic: of("kinetic_energy")?,
        velocity: of("mean_velocity")?,
    })
}

/// A program on the first core, where that can be asked for.
fn pinned(program: &str) -> Command {
    if on_path("taskset") {
        let mut command = Command::new("taskset");
        command.args(["-c", "0", program]);
        command
    } else {
        Command::new(program)
    }
}

fn on_path(program: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).any(|folder| folder.join(program).is_file())
}

fn output(mut command: Command) -> Result<String, String> {
    let program = command.get_program().to_string_lossy().into_owned();
    let output =
        command.current_dir(root()).output().map_err(|error| format!("cannot start {program}: {error}"))?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    if output.status.success() {
        return Ok(text);
    }
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    let lines: Vec<&str> = text.lines().chain(errors.lines()).collect();
    Err(format!(
        "{program} ended with {}:\n{}",
        output.status,
        lines[lines.len().saturating_sub(8)..].join("\n")
    ))
}

/// The time of the last line `Loop time of T on …`.
fn seconds_of_last_loop(text: &str) -> Option<f64> {
    let lines = text.lines().filter_map(|line| line.strip_prefix("Loop time of "));
    // A run of no steps comes last where a state is written; it took next to nothing.
    let mut times = lines.filter_map(|rest| rest.split_whitespace().next()?.parse::<f64>().ok());
    times.rfind(|&seconds| seconds > 0.05)
}

/// The number behind `"key":` in one line of JSON.
fn number(json: &str, key: &str) -> Option<f64> {
    let rest = json.split_once(&format!("\"{key}\":"))?.1;
    let end = rest.find([',', '}']).unwrap_or(rest.len());
    rest[..end].trim().parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_and_numbers_are_found_in_what_codes_print() {
        let text = "Loop time of 1.5 on 1 procs\nstep\nLoop time of 2.25 on 1 procs for 10 steps\nLoop time of 1e-6 on 1";
        assert_eq!(seconds_of_last_loop(text), Some(2.25));
        assert_eq!(seconds_of_last_loop("nothing"), None);
        let json = "{\"coordination\":5.25,\"kinetic_energy\":1.5e-6}";
        assert_eq!(number(json, "coordination"), Some(5.25));
        assert_eq!(number(json, "kinetic_energy"), Some(1.5e-6));
        assert_eq!(number(json, "energy"), None);
    }
}
