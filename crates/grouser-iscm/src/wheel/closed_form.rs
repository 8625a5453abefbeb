//! Stresses on the rim integrated by quadrature: the cheapest fidelity (Bekker 1969; Wong & Reece 1967).

use super::search::sinkage_in_balance;
use super::{OperatingPoint, PressurePeak, SingleWheel, WheelError, WheelSoil};
use crate::shear::JanosiHanamoto;

/// Points of the quadrature on each part of the rim.
const N_POINTS: usize = 24;

/// Steady state under the wheel's load at `slip` and `slip_angle` \[rad\].
pub fn operating_point(
    wheel: &SingleWheel,
    soil: &WheelSoil,
    slip: f64,
    slip_angle: f64,
) -> Result<OperatingPoint, WheelError> {
    wheel.check(soil, slip, slip_angle)?;
    let radius = wheel.acting_radius();
    let mut n_evaluations = 0;
    let deepest = (0.99 * radius).min(soil.pressure.max_sinkage());
    let force = |sinkage| {
        n_evaluations += 1;
        Rim::new(wheel, soil, slip, slip_angle, sinkage).integrate().vertical_force
    };
    let sinkage = sinkage_in_balance(force, wheel.load, deepest / 16.0, deepest, 1e-12)?;
    Ok(OperatingPoint { n_evaluations, ..Rim::new(wheel, soil, slip, slip_angle, sinkage).integrate() })
}

/// Stresses on the rim at one sinkage.
struct Rim<'a> {
    wheel: &'a SingleWheel,
    soil: &'a WheelSoil,
    shear: &'a JanosiHanamoto,
    slip: f64,
    slip_angle: f64,
    radius: f64,
    acting_slip: f64,
    sinkage: f64,
    residual: f64,
    entry: f64,
    peak: f64,
    exit: f64,
}

impl<'a> Rim<'a> {
    fn new(wheel: &'a SingleWheel, soil: &'a WheelSoil, slip: f64, slip_angle: f64, sinkage: f64) -> Self {
        let radius = wheel.acting_radius();
        let angle_at = |sinkage: f64| (1.0 - sinkage / radius).clamp(-1.0, 1.0).acos();
        let entry = angle_at(sinkage);
        let peak = match soil.peak {
            PressurePeak::Bottom => 0.0,
            PressurePeak::WongReece { c_1, c_2 } => (c_1 + c_2 * slip.abs()) * entry,
        };
        // Ground that springs back by p/k_u leaves the rim where the rim has risen by as much.
        let risen = soil.rebound.map_or(0.0, |k_u| (soil.pressure.pressure(sinkage) / k_u).min(sinkage));
        Self {
            wheel,
            soil,
            shear: &soil.shear,
            slip,
            slip_angle,
            radius,
            acting_slip: wheel.acting_slip(slip),
            sinkage,
            residual: sinkage - risen,
            entry,
            peak,
            exit: -angle_at(risen),
        }
    }

    /// Normal stress \[Pa\] at the angle θ \[rad\] from the lowest point.
    fn pressure(&self, theta: f64) -> f64 {
        let depth = |theta: f64| (self.radius * (theta.cos() - self.entry.cos())).max(0.0);
        if theta < 0.0 {
            let k_u = self.soil.rebound.unwrap_or(0.0);
            return (k_u * (depth(theta) - self.residual)).max(0.0);
        }
        // Wong & Reece: behind the peak as before it, the angles stretched to meet at the bottom.
        let mirrored =
            if theta < self.peak { self.entry - theta / self.peak * (self.entry - self.peak) } else { theta };
        self.soil.pressure.pressure(depth(mirrored))
    }

    /// Forces and works over the parts of the rim between the kinks of the stress.
    fn integrate(&self) -> OperatingPoint {
        let (b, r) = (self.wheel.width, self.radius);
        let rest = 1.0 - self.acting_slip;
        let sideways = self.slip_angle.tan();
        // Vertical, compaction, thrust, lateral, rim, shear loss.
        let mut sums = [0.0; 6];
        // Each part from the end where the pressure is least: θ = from + (to − from) u² smooths powers of the sinkage there.
        for [from, to] in [[self.exit, 0.0], [0.0, self.peak], [self.entry, self.peak]] {
            if to == from {
                continue;
            }
            for (u, weight) in gauss_legendre() {
                let theta = from + (to - from) * u * u;
                let w = weight * 2.0 * u * (to - from).abs() * b * r;
                let (sin, cos) = theta.sin_cos();
                let sigma = self.pressure(theta);
                let length = r * (self.entry - theta);
                let j_x = length - rest * r * (self.entry.sin() - sin);
                let j_y = rest * sideways * length;
                let j = j_x.hypot(j_y);
                let stress = if j > 0.0 { self.shear.stress(sigma, j) / j } else { 0.0 };
                let (along, across) = (stress * j_x, -stress * j_y);
                sums[0] += w * (sigma * cos + along * sin);
                sums[1] += w * sigma * sin;
                sums[2] += w * along * cos;
                sums[3] += w * across;
                sums[4] += w * along;
                sums[5] += w * (along * (1.0 - rest * cos) - across * rest * sideways);
            }
        }
        let [vertical_force, compaction_resistance, thrust, lateral_force, rim_force, sheared] = sums;
        let drawbar_pull = thrust - compaction_resistance;
        // Works per metre of rim of radius R; the acting circle runs faster by the ratio of the radii.
        let faster = r / self.wheel.radius;
        let travel = 1.0 - self.slip;
        OperatingPoint {
            slip: self.slip,
            slip_angle: self.slip_angle,
            sinkage: self.sinkage,
            rut_depth: self.residual,
            vertical_force,
            drawbar_pull,
            thrust,
            compaction_resistance,
            lateral_force,
            torque: rim_force * r,
            axle_work: rim_force * faster,
            drawbar_work: travel * (drawbar_pull + sideways * lateral_force),
            compaction_loss: travel * compaction_resistance,
            shear_loss: sheared * faster,
            n_evaluations: 1,
        }
    }
}

/// Points and weights of the Gauss–Legendre rule on 0…1.
fn gauss_legendre() -> &'static [(f64, f64); N_POINTS] {
    static RULE: std::sync::OnceLock<[(f64, f64); N_POINTS]> = std::sync::OnceLock::new();
    RULE.get_or_init(|| {
        std::array::from_fn(|k| {
            // Newton's method on the Legendre polynomial from the usual first guess.
            let n = N_POINTS as f64;
            let mut x = (std::f64::consts::PI * (k as f64 + 0.75) / (n + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..20 {
                let (mut p_0, mut p_1) = (1.0, x);
                for m in 2..=N_POINTS {
                    let m = m as f64;
                    (p_0, p_1) = (p_1, ((2.0 * m - 1.0) * x * p_1 - (m - 1.0) * p_0) / m);
                }
                slope = n * (x * p_1 - p_0) / (x * x - 1.0);
                x -= p_1 / slope;
            }
            (0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope))
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rule_integrates_polynomials_of_high_degree_exactly() {
        for degree in [0, 1, 7, 30, 47] {
            let sum: f64 = gauss_legendre().iter().map(|(x, w)| w * x.powi(degree)).sum();
            assert!((sum * f64::from(degree + 1) - 1.0).abs() < 1e-13, "degree {degree}: {sum}");
        }
    }
}
