//! Nodal forces of the elements' stresses: f_i = −∫ P ∇N_i dV (`docs/theory/elastic_solids.md`, steps 3 to 6).
//!
//! Blocks run in parallel, each into memory of its own; every node then adds its blocks' contributions in ascending order.
//! The order of all sums is fixed by the mesh: the same bits for any number of threads.

use grouser_geometry::{TetrahedralMesh, Vec3};
use rayon::prelude::*;

use crate::block_kernel::{self, Scratch, gather};
use crate::element_blocks::{Block, NodeGather};
use crate::elements::NodeForces;
use crate::law::Law;
use crate::nodal_average::NodalAverage;
use crate::number::LANES;
use crate::tensor::Tensor;
use crate::with_law;

/// Blocks with the memory that their results go to.
#[derive(Clone, Debug)]
pub(crate) struct BlockSet<const E: usize, const Q: usize> {
    blocks: Vec<Block<E, Q>>,
    /// Forces of the local nodes, block after block [N].
    forces: Vec<Vec3>,
    /// V θ of the local nodes, block after block [m³]; empty without averages.
    volume_changes: Vec<f64>,
    results: Vec<BlockResult>,
    gather: NodeGather,
    average: Option<NodalAverage>,
}

/// What a block leaves behind beside forces.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BlockResult {
    /// Smallest volume ratio J; NaN wins.
    pub smallest_ratio: f64,
    /// Power that the viscous stress dissipates [W].
    pub viscous_power: f64,
}

/// Viscous part: stiffness-proportional damping β [s] with the nodal velocities.
#[derive(Clone, Copy)]
pub(crate) struct Viscosity<'a> {
    pub velocity: &'a [Vec3],
    pub beta: f64,
}

/// Element whose volume ratio is not positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Inversion {
    pub element: usize,
    pub volume_ratio: f64,
}

impl<const E: usize, const Q: usize> BlockSet<E, Q> {
    pub fn new(mesh: &TetrahedralMesh, laws: &[Law], is_averaged: bool) -> Self {
        let blocks: Vec<Block<E, Q>> = Block::of_mesh(mesh, laws);
        let gather = NodeGather::new(mesh.nodes.len(), blocks.iter().map(|b| &b.nodes[..]));
        let mut average = is_averaged.then(|| NodalAverage::new(&blocks, laws));
        let n_places = gather.n_sources();
        let mut volume_changes = Vec::new();
        if let Some(average) = &mut average {
            volume_changes.resize(n_places, 0.0);
            let mut first_place = 0;
            for block in &blocks {
                let own = &mut volume_changes[first_place..first_place + block.nodes.len()];
                for group in &block.groups {
                    for lane in 0..LANES {
                        let quarter = group.weights[0].0[lane] / 4.0;
                        own[group.first[lane] as usize] += quarter;
                        group.others.iter().for_each(|o| own[o[lane] as usize] += quarter);
                    }
                }
                first_place += block.nodes.len();
            }
            average.set_volume(&volume_changes);
        }
        let results = vec![BlockResult { smallest_ratio: 1.0, viscous_power: 0.0 }; blocks.len()];
        Self { blocks, forces: vec![Vec3::zeros(); n_places], volume_changes, results, gather, average }
    }

