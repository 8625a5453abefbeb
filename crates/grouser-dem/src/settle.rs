//! Settling under gravity to a stated kinetic energy.

use crate::{Bed, Failure};
use grouser_contact::{ContactLaw, Precision, Real};
use serde::{Deserialize, Serialize};

/// When a bed counts as settled.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SettleCriterion {
    /// Mean kinetic energy of a grain over the work m g r of lifting it by its radius [-].
    pub kinetic_energy_ratio: f64,
    /// Time after which settling is given up [s].
    pub longest_s: f64,
}

impl Default for SettleCriterion {
    fn default() -> Self {
        Self { kinetic_energy_ratio: 1e-6, longest_s: 5.0 }
    }
}

/// How settling ended.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settled {
    /// Steps made.
    pub n_steps: u64,
    /// Time simulated [s].
    pub time_s: f64,
    /// Ratio reached (see [`SettleCriterion::kinetic_energy_ratio`]).
    pub kinetic_energy_ratio: f64,
    /// The criterion was met; otherwise the time ran out.
    pub is_settled: bool,
}

/// A bed on its way to rest.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settling {
    criterion: SettleCriterion,
    n_steps: u64,
    time_step: f64,
}

/// Steps between two looks at the energy.
const STEPS_PER_LOOK: u64 = 100;

impl Settling {
    /// Settling with a step of `time_step` [s].
    pub fn new(criterion: SettleCriterion, time_step: f64) -> Self {
        Self { criterion, n_steps: 0, time_step }
    }

    /// Simulated time [s].
    pub fn time(&self) -> f64 {
        self.n_steps as f64 * self.time_step
    }

    /// Kinetic energy of the bed over Σ m g r now [-].
    pub fn energy_ratio<L: ContactLaw<P::Real>, P: Precision>(&self, bed: &Bed<L, P>) -> f64 {
        kinetic_energy_ratio(bed)
    }

    /// Goes on for some steps; `Some` when the bed is at rest or the time is up.
    ///
    /// # Errors
    /// When the motion has become meaningless.
    pub fn advance<L: ContactLaw<P::Real>, P: Precision>(
        &mut self,
        bed: &mut Bed<L, P>,
    ) -> Result<Option<Settled>, Failure> {
        bed.run(STEPS_PER_LOOK, self.time_step, |_| {
            self.n_steps += 1;
            Ok::<(), Failure>(())
        })?;
        let ratio = kinetic_energy_ratio(bed);
        // Touching grains carry each other: fewer than one contact a grain means that the bed is still falling.
        let carries_itself = bed.n_contacts() >= bed.grains().len() || bed.grains().len() < 8;
        let is_settled = carries_itself && ratio < self.criterion.kinetic_energy_ratio;
        let is_over = is_settled || self.time() >= self.criterion.longest_s;
        Ok(is_over.then(|| Settled {
            n_steps: self.n_steps,
            time_s: self.time(),
            kinetic_energy_ratio: ratio,
            is_settled,
        }))
    }
}

/// Kinetic energy of the bed over Σ m g r.
fn kinetic_energy_ratio<L: ContactLaw<P::Real>, P: Precision>(bed: &Bed<L, P>) -> f64 {
    let gravity = bed.settings().gravity.norm();
    let scale: f64 = bed
        .grains()
        .spheres
        .iter()
        .map(|sphere| sphere.mass.to_f64() * gravity * sphere.radius.to_f64())
        .sum();
    bed.grains().kinetic_energy().iter().sum::<f64>() / scale
}
