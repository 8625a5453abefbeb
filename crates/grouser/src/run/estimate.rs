//! What a scene will cost, before it runs.

use super::{Law, Materials, SetupError, WithLaw, bed, time_step, with_law};
use crate::scene::{Motion, Scenario, Soil, Tool};
use grouser_dem::{Domain, Failure, TimeStep, sphere};
use grouser_geometry::Vec3;
use std::time::{Duration, Instant};

/// Cost of a scene.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// The step and what binds it.
    pub time_step: TimeStep,
    /// Number of grains.
    pub n_grains: usize,
    /// Steps of settling, by the time of fall and a few times that of coming to rest.
    pub settling_steps: u64,
    /// Steps of all tools together.
    pub tool_steps: u64,
    /// Grain-steps per second of this machine with the present number of threads, measured just now.
    pub rate: f64,
    /// Memory at the peak [bytes].
    pub bytes: usize,
}

impl Estimate {
    /// Time by the clock that settling and tools will take.
    pub fn wall(&self) -> Duration {
        let grain_steps = (self.settling_steps + self.tool_steps) as f64 * self.n_grains as f64;
        Duration::from_secs_f64(grain_steps / self.rate)
    }
}

/// Memory of a grain with its pairs [bytes] (`docs/performance.md`).
const BYTES_PER_GRAIN: usize = 500;

/// Estimates a scene; takes about a fifth of a second, for the measurement.
///
/// # Errors
/// When the scene cannot be built.
pub fn estimate(scenario: &Scenario) -> Result<Estimate, SetupError> {
    let step = time_step(scenario)?;
    let Soil::Grains(soil) = &scenario.soil;
    let n_grains = bed::layers(soil, &Materials::of(scenario)).iter().map(|layer| layer.n_grains).sum();
    let depth: f64 = soil.layers.iter().map(|layer| layer.depth_m).sum();
    let gravity = scenario.gravity_m_s2.iter().map(|g| g * g).sum::<f64>().sqrt();
    // The top grain falls about once the bed's depth; coming to rest takes about three times as long.
    let fall = (2.0 * 1.2 * depth / gravity).sqrt();
    let settling_steps = (4.0 * fall / step.step_s) as u64;
    let mut tool_steps = 0;
    let mut copies = 1;
    if let (Some(Tool::Plates(plates)), Some(Motion::Press(press))) = (&scenario.tool, &scenario.motion) {
        let travel = press.gap_m + press.depth_m;
        tool_steps = (travel / press.speed_m_s / step.step_s) as u64 * plates.diameters_m.len() as u64;
        copies = 2;
    }
    let rate = with_law(&scenario.dials, MeasuredRate { n_grains })?;
    Ok(Estimate {
        time_step: step,
        n_grains,
        settling_steps,
        tool_steps,
        rate,
        bytes: copies * n_grains * BYTES_PER_GRAIN,
    })
}

/// Grain-steps per second of a block of touching grains of about the scene's size.
struct MeasuredRate {
    n_grains: usize,
}

impl WithLaw for MeasuredRate {
    type Output = Result<f64, SetupError>;
    fn with<L: Law>(self, law: L) -> Self::Output {
        let n = (self.n_grains.clamp(500, 20_000) as f64).cbrt().ceil() as usize;
        let radius = 4e-3;
        // A cubic lattice that touches: six contacts a grain, as many as a bed at rest has.
        let spacing = 1.999 * radius;
        let place = |i: usize| Vec3::new((i % n) as f64, (i / n % n) as f64, (i / n / n) as f64) * spacing;
        let spheres =
            (0..n * n * n).map(|i| sphere::<grouser_contact::F64>(place(i), radius, 2600.0, 0)).collect();
        let material = grouser_contact::Material { young_pa: 1e7, poisson: 0.3, density_kg_m3: 2600.0 };
        let between = grouser_contact::Interaction { restitution: 0.5, friction: 0.5 };
        let table =
            grouser_contact::PairTable::new(&[material], grouser_contact::Tail::Keep, |_, _| between)?;
        let settings = grouser_dem::BedSettings {
            domain: Domain { lower: Vec3::repeat(-1.0), upper: Vec3::repeat(2.0), is_periodic: [false; 3] },
            planes: Vec::new(),
            gravity: Vec3::zeros(),
            rotation: grouser_dem::Rotation::Free,
            has_ledger: true,
        };
        let mut bed = grouser_dem::Bed::new(spheres, settings, table, law)?;
        let mut go = |n_steps| bed.run(n_steps, 1e-5, |_| Ok::<(), Failure>(()));
        let (mut n_steps, begun) = (0, Instant::now());
        // A lattice that fails to step says nothing about the scene; the count then stays small and the rate low.
        while begun.elapsed() < Duration::from_millis(200) && go(10).is_ok() {
            n_steps += 10;
        }
        Ok((n_steps.max(1) * n * n * n) as f64 / begun.elapsed().as_secs_f64())
    }
}
