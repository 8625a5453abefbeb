//! The `grouser` program.

use std::process::ExitCode;

fn main() -> ExitCode {
    grouser::cli::main()
}
