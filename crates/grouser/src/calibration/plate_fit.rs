//! Bekker's pressure–sinkage law p = (k_c/b + k_φ) zⁿ fitted to several plates at once; b is the plate's radius.
//!
//! M. G. Bekker, "Introduction to Terrain-Vehicle Systems" (1969). For a given n the law is linear in k_c and k_φ, so only n
//! is searched (variable projection). Confidence intervals come from the covariance of all three, s² (JᵀJ)⁻¹.

use grouser_geometry::nalgebra::{Matrix3, Vector3};
use serde::Serialize;
use statrs::distribution::{ContinuousCDF, StudentsT};

/// One point of a plate's curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlatePoint {
    /// Radius of the plate b [m].
    pub radius: f64,
    /// Sinkage z [m].
    pub sinkage: f64,
    /// Mean pressure p [Pa].
    pub pressure: f64,
}

/// A parameter with the half width of its 95 % confidence interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimated {
    /// Value.
    pub value: f64,
    /// Half width of the 95 % confidence interval; infinite when the data cannot tell.
    pub half_width: f64,
}

/// Bekker's three parameters. Units: k_c [Pa/m^(n−1)], k_φ [Pa/mⁿ].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PlateFit {
    /// Cohesive modulus k_c.
    pub k_c: Estimated,
    /// Frictional modulus k_φ.
    pub k_phi: Estimated,
    /// Exponent n [-].
    pub n: Estimated,
    /// Root mean square of the residuals over the mean pressure [-].
    pub relative_rms: f64,
    /// Points used.
    pub n_points: usize,
}

impl PlateFit {
    /// Pressure that the law gives [Pa].
    pub fn pressure(&self, radius: f64, sinkage: f64) -> f64 {
        (self.k_c.value / radius + self.k_phi.value) * sinkage.powf(self.n.value)
    }
}

/// The law that fits `points` best in the sense of least squares; `None` with fewer than four points of positive sinkage
/// or fewer than two different plates (the data cannot tell k_c from k_φ).
pub fn fit_plates(points: &[PlatePoint]) -> Option<PlateFit> {
    let points: Vec<PlatePoint> =
        points.iter().copied().filter(|p| p.sinkage > 0.0 && p.pressure.is_finite()).collect();
    let first = points.first()?;
    let has_two_plates = points.iter().any(|point| (point.radius - first.radius).abs() > 1e-9);
    if points.len() < 4 || !has_two_plates {
        return None;
    }
    let residual = |n: f64| linear_part(&points, n).map_or(f64::INFINITY, |(_, _, sum)| sum);
    // The residual has one valley in n; golden section over everything that soils show.
    let (mut low, mut high) = (0.05, 4.0);
    let share = (5.0_f64.sqrt() - 1.0) / 2.0;
    for _ in 0..90 {
        let (left, right) = (high - share * (high - low), low + share * (high - low));
        if residual(left) < residual(right) { high = right } else { low = left }
    }
    let n = 0.5 * (low + high);
    let (k_c, k_phi, sum) = linear_part(&points, n)?;

    let mut normal = Matrix3::zeros();
    for point in &points {
        let power = point.sinkage.powf(n);
        let modulus = k_c / point.radius + k_phi;
        let row = Vector3::new(power / point.radius, power, modulus * power * point.sinkage.ln());
        normal += row * row.transpose();
    }
    let freedom = (points.len() - 3) as f64;
    let quantile = StudentsT::new(0.0, 1.0, freedom).ok()?.inverse_cdf(0.975);
    let half_width = |k: usize| match normal.try_inverse() {
        Some(inverse) => quantile * (sum / freedom * inverse[(k, k)]).sqrt(),
        None => f64::INFINITY,
    };
    let mean = points.iter().map(|point| point.pressure).sum::<f64>() / points.len() as f64;
    Some(PlateFit {
        k_c: Estimated { value: k_c, half_width: half_width(0) },
        k_phi: Estimated { value: k_phi, half_width: half_width(1) },
        n: Estimated { value: n, half_width: half_width(2) },
        relative_rms: (sum / points.len() as f64).sqrt() / mean,
        n_points: points.len(),
    })
}

/// k_c, k_φ and the sum of squared residuals for a given exponent.
fn linear_part(points: &[PlatePoint], n: f64) -> Option<(f64, f64, f64)> {
    let (mut cc, mut cp, mut pp, mut c, mut p) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for point in points {
        let power = point.sinkage.powf(n);
        let (of_c, of_phi) = (power / point.radius, power);
        cc += of_c * of_c;
        cp += of_c * of_phi;
        pp += of_phi * of_phi;
        c += of_c * point.pressure;
        p += of_phi * point.pressure;
    }
    let determinant = cc * pp - cp * cp;
    if determinant.abs() <= 1e-14 * cc * pp {
        return None;
    }
    let (k_c, k_phi) = ((c * pp - p * cp) / determinant, (p * cc - c * cp) / determinant);
    let square =
        |point: &PlatePoint| ((k_c / point.radius + k_phi) * point.sinkage.powf(n) - point.pressure).powi(2);
    Some((k_c, k_phi, points.iter().map(square).sum()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    fn synthetic(noise: impl Fn(usize) -> f64) -> Vec<PlatePoint> {
        // Dry sand: k_c = −169 kPa/m^(n−1), k_φ = 9219 kPa/mⁿ, n = 1.328.
        let point = |i: usize| {
            let (radius, sinkage) = ([0.03, 0.04, 0.05][i % 3], 0.002 + 0.0008 * (i / 3) as f64);
            let pressure = (-169e3 / radius + 9219e3) * sinkage.powf(1.328) * (1.0 + noise(i));
            PlatePoint { radius, sinkage, pressure }
        };
        (0..60).map(point).collect()
    }

    #[test]
    fn exact_curves_give_the_exact_parameters() {
        let fit = fit_plates(&synthetic(|_| 0.0)).unwrap();
        assert!((fit.k_c.value / -169e3 - 1.0).abs() < 1e-6, "{fit:?}");
        assert!((fit.k_phi.value / 9219e3 - 1.0).abs() < 1e-6);
        assert!((fit.n.value - 1.328).abs() < 1e-7 && fit.relative_rms < 1e-7);
    }

    #[test]
    fn confidence_intervals_hold_the_truth_nineteen_times_of_twenty() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(4);
        let n_trials = 500;
        let mut n_inside = 0;
        for _ in 0..n_trials {
            let mut points = synthetic(|_| 0.0);
            for point in &mut points {
                // Nearly normal, by the sum of four uniform numbers.
                let noise: f64 = (0..4).map(|_| random.random::<f64>() - 0.5).sum();
                point.pressure += 300.0 * noise;
            }
            let fit = fit_plates(&points).unwrap();
            n_inside += u32::from((fit.n.value - 1.328).abs() < fit.n.half_width);
        }
        let share = f64::from(n_inside) / f64::from(n_trials);
        assert!((0.92..=0.975).contains(&share), "{share}");
    }

    #[test]
    fn one_plate_cannot_tell_the_moduli_apart() {
        let mut points = synthetic(|_| 0.0);
        points.iter_mut().for_each(|point| point.radius = 0.03);
        assert!(fit_plates(&points).is_none());
    }
}
