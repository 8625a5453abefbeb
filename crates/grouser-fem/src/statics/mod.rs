//! Static equilibrium: K u = b, or Newton's method where the formulation is not linear.

mod block_matrix;
pub mod conjugate_gradients;
mod incomplete_cholesky;
mod nested_dissection;
mod sparse_cholesky;

use grouser_geometry::Vec3;
use grouser_geometry::nalgebra::{DMatrix, Matrix3};
use serde::{Deserialize, Serialize};

pub use block_matrix::BlockMatrix;
pub use conjugate_gradients::Convergence;
pub use incomplete_cholesky::IncompleteCholesky;
pub use nested_dissection::order as nested_dissection_order;
pub use sparse_cholesky::{CholeskyError, SparseCholesky};

use crate::element_state::{ElementStates, SlotGradient};
use crate::material::Formulation;
use crate::solid::Solid;

/// Solver of the linear systems.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum LinearSolver {
    /// Sparse Cholesky up to [`DIRECT_UNKNOWNS`] unknowns and for thin solids, which have more than half of their nodes on the
    /// boundary; otherwise conjugate gradients, and sparse Cholesky where they fail ([`StaticSummary::has_fallen_back`]).
    #[default]
    Automatic,
    /// Conjugate gradients with incomplete Cholesky: little memory, two to three times faster for large compact solids.
    ConjugateGradients,
    /// Sparse Cholesky with nested dissection: exact, about twice as fast for large thin solids such as tires.
    SparseCholesky,
}

/// Unknowns up to which [`LinearSolver::Automatic`] factorises: both solvers then take about the same time
/// (`docs/performance.md`), and the direct one needs no tolerance.
pub const DIRECT_UNKNOWNS: usize = 10_000;

/// Iterations after which conjugate gradients have failed: sound matrices of 4e5 unknowns need some hundred.
const MOST_ITERATIONS: usize = 5_000;

/// How a static equilibrium was reached.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct StaticSummary {
    /// Linear systems solved.
    pub linear_solutions: usize,
    /// Iterations of conjugate gradients, over all systems.
    pub iterations: usize,
    /// Whether conjugate gradients failed and the slower sparse Cholesky took their place.
    pub has_fallen_back: bool,
}

/// How a static equilibrium is sought.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StaticOptions {
    /// Linear solver.
    pub solver: LinearSolver,
    /// Out-of-balance force over applied force at which to stop.
    pub tolerance: f64,
    /// Parts in which loads and prescribed displacements are brought on (formulations that are not linear).
    pub load_steps: usize,
    /// Most Newton iterations of one part.
    pub max_iterations: usize,
}

impl Default for StaticOptions {
    fn default() -> Self {
        Self { solver: LinearSolver::default(), tolerance: 1e-10, load_steps: 1, max_iterations: 30 }
    }
}

/// Why no static equilibrium was found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StaticError {
    /// The supports leave a rigid motion free.
    #[error(
        "the supports leave {free} of 6 rigid motions free: statics needs a solid that cannot move as a whole; hold the nodes of a surface, or hold components on symmetry planes"
    )]
    FreeRigidMotion {
        /// Number of free rigid motions.
        free: usize,
    },
    /// The linear solver failed.
    #[error(transparent)]
    Cholesky(#[from] CholeskyError),
    /// Conjugate gradients did not reach the tolerance.
    #[error(
        "conjugate gradients stopped at relative residual {residual:e} after {iterations} iterations: expected {tolerance:e}; the stiffness may be nearly singular (ν close to 0.5, slivers) – use the sparse Cholesky solver"
    )]
    NotConverged {
        /// Residual reached.
        residual: f64,
        /// Iterations made.
        iterations: usize,
        /// Residual asked for.
        tolerance: f64,
    },
    /// Newton's method did not converge.
    #[error(
        "no equilibrium at {fraction:.3} of the load: out-of-balance force {residual:e} of the applied after {iterations} iterations; use more load_steps, or the solid buckles or is overloaded"
    )]
    NoEquilibrium {
        /// Fraction of the load.
        fraction: f64,
        /// Relative out-of-balance force.
        residual: f64,
        /// Iterations made.
        iterations: usize,
    },
    /// An element turned inside out on the way.
    #[error(
        "element {element} is inverted (volume ratio {volume_ratio:.3}) at {fraction:.3} of the load: use more load_steps, or reduce the load"
    )]
    InvertedElement {
        /// Number of the element.
        element: u64,
        /// Its volume ratio J.
        volume_ratio: f64,
        /// Fraction of the load.
        fraction: f64,
    },
}

