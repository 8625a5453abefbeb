//! One plate on its way into its copy of the bed.

use super::level;
use super::tool::Plate;
use super::{Law, Materials, SetupError};
use crate::output::{PointField, PolyData, Table};
use crate::scene::{Plates, Press, Scenario};
use grouser_dem::{Bed, BedEnergy, Failure};
use grouser_geometry::{Vec3, Wrench};
use serde::{Deserialize, Serialize};

/// Columns of a plate's time series.
const COLUMNS: [(&str, &str); 14] = [
    ("time", "s"),
    ("sinkage", "m"),
    ("pressure", "Pa"),
    ("force_x", "N"),
    ("force_y", "N"),
    ("force_z", "N"),
    ("moment_x", "N·m"),
    ("moment_y", "N·m"),
    ("moment_z", "N·m"),
    ("power", "W"),
    ("work", "J"),
    ("kinetic_energy", "J"),
    ("contacts_per_grain", "-"),
    ("plate_contacts", "-"),
];

/// A plate, its bed, and what has been measured so far.
#[derive(Clone, Serialize, Deserialize)]
#[serde(bound = "L: Law")]
pub struct Pressing<L: Law> {
    bed: Bed<L>,
    plate: Plate<L>,
    diameter: f64,
    /// Height of the bed's surface at the start [m].
    level: f64,
    time_step: f64,
    n_steps: u64,
    steps_done: u64,
    steps_per_sample: u64,
    /// Sum of the plate's loads since the last sample.
    sum: Wrench,
    table: Table,
    before: BedEnergy,
}

/// Energy of a finished press [J].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PressLedger {
    /// Work of the plate on the bed.
    pub input: f64,
    /// Kinetic energy gained.
    pub kinetic: f64,
    /// Elastic energy gained by contacts among grains and with the box.
    pub elastic: f64,
    /// Elastic energy of contacts with the plate.
    pub plate_elastic: f64,
    /// Gravitational energy gained.
    pub gravitational: f64,
    /// Lost in normal dashpots.
    pub normal_damping: f64,
    /// Lost by sliding.
    pub sliding: f64,
    /// Lost by tangential motion without sliding: dashpots, and springs that unloading slackens.
    pub sticking: f64,
}

impl PressLedger {
    /// Energy gained [J].
    pub fn stored(&self) -> f64 {
        self.kinetic + self.elastic + self.plate_elastic + self.gravitational
    }

    /// Energy lost [J].
    pub fn dissipated(&self) -> f64 {
        self.normal_damping + self.sliding + self.sticking
    }

    /// What the ledger misses, over the larger of work and loss [-].
    pub fn residual_fraction(&self) -> f64 {
        (self.input - self.stored() - self.dissipated()) / self.input.abs().max(self.dissipated())
    }
}

impl<L: Law> Pressing<L> {
    /// A plate of `diameter` [m] above the middle of `bed`, at the gap that the motion asks for.
    ///
    /// # Errors
    /// When the plate cannot be made.
    pub fn new(
        scenario: &Scenario,
        (plates, press): (&Plates, &Press),
        diameter: f64,
        mut bed: Bed<L>,
        time_step: f64,
    ) -> Result<Self, SetupError> {
        let materials = Materials::of(scenario);
        let size = [0, 1].map(|axis| bed.settings().domain.size()[axis]);
        let centre = size.map(|length| length / 2.0);
        let level = level::surface_level(&bed.grains().spheres, size);
        let top = level::highest_below_disc(&bed.grains().spheres, centre, diameter / 2.0);
        let lowest_point = Vec3::new(centre[0], centre[1], top + press.gap_m);
        let material = materials.number(&plates.material);
        let plate = Plate::new(plates, diameter, lowest_point, press.speed_m_s, material)?;
        bed.keep_ledger(true);
        let travel = lowest_point.z - level + press.depth_m;
        Ok(Self {
            before: bed.energy(),
            bed,
            plate,
            diameter,
            level,
            time_step,
            n_steps: (travel / press.speed_m_s / time_step).ceil() as u64,
            steps_done: 0,
            steps_per_sample: (scenario.outputs.sample_every_s / time_step).round().max(1.0) as u64,
            sum: Wrench::default(),
            table: Table::new(&COLUMNS),
        })
    }

    /// Steps that remain.
    pub fn steps_left(&self) -> u64 {
        self.n_steps - self.steps_done
    }

    /// Steps made.
    pub fn steps_done(&self) -> u64 {
        self.steps_done
    }

