//! Start position: a simplified search in height alone (P2 tests 9 and 17).

use super::{Frozen, NoEquilibrium, SearchSettings};
use crate::machine::Machine;
use crate::mechanism::{Configuration, GRAVITY};
use crate::terrain::Terrain;

/// Lowers the machine, as it is turned, until the ground carries its weight; returns the height just before.
pub fn start_position(
    machine: &Machine,
    terrain: &Terrain,
    from: &Configuration,
    travel: f64,
    settings: &SearchSettings,
) -> Result<Configuration, NoEquilibrium> {
    let integration = settings.integration();
    let weight = machine.mechanism.mass() * GRAVITY;
    let mut at = from.clone();
    let lift = |height: f64, at: &mut Configuration| -> Result<f64, NoEquilibrium> {
        at.height = height;
        let frozen = Frozen::new(machine, terrain, at, travel, integration.clone())?;
        let carried: f64 = frozen.loads.iter().map(|l| l.wrench.force.z).sum();
        Ok(carried - weight)
    };
    // High enough that nothing touches, low enough that everything is buried.
    let (mut low, mut high) = (from.height, from.height);
    let mut step = 0.05;
    while lift(high, &mut at)? > 0.0 {
        high += step;
        step *= 1.5;
    }
    let mut step = 0.05;
    while lift(low, &mut at)? <= 0.0 {
        high = low;
        low -= step;
        step *= 1.5;
    }
    let (mut f_high, mut f_low) = (lift(high, &mut at)?, lift(low, &mut at)?);
    for _ in 0..100 {
        if high - low <= settings.position_tolerance {
            break;
        }
        let t = (low * f_high - high * f_low) / (f_high - f_low);
        let height = t.clamp(low + 0.01 * (high - low), high - 0.01 * (high - low));
        let f = lift(height, &mut at)?;
        if f > 0.0 {
            (low, f_low) = (height, f);
            f_high *= 0.5;
        } else {
            (high, f_high) = (height, f);
            f_low *= 0.5;
        }
    }
    at.height = high;
    Ok(at)
}
