//! Traction of a whole machine at its equilibrium, and the slip at which it pulls.

use grouser_geometry::Vec3;
use thiserror::Error;

use super::{JanosiHanamoto, Motion, Traction, foot_traction};
use crate::equilibrium::Equilibrium;
use crate::machine::Machine;
use crate::terrain::Terrain;

/// What the ground gives a machine whose wheels and belts all turn with one slip.
#[derive(Clone, Debug, PartialEq)]
pub struct MachineTraction {
    /// Slip \[-\].
    pub slip: f64,
    /// Shear on each piece of running gear.
    pub feet: Vec<Traction>,
    /// Torque at the wheels of each piece \[N·m\]: force along the rim or belt times the radius of its first wheel.
    pub torques: Vec<f64>,
    /// Forward part of all shear \[N\].
    pub thrust: f64,
    /// Backward part of all pressure \[N\]: compaction and grade.
    pub resistance: f64,
    /// Thrust minus resistance \[N\].
    pub drawbar_pull: f64,
    /// Force of shear and pressure to the left \[N\].
    pub lateral_force: f64,
    /// Upward part of all shear \[N\]; the equilibrium does not know of it.
    pub lift: f64,
}

/// No slip gives the pull.
#[derive(Clone, Debug, PartialEq, Error)]
#[error(
    "the machine pulls at most {most:.1} N, at slip {slip}; {pull} N were asked; remedy: less pull, more load on driven gear, stronger ground"
)]
pub struct NoPull {
    /// Largest pull \[N\].
    pub most: f64,
    /// Slip there.
    pub slip: f64,
    /// Wanted pull \[N\].
    pub pull: f64,
}

/// Traction of `machine` at `rest` with every wheel and belt turning at `slip`, straight ahead.
pub fn machine_traction(
    machine: &Machine,
    terrain: &Terrain,
    rest: &Equilibrium,
    law: &JanosiHanamoto,
    slip: f64,
) -> MachineTraction {
    let frozen = &rest.frozen;
    let forward = frozen.poses[0].rotation * Vec3::x();
    let motion = Motion { forward, slip, slip_angle: 0.0 };
    let (loads, polygons) = (&frozen.loads, frozen.polygons(machine, terrain));
    let feet: Vec<Traction> = machine
        .feet
        .iter()
        .enumerate()
        .map(|(k, foot)| {
            let gap = foot.belts.iter().map(|belt| belt.pitch).fold(0.0, f64::max);
            foot_traction(&frozen.imprints[k], terrain, &polygons[k], law, motion, gap)
        })
        .collect();
    let shear: Vec3 = feet.iter().map(|t| t.wrench.force).sum();
    let pressure: Vec3 = loads.iter().map(|l| l.wrench.force).sum();
    let radius = |k: usize| machine.feet[k].wheels.first().map_or(0.0, |wheel| wheel.radius);
    MachineTraction {
        slip,
        torques: feet.iter().enumerate().map(|(k, t)| t.rim_force * radius(k)).collect(),
        thrust: shear.dot(&forward),
        resistance: -pressure.dot(&forward),
        drawbar_pull: (shear + pressure).dot(&forward),
        lateral_force: (shear + pressure).dot(&motion.left()),
        lift: shear.z,
        feet,
    }
}

/// The least slip from 0 to 0.99 at which `machine` pulls `drawbar_pull` \[N\], to 1e-9.
///
/// # Errors
/// When the pull is beyond what the ground gives.
pub fn machine_slip(
    machine: &Machine,
    terrain: &Terrain,
    rest: &Equilibrium,
    law: &JanosiHanamoto,
    drawbar_pull: f64,
) -> Result<MachineTraction, NoPull> {
    let at = |slip| machine_traction(machine, terrain, rest, law, slip);
    let (mut low, mut most) = (0.0, NoPull { most: f64::NEG_INFINITY, slip: 0.0, pull: drawbar_pull });
    for k in 0..=33 {
        let slip = 0.03 * f64::from(k);
        let found = at(slip);
        if found.drawbar_pull >= drawbar_pull {
            let mut high = slip;
            while high - low > 1e-9 {
                let middle = 0.5 * (low + high);
                if at(middle).drawbar_pull >= drawbar_pull { high = middle } else { low = middle }
            }
            return Ok(at(high));
        }
        if found.drawbar_pull > most.most {
            most = NoPull { most: found.drawbar_pull, slip, pull: drawbar_pull };
        }
        low = slip;
    }
    Err(most)
}
