//! A tire that sinks into a bed and rolls over it: rigid, or an elastic tread on a rim.

mod axle;
mod elastic_tire;
mod ledger;
mod outcome;
mod pictures;
mod traction;
mod variant;

pub use axle::{Axle, Phase, Place};
pub use elastic_tire::{ElasticTire, Tread, TreadError, TreadSpec};
pub use ledger::TireLedger;
pub use traction::{MeanTraction, Traction};
pub use variant::Variant;

use super::frames::{grains_frame, surface_frame};
use super::law::RealOf;
use super::on_bed::{Broken, Pass};
use super::{Law, LawBed, Materials, Outcome, SetupError, level};
use crate::output::{PointField, PolyData, Table};
use crate::scene::{Roll, Scenario, SubSteps, Tire};
use grouser_contact::ContactLedger;
use grouser_coupling::{Deepest, Margin, Step, SurfaceContacts};
use grouser_dem::{BedEnergy, Failure, Grains};
use grouser_fem::DynamicsError;
use grouser_geometry::{TireSize, TriangleSurface, Vec3};
use serde::{Deserialize, Serialize};
use std::time::{Duration, Instant};

/// Columns of a tire's time series.
const COLUMNS: [(&str, &str); 20] = [
    ("time", "s"),
    ("travel", "m"),
    ("sinkage", "m"),
    ("deflection", "m"),
    ("force_x", "N"),
    ("force_y", "N"),
    ("force_z", "N"),
    ("gross_tractive_effort", "N"),
    ("running_resistance", "N"),
    ("drawbar_pull", "N"),
    ("torque", "N·m"),
    ("torque_over_radius", "N"),
    ("torque_over_radius_minus_pull", "N"),
    ("power", "W"),
    ("work_on_grains", "J"),
    ("contact_patch", "m²"),
    ("tire_contacts", "-"),
    ("kinetic_energy", "J"),
    ("strain_energy", "J"),
    ("spin", "rad/s"),
];

/// Overlap over radius up to which Hertz's law holds for a grain pressed into rubber [-]: at 0.5 it is 5 % above the exact force
/// of a rigid sphere on a half-space (I. N. Sneddon, Int. J. Engng Sci. 3, 1965).
const LARGEST_INDENTATION: f64 = 0.5;

/// What rolls.
#[derive(Clone, Serialize, Deserialize)]
#[serde(bound = "L: Law")]
enum Body<L: Law> {
    Rigid { contacts: Box<SurfaceContacts<L::Memory>>, work: [f64; 2] },
    Elastic(Box<ElasticTire<L>>),
}

/// A tire, its bed, and what has been measured so far.
#[derive(Clone, Serialize, Deserialize)]
#[serde(bound = "L: Law")]
pub struct TireRun<L: Law> {
    variant: Variant,
    roll: Roll,
    /// Outer radius of the size code [m].
    radius: f64,
    bed: LawBed<L>,
    body: Body<L>,
    axle: Axle,
    /// Height of the bed's surface at the start [m], and the depth at which sinking is given up.
    level: f64,
    deepest_axle: f64,
    gravity: Vec3,
    time_step: f64,
    n_steps: u64,
    steps_done: u64,
    steps_per_sample: u64,
    /// Steps until the travel began.
    steps_sinking: Option<u64>,
    traction: Traction,
    table: Table,
    before: BedEnergy,
    pictures: Vec<(String, String, Vec<u8>)>,
    files: Vec<(String, Vec<u8>)>,
    /// Time by the clock of all steps.
    #[serde(skip)]
    spent: Duration,
}

/// A tire that has travelled its way.
#[derive(Clone, Serialize, Deserialize)]
pub struct Rolled {
    /// Which one.
    pub variant: Variant,
    /// Time series.
    pub table: Table,
    /// Time at which the travel began [s].
    pub travel_from: f64,
    /// Where the work went.
    pub ledger: TireLedger,
    /// Elements of the tread, sub-steps in a step.
    pub n_elements: usize,
    /// Sub-steps of the solid in each step of the grains.
    pub sub_steps: u32,
    /// Pictures: name, caption, file.
    pub pictures: Vec<(String, String, Vec<u8>)>,
    /// Further files.
    pub files: Vec<(String, Vec<u8>)>,
    /// Steps made.
    pub n_steps: u64,
    /// Time by the clock of all steps, of the solid and of its contacts [s]; zero where another process computed it.
    #[serde(skip)]
    pub spent: [f64; 3],
}

