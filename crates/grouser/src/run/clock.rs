//! Time by the clock: what a run took, when to speak, and how long the rest will take.

use std::fs;
use std::time::{Duration, Instant};

/// Measures a run.
pub(super) struct Clock {
    begun: Instant,
    prepared: Option<Duration>,
}

/// What a run took.
pub(super) struct Taken {
    /// Time by the clock [s].
    pub wall_s: f64,
    /// Time until the scene was prepared [s].
    pub setup_s: f64,
    /// Processor time of all threads [s].
    pub cpu_s: Option<f64>,
}

impl Clock {
    pub fn start() -> Self {
        Self { begun: Instant::now(), prepared: None }
    }

    /// Preparation is over; only the first call counts.
    pub fn is_prepared(&mut self) {
        self.prepared.get_or_insert_with(|| self.begun.elapsed());
    }

    pub fn stop(&self) -> Taken {
        let wall = self.begun.elapsed();
        let setup = self.prepared.unwrap_or(wall);
        Taken { wall_s: wall.as_secs_f64(), setup_s: setup.as_secs_f64(), cpu_s: cpu_seconds() }
    }
}

/// When to speak, and how long the rest will take.
#[derive(Default)]
pub(super) struct Pace {
    spoke: Option<Instant>,
    first: Option<(Instant, f64)>,
}

impl Pace {
    pub fn is_due(&mut self) -> bool {
        let is_due = self.spoke.is_none_or(|spoke| spoke.elapsed() > Duration::from_millis(250));
        if is_due {
            self.spoke = Some(Instant::now());
        }
        is_due
    }

    pub fn left(&mut self, done: f64) -> Duration {
        let &mut (begun, first) = self.first.get_or_insert((Instant::now(), done));
        let share = (done - first).max(1e-9);
        Duration::from_secs_f64((begun.elapsed().as_secs_f64() * (1.0 - done) / share).clamp(0.0, 1e7))
    }
}

/// Processor time of all threads of this process [s]; `None` where the system does not tell.
fn cpu_seconds() -> Option<f64> {
    let text = fs::read_to_string("/proc/self/stat").ok()?;
    let fields: Vec<&str> = text.rsplit(')').next()?.split_whitespace().collect();
    let ticks: f64 = fields.get(11)?.parse::<f64>().ok()? + fields.get(12)?.parse::<f64>().ok()?;
    // The kernel reports in hundredths of a second on every Linux.
    Some(ticks / 100.0)
}