    /// Steps in all.
    pub fn n_steps(&self) -> u64 {
        self.n_steps
    }

    /// Simulated time since the plate began to move [s].
    pub fn time(&self) -> f64 {
        self.steps_done as f64 * self.time_step
    }

    /// The samples.
    pub fn table(&self) -> &Table {
        &self.table
    }

    /// Diameter of the plate [m].
    pub fn diameter(&self) -> f64 {
        self.diameter
    }

    /// Steps from one sample to the next.
    pub fn steps_per_sample(&self) -> u64 {
        self.steps_per_sample
    }

    /// Height of the bed's surface before the plate came [m].
    pub fn level(&self) -> f64 {
        self.level
    }

    /// Steps until the next sample is due.
    pub fn steps_to_sample(&self) -> u64 {
        self.steps_left().min(self.steps_per_sample - self.steps_done % self.steps_per_sample)
    }

    /// Goes on for `n_steps`, at most to the next sample, which is taken when it is due.
    ///
    /// # Errors
    /// When the motion has become meaningless.
    pub fn advance(&mut self, n_steps: u64) -> Result<(), Failure> {
        let (law, dt) = (L::default(), self.time_step);
        let Self { bed, plate, sum, steps_done, .. } = self;
        let table = bed.pair_table().clone();
        bed.run(n_steps, dt, |grains| {
            // The plate moves, meets the grains, and both receive their forces.
            let load = plate.step(grains, &law, &table, dt)?;
            *sum += load;
            *steps_done += 1;
            Ok::<(), Failure>(())
        })?;
        if self.steps_done.is_multiple_of(self.steps_per_sample) {
            self.sample();
        }
        Ok(())
    }

    /// A row of the time series: loads are means since the last row, everything else is of this instant.
    fn sample(&mut self) {
        let share = 1.0 / self.steps_per_sample as f64;
        let (force, moment) = (self.sum.force * share, self.sum.moment * share);
        self.sum = Wrench::default();
        let area = std::f64::consts::PI * self.diameter * self.diameter / 4.0;
        let n_grains = self.bed.grains().len() as f64;
        self.table.push(&[
            self.time(),
            self.level - self.plate.lowest_point(),
            force.z / area,
            force.x,
            force.y,
            force.z,
            moment.x,
            moment.y,
            moment.z,
            -self.plate.applied_power(),
            self.plate.work_on_grains(),
            self.bed.grains().kinetic_energy().iter().sum(),
            2.0 * self.bed.n_contacts() as f64 / n_grains,
            self.plate.n_contacts() as f64,
        ]);
    }

    /// Where the plate's work went.
    pub fn ledger(&self) -> PressLedger {
        let (before, after) = (self.before, self.bed.energy());
        let mut contacts = after.contacts;
        let plate = self.plate.ledger();
        let elastic = contacts.elastic() - before.contacts.elastic();
        contacts += *plate;
        PressLedger {
            input: self.plate.work_on_grains(),
            kinetic: after.kinetic + after.rotational - before.kinetic - before.rotational,
            elastic,
            plate_elastic: plate.elastic(),
            gravitational: after.gravitational - before.gravitational,
            normal_damping: contacts.normal_damping,
            sliding: contacts.sliding,
            sticking: contacts.dissipated() - contacts.normal_damping - contacts.sliding,
        }
    }

    /// Grains as ParaView sees them.
    pub fn grains_frame(&self) -> PolyData<'static> {
        let grains = self.bed.grains();
        let spheres = &grains.spheres;
        PolyData {
            time: self.time(),
            points: spheres.iter().map(|sphere| sphere.position.to_array()).collect(),
            triangles: Vec::new(),
            fields: vec![
                ("radius", PointField::Scalar(spheres.iter().map(|sphere| sphere.radius).collect())),
                ("velocity", PointField::Vector(spheres.iter().map(|s| s.velocity.to_array()).collect())),
                ("spin", PointField::Vector(spheres.iter().map(|s| s.spin.to_array()).collect())),
                ("id", PointField::Id(grains.ids.iter().map(|&id| i64::from(id)).collect())),
            ],
        }
    }

    /// The plate as ParaView sees it.
    pub fn plate_frame(&self) -> PolyData<'static> {
        let surface = self.plate.surface_in_place();
        PolyData {
            time: self.time(),
            points: surface.vertices.iter().map(|v| [v.x, v.y, v.z]).collect(),
            triangles: surface.triangles,
            fields: Vec::new(),
        }
    }

    /// The bed.
    pub fn bed(&self) -> &Bed<L> {
        &self.bed
    }
}
