//! Damping that makes restitution a constant: Y. Tsuji, T. Tanaka, T. Ishida, Powder Technology 71 (1992).
//!
//! The dashpot c = α √(m* k), with the secant stiffness k = 4/3 E* √(R* δ), loses the same share of the energy at
//! every speed. With lengths in units of the largest undamped overlap scale and time likewise, an impact is
//! x″ = −(x^{3/2} + α x^{1/4} x′), x(0) = 0, x′(0) = 1, whatever the masses, stiffness and speed.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// α for each e (as bits) that was asked for with the tail cut: a process asks for the same few again and again, and each takes
/// fifty impacts.
static FOUND: Mutex<BTreeMap<u64, f64>> = Mutex::new(BTreeMap::new());

/// What becomes of the attraction that the dashpot would exert while two grains separate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Tail {
    /// Keep it: the contact lasts until the overlap is zero and the closed form α(e) holds.
    Keep,
    /// Cut the force at zero, and choose α so that the restitution asked for is the one obtained.
    #[default]
    CutCorrected,
}

/// Damping coefficient α [-] that yields the restitution `e` in (0, 1].
///
/// With the tail kept α = −√5 ln e / √(π² + ln² e), P0 Eq. (23) with the sign that dissipates.
/// ```
/// # use grouser_contact::{Tail, damping_coefficient};
/// assert!((damping_coefficient(0.5, Tail::Keep) - 0.481769).abs() < 1e-6);
/// assert_eq!(damping_coefficient(1.0, Tail::CutCorrected), 0.0);
/// ```
pub fn damping_coefficient(e: f64, tail: Tail) -> f64 {
    if e >= 1.0 {
        return 0.0;
    }
    let ln_e = e.ln();
    let kept = -(5.0_f64.sqrt()) * ln_e / (std::f64::consts::PI.powi(2) + ln_e * ln_e).sqrt();
    match tail {
        Tail::Keep => kept,
        Tail::CutCorrected => {
            let found = || FOUND.lock().unwrap_or_else(PoisonError::into_inner);
            let known = found().get(&e.to_bits()).copied();
            let alpha = known.unwrap_or_else(|| inverse_of_cut_restitution(e, kept));
            found().insert(e.to_bits(), alpha);
            alpha
        }
    }
}

/// Restitution [-] that the damping coefficient `alpha` yields when the force is cut at zero.
///
/// The published map for the closed-form α of e = 0.2, 0.4, 0.6, 0.8 is 0.325, 0.472, 0.632, 0.808.
pub fn restitution_with_cut_tail(alpha: f64) -> f64 {
    let acceleration =
        |x: f64, v: f64| -(x.max(0.0) * x.max(0.0).sqrt() + alpha * x.max(0.0).sqrt().sqrt() * v);
    // The contact of an undamped impact lasts 3.218 in these units; 2e4 steps make the result exact to 1e-8.
    let (mut x, mut v, dt) = (0.0, 1.0, 1.6e-4);
    loop {
        let (k1x, k1v) = (v, acceleration(x, v));
        let (k2x, k2v) = (v + 0.5 * dt * k1v, acceleration(x + 0.5 * dt * k1x, v + 0.5 * dt * k1v));
        let (k3x, k3v) = (v + 0.5 * dt * k2v, acceleration(x + 0.5 * dt * k2x, v + 0.5 * dt * k2v));
        let (k4x, k4v) = (v + dt * k3v, acceleration(x + dt * k3x, v + dt * k3v));
        x += dt / 6.0 * (k1x + 2.0 * k2x + 2.0 * k3x + k4x);
        v += dt / 6.0 * (k1v + 2.0 * k2v + 2.0 * k3v + k4v);
        let has_separated = x <= 0.0 || (v < 0.0 && acceleration(x, v) >= 0.0);
        if has_separated || !v.is_finite() {
            return -v;
        }
    }
}

/// Bisection: the restitution falls steadily as α grows, and cutting the tail only ever raises it.
fn inverse_of_cut_restitution(e: f64, kept: f64) -> f64 {
    let (mut low, mut high) = (kept, 2.0 * kept.max(1.0));
    while restitution_with_cut_tail(high) > e && high < 1e3 {
        high *= 2.0;
    }
    for _ in 0..48 {
        let middle = 0.5 * (low + high);
        if restitution_with_cut_tail(middle) > e { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cutting_the_tail_gives_the_published_map() {
        for (asked, obtained) in [(0.2, 0.3249), (0.4, 0.4720), (0.6, 0.6323), (0.8, 0.8081)] {
            let e = restitution_with_cut_tail(damping_coefficient(asked, Tail::Keep));
            assert!((e - obtained).abs() < 1e-4, "{asked}: {e} against {obtained}");
        }
    }

    #[test]
    fn corrected_damping_returns_the_restitution_asked_for() {
        for e in [0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99] {
            let obtained = restitution_with_cut_tail(damping_coefficient(e, Tail::CutCorrected));
            assert!((obtained - e).abs() < 1e-5, "{e}: {obtained}");
        }
    }
}
