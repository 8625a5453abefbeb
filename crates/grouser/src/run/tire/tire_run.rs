//! A tire on its way over its bed, and what is measured.

use super::axle::{Axle, Phase, Place};
use super::body::{Body, StepInput};
use super::ledger::TireLedger;
use super::traction::Traction;
use super::tread::{Tread, TreadSpec};
use super::{outcome, parts, pictures};
use crate::output::{PointField, PolyData, Table};
use crate::run::frames::{grains_frame, surface_frame};
use crate::run::on_bed::{Broken, Pass};
use crate::run::{Law, LawBed, Materials, Outcome, SetupError, level};
use crate::scene::{Roll, Scenario};
use grouser_dem::BedEnergy;
use grouser_geometry::{TireSize, Vec3};
use serde::{Deserialize, Serialize};
use std::time::{Duration, Instant};

/// Columns of a tire's time series.
const COLUMNS: [(&str, &str); 22] = [
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
    ("energy_residual", "J"),
    ("deepest_overlap", "-"),
];

/// Share of the bed's depth that the tire may be above the floor before sinking is given up [-].
const NEAR_FLOOR: f64 = 0.2;

/// A tire, its bed, and what has been measured so far.
#[derive(Clone, Serialize, Deserialize)]
#[serde(bound = "L: Law")]
pub struct TireRun<L: Law> {
    roll: Roll,
    /// Outer radius of the size code, which slip is measured with [m].
    radius: f64,
    /// Outer surface of the inflated tire without load, in the frame of the rim [m].
    free: Vec<Vec3>,
    bed: LawBed<L>,
    body: Body<L>,
    axle: Axle,
    /// Height of the bed's surface at the start, and that of the axle at which sinking is given up [m].
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
    /// Largest overlap over a grain's radius at the tire since the last sample [-].
    deepest: f64,
    table: Table,
    before: BedEnergy,
    pictures: Vec<Kept>,
    files: Vec<(String, Vec<u8>)>,
    /// Time by the clock of all steps since this process began.
    #[serde(skip)]
    spent: Duration,
}

/// A picture: name, caption, file.
type Kept = (String, String, Vec<u8>);

/// A tire that has travelled its way.
#[derive(Clone, Serialize, Deserialize)]
pub struct Rolled {
    /// Time series.
    pub table: Table,
    /// Time at which the travel began [s].
    pub travel_from: f64,
    /// Where the work went.
    pub ledger: TireLedger,
    /// Elements of the tread; none where it is rigid.
    pub n_elements: usize,
    /// Sub-steps of the solid in each step of the grains.
    pub sub_steps: u32,
    /// Pictures.
    pub pictures: Vec<Kept>,
    /// Further files.
    pub files: Vec<(String, Vec<u8>)>,
    /// Time by the clock of all steps, of the solid and of its contacts [s]; zero where another process computed it.
    #[serde(skip)]
    pub spent: [f64; 3],
    /// Share of steps at which the hierarchy of boxes was refitted and asked [-].
    pub refit_share: f64,
}

impl<L: Law> Pass<L> for TireRun<L> {
    type Finished = Rolled;

    fn n_passes(_: &Scenario) -> usize {
        1
    }

