//! Where a machine comes to rest on the ground (P2 §2.3.3).
//!
//! Steps as in `docs/theory/iscm.md`: E1 draw the imprints, E2 solve with the imprints following the motion in first order,
//! E3 repeat until drawing again changes nothing. Both solvers share E1 and E3, so they answer the same question.

mod frozen;
mod nested;
mod newton;
mod start;

use grouser_geometry::Pose;
use serde::{Deserialize, Serialize};
use thiserror::Error;

pub use frozen::Frozen;
pub use start::start_position;

use crate::contact::Integration;
use crate::machine::Machine;
use crate::mechanism::Configuration;
use crate::polygon::{PartialLoad, SubTriangles};
use crate::terrain::Terrain;

/// How the equilibrium of drawn imprints is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Solver {
    /// Newton's method, bracketed along each direction.
    #[default]
    Fast,
    /// Loops within loops, each a bracketed search in one degree of freedom (P2 Fig. 6); slow, the reference.
    Nested,
}

/// Accuracy and means of the search.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SearchSettings {
    /// Parts per side of a polygon, P2 §2.3.2.2; even.
    pub integration_resolution: usize,
    /// Treatment of partially loaded polygons.
    pub partial: PartialLoad,
    /// Solver.
    pub solver: Solver,
    /// Change of position at which the search ends \[m\]; angles count at one metre from their axis.
    pub position_tolerance: f64,
    /// Most drawings of the imprints.
    pub max_drawings: usize,
}

impl Default for SearchSettings {
    fn default() -> Self {
        Self {
            integration_resolution: 4,
            partial: PartialLoad::Proportional,
            solver: Solver::Fast,
            position_tolerance: 1e-7,
            max_drawings: 80,
        }
    }
}

impl SearchSettings {
    /// How forces are integrated.
    pub fn integration(&self) -> Integration {
        Integration { sub_triangles: SubTriangles::new(self.integration_resolution), partial: self.partial }
    }

    /// Advice where a setting is legal but unwise.
    pub fn advice(&self) -> Option<String> {
        (self.integration_resolution % 2 == 1).then(|| {
            let n = self.integration_resolution;
            format!(
                "integration resolution {n} is odd: the step function of P2 Eq. (6) then misses the quarter and three quarters of a \
                 partially loaded polygon; take {} instead",
                n + 1
            )
        })
    }
}

/// A machine at rest.
#[derive(Clone, Debug)]
pub struct Equilibrium {
    /// Where it stands.
    pub configuration: Configuration,
    /// Drawings of the imprints.
    pub n_drawings: usize,
    /// Evaluations of the ground's forces.
    pub n_evaluations: usize,
    /// Change of position at the last drawing \[m\]; above the tolerance where the grid allows no more.
    pub last_change: f64,
    /// Joints that rest on a stop.
    pub at_stop: Vec<String>,
    /// Imprints at rest.
    pub frozen: Frozen,
}

/// Why a machine finds no rest.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum NoEquilibrium {
    /// It turns over.
    #[error(
        "the machine rolls over: {axis} reached {angle_deg:.1}° after {n_drawings} drawings{stops}; usual cause: centre of mass too \
         high for the slope, or an articulation stop that lifts a side; remedy: a gentler slope, a wider track, or wider stops"
    )]
    RollOver {
        /// Pitch or roll.
        axis: &'static str,
        /// Angle \[°\].
        angle_deg: f64,
        /// Drawings of the imprints until then.
        n_drawings: usize,
        /// Joints at their stops, as text.
        stops: String,
    },
    /// A wheel stands beside the grid.
    #[error(
        "wheel {wheel} of running gear {foot} is at ({x:.3}, {y:.3}) m, off the terrain; remedy: a shorter route or a larger terrain"
    )]
    OffTerrain {
        /// Running gear, counted from 0.
        foot: usize,
        /// Wheel, counted from 0.
        wheel: usize,
        /// Position \[m\].
        x: f64,
        /// Position \[m\].
        y: f64,
    },
    /// Deeper than the relationships are known.
    #[error(
        "running gear {foot} sinks {sinkage:.4} m, the pressure–sinkage relationship ends at {max_sinkage:.4} m; remedy: a larger \
         maximum sinkage or deeper data, less load, wider gear"
    )]
    TooDeep {
        /// Running gear, counted from 0.
        foot: usize,
        /// Sinkage \[m\].
        sinkage: f64,
        /// Largest known sinkage \[m\].
        max_sinkage: f64,
    },
    /// The search did not settle.
    #[error(
        "no equilibrium after {n_drawings} drawings: the position still changes by {change:.2e} m (tolerance {tolerance:.1e} m); usual \
         cause: gear balancing on a rigid edge; remedy: finer terrain or a larger tolerance"
    )]
    NotSettled {
        /// Drawings of the imprints.
        n_drawings: usize,
        /// Last change \[m\].
        change: f64,
        /// Tolerance \[m\].
        tolerance: f64,
    },
    /// A force that is not a number.
    #[error("the force on running gear {foot} is not finite; usual cause: extreme parameters")]
    NonFiniteForce {
        /// Running gear, counted from 0.
        foot: usize,
    },
}