impl<L: Law> Pass<L> for TireRun<L> {
    type Finished = Rolled;

    fn n_passes(scenario: &Scenario) -> usize {
        variant::parts(scenario).map_or(0, |(tire, roll)| Variant::all(tire, roll).len())
    }

    fn begin(
        scenario: &Scenario,
        number: usize,
        mut bed: LawBed<L>,
        time_step: f64,
        _: &[Rolled],
    ) -> Result<Self, SetupError> {
        let (tire, roll) = variant::parts(scenario).expect("composed for a tire");
        let variant = Variant::all(tire, roll)[number];
        let materials = Materials::of(scenario);
        let size = [0, 1].map(|axis| bed.settings().domain.size()[axis]);
        let level = level::surface_level(&bed.grains().spheres, size);
        let gravity = Vec3::from(scenario.gravity_m_s2);
        let nominal = TireSize::parse(&tire.size).map_err(TreadError::from)?;
        let spec = variant.spec(tire, &materials);
        let inflated = spec.as_ref().map(TreadSpec::inflated).transpose()?;
        let largest_radius = inflated.as_ref().map_or(nominal.outer_radius(), Tread::largest_radius);
        let centre = [roll.start_m, size[1] / 2.0];
        let half = [0.5 * largest_radius, nominal.width / 2.0];
        let top = level::highest_below_box(&bed.grains().spheres, centre, half);
        let position = Vec3::new(centre[0], centre[1], top + roll.gap_m + largest_radius);
        let weight = inflated.as_ref().map_or(0.0, |tread| tread.solid.nodal_mass().iter().sum::<f64>());
        let (radius, g) = (nominal.outer_radius(), gravity.norm());
        let axle = Axle::new(roll, variant.slip, radius, position, weight * g, g);
        let material = materials.number(&tire.material);
        let body = match inflated {
            None => {
                let mesh = variant.shape(tire).mesh().map_err(TreadError::from)?;
                let outer = mesh.facets("outer").expect("treads have an outer surface");
                let (surface, _) = mesh.triangle_surface(outer);
                Body::Rigid { contacts: Box::new(SurfaceContacts::new(surface, material)), work: [0.0; 2] }
            }
            Some(tread) => {
                let sub_steps = match tire.sub_steps {
                    SubSteps::Auto => None,
                    SubSteps::Fixed(n) => Some(n),
                };
                let margin = Margin(tire.refit_margin);
                let tire = ElasticTire::new(tread, axle.now(), material, margin, sub_steps, time_step)?;
                Body::Elastic(Box::new(tire))
            }
        };
        bed.keep_ledger(true);
        let sinking = (position.z - largest_radius - 0.2 * level) / roll.sinking_speed_m_s;
        Ok(Self {
            before: bed.energy(),
            variant,
            roll: roll.clone(),
            radius,
            body,
            level,
            deepest_axle: largest_radius + 0.2 * level,
            gravity,
            n_steps: ((sinking + Axle::travel_time(roll)) / time_step) as u64,
            time_step,
            steps_done: 0,
            steps_per_sample: (scenario.outputs.sample_every_s / time_step).round().max(1.0) as u64,
            steps_sinking: None,
            traction: Traction::default(),
            table: Table::new(&COLUMNS),
            bed,
            axle,
            pictures: Vec::new(),
            files: Vec::new(),
            spent: Duration::ZERO,
        })
    }

