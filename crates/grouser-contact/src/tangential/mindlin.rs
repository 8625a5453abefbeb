//! Tangential spring with memory: R. D. Mindlin, 1949; P0 Eqs. (24)–(27) with a spring vector.
//!
//! The spring s [m] is the tangential displacement of the first body against the second since they touched. Each step
//! it is turned into the present tangent plane, stretched by the sliding, and cut where the force reaches μ F_n.

use crate::{Real, Vector};
use serde::{Deserialize, Serialize};

/// What a growing normal load does to a tangential spring that is already stretched.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Loading {
    /// The stiffness gained acts on new displacement only; on unloading the force falls with the contact radius.
    /// No closed path of loading yields energy.
    #[default]
    Passive,
    /// F_t = k_t(δ) s with the displacement since first touch (P0, and the codes compared by Chung & Ooi 2011).
    /// Oblique impacts without damping gain energy where ν < 0.25 (0.8 % at ν = 0.23, μ = 10).
    TotalDisplacement,
}

/// Result of the tangential law.
#[derive(Clone, Copy, Debug)]
pub struct Tangential<T> {
    /// Force on the first body [N].
    pub force: Vector<T>,
    /// Spring after this step [m].
    pub spring: Vector<T>,
    /// The Coulomb limit was reached.
    pub is_sliding: bool,
}

/// Spring and dashpot in the tangent plane, cut together at `limit` = μ F_n [N].
///
/// `spring` lies in the tangent plane and includes the present step's sliding [m]; `stiffness` k_t [N/m],
/// `dashpot` c_t [N·s/m], `velocity` tangential, of the first body against the second [m/s].
#[inline(always)]
pub fn mindlin<T: Real>(
    spring: Vector<T>,
    velocity: Vector<T>,
    stiffness: T,
    softness: T,
    dashpot: T,
    limit: T,
) -> Tangential<T> {
    let trial = -(spring * stiffness + velocity * dashpot);
    let trial_squared = trial.norm_squared();
    let is_sliding = trial_squared > limit * limit;
    let share = if is_sliding { limit / trial_squared.sqrt() } else { T::ONE };
    let force = trial * share;
    // While sliding the spring holds the whole limit; the dashpot has no say beyond it.
    let cut = -(force * softness);
    let choose = |a: T, b: T| if is_sliding { a } else { b };
    let spring = Vector::new(choose(cut.x, spring.x), choose(cut.y, spring.y), choose(cut.z, spring.z));
    Tangential { force, spring, is_sliding }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sticking_spring_keeps_its_stretch_and_a_sliding_one_holds_the_limit() {
        let spring = Vector::new(3e-6, 4e-6, 0.0);
        let stuck = mindlin(spring, Vector::ZERO, 1e6, 1e-6, 0.0, 6.0);
        assert!(!stuck.is_sliding && stuck.spring == spring);
        assert!((stuck.force.norm() - 5.0_f64).abs() < 1e-12);
        let slid = mindlin(spring, Vector::ZERO, 1e6, 1e-6, 0.0, 2.0);
        assert!(slid.is_sliding);
        assert!((slid.force + Vector::new(1.2, 1.6, 0.0)).norm() < 1e-12);
        assert!((slid.spring.norm() - 2e-6_f64).abs() < 1e-18);
    }

    #[test]
    fn the_dashpot_is_inside_the_coulomb_limit_and_opposes_the_motion() {
        let slid = mindlin(Vector::ZERO, Vector::new(2.0, 0.0, 0.0), 1e6, 1e-6, 10.0, 3.0);
        assert!(slid.is_sliding);
        assert!((slid.force - Vector::new(-3.0, 0.0, 0.0)).norm() < 1e-12_f64);
    }
}
