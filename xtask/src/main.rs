//! Everything done to this repository is a verb of `cargo xtask`.

mod bench;
mod grouser;
mod peers;
mod process;
mod test;
mod tidy;

use std::process::ExitCode;

const HELP: &str = "\
Everything done to this repository:

  cargo xtask run SCENE …       grouser's own verbs, built in release mode; `cargo xtask run --help` shows them
  cargo xtask check SCENE …
  cargo xtask verify …

  cargo xtask test              format, lints, unit and doc tests, verification, every scene with --quick, tidiness
  cargo xtask tidy              the repository's rules alone
  cargo xtask bench [GROUP] …   criterion benches and throughput figures; `--json FILE` writes them all as one array
  cargo xtask peers [--json FILE]  the same beds in LAMMPS, LIGGGHTS and Yade where installed: speed and agreement
  cargo xtask docs              the crates' documentation, warnings being errors
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (verb, rest) = match arguments.split_first() {
        Some((verb, rest)) => (verb.as_str(), rest),
        None => ("help", &[][..]),
    };
    let is_ok = match verb {
        "run" | "check" | "verify" => return grouser::become_grouser(&arguments),
        "test" => test::test(),
        "tidy" => tidy::report(),
        "bench" => bench::bench(rest),
        "peers" => peers::peers(rest),
        "docs" => test::docs(),
        "help" | "--help" | "-h" => {
            print!("{HELP}");
            true
        }
        unknown => {
            eprint!("error: there is no verb `{unknown}`\n\n{HELP}");
            return ExitCode::from(2);
        }
    };
    ExitCode::from(u8::from(!is_ok))
}
