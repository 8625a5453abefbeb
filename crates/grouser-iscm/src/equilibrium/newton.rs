//! Newton's method, bracketed along each direction: the default search.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::Frozen;
use super::frozen::Balance;
use crate::machine::Machine;
use crate::mechanism::GRAVITY;
use crate::terrain::Terrain;

/// Largest motion while imprints stay as drawn \[m, rad\].
const REACH: f64 = 0.1;

/// Where the search ended.
pub(super) struct Settled {
    /// Degrees of freedom.
    pub q: Vec<f64>,
    /// Those that rest on a stop.
    pub stops: Vec<usize>,
    /// Evaluations of the ground's forces.
    pub n_evaluations: usize,
}

/// E2: degrees of freedom in balance, those at a stop, and the evaluations spent.
pub(super) fn solve(
    frozen: &Frozen,
    machine: &Machine,
    terrain: &Terrain,
    tolerance: f64,
    max_iterations: usize,
) -> Settled {
    let mechanism = &machine.mechanism;
    let n = mechanism.n_dofs();
    let start = mechanism.dofs(&frozen.at);
    let mut q = start.clone();
    let mut n_evaluations = 1;
    let mut here = frozen.balance(machine, terrain, &q);
    let mut stops = Vec::new();
    for _ in 0..max_iterations {
        stops = pressed_stops(machine, &q, &here.forces);
        let mut d = direction(&here, &stops, mechanism.mass() * GRAVITY);
        // Stay near the drawing and within the stops.
        let largest = d.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        if largest > REACH / 2.0 {
            d *= REACH / 2.0 / largest;
        }
        let mut is_clipped = false;
        let target: Vec<f64> = (0..n)
            .map(|k| {
                let [low, high] = mechanism.limits(k);
                let near = (q[k] + d[k]).clamp(start[k] - REACH, start[k] + REACH);
                is_clipped |= near != q[k] + d[k];
                near.clamp(low, high)
            })
            .collect();
        let d: Vec<f64> = (0..n).map(|k| target[k] - q[k]).collect();
        // What is left after so short a step is a fraction of it.
        if d.iter().all(|part| part.abs() <= tolerance) {
            q.iter_mut().zip(&d).for_each(|(q, d)| *q += d);
            break;
        }
        let work = |b: &Balance| b.forces.iter().zip(&d).map(|(f, d)| f * d).sum::<f64>();
        let uphill = work(&here);
        let mut there = frozen.balance(machine, terrain, &target);
        n_evaluations += 1;
        let mut t = 1.0;
        if uphill > 0.0 && work(&there) < -0.5 * uphill {
            // Overshot: the balance along d lies between; close in on it (Illinois).
            let (mut a, mut f_a, mut b, mut f_b) = (0.0, uphill, 1.0, work(&there));
            for _ in 0..30 {
                t = (a * f_b - b * f_a) / (f_b - f_a);
                let point: Vec<f64> = (0..n).map(|k| q[k] + t * d[k]).collect();
                there = frozen.balance(machine, terrain, &point);
                n_evaluations += 1;
                let f = work(&there);
                if f.abs() <= 0.2 * uphill || (b - a) < 1e-9 {
                    break;
                }
                if f > 0.0 {
                    (a, f_a) = (t, f);
                    f_b *= 0.5;
                } else {
                    (b, f_b) = (t, f);
                    f_a *= 0.5;
                }
            }
        }
        let step = d.iter().fold(0.0_f64, |a, b| a.max((t * b).abs()));
        for k in 0..n {
            q[k] += t * d[k];
        }
        here = there;
        let is_at_edge = q.iter().zip(&start).any(|(a, b)| (a - b).abs() > 0.999 * REACH);
        if step <= tolerance || (is_clipped && is_at_edge) {
            break;
        }
    }
    Settled { q, stops, n_evaluations }
}

/// Share of the weight that the ground carries less than the machine weighs after a loose search.
const LIFT: f64 = 1e-3;

/// A balance near enough to leave a footprint, lifted until the ground carries less than the weight; and the evaluations spent.
pub(super) fn settle_and_lift(
    frozen: &Frozen,
    machine: &Machine,
    terrain: &Terrain,
    tolerance: f64,
) -> (Vec<f64>, usize) {
    let mechanism = &machine.mechanism;
    let weight = mechanism.mass() * GRAVITY;
    let mut q = mechanism.dofs(&frozen.at);
    let mut n_evaluations = 0;
    let mut step = f64::INFINITY;
    for _ in 0..6 {
        let mut here = frozen.balance(machine, terrain, &q);
        n_evaluations += 1;
        // What is left after a step of Newton's method is a fraction of it.
        if step <= 3.0 * tolerance && here.forces[0] < 0.0 {
            return (q, n_evaluations);
        }
        let stops = pressed_stops(machine, &q, &here.forces);
        here.forces[0] += LIFT * weight;
        let d = direction(&here, &stops, weight);
        step = d.iter().fold(0.0, |a, b| a.max(b.abs()));
        if step > REACH / 2.0 {
            break;
        }
        for k in 0..q.len() {
            let [low, high] = mechanism.limits(k);
            q[k] = (q[k] + d[k]).clamp(low, high);
        }
        // The way that is left is mostly a tenth of so short a step, and less than the lift: no need to verify it.
        if step <= tolerance {
            return (q, n_evaluations);
        }
    }
    // Not near enough: the careful search, then straight up.
    let settled = solve(frozen, machine, terrain, tolerance, 10);
    let mut q = settled.q;
    let mut here = frozen.balance(machine, terrain, &q);
    n_evaluations += settled.n_evaluations + 1;
    for _ in 0..40 {
        if here.forces[0] < 0.0 {
            break;
        }
        q[0] += (here.forces[0] + LIFT * weight) / here.stiffness[(0, 0)].max(1e-3 * weight);
        here = frozen.balance(machine, terrain, &q);
        n_evaluations += 1;
    }
    (q, n_evaluations)
}

/// Degrees of freedom that lie on a stop and are pushed against it.
fn pressed_stops(machine: &Machine, q: &[f64], forces: &[f64]) -> Vec<usize> {
    (0..q.len())
        .filter(|&k| {
            let [low, high] = machine.mechanism.limits(k);
            (q[k] <= low + 1e-12 && forces[k] < 0.0) || (q[k] >= high - 1e-12 && forces[k] > 0.0)
        })
        .collect()
}

/// Newton's direction K⁻¹ Q; where K is not positive definite (gear in the air, near turning over) K is raised until it is.
fn direction(here: &Balance, stops: &[usize], weight: f64) -> DVector<f64> {
    let n = here.forces.len();
    let mut k = (&here.stiffness + here.stiffness.transpose()) * 0.5;
    let mut force = DVector::from_column_slice(&here.forces);
    for &stop in stops {
        k.fill_row(stop, 0.0);
        k.fill_column(stop, 0.0);
        k[(stop, stop)] = weight;
        force[stop] = 0.0;
    }
    let scale = (0..n).map(|i| k[(i, i)].abs()).fold(weight, f64::max);
    let mut raise = 0.0;
    loop {
        if let Some(cholesky) = Cholesky::new(&k + DMatrix::identity(n, n) * raise) {
            return cholesky.solve(&force);
        }
        raise = if raise == 0.0 { 1e-9 * scale } else { 10.0 * raise };
    }
}
