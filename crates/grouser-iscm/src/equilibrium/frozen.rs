//! A machine over drawn imprints: generalised forces and stiffness.

use grouser_geometry::Pose;
use nalgebra::{DMatrix, Matrix6xX, Vector6};
use rayon::prelude::*;

use super::{NoEquilibrium, motion, newton};
use crate::contact::{FootImprint, FootLoad, Integration, LoadedPolygon};
use crate::machine::Machine;
use crate::mechanism::Configuration;
use crate::terrain::Terrain;

/// Imprints of all running gear, drawn where the machine stood, and how they answer when it moves a little.
#[derive(Clone, Debug)]
pub struct Frozen {
    /// Where the imprints were drawn.
    pub at: Configuration,
    /// Poses of all bodies there.
    pub poses: Vec<Pose>,
    /// Imprint of each foot.
    pub imprints: Vec<FootImprint>,
    /// Loads of all feet there.
    pub loads: Vec<FootLoad>,
    integration: Integration,
}

/// Generalised forces and their decrease with the degrees of freedom.
pub(super) struct Balance {
    pub forces: Vec<f64>,
    pub stiffness: DMatrix<f64>,
}

impl Frozen {
    /// E1: draws the imprints of all running gear.
    pub fn new(
        machine: &Machine,
        terrain: &Terrain,
        at: &Configuration,
        travel: f64,
        integration: Integration,
    ) -> Result<Self, NoEquilibrium> {
        let poses = machine.mechanism.poses(at);
        for (foot, gear) in machine.feet.iter().enumerate() {
            for (wheel, w) in gear.wheels.iter().enumerate() {
                let p = poses[gear.body] * nalgebra::Point3::from(w.centre);
                if !terrain.grid().contains(p.x, p.y) {
                    return Err(NoEquilibrium::OffTerrain { foot, wheel, x: p.x, y: p.y });
                }
            }
        }
        // Every search begins where the imprints are drawn: one piece of work for each foot.
        let drawn = on_all_feet(machine.feet.len(), |foot| {
            let (gear, shapes) = (&machine.feet[foot], at.tracks.get(machine.slack_belts(foot)));
            let (pose, shapes) = (&poses[gear.body], shapes.unwrap_or_default());
            let imprint = gear.imprint_with(terrain, pose, travel, integration.partial, shapes);
            let load = imprint.load(terrain, &motion(pose, pose), &integration);
            (imprint, load)
        });
        let (imprints, loads) = drawn.into_iter().unzip();
        Ok(Self { at: at.clone(), poses, imprints, loads, integration })
    }

    /// Load of one foot after its body moved to `pose`.
    pub fn foot_load(&self, foot: usize, machine: &Machine, terrain: &Terrain, pose: &Pose) -> FootLoad {
        let moved = motion(&self.poses[machine.feet[foot].body], pose);
        self.imprints[foot].load(terrain, &moved, &self.integration)
    }

    /// Loaded polygons of each foot where the imprints were drawn.
    pub fn polygons(&self, machine: &Machine, terrain: &Terrain) -> Vec<Vec<LoadedPolygon>> {
        on_all_feet(machine.feet.len(), |foot| {
            let pose = &self.poses[machine.feet[foot].body];
            self.imprints[foot].polygons(terrain, &motion(pose, pose), &self.integration)
        })
    }

    /// A loose balance without drawing again, in which the ground carries a little less than the machine's weight (P2 §2.4); also
    /// returns the evaluations spent.
    pub fn settle_and_lift(
        &self,
        machine: &Machine,
        terrain: &Terrain,
        tolerance: f64,
    ) -> (Configuration, usize) {
        let (q, n_evaluations) = newton::settle_and_lift(self, machine, terrain, tolerance);
        let mut at = self.moved(machine, &q);
        self.carry_tracks(machine, terrain, &mut at, 1.0);
        (at, n_evaluations)
    }

    /// Sets the shapes of slack tracks a `share` of the way to where they rest after the bodies moved to `at`.
    pub fn carry_tracks(&self, machine: &Machine, terrain: &Terrain, at: &mut Configuration, share: f64) {
        if self.imprints.iter().all(|imprint| imprint.tracks.is_empty()) {
            return;
        }
        let poses = machine.mechanism.poses(at);
        let shapes = on_all_feet(self.imprints.len(), |foot| {
            let body = machine.feet[foot].body;
            let moved = motion(&self.poses[body], &poses[body]);
            let tracks = self.imprints[foot].tracks.iter();
            tracks.map(|track| track.shape(terrain, &moved, share)).collect::<Vec<_>>()
        });
        at.tracks = shapes.into_iter().flatten().collect();
    }