impl Solid {
    /// Brings displacements to equilibrium with all loads, applied forces and held nodes, and the velocities to zero.
    ///
    /// # Errors
    /// [`StaticError`]; the displacements are then those of the last iteration.
    pub fn solve_statics(&mut self, options: &StaticOptions) -> Result<StaticSummary, StaticError> {
        self.refuse_free_rigid_motion()?;
        let steps = if self.settings.formulation == Formulation::BodyAttached {
            1
        } else {
            options.load_steps.max(1)
        };
        let start: Vec<Vec3> = self.state.supports.values().map(|s| s.displacement).collect();
        let begin: Vec<Vec3> =
            self.state.supports.keys().map(|&n| self.state.displacement[n as usize]).collect();
        let mut summary = StaticSummary::default();
        for step in 1..=steps {
            let fraction = step as f64 / steps as f64;
            // Prescribed displacements grow with the load.
            let target: Vec<Vec3> = begin.iter().zip(&start).map(|(b, s)| b + (s - b) * fraction).collect();
            self.equilibrate(fraction, &target, options, &mut summary)?;
        }
        self.state.velocity.fill(Vec3::zeros());
        self.state.acceleration.fill(Vec3::zeros());
        self.is_started = false;
        Ok(summary)
    }

    fn equilibrate(
        &mut self,
        fraction: f64,
        target: &[Vec3],
        options: &StaticOptions,
        summary: &mut StaticSummary,
    ) -> Result<(), StaticError> {
        let n = self.mesh.nodes.len();
        let held = self.held_components();
        let is_linear = self.settings.formulation == Formulation::BodyAttached;
        let mut residual = f64::INFINITY;
        for iterations in 0..=options.max_iterations {
            let (out_of_balance, scale) = self.out_of_balance(fraction)?;
            // Held components still to be moved.
            let mut increment = vec![Vec3::zeros(); n];
            let mut largest_move = 0.0f64;
            for ((&node, support), target) in self.state.supports.iter().zip(target) {
                let missing = target - self.state.displacement[node as usize];
                for c in (0..3).filter(|&c| support.held[c]) {
                    increment[node as usize][c] = missing[c];
                    largest_move = largest_move.max(missing[c].abs());
                }
            }
            let free = |f: &[Vec3]| -> f64 {
                let sum: f64 = (0..n)
                    .flat_map(|i| (0..3).map(move |c| (i, c)))
                    .filter(|&(i, c)| !held[i][c])
                    .map(|(i, c)| f[i][c] * f[i][c])
                    .sum();
                sum.sqrt()
            };
            residual = if scale > 0.0 { free(&out_of_balance) / scale } else { 0.0 };
            if iterations > 0 && (is_linear || residual <= options.tolerance) {
                self.state.reaction = self.reactions_of(&out_of_balance);
                return Ok(());
            }
            let mut stiffness = self.tangent_stiffness(fraction);
            let moved = stiffness.hold(&held, &increment);
            let right_hand_side: Vec<Vec3> = (0..n)
                .map(|i| {
                    Vec3::from_fn(|c, _| moved[i][c] + if held[i][c] { 0.0 } else { out_of_balance[i][c] })
                })
                .collect();
            let mut step = vec![Vec3::zeros(); n];
            self.solve_linear(&stiffness, &right_hand_side, &mut step, options, summary)?;
            self.state.displacement.iter_mut().zip(&step).for_each(|(u, d)| *u += d);
        }
        Err(StaticError::NoEquilibrium { fraction, residual, iterations: options.max_iterations })
    }