    fn begin(
        scenario: &Scenario,
        _: usize,
        mut bed: LawBed<L>,
        time_step: f64,
        _: &[Rolled],
    ) -> Result<Self, SetupError> {
        let (tire, roll) = parts(scenario).expect("composed for a tire");
        let materials = Materials::of(scenario);
        let size = [0, 1].map(|axis| bed.settings().domain.size()[axis]);
        let level = level::surface_level(&bed.grains().spheres, size);
        let gravity = Vec3::from(scenario.gravity_m_s2);
        let nominal = TireSize::parse(&tire.size).map_err(super::TreadError::from)?;
        let spec = TreadSpec::of(tire, materials.elastic(&tire.material));
        let tread = Body::<L>::inflated(spec.as_ref())?;
        let largest_radius = tread.as_ref().map_or(nominal.outer_radius(), Tread::largest_radius);
        let centre = [roll.start_m, size[1] / 2.0];
        let half = [0.5 * largest_radius, nominal.width / 2.0];
        let top = level::highest_below_box(&bed.grains().spheres, centre, half);
        let position = Vec3::new(centre[0], centre[1], top + roll.gap_m + largest_radius);
        let mass = tread.as_ref().map_or(0.0, |tread| tread.solid.nodal_mass().iter().sum::<f64>());
        let (radius, g) = (nominal.outer_radius(), gravity.norm());
        let axle = Axle::new(roll, radius, position, mass * g, g);
        let body = Body::new(tire, tread, &axle, materials.number(&tire.material), time_step)?;
        bed.keep_ledger(true);
        let pose = axle.now().pose();
        let to_rim = |v: &Vec3| pose.inverse_transform_point(&(*v).into()).coords;
        let free = body.surface(&axle).vertices.iter().map(to_rim).collect();
        let deepest_axle = largest_radius + NEAR_FLOOR * level;
        let sinking = (position.z - deepest_axle) / roll.sinking_speed_m_s;
        Ok(Self {
            before: bed.energy(),
            roll: roll.clone(),
            radius,
            free,
            body,
            level,
            deepest_axle,
            gravity,
            n_steps: ((sinking + Axle::travel_time(roll)) / time_step) as u64,
            time_step,
            steps_done: 0,
            steps_per_sample: (scenario.outputs.sample_every_s / time_step).round().max(1.0) as u64,
            steps_sinking: None,
            traction: Traction::default(),
            deepest: 0.0,
            table: Table::new(&COLUMNS),
            bed,
            axle,
            pictures: Vec::new(),
            files: Vec::new(),
            spent: Duration::ZERO,
        })
    }

    fn advance(&mut self, scenario: &Scenario) -> Result<(), Broken> {
        let begun = Instant::now();
        let n_steps = (self.n_steps - self.steps_done)
            .min(self.steps_per_sample - self.steps_done % self.steps_per_sample);
        let (dt, gravity) = (self.time_step, self.gravity);
        let Self { bed, body, axle, traction, deepest, steps_done, .. } = self;
        let (law, table) = (*bed.law(), bed.pair_table().clone());
        let input = StepInput {
            law: &law,
            table: &table,
            gravity,
            dt,
            largest_overlap: scenario.dials.largest_overlap,
        };
        bed.run(n_steps, dt, |grains| {
            traction.begin_step();
            *deepest = deepest.max(body.step(axle, grains, input, traction)?);
            *steps_done += 1;
            Ok::<(), Broken>(())
        })?;
        self.spent += begun.elapsed();
        if self.steps_sinking.is_none() {
            self.look_whether_sunk()?;
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
        match self.axle.phase() {
            Phase::Sinking => format!("sinking, the ground carries {:.0} N", self.traction.last().z),
            Phase::Travelling { .. } => {
                format!("travelling, {:.3} m", self.axle.now().position.x - self.roll.start_m)
            }
        }
    }

    fn frames(&self) -> Vec<(&'static str, PolyData<'static>)> {
        let mut tire = surface_frame(self.body.surface(&self.axle));
        if let Some(elastic) = self.body.elastic() {
            let force = elastic.contacts().vertex_forces().iter().map(|f| [f.x, f.y, f.z]).collect();
            tire.fields.push(("force", PointField::Vector(force)));
        }
        vec![("grains", grains_frame(&self.bed)), ("tire", tire)]
    }

    fn bed(&self) -> &LawBed<L> {
        &self.bed
    }

    fn rows(&self) -> (&str, &Table) {
        ("tire", &self.table)
    }

    fn finish(mut self, _: &Scenario) -> Rolled {
        self.leave("travelled");
        let elastic = self.body.elastic();
        let [solid, contacts] = self.body.spent();
        Rolled {
            n_elements: elastic.map_or(0, |tire| tire.tread().solid.mesh().n_elements()),
            sub_steps: elastic.map_or(0, |tire| tire.sub_steps()),
            refit_share: elastic
                .map_or(0.0, |tire| tire.contacts().n_refits() as f64 / self.steps_done.max(1) as f64),
            ledger: self.ledger(),
            travel_from: self.steps_sinking.unwrap_or(self.steps_done) as f64 * self.time_step,
            table: self.table,
            pictures: self.pictures,
            files: self.files,
            spent: [self.spent, solid, contacts].map(|time| time.as_secs_f64()),
        }
    }

    fn outcome(scenario: &Scenario, bed: &LawBed<L>, done: &[Rolled]) -> Outcome {
        outcome::outcome(scenario, bed.grains().len(), done)
    }
}

impl<L: Law> TireRun<L> {
    /// The travel begins when the ground carries the load; a tire that nears the floor without that is given up.
    fn look_whether_sunk(&mut self) -> Result<(), Broken> {
        if matches!(self.axle.phase(), Phase::Travelling { .. }) {
            self.steps_sinking = Some(self.steps_done);
            self.n_steps = self.steps_done + (Axle::travel_time(&self.roll) / self.time_step).ceil() as u64;
            self.leave("sunk");
            return Ok(());
        }
        if self.axle.now().position.z > self.deepest_axle && self.steps_done < self.n_steps {
            return Ok(());
        }
        let force = self.traction.last().z;
        Err(Broken {
            what: format!(
                "the tire sank through {:.0} % of the bed and the ground carries {force:.0} N of the {} N asked for",
                100.0 * (1.0 - NEAR_FLOOR),
                self.roll.load_n
            ),
            remedy: "lower motion.load_n, or make the bed deeper or stronger: more friction, grains that roll less freely".into(),
        })
    }