    /// G2: leaves the footprints of all feet after the bodies moved to a configuration nearby, one foot after the other.
    pub fn stamp(&self, machine: &Machine, terrain: &mut Terrain, to: &Configuration) {
        let poses = machine.mechanism.poses(to);
        self.stamp_after(terrain, |foot| {
            let body = machine.feet[foot].body;
            motion(&self.poses[body], &poses[body])
        });
    }

    /// The same where the imprints were drawn.
    pub fn stamp_here(&self, terrain: &mut Terrain) {
        self.stamp_after(terrain, |_| Pose::identity());
    }

    fn stamp_after(&self, terrain: &mut Terrain, motion: impl Fn(usize) -> Pose + Sync) {
        let prints =
            on_all_feet(self.imprints.len(), |foot| self.imprints[foot].print(terrain, &motion(foot)));
        prints.iter().for_each(|print| print.leave(terrain));
    }

    /// Names a sinkage beyond the data and forces that are not numbers.
    pub(super) fn check(&self, machine: &Machine, terrain: &Terrain) -> Result<(), NoEquilibrium> {
        let max_sinkage = terrain.field().max_sinkage();
        let deepest = on_all_feet(machine.feet.len(), |foot| {
            self.imprints[foot].deepest(terrain, self.integration.partial)
        });
        for (foot, (load, sinkage)) in self.loads.iter().zip(deepest).enumerate() {
            if !load.wrench.force.iter().all(|f| f.is_finite()) {
                return Err(NoEquilibrium::NonFiniteForce { foot });
            }
            if sinkage > max_sinkage + 1e-9 {
                return Err(NoEquilibrium::TooDeep { foot, sinkage, max_sinkage });
            }
        }
        Ok(())
    }

    /// Configuration with other values of the degrees of freedom.
    pub(super) fn moved(&self, machine: &Machine, q: &[f64]) -> Configuration {
        let mut at = self.at.clone();
        machine.mechanism.set_dofs(&mut at, q);
        at
    }

    /// Forces and stiffness at `q`.
    pub(super) fn balance(&self, machine: &Machine, terrain: &Terrain, q: &[f64]) -> Balance {
        let mechanism = &machine.mechanism;
        let at = self.moved(machine, q);
        let poses = mechanism.poses(&at);
        let twists = mechanism.twists(&at, &poses);
        let n = twists.len();
        let mut forces = mechanism.own_forces(&at, &poses, &twists);
        let mut stiffness = DMatrix::zeros(n, n);
        // Weight that shifts with rotation.
        let step = 1e-6;
        for column in 1..n {
            let mut other = q.to_vec();
            other[column] += step;
            let at = self.moved(machine, &other);
            let poses = mechanism.poses(&at);
            let own = mechanism.own_forces(&at, &poses, &mechanism.twists(&at, &poses));
            for row in 0..n {
                stiffness[(row, column)] -= (own[row] - forces[row]) / step;
            }
        }
        let moved;
        let loads = if q == mechanism.dofs(&self.at) {
            &self.loads
        } else {
            moved = on_all_feet(machine.feet.len(), |foot| {
                self.foot_load(foot, machine, terrain, &poses[machine.feet[foot].body])
            });
            &moved
        };
        for (foot, load) in loads.iter().enumerate() {
            let o = self.imprints[foot].reference;
            let mut t = Matrix6xX::zeros(n);
            for (k, twist) in twists.iter().enumerate() {
                if mechanism.hangs_on(machine.feet[foot].body, twist.body) {
                    let (v, w) = (twist.velocity(o), twist.omega);
                    t.set_column(k, &Vector6::new(v.x, v.y, v.z, w.x, w.y, w.z));
                }
            }
            let (f, m) = (load.wrench.force, load.wrench.moment);
            let q_f = t.tr_mul(&Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z));
            for k in 0..n {
                forces[k] += q_f[k];
            }
            stiffness += t.transpose() * load.stiffness * &t;
        }
        Balance { forces, stiffness }
    }
}

/// What `work` gives for each foot. Feet come in pairs, left and right, and differ along the machine: with two threads each takes a side. The
/// last pair comes first: mostly it carries tracks and costs most, and what comes last should be little.
fn on_all_feet<T: Send>(n: usize, work: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let by_side: Vec<usize> = (0..n).step_by(2).rev().chain((1..n).step_by(2).rev()).collect();
    let done: Vec<T> = by_side.par_iter().map(|&foot| work(foot)).collect();
    let mut feet: Vec<(usize, T)> = by_side.into_iter().zip(done).collect();
    feet.sort_by_key(|&(foot, _)| foot);
    feet.into_iter().map(|(_, done)| done).collect()
}