    /// Whether more than half of the nodes lie on the boundary: small separators, a sparse Cholesky factor.
    fn is_thin(&self) -> bool {
        let facets = self.mesh.boundary().unwrap_or_default();
        let mut nodes: Vec<u32> = facets.into_iter().flat_map(|f| self.mesh.facet_nodes(f)).collect();
        nodes.sort_unstable();
        nodes.dedup();
        2 * nodes.len() > self.mesh.nodes.len()
    }

    /// One linear system by the solver asked for.
    fn solve_linear(
        &self,
        stiffness: &BlockMatrix,
        right_hand_side: &[Vec3],
        step: &mut [Vec3],
        options: &StaticOptions,
        summary: &mut StaticSummary,
    ) -> Result<(), StaticError> {
        summary.linear_solutions += 1;
        let is_direct = match options.solver {
            LinearSolver::Automatic => {
                3 * step.len() <= DIRECT_UNKNOWNS || summary.has_fallen_back || self.is_thin()
            }
            solver => solver == LinearSolver::SparseCholesky,
        };
        if !is_direct {
            match iterate(stiffness, right_hand_side, step, options.tolerance.min(1e-8), summary) {
                Ok(()) => return Ok(()),
                Err(failure) if options.solver == LinearSolver::ConjugateGradients => return Err(failure),
                Err(_) => summary.has_fallen_back = true,
            }
        }
        SparseCholesky::new(stiffness, &self.mesh.nodes)?.solve(right_hand_side, step);
        Ok(())
    }

    /// External plus internal forces [N], and the size of the forces that must balance.
    fn out_of_balance(&mut self, fraction: f64) -> Result<(Vec<Vec3>, f64), StaticError> {
        let n = self.mesh.nodes.len();
        let mut external = vec![Vec3::zeros(); n];
        self.add_external_forces(fraction, &mut external);
        let mut internal = vec![Vec3::zeros(); n];
        let displacement = &self.state.displacement;
        let forces = self.elements.update(displacement, None);
        forces.and_then(|_| self.elements.refuse_inversion(displacement)).map_err(|i| {
            let element = self.mesh.element_label(i.element);
            StaticError::InvertedElement { element, volume_ratio: i.volume_ratio, fraction }
        })?;
        let forces = self.elements.node_forces();
        internal.iter_mut().enumerate().for_each(|(i, f)| *f = forces.of(i));
        let norm = |f: &[Vec3]| f.iter().map(Vec3::norm_squared).sum::<f64>().sqrt();
        let scale = norm(&external).max(norm(&internal));
        Ok((external.iter().zip(&internal).map(|(e, i)| e + i).collect(), scale))
    }

    /// Forces that the supports exert [N]: minus what is out of balance on held components.
    pub(crate) fn reactions_of(&self, out_of_balance: &[Vec3]) -> Vec<Vec3> {
        self.state
            .supports
            .iter()
            .map(|(&n, s)| Vec3::from_fn(|c, _| if s.held[c] { -out_of_balance[n as usize][c] } else { 0.0 }))
            .collect()
    }

    /// Derivative of minus the forces by the displacements [N/m] at the present state (K of P0 Eq. 34, corrected).
    pub fn stiffness(&self) -> BlockMatrix {
        self.tangent_stiffness(1.0)
    }

