//! Loops within loops (P2 Fig. 6): bogies within components within the vehicle; the reference for the fast search.

use std::cell::Cell;

use super::Frozen;
use crate::machine::Machine;
use crate::terrain::Terrain;

/// E2 by nested bracketed searches: height outside, then pitch, roll and joints, the last ones innermost.
pub(super) fn solve(
    frozen: &Frozen,
    machine: &Machine,
    terrain: &Terrain,
    tolerance: f64,
) -> (Vec<f64>, Vec<usize>, usize) {
    let q = machine.mechanism.dofs(&frozen.at);
    let search =
        Search { frozen, machine, terrain, start: q.clone(), tolerance, n_evaluations: Cell::new(0) };
    let mut q = q;
    let forces = search.settle(&mut q, 0);
    let stops = (3..q.len())
        .filter(|&k| {
            let [low, high] = machine.mechanism.limits(k);
            (q[k] <= low && forces[k] < 0.0) || (q[k] >= high && forces[k] > 0.0)
        })
        .collect();
    (q, stops, search.n_evaluations.get())
}

struct Search<'a> {
    frozen: &'a Frozen,
    machine: &'a Machine,
    terrain: &'a Terrain,
    start: Vec<f64>,
    tolerance: f64,
    n_evaluations: Cell<usize>,
}

impl Search<'_> {
    /// Brings the degrees of freedom from `level` on into balance and returns the forces there.
    fn settle(&self, q: &mut Vec<f64>, level: usize) -> Vec<f64> {
        if level == q.len() {
            self.n_evaluations.set(self.n_evaluations.get() + 1);
            return self.frozen.balance(self.machine, self.terrain, q).forces;
        }
        let reach = 0.1;
        let limits = self.machine.mechanism.limits(level);
        let low = (self.start[level] - reach).max(limits[0]);
        let high = (self.start[level] + reach).min(limits[1]);
        let at = |q: &mut Vec<f64>, value: f64| {
            q[level] = value;
            self.settle(q, level + 1)
        };
        // Widen a bracket around the present value: the force falls as the coordinate grows.
        let (mut a, mut b) = (q[level], q[level]);
        let mut forces = at(q, a);
        let (mut f_a, mut f_b) = (forces[level], forces[level]);
        let mut width = 1e-5_f64;
        while f_b > 0.0 && b < high {
            (a, f_a) = (b, f_b);
            b = (b + width).min(high);
            forces = at(q, b);
            f_b = forces[level];
            width *= 6.0;
        }
        while f_a < 0.0 && a > low {
            (b, f_b) = (a, f_a);
            a = (a - width).max(low);
            forces = at(q, a);
            f_a = forces[level];
            width *= 6.0;
        }
        if f_a <= 0.0 || f_b >= 0.0 {
            let best = if f_b >= 0.0 { b } else { a };
            return at(q, best); // balanced already, or pressed against a stop or the edge of the drawing
        }
        let tolerance = self.tolerance * 0.1_f64.powi((level as i32).min(3));
        let (mut g_a, mut g_b) = (f_a, f_b);
        for _ in 0..80 {
            if b - a <= tolerance {
                break;
            }
            let t = ((a * g_b - b * g_a) / (g_b - g_a)).clamp(a + 1e-3 * (b - a), b - 1e-3 * (b - a));
            forces = at(q, t);
            let f = forces[level];
            if f > 0.0 {
                (a, g_a) = (t, f);
                g_b *= 0.5;
            } else if f < 0.0 {
                (b, g_b) = (t, f);
                g_a *= 0.5;
            } else {
                break;
            }
        }
        forces
    }
}
