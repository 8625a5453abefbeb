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
    let search = Search {
        order: order(machine),
        frozen,
        machine,
        terrain,
        start: q.clone(),
        tolerance,
        n_evaluations: Cell::new(0),
    };
    let mut q = q;
    let forces = search.settle(&mut q, &search.order);
    let stops = (3..q.len())
        .filter(|&k| {
            let [low, high] = machine.mechanism.limits(k);
            (q[k] <= low && forces[k] < 0.0) || (q[k] >= high && forces[k] > 0.0)
        })
        .collect();
    (q, stops, search.n_evaluations.get())
}

/// One loop: a degree of freedom that others depend on, or last bodies of the chain that do not feel each other.
enum Loop {
    One(usize),
    Leaves(Vec<usize>),
}

/// Height, pitch, roll and joints between components one within another; bogies, innermost, each for itself.
fn order(machine: &Machine) -> Vec<Loop> {
    let mechanism = &machine.mechanism;
    let is_leaf = |dof: usize| {
        mechanism.dof_body(dof).is_some_and(|body| {
            (0..mechanism.n_dofs()).all(|other| {
                other == dof || mechanism.dof_body(other).is_none_or(|b| !mechanism.hangs_on(b, body))
            })
        })
    };
    let (leaves, inner): (Vec<usize>, Vec<usize>) = (0..mechanism.n_dofs()).partition(|&dof| is_leaf(dof));
    inner.into_iter().map(Loop::One).chain([Loop::Leaves(leaves)]).collect()
}

struct Search<'a> {
    order: Vec<Loop>,
    frozen: &'a Frozen,
    machine: &'a Machine,
    terrain: &'a Terrain,
    start: Vec<f64>,
    tolerance: f64,
    n_evaluations: Cell<usize>,
}

impl Search<'_> {
    /// Brings the degrees of freedom of the remaining loops into balance and returns the forces there.
    fn settle(&self, q: &mut Vec<f64>, loops: &[Loop]) -> Vec<f64> {
        let depth = self.order.len() - loops.len();
        match loops {
            [] => self.forces(q),
            [Loop::One(level), inner @ ..] => {
                self.bracket(q, *level, depth, &|q: &mut Vec<f64>| self.settle(q, inner))
            }
            [Loop::Leaves(leaves), inner @ ..] => {
                for &leaf in leaves {
                    self.bracket(q, leaf, depth, &|q: &mut Vec<f64>| self.forces(q));
                }
                self.settle(q, inner)
            }
        }
    }

    fn forces(&self, q: &[f64]) -> Vec<f64> {
        self.n_evaluations.set(self.n_evaluations.get() + 1);
        self.frozen.balance(self.machine, self.terrain, q).forces
    }

    /// A bracketed search in one degree of freedom; `inner` settles what depends on it.
    fn bracket(
        &self,
        q: &mut Vec<f64>,
        level: usize,
        depth: usize,
        inner: &dyn Fn(&mut Vec<f64>) -> Vec<f64>,
    ) -> Vec<f64> {
        let reach = 0.1;
        let limits = self.machine.mechanism.limits(level);
        let low = (self.start[level] - reach).max(limits[0]);
        let high = (self.start[level] + reach).min(limits[1]);
        let at = |q: &mut Vec<f64>, value: f64| {
            q[level] = value;
            inner(q)
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
        let tolerance = self.tolerance * 0.1_f64.powi((depth as i32).min(3));
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