    fn advance(&mut self, _: &Scenario) -> Result<(), Broken> {
        let begun = Instant::now();
        let n_steps = (self.n_steps - self.steps_done)
            .min(self.steps_per_sample - self.steps_done % self.steps_per_sample);
        let (dt, gravity) = (self.time_step, self.gravity);
        let Self { bed, body, axle, traction, steps_done, .. } = self;
        let (law, table) = (*bed.law(), bed.pair_table().clone());
        bed.run(n_steps, dt, |grains| {
            traction.begin_step();
            body.step(axle, grains, (&law, &table), gravity, dt, traction)?;
            *steps_done += 1;
            Ok::<(), Broken>(())
        })?;
        self.spent += begun.elapsed();
        if self.steps_sinking.is_none() && matches!(self.axle.phase(), Phase::Travelling { .. }) {
            self.steps_sinking = Some(self.steps_done);
            self.n_steps = self.steps_done + (Axle::travel_time(&self.roll) / dt).ceil() as u64;
            self.leave("sunk");
        }
        if self.steps_sinking.is_none() && self.axle.now().position.z < self.deepest_axle {
            let force = self.traction.last().z;
            return Err(Broken {
                what: format!(
                    "the tire sank through four fifths of the bed and the ground carries {force:.0} N of the {} N asked for",
                    self.roll.load_n
                ),
                remedy: "lower motion.load_n, make the bed deeper, or its grains stiffer".into(),
            });
        }
        if self.steps_done.is_multiple_of(self.steps_per_sample) {
            self.sample();
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
        let phase = match self.axle.phase() {
            Phase::Sinking => "sinking",
            Phase::Travelling { .. } => "travelling",
        };
        format!("{}, {phase}", self.variant.label())
    }

    fn frames(&self) -> Vec<(&'static str, PolyData<'static>)> {
        let mut tire = surface_frame(self.surface());
        if let Body::Elastic(elastic) = &self.body {
            let force = elastic.contacts().vertex_forces().iter().map(|f| [f.x, f.y, f.z]).collect();
            tire.fields.push(("force", PointField::Vector(force)));
        }
        vec![("grains", grains_frame(&self.bed)), ("tire", tire)]
    }

    fn finish(mut self, _: &Scenario) -> Rolled {
        self.leave("travelled");
        let (n_elements, sub_steps) = match &self.body {
            Body::Rigid { .. } => (0, 0),
            Body::Elastic(tire) => (tire.tread().solid.mesh().n_elements(), tire.sub_steps()),
        };
        let [solid, contacts] = match &self.body {
            Body::Rigid { .. } => [Duration::ZERO; 2],
            Body::Elastic(tire) => tire.spent(),
        };
        Rolled {
            ledger: self.ledger(),
            variant: self.variant,
            travel_from: self.steps_sinking.unwrap_or(self.steps_done) as f64 * self.time_step,
            table: self.table,
            n_elements,
            sub_steps,
            pictures: self.pictures,
            files: self.files,
            n_steps: self.steps_done,
            spent: [self.spent, solid, contacts].map(|time| time.as_secs_f64()),
        }
    }

    fn outcome(scenario: &Scenario, bed: &LawBed<L>, done: &[Rolled]) -> Outcome {
        outcome::outcome(scenario, bed.grains().len(), done)
    }
}

impl<L: Law> Body<L> {
    fn step(
        &mut self,
        axle: &mut Axle,
        grains: &mut Grains<L::Precision>,
        (law, table): (&L, &grouser_contact::PairTable<RealOf<L>>),
        gravity: Vec3,
        dt: f64,
        traction: &mut Traction,
    ) -> Result<(), Broken> {
        let deepest = match self {
            Self::Elastic(tire) => {
                tire.coupled_step(axle, grains, (law, table), gravity, dt, traction)?;
                tire.deepest()
            }
            Self::Rigid { contacts, work } => {
                axle.predict(dt);
                let motion = axle.now().motion();
                let step = Step { law, table, time_step: dt, fastest: grains.fastest() };
                let Grains { spheres, ids, loads, .. } = grains;
                let on_tire = contacts.forces_seen(&motion, (spheres, ids), loads, &step, |seen| {
                    traction.add(&seen, &motion.position);
                });
                axle.receive(on_tire.force.z, on_tire.force.z);
                let power = on_tire.force.dot(&motion.velocity) + on_tire.moment.dot(&motion.spin);
                work[0] += 0.5 * (work[1] + power) * dt;
                work[1] = power;
                contacts.deepest()
            }
        };
        match deepest {
            Some(Deepest { grain, position, depth }) if depth > LARGEST_INDENTATION => {
                Err(Failure::OverlapTooLarge { grain, position, depth }.into())
            }
            _ => Ok(()),
        }
    }