    fn tangent_stiffness(&self, fraction: f64) -> BlockMatrix {
        let states =
            ElementStates::new(&self.mesh, &self.laws, &self.state.displacement, self.is_pressure_averaged());
        let slots = states.slot_gradients();
        let mut k = assemble(&states, &slots);
        if self.settings.formulation != Formulation::BodyAttached {
            // Centrifugal forces grow with the position: −m (ω × (ω × u)) = m (ω² − ω ωᵀ) u.
            let w = self.loads.spin.angular_velocity;
            let softening = w * w.transpose() - Matrix3::identity() * w.norm_squared();
            for (i, mass) in self.nodal_mass.iter().enumerate().filter(|_| w != Vec3::zeros()) {
                *k.block_mut(i, i) += softening * (fraction * mass);
            }
            for load in &self.loads.pressures {
                load.add_stiffness(&self.mesh, |n| self.position(n), fraction, &mut k);
            }
        }
        k
    }

    fn refuse_free_rigid_motion(&self) -> Result<(), StaticError> {
        let size = self.mesh.nodes.iter().map(Vec3::norm).fold(0.0, f64::max);
        let mut gram = DMatrix::<f64>::zeros(6, 6);
        for (&node, support) in &self.state.supports {
            let x = self.mesh.nodes[node as usize] / size;
            for c in (0..3).filter(|&c| support.held[c]) {
                let mut row = DMatrix::zeros(1, 6);
                row[c] = 1.0;
                (0..3).for_each(|k| row[3 + k] = Vec3::ith(k, 1.0).cross(&x)[c]);
                gram += row.transpose() * row;
            }
        }
        let eigenvalues = gram.symmetric_eigenvalues();
        let free = eigenvalues.iter().filter(|&&l| l <= 1e-9 * eigenvalues.max().max(1e-300)).count();
        if free > 0 { Err(StaticError::FreeRigidMotion { free }) } else { Ok(()) }
    }
}

/// Stiffness of all elements, and of the averaged nodal pressures that `slots` describe [N/m].
pub(crate) fn assemble(states: &ElementStates<'_>, slots: &[SlotGradient]) -> BlockMatrix {
    let mesh = states.mesh;
    let slot_nodes: Vec<Vec<u32>> =
        slots.iter().map(|s| s.entries.iter().map(|&(node, _)| node).collect()).collect();
    let elements = (0..mesh.n_elements()).map(|e| mesh.element(e));
    let groups = elements.chain(slot_nodes.iter().map(Vec::as_slice));
    let mut k = BlockMatrix::with_pattern(mesh.nodes.len(), groups);
    for e in 0..mesh.n_elements() {
        let element = states.stiffness(e);
        for (i, &a) in mesh.element(e).iter().enumerate() {
            for (j, &b) in mesh.element(e).iter().enumerate() {
                *k.block_mut(a as usize, b as usize) += element.fixed_view::<3, 3>(3 * i, 3 * j);
            }
        }
    }
    for slot in slots {
        for (a, ga) in &slot.entries {
            for (b, gb) in &slot.entries {
                *k.block_mut(*a as usize, *b as usize) += ga * gb.transpose() * slot.factor;
            }
        }
    }
    k
}

/// Conjugate gradients from zero.
fn iterate(
    stiffness: &BlockMatrix,
    right_hand_side: &[Vec3],
    step: &mut [Vec3],
    tolerance: f64,
    summary: &mut StaticSummary,
) -> Result<(), StaticError> {
    let broken = || CholeskyError::NotPositive("incomplete factorisation broke down".to_owned());
    let preconditioner = IncompleteCholesky::new(stiffness).ok_or_else(broken)?;
    step.fill(Vec3::zeros());
    let most = (20 * step.len() + 100).min(MOST_ITERATIONS);
    let end = conjugate_gradients::solve(stiffness, &preconditioner, right_hand_side, step, tolerance, most);
    summary.iterations += end.iterations;
    if end.relative_residual <= tolerance {
        return Ok(());
    }
    let (residual, iterations) = (end.relative_residual, end.iterations);
    Err(StaticError::NotConverged { residual, iterations, tolerance })
}
