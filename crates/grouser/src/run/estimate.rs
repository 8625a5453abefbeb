//! What a scene will cost, before it runs.

use super::indenter::Indenter;
use super::{Law, Materials, SetupError, WithLaw, bed, time_step, with_law};
use crate::scene::{Grains, Motion, Scenario, Soil, Study, variant};
use grouser_dem::{Domain, Failure, sphere};
use grouser_geometry::Vec3;
use std::time::{Duration, Instant};

/// Cost of a scene.
#[derive(Clone, Debug, Default)]
pub struct Estimate {
    /// What the cost is made of: name and a few words.
    pub lines: Vec<(&'static str, String)>,
    /// Time by the clock; `None` where nobody can tell.
    pub wall: Option<Duration>,
}

/// Memory of a grain with its pairs [bytes] (`docs/performance.md`).
const BYTES_PER_GRAIN: usize = 500;

/// Estimates a scene.
///
/// # Errors
/// When the scene cannot be built.
pub fn estimate(scenario: &Scenario) -> Result<Estimate, SetupError> {
    if let Some(study) = &scenario.study {
        return of_study(scenario, study);
    }
    match &scenario.soil {
        Soil::Grains(soil) => on_grains(scenario, soil),
        Soil::PressureSinkage(_) => Ok(super::driving::estimate(scenario)),
        Soil::PlateTested(_) => Ok(super::slip_sweep::estimate(scenario)),
    }
}

/// Estimates a study by its first variant.
fn of_study(scenario: &Scenario, study: &Study) -> Result<Estimate, SetupError> {
    let variants = study.variants();
    let Some(Ok(first)) = variants.first().map(|each| variant(scenario, each)) else {
        return Ok(Estimate::default());
    };
    let mut estimate = estimate(&first)?;
    estimate.lines.insert(0, ("variants", format!("{}; what follows is the first of them", variants.len())));
    estimate.wall = estimate.wall.map(|wall| wall * variants.len() as u32);
    Ok(estimate)
}

/// Estimates a scene on grains; takes about a fifth of a second, for the measurement.
fn on_grains(scenario: &Scenario, soil: &Grains) -> Result<Estimate, SetupError> {
    let step = time_step(scenario, soil)?;
    let n_grains: usize =
        bed::layers(soil, &Materials::of(scenario)).iter().map(|layer| layer.n_grains).sum();
    let depth: f64 = soil.layers.iter().map(|layer| layer.depth_m).sum();
    let gravity = scenario.gravity();
    // The top grain falls about once the bed's depth; coming to rest takes about three times as long.
    let fall = (2.0 * 1.2 * depth / gravity).sqrt();
    let settling_steps = (4.0 * fall / step.step_s) as u64;
    let without_plates = super::tire::parts(scenario).is_some() || super::collapse::of(scenario).is_some();
    let n_passes = Indenter::count(scenario) + usize::from(without_plates);
    let tool_s = n_passes as f64 * scenario.motion.as_ref().map_or(0.0, Motion::duration);
    let tool_steps = (tool_s / step.step_s) as u64;
    let copies = if tool_steps > 0 { 2 } else { 1 };
    let rate = with_law(&scenario.dials, MeasuredRate { n_grains })??;
    let binding = step.binding();
    Ok(Estimate {
        lines: vec![
            (
                "time step",
                format!(
                    "{:.3e} s, bound by the {} criterion ({} of {:.3e} s): {}",
                    step.step_s, binding.name, binding.fraction, binding.time_s, binding.place
                ),
            ),
            ("grains", n_grains.to_string()),
            (
                "steps",
                format!(
                    "about {settling_steps} to settle the bed (none when it is in the cache), {tool_steps} of the tools"
                ),
            ),
            ("memory", format!("about {:.0} MB", (copies * n_grains * BYTES_PER_GRAIN) as f64 / 1e6)),
            (
                "pace",
                format!(
                    "{:.1} million grain-steps a second on {} threads, measured just now",
                    rate / 1e6,
                    rayon::current_num_threads()
                ),
            ),
        ],
        wall: Some(Duration::from_secs_f64((settling_steps + tool_steps) as f64 * n_grains as f64 / rate)),
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
        let spheres = (0..n * n * n).map(|i| sphere::<L::Precision>(place(i), radius, 2600.0, 0)).collect();
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
