//! The command line: verbs, messages, exit status.

mod check;
mod run;
mod terminal;
mod verify;

use crate::diagnostic::Diagnostic;
use crate::scene::{self, Scenario};
use clap::{Args, Parser, Subcommand};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// The input is wrong.
const WRONG_INPUT: u8 = 2;
/// The numerics failed.
const FAILED: u8 = 3;
/// Somebody interrupted the run.
const INTERRUPTED: u8 = 130;

/// Terramechanics from one scenario file: what happens between a machine and soft ground.
#[derive(Parser)]
#[command(version, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Subcommand)]
enum Verb {
    /// Validate a scene; print it with every default, the binding time-step criterion, and what a run will cost
    Check(Scene),
    /// Run a scene and leave its results in a folder
    Run(run::Run),
    /// Compute every analytical and published case and compare it with its reference
    Verify(verify::Verify),
}

/// Which scene, and what to change about it.
#[derive(Args)]
struct Scene {
    /// Scenario file (RON)
    scene: PathBuf,
    /// Take the scene's own coarser version, which ends within a minute on two cores
    #[arg(long)]
    quick: bool,
    /// Replace a value, for instance --set soil.layers[0].depth_m=0.05 (repeatable)
    #[arg(long = "set", value_name = "PATH=VALUE")]
    sets: Vec<String>,
    /// Threads to compute with [default: all processors]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
}

/// Runs the program with the arguments of the process.
pub fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            let _ = error.print();
            return ExitCode::from(if error.use_stderr() { WRONG_INPUT } else { 0 });
        }
    };
    let status = match cli.verb {
        Verb::Check(scene) => check::check(&scene),
        Verb::Run(run) => run.run(),
        Verb::Verify(verify) => verify.verify(),
    };
    ExitCode::from(status)
}

impl Scene {
    /// The checked scenario, or messages about it on the standard error and an exit status.
    fn read(&self) -> Result<Scenario, u8> {
        if let Some(n) = self.threads {
            // Fails only when a pool exists already, which is this one.
            let _ = rayon::ThreadPoolBuilder::new().num_threads(usize::from(n)).build_global();
        }
        let report = |messages: &[Diagnostic]| {
            messages.iter().for_each(|message| eprintln!("{message}\n"));
            WRONG_INPUT
        };
        let name = self.scene.display().to_string();
        let text = std::fs::read_to_string(&self.scene).map_err(|error| {
            let message = Diagnostic::new(format!("{name}: {error}"))
                .expected("a scenario file that can be read")
                .usual_cause("a misspelt path, or another current folder")
                .remedy("the scenes that come with grouser lie in `scenarios/`");
            report(&[message])
        })?;
        let mut sets = Vec::new();
        for set in &self.sets {
            let Some((path, value)) = set.split_once('=') else {
                let message = Diagnostic::new(format!("--set {set}: there is no `=`"))
                    .expected("--set PATH=VALUE, for instance --set soil.seed=2")
                    .usual_cause("a blank around `=`");
                return Err(report(&[message]));
            };
            sets.push((path.trim().to_owned(), value.trim().to_owned()));
        }
        let (scenario, advice) =
            scene::read_with_advice(&name, &text, self.quick, &sets).map_err(|messages| report(&messages))?;
        advice.iter().for_each(|message| eprintln!("{}\n", message.as_advice()));
        Ok(scenario)
    }

    /// Where results go when nobody says: `out/<name of the scene>`.
    fn default_folder(&self) -> PathBuf {
        let stem = self.scene.file_stem().unwrap_or(self.scene.as_os_str());
        Path::new("out").join(stem)
    }
}
