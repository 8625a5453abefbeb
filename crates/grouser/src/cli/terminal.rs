//! Progress on a terminal as one line that renews itself, elsewhere as a line now and then.

use crate::run::{Progress, Stage};
use std::io::{IsTerminal, Write};
use std::time::{Duration, Instant};

pub(super) struct Terminal {
    is_terminal: bool,
    spoke: Option<Instant>,
}

impl Terminal {
    pub fn new() -> Self {
        Self { is_terminal: std::io::stderr().is_terminal(), spoke: None }
    }

    /// Ends a line that renews itself.
    pub fn finish(&mut self) {
        if self.is_terminal && self.spoke.take().is_some() {
            eprintln!();
        }
    }
}

impl Progress for Terminal {
    fn stage(&mut self, stage: &Stage) {
        let text = match stage.done {
            None => stage.text.clone(),
            Some((done, left)) => format!("{}  {:5.1} %  {} left", stage.text, 100.0 * done, clock(left)),
        };
        if self.is_terminal {
            self.spoke = Some(Instant::now());
            eprint!("\r\x1b[2K{text}");
            let _ = std::io::stderr().flush();
        } else if self.spoke.is_none_or(|spoke| spoke.elapsed() > Duration::from_secs(5)) {
            self.spoke = Some(Instant::now());
            eprintln!("{text}");
        }
    }

    fn note(&mut self, text: &str) {
        self.finish();
        eprintln!("{text}");
    }
}

fn clock(time: Duration) -> String {
    let seconds = time.as_secs();
    match seconds {
        0..60 => format!("{seconds} s"),
        60..3600 => format!("{} min {:02} s", seconds / 60, seconds % 60),
        _ => format!("{} h {:02} min", seconds / 3600, seconds % 3600 / 60),
    }
}
