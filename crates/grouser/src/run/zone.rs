//! The active zone of a scene: from its dial to the bed's zone around a tool, and what it did.

use super::{Law, LawBed};
use crate::output::summary::Metric;
use crate::scene::Scenario;
use grouser_contact::Real;
use grouser_dem::{ActiveZone, Failure, ZoneAccount};
use grouser_geometry::TriangleSurface;
use serde::{Deserialize, Serialize};

/// Edge of a block over the mean radius of the grains [-].
const BLOCK: f64 = 6.0;
/// Time of rest over the time in which a grain falls by its own radius [-].
const REST_TIME: f64 = 0.3;

/// What a bed's active zone does during a pass; nothing where the scene has no such dial.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ZoneWatch {
    seen: Option<Seen>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Seen {
    n_samples: f64,
    /// Sum over samples of the share of grains that are awake.
    awake: f64,
    account: ZoneAccount,
}

impl ZoneWatch {
    /// Turns the zone of `bed` on, if the scene asks for one, for a tool that moves with `speed` [m/s].
    ///
    /// # Errors
    /// When the bed's motion has become meaningless.
    pub fn begin<L: Law>(scenario: &Scenario, bed: &mut LawBed<L>, speed: f64) -> Result<Self, Failure> {
        let Some(dial) = &scenario.dials.active_zone else { return Ok(Self::default()) };
        let spheres = &bed.grains().spheres;
        let radius = spheres.iter().map(|sphere| sphere.radius.to_f64()).sum::<f64>() / spheres.len() as f64;
        let largest = spheres.iter().fold(0.0_f64, |most, sphere| most.max(sphere.radius.to_f64()));
        let gravity = bed.settings().gravity.norm();
        // Without gravity the tool's own motion sets the pace.
        let fall = if gravity > 0.0 { (2.0 * radius / gravity).sqrt() } else { radius / speed };
        bed.set_active_zone(Some(ActiveZone {
            block_m: (BLOCK * radius).max(3.0 * largest),
            rest_speed: dial.rest * speed,
            rest_time_s: REST_TIME * fall,
            wake: dial.wake,
        }))?;
        Ok(Self { seen: Some(Seen::default()) })
    }

    /// Before some steps: what lies within the dial's reach of the tool is awake.
    pub fn reach<L: Law>(&self, scenario: &Scenario, bed: &mut LawBed<L>, tool: &TriangleSurface) {
        if let (Some(dial), Some(_)) = (&scenario.dials.active_zone, self.seen) {
            let bounds = tool.bounding_box();
            let half = bounds.extent() / 2.0;
            bed.keep_awake(vec![[bounds.center() - half, bounds.center() + half]], dial.reach_m);
        }
    }

    /// Takes a sample.
    pub fn sample<L: Law>(&mut self, bed: &LawBed<L>) {
        if let (Some(seen), Some(account)) = (&mut self.seen, bed.zone()) {
            seen.n_samples += 1.0;
            seen.awake += account.n_awake as f64 / bed.grains().len() as f64;
            seen.account = *account;
        }
    }

    /// What to say about it; names begin with `label`.
    pub fn metrics(&self, label: &str) -> Vec<Metric> {
        let Some(seen) = &self.seen else { return Vec::new() };
        let metric = |name: &str, value: f64, unit: &str| Metric {
            name: format!("{label}: {name}"),
            value,
            unit: unit.into(),
            ..Metric::default()
        };
        let count = |name: &str, count: u64| metric(name, count as f64, "-");
        vec![
            metric("grains awake, mean share", seen.awake / seen.n_samples.max(1.0), "-"),
            metric("impulse taken up by sleeping grains", seen.account.border_impulse.norm(), "N·s"),
            count("changes of the active zone", seen.account.n_changes),
            count("blocks woken beyond the reach of the active zone", seen.account.n_woken),
            count("sleeping grains touched beyond the reach of the active zone", seen.account.n_surprised),
        ]
    }
}