    /// Internal forces of the displacements [m]; returns the power of the viscous stress [W].
    pub fn update(
        &mut self,
        displacement: &[Vec3],
        viscosity: Option<Viscosity<'_>>,
    ) -> Result<f64, Inversion> {
        let Self { blocks, forces, volume_changes, results, average, .. } = self;
        let is_parallel = is_worth_threads(blocks.len());
        if let Some(average) = average {
            let work = |_, block: &Block<E, Q>, changes: &mut [f64], scratch: &mut Scratch| {
                gather(&block.nodes, displacement, &mut scratch.displacement);
                with_law!(block.law, |law| block_kernel::volume_changes(law, block, scratch));
                changes.copy_from_slice(&scratch.scalar[..block.nodes.len()]);
            };
            for_each_block(blocks, split_by_block(blocks, volume_changes), work);
            average.update_pressure(volume_changes, is_parallel);
        }
        let average = average.as_ref();
        let work = |b: usize,
                    block: &Block<E, Q>,
                    (forces, result): (&mut [Vec3], &mut BlockResult),
                    scratch: &mut Scratch| {
            let n_local = block.nodes.len();
            gather(&block.nodes, displacement, &mut scratch.displacement);
            scratch.force[..n_local].fill([0.0; 4]);
            if let Some(average) = average {
                for (local, &slot) in average.slots[b].iter().enumerate() {
                    scratch.scalar[local] = average.pressure[slot as usize];
                }
            }
            let beta = viscosity.map_or(0.0, |v| v.beta);
            if let Some(viscosity) = viscosity {
                gather(&block.nodes, viscosity.velocity, &mut scratch.velocity);
            }
            let groups = &block.groups;
            *result = with_law!(block.law, |law| match (average.is_some(), viscosity.is_some()) {
                (false, false) => block_kernel::forces::<_, E, Q, false, false>(law, beta, groups, scratch),
                (false, true) => block_kernel::forces::<_, E, Q, false, true>(law, beta, groups, scratch),
                (true, false) => block_kernel::forces::<_, E, Q, true, false>(law, beta, groups, scratch),
                (true, true) => block_kernel::forces::<_, E, Q, true, true>(law, beta, groups, scratch),
            });
            for (f, s) in forces.iter_mut().zip(scratch.force.iter()) {
                *f = Vec3::new(s[0], s[1], s[2]);
            }
        };
        let parts = split_by_block(blocks, forces).into_iter().zip(results.iter_mut()).collect();
        for_each_block(blocks, parts, work);
        // Not "> 0" turned around: a NaN must count as inverted too.
        if let Some(b) = self.results.iter().position(|r| !(r.smallest_ratio > 0.0)) {
            return Err(self.find_inversion(b, displacement));
        }
        Ok(self.results.iter().map(|r| r.viscous_power).sum())
    }

    /// Forces of the last [`Self::update`].
    pub fn node_forces(&self) -> NodeForces<'_> {
        NodeForces::Gathered { gather: &self.gather, forces: &self.forces }
    }

    /// Number of (block, node) pairs: nodes counted once for each block that touches them.
    pub fn n_block_nodes(&self) -> usize {
        self.gather.n_sources()
    }

    /// Memory of the groups' constants [bytes].
    pub fn element_bytes(&self) -> usize {
        self.blocks.iter().map(|b| size_of_val(&b.groups[..])).sum()
    }

    /// Whether the solid is large enough for threads to pay.
    pub fn is_worth_threads(&self) -> bool {
        is_worth_threads(self.blocks.len())
    }

    /// Element of the smallest volume ratio of block `b`.
    fn find_inversion(&self, b: usize, displacement: &[Vec3]) -> Inversion {
        let block = &self.blocks[b];
        let u = |local: u16| displacement[block.nodes[local as usize] as usize];
        let mut worst = Inversion { element: 0, volume_ratio: f64::INFINITY };
        for (lane, &element) in block.elements.iter().enumerate() {
            let (group, lane) = (&block.groups[lane / LANES], lane % LANES);
            for gradients in &group.gradients {
                let mut h = Tensor::identity();
                for i in 0..E {
                    let d = u(group.others[i][lane]) - u(group.first[lane]);
                    h = h + Tensor::from_fn(|r, c| d[r] * gradients[i][c].0[lane]);
                }
                let volume_ratio = h.determinant();
                // The first NaN stays.
                if !worst.volume_ratio.is_nan() && !(volume_ratio >= worst.volume_ratio) {
                    worst = Inversion { element: element as usize, volume_ratio };
                }
            }
        }
        worst
    }
}

/// Starting threads costs more than a few blocks of work.
fn is_worth_threads(n_blocks: usize) -> bool {
    n_blocks >= 4
}

/// The parts of concatenated results that belong to the blocks.
fn split_by_block<'a, T, const E: usize, const Q: usize>(
    blocks: &[Block<E, Q>],
    mut all: &'a mut [T],
) -> Vec<&'a mut [T]> {
    let next = |block: &Block<E, Q>| {
        let (own, rest) = std::mem::take(&mut all).split_at_mut(block.nodes.len());
        all = rest;
        own
    };
    blocks.iter().map(next).collect()
}

fn for_each_block<T: Send, const E: usize, const Q: usize>(
    blocks: &[Block<E, Q>],
    outputs: Vec<T>,
    work: impl Fn(usize, &Block<E, Q>, T, &mut Scratch) + Sync + Send,
) {
    thread_local! {
        static SCRATCH: std::cell::RefCell<Scratch> = std::cell::RefCell::new(Scratch::new());
    }
    let run = |(b, (block, output)): (usize, (&Block<E, Q>, T))| {
        SCRATCH.with_borrow_mut(|scratch| work(b, block, output, scratch));
    };
    if is_worth_threads(blocks.len()) {
        blocks.par_iter().zip(outputs).enumerate().for_each(run);
    } else {
        blocks.iter().zip(outputs).enumerate().for_each(run);
    }
}
