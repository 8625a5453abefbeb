//! `grouser run`: a scene into a folder.

use super::terminal::Terminal;
use super::{FAILED, INTERRUPTED, Scene, check};
use crate::run::{Ended, Options, Progress, estimate, run};
use clap::Args;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};

/// Set by Ctrl-C.
static IS_INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// A scene, and how to run it.
#[derive(Args)]
pub(super) struct Run {
    #[command(flatten)]
    scene: Scene,
    /// Folder for the results [default: out/<name of the scene>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Take up the run that was interrupted in this folder; the result is the same bytes as without interruption
    #[arg(long)]
    resume: bool,
}

impl Run {
    pub fn run(self) -> u8 {
        let scenario = match self.scene.read() {
            Ok(scenario) => scenario,
            Err(status) => return status,
        };
        let mut terminal = Terminal::new();
        match estimate(&scenario) {
            Ok(estimate) => terminal.note(&check::described(&estimate)),
            Err(error) => {
                eprintln!("error: {error}");
                return FAILED;
            }
        }
        // A second Ctrl-C ends at once; the last checkpoint stays.
        let _ = ctrlc::set_handler(|| {
            if IS_INTERRUPTED.swap(true, Ordering::Relaxed) {
                std::process::exit(i32::from(INTERRUPTED));
            }
        });
        let folder = self.out.unwrap_or_else(|| self.scene.default_folder());
        let options = Options {
            folder: folder.clone(),
            resumes: self.resume,
            is_interrupted: &IS_INTERRUPTED,
            git: env!("GROUSER_GIT").into(),
        };
        let ended = run(&scenario, &options, &mut terminal);
        terminal.finish();
        match ended {
            Ok(Ended::Done) => {
                eprintln!("done; open {}", folder.join("report.html").display());
                0
            }
            Ok(Ended::Interrupted) => {
                eprintln!("interrupted; the same command with --resume goes on from the checkpoint");
                INTERRUPTED
            }
            Err(error) => {
                eprintln!("error: {error}");
                error.exit_status()
            }
        }
    }
}
