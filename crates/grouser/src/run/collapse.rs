//! A column of grains that loses its support and slides into a slope.

use super::frames::grains_frame;
use super::on_bed::{Broken, Pass};
use super::slope::{Slope, profile, slope};
use super::tool_ledger::ToolLedger;
use super::{Law, LawBed, Outcome, SetupError, collapse_outcome};
use crate::output::{PolyData, Table};
use crate::scene::{Collapse, Motion, Scenario};
use grouser_contact::{ContactLedger, Precision, Real, Sphere, Vector};
use grouser_dem::{Bed, BedEnergy, Failure, Grains};
use grouser_geometry::Orientation;
use serde::{Deserialize, Serialize};

/// Columns of the time series.
const COLUMNS: [(&str, &str); 5] = [
    ("time", "s"),
    ("angle", "deg"),
    ("height_at_the_wall", "m"),
    ("kinetic_energy_ratio", "-"),
    ("contacts_per_grain", "-"),
];
/// Centres below this many mean radii over the floor belong to grains that lie on it [-].
const ON_THE_FLOOR: f64 = 1.5;
/// Times of free fall from the column's height before which nothing counts as rest [-].
const LEAST_FALLS: f64 = 2.0;

/// What the scene asks for, where it is one of a collapse.
pub fn of(scenario: &Scenario) -> Option<&Collapse> {
    match (&scenario.tool, &scenario.motion) {
        (None, Some(Motion::Collapse(collapse))) => Some(collapse),
        _ => None,
    }
}

/// A column on its way.
#[derive(Clone, Serialize, Deserialize)]
#[serde(bound = "L: Law")]
pub struct Collapsing<L: Law> {
    bed: LawBed<L>,
    /// Where grains that lie on the floor are held, by number.
    held: Vec<Option<Held>>,
    /// Mean height of the tops of held grains [m].
    base: f64,
    time_step: f64,
    n_steps: u64,
    /// Steps before which it cannot be at rest.
    least_steps: u64,
    steps_done: u64,
    steps_per_sample: u64,
    table: Table,
    before: BedEnergy,
}

/// Place [m] and orientation of a grain that does not move.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Held {
    place: [f64; 3],
    orientation: Option<Orientation>,
}

/// A slope at rest.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Collapsed {
    /// Height of the surface over x.
    pub profile: Vec<(f64, f64)>,
    /// Mean height of the tops of the grains of the floor [m].
    pub base: f64,
    /// Time series.
    pub table: Table,
    /// Where the energy went.
    pub ledger: ToolLedger,
    /// Energy of the grains' height over the floor at the start [J].
    pub height_energy: f64,
    /// Time until it was at rest, or was measured all the same [s].
    pub time: f64,
}

impl Collapsed {
    /// What the ledger misses, over the energy of the height at the start [-]: a column that stands loses next to nothing.
    pub fn residual(&self) -> f64 {
        (self.ledger.input - self.ledger.stored() - self.ledger.dissipated()) / self.height_energy
    }

    /// The line through the surface.
    pub fn slope(&self) -> Slope {
        slope(&self.profile, self.base)
    }
}

impl<L: Law> Pass<L> for Collapsing<L> {
    type Finished = Collapsed;

    fn n_passes(_: &Scenario) -> usize {
        1
    }

    fn begin(
        scenario: &Scenario,
        _: usize,
        settled: LawBed<L>,
        time_step: f64,
        _: &[Collapsed],
    ) -> Result<Self, SetupError> {
        let collapse = of(scenario).expect("composed for a collapse");
        let (mut bed, held) = column::<L>(&settled, scenario, collapse.column_m)?;
        let tops =
            held.iter().zip(radii(&bed)).filter_map(|(held, radius)| Some(held.as_ref()?.place[2] + radius));
        let (sum, n) = tops.fold((0.0, 0.0), |(sum, n), top| (sum + top, n + 1.0));
        // The ledger begins with what contacts store by now, which a bed without lists does not know.
        bed.renew_lists()?;
        bed.keep_ledger(true);
        let height = bed.grains().spheres.iter().map(|s| s.position.z.to_f64()).fold(0.0, f64::max);
        let gravity = scenario.gravity();
        Ok(Self {
            before: bed.energy(),
            bed,
            held,
            base: if n > 0.0 { sum / n } else { 0.0 },
            time_step,
            n_steps: (collapse.longest_s / time_step).ceil() as u64,
            least_steps: (LEAST_FALLS * (2.0 * height / gravity).sqrt() / time_step) as u64,
            steps_done: 0,
            steps_per_sample: (scenario.outputs.sample_every_s / time_step).round().max(1.0) as u64,
            table: Table::new(&COLUMNS),
        })
    }

    fn advance(&mut self, scenario: &Scenario) -> Result<(), Broken> {
        let n_steps = (self.n_steps - self.steps_done)
            .min(self.steps_per_sample - self.steps_done % self.steps_per_sample);
        let Self { bed, held, steps_done, .. } = self;
        bed.run(n_steps, self.time_step, |grains| {
            hold(grains, held);
            *steps_done += 1;
            Ok::<(), Failure>(())
        })?;
        let ratio = self.sample(scenario);
        let asked = of(scenario).map_or(0.0, |collapse| collapse.energy_ratio);
        if self.steps_done >= self.least_steps && ratio < asked {
            self.n_steps = self.steps_done;
        }
        Ok(())
    }