    fn contact_ledger(&self) -> &ContactLedger {
        match self {
            Self::Rigid { contacts, .. } => contacts.ledger(),
            Self::Elastic(tire) => tire.contact_ledger(),
        }
    }

    fn n_contacts(&self) -> usize {
        match self {
            Self::Rigid { contacts, .. } => contacts.n_contacts(),
            Self::Elastic(tire) => tire.contacts().n_contacts(),
        }
    }

    /// Work of the grains on the tire [J] and its power now [W].
    fn contact_work(&self) -> [f64; 2] {
        match self {
            Self::Rigid { work, .. } => *work,
            Self::Elastic(tire) => tire.contact_work(),
        }
    }
}

impl From<DynamicsError> for Broken {
    fn from(error: DynamicsError) -> Self {
        let remedy = match &error {
            DynamicsError::InvertedElement { .. } => {
                "take a finer or thicker tread, a higher inflation, or a smaller load; try `models: [FiniteStrain]`"
            }
            _ => "take `sub_steps: Auto`, or more of them",
        };
        Self { what: error.to_string(), remedy: remedy.into() }
    }
}

impl<L: Law> TireRun<L> {
    /// A row of the time series: loads are means since the last row, everything else is of this instant.
    fn sample(&mut self) {
        let patch = self.traction.patch_area();
        let mean = self.traction.take_means();
        let place = *self.axle.now();
        let lowest = self.surface().vertices.iter().fold(f64::INFINITY, |low, v| low.min(v.z));
        let [work, power] = self.body.contact_work();
        let by_torque = mean.torque / self.radius;
        let strain_energy = match &self.body {
            Body::Rigid { .. } => 0.0,
            Body::Elastic(tire) => tire.tread().solid.strain_energy(),
        };
        self.table.push(&[
            self.axle.time(),
            place.position.x - self.roll.start_m,
            self.level - lowest,
            self.radius - (place.position.z - lowest),
            mean.force.x,
            mean.force.y,
            mean.force.z,
            mean.gross,
            mean.resistance,
            mean.force.x,
            mean.torque,
            by_torque,
            by_torque - mean.force.x,
            -power,
            -work,
            patch,
            self.body.n_contacts() as f64,
            self.bed.grains().kinetic_energy().iter().sum(),
            strain_energy,
            place.spin,
        ]);
    }

    /// The outer surface where it is now.
    fn surface(&self) -> TriangleSurface {
        match &self.body {
            Body::Rigid { contacts, .. } => contacts.surface().transformed(&self.axle.now().pose()),
            Body::Elastic(tire) => tire.contacts().surface().clone(),
        }
    }

    /// Draws the tire and the bed as they are now, and keeps the tread for ParaView.
    fn leave(&mut self, when: &str) {
        let tread = match &self.body {
            Body::Rigid { .. } => None,
            Body::Elastic(tire) => Some(tire.tread()),
        };
        let axle = self.axle.now().position;
        let scene = pictures::Seen {
            spheres: pictures::balls(&self.bed.grains().spheres),
            skin: pictures::skin(tread, &self.surface()),
            axle,
            level: self.level,
            radius: self.radius,
        };
        let name = self.variant.name();
        for (view, caption, png) in scene.pictures() {
            let caption = format!("{}, {when}: {caption}", self.variant.label());
            self.pictures.push((format!("{name}_{when}_{view}"), caption, png));
        }
        if let Some(tread) = tread
            && when == "travelled"
        {
            let bytes = pictures::tetrahedra(tread, self.axle.time()).to_bytes();
            self.files.push((format!("{name}.vtu"), bytes));
        }
    }

    fn ledger(&self) -> TireLedger {
        let solid = match &self.body {
            Body::Rigid { .. } => None,
            Body::Elastic(tire) => Some(&tire.tread().solid),
        };
        let [on_tire, _] = self.body.contact_work();
        TireLedger::between(&self.before, &self.bed.energy(), self.body.contact_ledger(), solid, on_tire)
    }
}

/// The parts of a scene that a tire needs, where it has them.
pub fn parts(scenario: &Scenario) -> Option<(&Tire, &Roll)> {
    variant::parts(scenario)
}
