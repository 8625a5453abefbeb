//! One tool on its way into its copy of the bed.

use super::frames::{grains_frame, surface_frame};
use super::indenter::Indenter;
use super::on_bed::{Broken, Pass};
use super::press_outcome;
use super::rigid_tool::RigidTool;
use super::tool_ledger::ToolLedger;
use super::zone::ZoneWatch;
use super::{Law, LawBed, Materials, Outcome, SetupError, level};
use crate::output::{PolyData, Table};
use crate::scene::{Motion, Scenario};
use grouser_dem::{BedEnergy, Failure};
use grouser_geometry::{Vec3, Wrench};
use serde::{Deserialize, Serialize};

/// Columns of a tool's time series.
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
    ("tool_contacts", "-"),
];

/// A tool, its bed, and what has been measured so far.
#[derive(Clone, Serialize, Deserialize)]
#[serde(bound = "L: Law")]
pub struct Pressing<L: Law> {
    bed: LawBed<L>,
    tool: RigidTool<L>,
    label: String,
    name: String,
    diameter: f64,
    /// Height of the bed's surface at the start [m].
    level: f64,
    time_step: f64,
    n_steps: u64,
    steps_done: u64,
    steps_per_sample: u64,
    /// Sum of the tool's loads since the last sample.
    sum: Wrench,
    table: Table,
    before: BedEnergy,
    zone: ZoneWatch,
}

/// A tool that has reached its depth.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Pressed {
    /// What it is, in a few words.
    pub label: String,
    /// Name of its time series.
    pub name: String,
    /// Diameter, or that of the circle of the same area [m].
    pub diameter: f64,
    /// Time series.
    pub table: Table,
    /// Where the work went.
    pub ledger: ToolLedger,
    /// What the active zone did, where there is one.
    pub zone: ZoneWatch,
}

impl<L: Law> Pass<L> for Pressing<L> {
    type Finished = Pressed;

    fn n_passes(scenario: &Scenario) -> usize {
        Indenter::count(scenario)
    }

    /// A tool above the middle of `bed`, at the gap that the motion asks for.
    fn begin(
        scenario: &Scenario,
        number: usize,
        mut bed: LawBed<L>,
        time_step: f64,
        _: &[Pressed],
    ) -> Result<Self, SetupError> {
        let (Some(tool), Some(Motion::Press(press))) = (&scenario.tool, &scenario.motion) else {
            unreachable!("composed for a pressed tool")
        };
        let indenter = Indenter::new(tool, number)?;
        let size = [0, 1].map(|axis| bed.settings().domain.size()[axis]);
        let centre = size.map(|length| length / 2.0);
        let level = level::surface_level(&bed.grains().spheres, size);
        let top = level::highest_below_disc(&bed.grains().spheres, centre, indenter.reach);
        let lowest_point = Vec3::new(centre[0], centre[1], top + press.gap_m);
        let material = Materials::of(scenario).number(&indenter.material);
        let tool = RigidTool::pressed(indenter.surface, lowest_point, press.speed_m_s, material)?;
        bed.keep_ledger(true);
        let zone = ZoneWatch::begin(scenario, &mut bed, press.speed_m_s)?;
        let travel = lowest_point.z - level + press.depth_m;
        Ok(Self {
            before: bed.energy(),
            bed,
            tool,
            label: indenter.label,
            name: indenter.name,
            diameter: indenter.diameter,
            level,
            time_step,
            n_steps: (travel / press.speed_m_s / time_step).ceil() as u64,
            steps_done: 0,
            steps_per_sample: (scenario.outputs.sample_every_s / time_step).round().max(1.0) as u64,
            sum: Wrench::default(),
            table: Table::new(&COLUMNS),
            zone,
        })
    }

    fn advance(&mut self, scenario: &Scenario) -> Result<(), Broken> {
        self.zone.reach(scenario, &mut self.bed, &self.tool.surface_in_place());
        let (dt, largest_overlap) = (self.time_step, scenario.dials.largest_overlap);
        let n_steps = (self.n_steps - self.steps_done)
            .min(self.steps_per_sample - self.steps_done % self.steps_per_sample);
        let Self { bed, tool, sum, steps_done, .. } = self;
        let (law, table) = (*bed.law(), bed.pair_table().clone());
        bed.run(n_steps, dt, |grains| {
            // The tool moves, meets the grains, and both receive their forces.
            let load = tool.step(grains, &law, &table, dt, largest_overlap)?;
            *sum += load;
            *steps_done += 1;
            Ok::<(), Failure>(())
        })?;
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
        self.label.clone()
    }

    fn frames(&self) -> Vec<(&'static str, PolyData<'static>)> {
        vec![("grains", grains_frame(&self.bed)), ("tool", surface_frame(self.tool.surface_in_place()))]
    }

    fn bed(&self) -> &LawBed<L> {
        &self.bed
    }

    fn rows(&self) -> (&str, &Table) {
        (&self.name, &self.table)
    }

    fn finish(self, _: &Scenario) -> Pressed {
        let ledger = ToolLedger::between(
            &self.before,
            &self.bed.energy(),
            self.tool.ledger(),
            self.tool.work_on_grains(),
        );
        let Self { label, name, diameter, table, zone, .. } = self;
        Pressed { label, name, diameter, table, ledger, zone }
    }

    fn outcome(scenario: &Scenario, _: &LawBed<L>, done: &[Pressed]) -> Outcome {
        press_outcome::outcome(scenario, done)
    }
}

impl<L: Law> Pressing<L> {
    /// A row of the time series: loads are means since the last row, everything else is of this instant.
    fn sample(&mut self) {
        self.zone.sample(&self.bed);
        let share = 1.0 / self.steps_per_sample as f64;
        let (force, moment) = (self.sum.force * share, self.sum.moment * share);
        self.sum = Wrench::default();
        let area = std::f64::consts::PI * self.diameter * self.diameter / 4.0;
        let n_grains = self.bed.grains().len() as f64;
        self.table.push(&[
            self.steps_done as f64 * self.time_step,
            self.level - self.tool.height(),
            force.z / area,
            force.x,
            force.y,
            force.z,
            moment.x,
            moment.y,
            moment.z,
            -self.tool.applied_power(),
            self.tool.work_on_grains(),
            self.bed.grains().kinetic_energy().iter().sum(),
            2.0 * self.bed.n_contacts() as f64 / n_grains,
            self.tool.n_contacts() as f64,
        ]);
    }
}