/// Pitch or roll beyond which a machine counts as turned over \[rad\].
const TURNED_OVER: f64 = 1.0;

/// A way above which drawings say little about one another \[m, rad\].
const FAR: f64 = 5e-3;
/// Drawings of which most searches need no more.
const TRUSTED_DRAWINGS: usize = 8;
/// Least share of the way to a drawing's balance that is gone.
const SMALLEST_SHARE: f64 = 1.0 / 64.0;
/// Largest one.
const LARGEST_SHARE: f64 = 2.0;

/// Share of the `way` to go where the last `share` of the way `before` has led: Aitken's, as if the way through all degrees of freedom
/// repeated itself by a constant factor. Far from rest it does not, and the whole way is gone.
fn relaxed(share: f64, before: &[f64], way: &[f64]) -> f64 {
    if before.is_empty() || before.iter().chain(way).any(|part| part.abs() > FAR) {
        return 1.0;
    }
    let change: Vec<f64> = way.iter().zip(before).map(|(way, before)| way - before).collect();
    match dot(before, &change) {
        along if along < 0.0 => -share * along / dot(&change, &change),
        _ => 2.0 * share,
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Finds the equilibrium near `from`; `travel` \[m\] is how far the wheels have rolled.
pub fn equilibrium(
    machine: &Machine,
    terrain: &Terrain,
    from: &Configuration,
    travel: f64,
    settings: &SearchSettings,
) -> Result<Equilibrium, NoEquilibrium> {
    let integration = settings.integration();
    let mut at = from.clone();
    let mut n_evaluations = 0;
    let mut change = f64::INFINITY;
    let mut changes: Vec<f64> = Vec::new();
    // Share of the way to the drawing's balance that is gone: less where drawings answer each other to and fro.
    let (mut share, mut most) = (1.0_f64, LARGEST_SHARE);
    let mut way_before = Vec::new();
    for n_drawings in 1..=settings.max_drawings {
        let frozen = Frozen::new(machine, terrain, &at, travel, integration.clone())?; // E1
        // Early drawings are poor: no use in solving them to the end.
        let tolerance = settings.position_tolerance;
        let inner = (0.1 * tolerance).max(0.01 * change.min(1e-3));
        let (q, stops, n) = match settings.solver {
            Solver::Fast => {
                let settled = newton::solve(&frozen, machine, terrain, inner, 60); // E2
                (settled.q, settled.stops, settled.n_evaluations)
            }
            Solver::Nested => nested::solve(&frozen, machine, terrain, inner),
        };
        n_evaluations += n;
        let before = machine.mechanism.dofs(&at);
        let change_before = change;
        change = before.iter().zip(&q).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let way: Vec<f64> = before.iter().zip(&q).map(|(a, b)| b - a).collect();
        if n_drawings > TRUSTED_DRAWINGS && change > 0.5 * change_before {
            // To and fro, or ever on.
            let factor = if dot(&way_before, &way) < 0.0 { 0.5 } else { 2.0 };
            most = (factor * share).clamp(SMALLEST_SHARE, LARGEST_SHARE);
        }
        share = relaxed(share, &way_before, &way)
            .clamp(SMALLEST_SHARE, if at.tracks.is_empty() { most } else { most.min(1.0) });
        let gone: Vec<f64> = before.iter().zip(&way).map(|(a, way)| a + share * way).collect();
        way_before = way;
        machine.mechanism.set_dofs(&mut at, &gone);
        frozen.carry_tracks(machine, terrain, &mut at, share);
        let at_stop: Vec<String> = stops.iter().map(|&d| machine.mechanism.dof_name(d).to_string()).collect();
        for (axis, angle) in [("pitch", at.pitch), ("roll", at.roll)] {
            if angle.abs() > TURNED_OVER {
                let stops =
                    if at_stop.is_empty() { String::new() } else { format!(", at the stops of {at_stop:?}") };
                return Err(NoEquilibrium::RollOver {
                    axis,
                    angle_deg: angle.to_degrees(),
                    n_drawings,
                    stops,
                });
            }
        }
        changes.push(change);
        // E3: settled, or as settled as points entering and leaving the gear's outline allow.
        let is_stalled = changes.len() >= 12
            && change < 1e-4
            && changes[changes.len() - 6..].iter().all(|c| *c > 0.3 * changes[changes.len() - 7]);
        if (change <= tolerance && inner <= tolerance) || is_stalled {
            let settled = Frozen::new(machine, terrain, &at, travel, integration.clone())?;
            settled.check(machine, terrain)?;
            return Ok(Equilibrium {
                configuration: at,
                n_drawings,
                n_evaluations,
                last_change: change,
                at_stop,
                frozen: settled,
            });
        }
    }
    Err(NoEquilibrium::NotSettled {
        n_drawings: settings.max_drawings,
        change,
        tolerance: settings.position_tolerance,
    })
}

/// Motion from one pose to another.
pub(crate) fn motion(from: &Pose, to: &Pose) -> Pose {
    to * from.inverse()
}
