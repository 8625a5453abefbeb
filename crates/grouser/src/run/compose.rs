//! Which experiment a scene is: the one place that looks at soil, tool and motion together.

use super::collapse::Collapsing;
use super::driver::Driver;
use super::driving::Driving;
use super::on_bed::OnBed;
use super::press::Pressing;
use super::slip_sweep::SlipSweep;
use super::study;
use super::tire::TireRun;
use super::{Ended, Law, Options, Progress, RunError, SetupError, WithLaw, with_law};
use crate::scene::{Grains, Motion, Scenario, Soil, Tool};
use std::fs;

/// Runs a scene into a folder.
///
/// # Errors
/// When the scene cannot be built, its motion becomes meaningless, or a file cannot be written.
pub fn run(scenario: &Scenario, options: &Options, progress: &mut dyn Progress) -> Result<Ended, RunError> {
    fs::create_dir_all(&options.folder)?;
    let driver = Driver { scenario, options, progress };
    if let Some(study) = &scenario.study {
        return study::run(driver, study);
    }
    match &scenario.soil {
        Soil::Grains(soil) => {
            with_law(&scenario.dials, OnGrains { driver, soil }).map_err(SetupError::from)?
        }
        Soil::PlateTested(_) => driver.drive(|_| SlipSweep::begin(scenario)),
        Soil::PressureSinkage(_) => driver.drive(|_| Driving::begin(scenario)),
    }
}

/// A scene on a bed of grains.
struct OnGrains<'a> {
    driver: Driver<'a>,
    soil: &'a Grains,
}

impl WithLaw for OnGrains<'_> {
    type Output = Result<Ended, RunError>;
    fn with<L: Law>(self, law: L) -> Self::Output {
        let Self { driver, soil } = self;
        let scenario = driver.scenario;
        match scenario.tool {
            Some(Tool::Tire(_)) => {
                driver.drive(|progress| OnBed::<L, TireRun<L>>::begin(scenario, soil, law, progress))
            }
            None if matches!(scenario.motion, Some(Motion::Collapse(_))) => {
                driver.drive(|progress| OnBed::<L, Collapsing<L>>::begin(scenario, soil, law, progress))
            }
            _ => driver.drive(|progress| OnBed::<L, Pressing<L>>::begin(scenario, soil, law, progress)),
        }
    }
}
