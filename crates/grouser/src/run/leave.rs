//! What every run leaves at its end: time series, charts, pictures, summary and report.

use super::clock::Taken;
use super::driver::Driver;
use super::{Ended, Outcome, RunError, report};
use crate::output::Series;
use crate::output::summary::{self, Status, Summary, Time};
use crate::output::write_atomic;
use std::io;

/// What has come of a run, and how much was simulated.
pub(super) struct Left<'a> {
    pub outcome: Outcome,
    pub series: &'a [Series],
    pub n_steps: u64,
    pub time_s: f64,
}

/// Writes everything that is left.
pub(super) fn leave(
    driver: &Driver,
    left: Left,
    taken: &Taken,
    ended: &Result<Ended, RunError>,
) -> Result<(), RunError> {
    let folder = &driver.options.folder;
    let Left { outcome, series, n_steps, time_s } = left;
    let mut files = vec!["scenario.ron".to_owned(), "summary.json".to_owned(), "report.html".to_owned()];
    let mut write = |name: String, bytes: &[u8]| -> io::Result<()> {
        write_atomic(&folder.join(&name), bytes)?;
        files.push(name);
        Ok(())
    };
    for (name, table) in &outcome.tables {
        write(format!("{name}.csv"), table.to_csv().as_bytes())?;
    }
    for (name, chart) in &outcome.charts {
        let drawn = |error: Box<dyn std::error::Error + Send + Sync>| io::Error::other(error.to_string());
        write(format!("{name}.svg"), chart.to_svg().map_err(drawn)?.as_bytes())?;
        write(format!("{name}.png"), &chart.to_png().map_err(drawn)?)?;
    }
    for picture in &outcome.pictures {
        write(format!("{}.png", picture.name), &picture.png)?;
    }
    for (name, bytes) in &outcome.files {
        write(name.clone(), bytes)?;
    }
    files.extend(series.iter().map(|series| series.index()));
    if folder.join("checkpoint.bin").is_file() {
        files.push("checkpoint.bin".into());
    }
    let summary = Summary {
        schema: summary::SCHEMA,
        scenario: driver.scenario.title.clone(),
        version: env!("CARGO_PKG_VERSION"),
        git: driver.options.git.clone(),
        host: format!(
            "{} {}, {} processors",
            std::env::consts::OS,
            std::env::consts::ARCH,
            std::thread::available_parallelism().map_or(1, usize::from)
        ),
        threads: rayon::current_num_threads(),
        status: match ended {
            Ok(Ended::Done) => Status::Done,
            Ok(Ended::Interrupted) => Status::Interrupted,
            Err(_) => Status::Failed,
        },
        is_quick: driver.scenario.is_quick,
        error: ended.as_ref().err().map(ToString::to_string),
        time: Time {
            simulated_s: time_s,
            wall_s: taken.wall_s,
            cpu_s: taken.cpu_s,
            setup_s: taken.setup_s,
            steps: n_steps,
        },
        time_step: outcome.time_step.clone(),
        energy: outcome.energy.clone(),
        conventions: outcome.conventions.clone(),
        metrics: outcome.metrics.clone(),
        pictures: outcome.pictures.iter().map(|it| (it.name.clone(), it.caption.clone())).collect(),
        files,
    };
    summary.write(folder)?;
    let page = report::page(driver.scenario, &summary, &outcome);
    write_atomic(&folder.join("report.html"), page.as_bytes())?;
    Ok(())
}
