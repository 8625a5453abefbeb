//! Nodal forces of the elements' stresses: f_i = −∫ P ∇N_i dV (`docs/theory/elastic_solids.md`, steps 3 to 6).
//!
//! Blocks run in parallel, each into memory of its own; then every node adds its blocks' contributions in ascending order.
//! The order of all sums is fixed by the mesh: the same bits for any number of threads.

use grouser_geometry::{ElementOrder, TetrahedralMesh, Vec3};
use rayon::prelude::*;

use crate::block_kernel::{Scratch, forces, gather, volume_changes};
use crate::element_blocks::{Block, NodeGather};
use crate::law::Law;
use crate::nodal_average::NodalAverage;
use crate::number::LANES;
use crate::tensor::Tensor;
use crate::with_law;

/// Elements of a solid, ready to give forces.
#[derive(Clone, Debug)]
pub(crate) enum Elements {
    Linear(BlockSet<3, 1>),
    Quadratic(BlockSet<9, 4>),
}

/// Blocks with the memory that their results go to.
#[derive(Clone, Debug)]
pub(crate) struct BlockSet<const E: usize, const Q: usize> {
    blocks: Vec<Block<E, Q>>,
    outputs: Vec<Output>,
    gather: NodeGather,
    average: Option<NodalAverage>,
}

/// What a block leaves behind: forces of its local nodes and its smallest volume ratio.
#[derive(Clone, Debug, Default)]
struct Output {
    forces: Vec<Vec3>,
    volume_changes: Vec<f64>,
    smallest_ratio: f64,
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

impl Elements {
    pub fn new(mesh: &TetrahedralMesh, laws: &[Law], is_averaged: bool) -> Self {
        match mesh.order {
            ElementOrder::Linear => Self::Linear(BlockSet::new(mesh, laws, is_averaged)),
            ElementOrder::Quadratic => Self::Quadratic(BlockSet::new(mesh, laws, false)),
        }
    }

    /// Number of (block, node) pairs: nodes counted once for each block that touches them.
    pub fn n_block_nodes(&self) -> usize {
        match self {
            Self::Linear(set) => set.gather.sources.len(),
            Self::Quadratic(set) => set.gather.sources.len(),
        }
    }

    /// Memory of the groups' constants [bytes].
    pub fn element_bytes(&self) -> usize {
        fn bytes<const E: usize, const Q: usize>(set: &BlockSet<E, Q>) -> usize {
            set.blocks.iter().map(|b| size_of_val(&b.groups[..])).sum()
        }
        match self {
            Self::Linear(set) => bytes(set),
            Self::Quadratic(set) => bytes(set),
        }
    }

    /// Adds the internal forces [N] of the displacements [m] to `force`.
    pub fn add_forces(
        &mut self,
        displacement: &[Vec3],
        viscosity: Option<Viscosity<'_>>,
        force: &mut [Vec3],
    ) -> Result<(), Inversion> {
        match self {
            Self::Linear(set) => set.add_forces(displacement, viscosity, force),
            Self::Quadratic(set) => set.add_forces(displacement, viscosity, force),
        }
    }
}

impl<const E: usize, const Q: usize> BlockSet<E, Q> {
    fn new(mesh: &TetrahedralMesh, laws: &[Law], is_averaged: bool) -> Self {
        let blocks: Vec<Block<E, Q>> = Block::of_mesh(mesh, laws);
        let outputs = blocks
            .iter()
            .map(|b| Output { forces: vec![Vec3::zeros(); b.nodes.len()], ..Default::default() })
            .collect();
        let gather = NodeGather::new(mesh.nodes.len(), blocks.iter().map(|b| &b.nodes[..]));
        let average = is_averaged.then(|| NodalAverage::new(&blocks, laws));
        let mut set = Self { blocks, outputs, gather, average };
        if let Some(average) = &mut set.average {
            for (block, output) in set.blocks.iter().zip(&mut set.outputs) {
                output.volume_changes = vec![0.0; block.nodes.len()];
                for group in &block.groups {
                    for lane in 0..LANES {
                        let quarter = group.weights[0].0[lane] / 4.0;
                        output.volume_changes[group.first[lane] as usize] += quarter;
                        group.others.iter().for_each(|o| output.volume_changes[o[lane] as usize] += quarter);
                    }
                }
            }
            average.set_volume(&volume_parts(&set.outputs));
        }
        set
    }

    fn add_forces(
        &mut self,
        displacement: &[Vec3],
        viscosity: Option<Viscosity<'_>>,
        force: &mut [Vec3],
    ) -> Result<(), Inversion> {
        if let Some(average) = &mut self.average {
            for_each_block(&self.blocks, &mut self.outputs, |_, block, output, scratch| {
                gather(&block.nodes, displacement, &mut scratch.displacement);
                with_law!(block.law, |law| volume_changes(law, block, scratch));
                output.volume_changes.copy_from_slice(&scratch.scalar[..block.nodes.len()]);
            });
            average.update_pressure(&volume_parts(&self.outputs));
        }
        let average = self.average.as_ref();
        for_each_block(&self.blocks, &mut self.outputs, |b, block, output, scratch| {
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
            output.smallest_ratio =
                with_law!(block.law, |law| match (average.is_some(), viscosity.is_some()) {
                    (false, false) => forces::<_, E, Q, false, false>(law, beta, &block.groups, scratch),
                    (false, true) => forces::<_, E, Q, false, true>(law, beta, &block.groups, scratch),
                    (true, false) => forces::<_, E, Q, true, false>(law, beta, &block.groups, scratch),
                    (true, true) => forces::<_, E, Q, true, true>(law, beta, &block.groups, scratch),
                });
            for (f, s) in output.forces.iter_mut().zip(scratch.force.iter()) {
                *f = Vec3::new(s[0], s[1], s[2]);
            }
        });
        // Not "> 0" turned around: a NaN must count as inverted too.
        if let Some(b) = self.outputs.iter().position(|o| !(o.smallest_ratio > 0.0)) {
            return Err(self.find_inversion(b, displacement));
        }
        let (gather, outputs) = (&self.gather, &self.outputs);
        let sum = |(n, f): (usize, &mut Vec3)| {
            for &(block, local) in gather.of(n) {
                *f += outputs[block as usize].forces[local as usize];
            }
        };
        if is_worth_threads(self.blocks.len()) {
            force.par_iter_mut().with_min_len(4096).enumerate().for_each(sum);
        } else {
            force.iter_mut().enumerate().for_each(sum);
        }
        Ok(())
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

fn volume_parts(outputs: &[Output]) -> Vec<&[f64]> {
    outputs.iter().map(|o| &o.volume_changes[..]).collect()
}

/// Starting threads costs more than a few blocks of work.
pub(crate) fn is_worth_threads(n_blocks: usize) -> bool {
    n_blocks >= 4
}

fn for_each_block<const E: usize, const Q: usize>(
    blocks: &[Block<E, Q>],
    outputs: &mut [Output],
    work: impl Fn(usize, &Block<E, Q>, &mut Output, &mut Scratch) + Sync + Send,
) {
    thread_local! {
        static SCRATCH: std::cell::RefCell<Scratch> = std::cell::RefCell::new(Scratch::new());
    }
    let run = |(b, (block, output)): (usize, (&Block<E, Q>, &mut Output))| {
        SCRATCH.with_borrow_mut(|scratch| work(b, block, output, scratch));
    };
    if is_worth_threads(blocks.len()) {
        blocks.par_iter().zip(outputs.par_iter_mut()).enumerate().for_each(run);
    } else {
        blocks.iter().zip(outputs.iter_mut()).enumerate().for_each(run);
    }
}