    /// A row of the time series: loads are means since the last row, everything else is of this instant.
    fn sample(&mut self) {
        let patch = self.traction.patch_area();
        let mean = self.traction.take_means();
        let place = *self.axle.now();
        let surface = self.body.surface(&self.axle);
        let lowest = surface.vertices.iter().fold(f64::INFINITY, |low, v| low.min(v.z));
        let [work, power] = self.body.contact_work();
        let by_torque = mean.torque / self.radius;
        let ledger = self.ledger();
        self.table.push(&[
            self.axle.time(),
            place.position.x - self.roll.start_m,
            self.level - lowest,
            deflection(lowest, &self.free, &place),
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
            self.body.elastic().map_or(0.0, |tire| tire.tread().solid.strain_energy()),
            place.spin,
            ledger.residual(),
            self.bed.deepest_overlap().2.max(std::mem::take(&mut self.deepest)),
        ]);
    }

    /// Draws the tire and the bed as they are now, and keeps the tread for ParaView.
    fn leave(&mut self, when: &str) {
        let tread = self.body.elastic().map(|tire| tire.tread());
        let scene = pictures::Seen {
            spheres: pictures::balls(&self.bed.grains().spheres),
            skin: pictures::skin(tread, &self.body.surface(&self.axle)),
            axle: self.axle.now().position,
            level: self.level,
            radius: self.radius,
        };
        for (view, caption, png) in scene.pictures() {
            self.pictures.push((format!("{when}_{view}"), format!("{when}: {caption}"), png));
        }
        if let Some(tread) = tread {
            let bytes = pictures::tetrahedra(tread, self.axle.time()).to_bytes();
            self.files.push((format!("tread_{when}.vtu"), bytes));
        }
    }

    fn ledger(&self) -> TireLedger {
        let solid = self.body.elastic().map(|tire| &tire.tread().solid);
        let [on_tire, _] = self.body.contact_work();
        TireLedger::between(&self.before, &self.bed.energy(), self.body.contact_ledger(), solid, on_tire)
    }
}

/// How much higher the tire's lowest point, at the height `lowest` [m], is than that of the same tire without load [m], whose outer
/// surface in the frame of the rim is `free` [m].
fn deflection(lowest: f64, free: &[Vec3], place: &Place) -> f64 {
    let pose = place.pose();
    let height = |v: &Vec3| (pose.rotation * v).z + place.position.z;
    lowest - free.iter().map(height).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rigid_polygon_does_not_deflect_however_it_is_turned() {
        let corner = |n: u32, angle: f64| {
            let at = angle + f64::from(n) * std::f64::consts::TAU / 12.0;
            Vec3::new(0.3 * at.sin(), 0.0, 0.3 * at.cos())
        };
        let free: Vec<Vec3> = (0..12).map(|n| corner(n, 0.0)).collect();
        for angle in [0.0, 0.1, 0.26, 1.0, 7.0] {
            let position = Vec3::new(1.0, 2.0, 0.5);
            let place = Place { position, velocity: Vec3::zeros(), angle, spin: 0.0 };
            let height = |n| position.z + corner(n, angle).z;
            let lowest = (0..12).map(height).fold(f64::INFINITY, f64::min);
            assert!(deflection(lowest, &free, &place).abs() < 1e-15, "{angle}");
            assert!((deflection(lowest + 0.01, &free, &place) - 0.01).abs() < 1e-15);
        }
    }
}