    fn steps(&self) -> (u64, u64) {
        (self.steps_done, self.n_steps)
    }

    fn steps_per_sample(&self) -> u64 {
        self.steps_per_sample
    }

    fn label(&self) -> String {
        "a column collapses".into()
    }

    fn frames(&self) -> Vec<(&'static str, PolyData<'static>)> {
        vec![("grains", grains_frame(&self.bed))]
    }

    fn bed(&self) -> &LawBed<L> {
        &self.bed
    }

    fn rows(&self) -> (&str, &Table) {
        ("collapse", &self.table)
    }

    fn finish(self, _: &Scenario) -> Collapsed {
        let (ledger, tool) = (self.bed.energy(), ContactLedger::default());
        Collapsed {
            profile: profile(&self.bed.grains().spheres, size(&self.bed)),
            base: self.base,
            ledger: ToolLedger::between(&self.before, &ledger, &tool, 0.0),
            height_energy: self.before.gravitational,
            time: self.steps_done as f64 * self.time_step,
            table: self.table,
        }
    }

    fn outcome(_: &Scenario, _: &LawBed<L>, done: &[Collapsed]) -> Outcome {
        collapse_outcome::outcome(done)
    }
}

impl<L: Law> Collapsing<L> {
    /// A row of the time series; gives the kinetic energy over Σ m g r.
    fn sample(&mut self, scenario: &Scenario) -> f64 {
        let grains = self.bed.grains();
        let gravity = scenario.gravity();
        let weight = |s: &Sphere<L::Precision>| s.mass.to_f64() * gravity * s.radius.to_f64();
        let scale: f64 = grains.spheres.iter().map(weight).sum();
        let ratio = grains.kinetic_energy().iter().sum::<f64>() / scale;
        let found = slope(&profile(&grains.spheres, size(&self.bed)), self.base);
        let contacts = 2.0 * self.bed.n_contacts() as f64 / grains.len() as f64;
        let time = self.steps_done as f64 * self.time_step;
        self.table.push(&[time, found.angle_deg, found.height, ratio, contacts]);
        ratio
    }
}

/// Length of the box along x and y [m].
fn size<L: Law>(bed: &LawBed<L>) -> [f64; 2] {
    [0, 1].map(|axis| bed.settings().domain.size()[axis])
}

/// Radii by number [m].
fn radii<L: Law>(bed: &LawBed<L>) -> Vec<f64> {
    let grains = bed.grains();
    let mut radii = vec![0.0; grains.len()];
    for (sphere, &id) in grains.spheres.iter().zip(&grains.ids) {
        radii[id as usize] = sphere.radius.to_f64();
    }
    radii
}

/// The grains of a settled bed that stay, at rest, in the order of their numbers, and which of them are held. Springs begin anew.
fn column<L: Law>(
    settled: &LawBed<L>,
    scenario: &Scenario,
    length: f64,
) -> Result<(LawBed<L>, Vec<Option<Held>>), SetupError> {
    let grains = settled.grains();
    let mean_radius =
        grains.spheres.iter().map(|sphere| sphere.radius.to_f64()).sum::<f64>() / grains.len() as f64;
    let is_on_floor = |sphere: &Sphere<L::Precision>| sphere.position.z.to_f64() < ON_THE_FLOOR * mean_radius;
    let mut places: Vec<usize> = (0..grains.len())
        .filter(|&place| {
            let sphere = &grains.spheres[place];
            sphere.position.x.to_f64() < length || is_on_floor(sphere)
        })
        .collect();
    places.sort_by_key(|&place| grains.ids[place]);
    let still =
        |&place: &usize| Sphere { velocity: Vector::ZERO, spin: Vector::ZERO, ..grains.spheres[place] };
    let spheres: Vec<_> = places.iter().map(still).collect();
    let orientation = |place: usize| grains.orientations.as_ref().map(|all| all[place]);
    let held = places.iter().zip(&spheres).map(|(&place, sphere)| {
        let at = sphere.position.to_array().map(|c| c.to_f64());
        is_on_floor(sphere).then(|| Held { place: at, orientation: orientation(place) })
    });
    let held = held.collect();
    let mut bed =
        Bed::new(spheres, settled.settings().clone(), settled.pair_table().clone(), *settled.law())?;
    bed.set_largest_overlap(scenario.dials.largest_overlap);
    bed.set_integrator(scenario.dials.integrator)?;
    bed.set_background_damping(scenario.dials.background_damping_n_s_m);
    if let Some(orientations) = &mut bed.grains_mut().orientations {
        *orientations = places.iter().filter_map(|&place| orientation(place)).collect();
    }
    Ok((bed, held))
}

/// Puts held grains back, at rest.
fn hold<P: Precision>(grains: &mut Grains<P>, held: &[Option<Held>]) {
    let Grains { spheres, ids, orientations, .. } = grains;
    for (place, (sphere, &id)) in spheres.iter_mut().zip(ids.iter()).enumerate() {
        let Some(held) = &held[id as usize] else { continue };
        let [x, y, z] = held.place;
        sphere.position = Vector::new(x, y, z).cast();
        (sphere.velocity, sphere.spin) = (Vector::ZERO, Vector::ZERO);
        if let (Some(orientations), Some(kept)) = (orientations.as_mut(), held.orientation) {
            orientations[place] = kept;
        }
    }
}
