//! The `grouser` program itself, built in release mode.

use crate::process::{cargo, succeeds};
use std::path::PathBuf;
use std::process::{Command, ExitCode};

/// Builds the program; `None` when it does not build.
pub fn build() -> Option<PathBuf> {
    let is_built = succeeds(&mut cargo(&["build", "--quiet", "--release", "--package", "grouser"]));
    // This program is built by the same profile into the same folder.
    let own = std::env::current_exe().ok()?;
    is_built.then(|| own.with_file_name(format!("grouser{}", std::env::consts::EXE_SUFFIX)))
}

/// Goes on as `grouser` with these arguments, in the caller's folder: its exit status, its Ctrl-C.
pub fn become_grouser(arguments: &[String]) -> ExitCode {
    let Some(program) = build() else { return ExitCode::FAILURE };
    let mut command = Command::new(program);
    command.args(arguments);
    #[cfg(unix)]
    {
        let error = std::os::unix::process::CommandExt::exec(&mut command);
        eprintln!("error: cannot start grouser: {error}");
        ExitCode::FAILURE
    }
    #[cfg(not(unix))]
    match command.status() {
        Ok(status) => ExitCode::from(status.code().unwrap_or(1) as u8),
        Err(error) => {
            eprintln!("error: cannot start grouser: {error}");
            ExitCode::FAILURE
        }
    }
}
