//! The program as a user runs it: bytes, interruptions, messages, exit status.

mod both_searches;
mod bytes;
mod killed;
mod messages;
mod repose;
mod slips;
mod study;
mod vehicle;
mod vehicle_files;

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::Duration;

/// A scene of a few hundred grains: two small plates pressed into a walled cup.
const CUP: &str = r#"(
    title: "A cup of sand",
    materials: {
        "sand": (young_pa: 1e7, poisson: 0.25, density_kg_m3: 2500, restitution: 0.3, friction: 0.5),
        "steel": (young_pa: 2e11, poisson: 0.3, density_kg_m3: 7800, restitution: 0.3, friction: 0.3),
    },
    soil: Grains(
        container: (size_m: (0.08, 0.08, 0.10), x: Walled, material: "sand"),
        layers: [(material: "sand", sizes: Uniform(radius_m: (0.0045, 0.0055)), depth_m: 0.04)],
    ),
    tool: Plates(diameters_m: [0.03, 0.04], thickness_m: 0.01, material: "steel"),
    motion: Press(speed_m_s: 0.3, gap_m: 0.001, depth_m: 0.012),
    outputs: (sample_every_s: 0.001, vtk_every_s: 0.02, checkpoint_every_s: 0.01),
)"#;

/// Runs the program with its own cache folder.
fn grouser(cache: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_grouser"))
        .args(arguments)
        .env("GROUSER_CACHE", cache)
        .output()
        .expect("the program starts")
}

/// Starts the program and interrupts it `after` it has shown how far it is: by then it listens. Gives its exit status.
fn interrupted(command: &mut Command, after: Duration) -> Option<i32> {
    let mut child = command.stderr(Stdio::piped()).spawn().expect("the program starts");
    let mut lines = BufReader::new(child.stderr.take().expect("is piped")).lines().map_while(Result::ok);
    if lines.any(|line| line.starts_with("settling") || line.contains("% ")) {
        std::thread::sleep(after);
        Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill");
    }
    // A program whose lines nobody takes would wait for ever.
    lines.for_each(drop);
    child.wait().expect("it ends").code()
}

/// What the program wrote to its standard error.
fn errors(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}
