//! Linear tetrahedra that do not lock: the pressure comes from volume changes averaged around the nodes
//! (Bonet & Burton 1998, Commun. Numer. Meth. Engng 14, 437).

use rayon::prelude::*;

use crate::element_blocks::{Block, NodeGather};
use crate::law::{ElasticLaw, Law};
use crate::with_law;

/// Volume change averaged over the elements around each node, for linear tetrahedra that do not lock.
#[derive(Clone, Debug)]
pub(crate) struct NodalAverage {
    /// Quarter of the volume of the adjoining elements of one region [m³], by block and local node order of `slots`.
    pub node_volume: Vec<f64>,
    /// Nodal pressure U'(θ) [Pa].
    pub pressure: Vec<f64>,
    /// Region of each slot.
    slot_law: Vec<Law>,
    /// Slot of each local node of each block: nodes between two materials have one slot for each.
    pub slots: Vec<Vec<u32>>,
    gather: NodeGather,
}

impl NodalAverage {
    /// Slots of the nodes of all blocks; `laws` by region.
    pub fn new<const E: usize, const Q: usize>(blocks: &[Block<E, Q>], laws: &[Law]) -> Self {
        // A slot for each (region, node): pressures of two materials are not averaged with each other.
        let mut pairs: Vec<(u32, u32)> =
            blocks.iter().flat_map(|b| b.nodes.iter().map(|&n| (b.region, n))).collect();
        pairs.sort_unstable();
        pairs.dedup();
        let slot = |region: u32, node: u32| pairs.partition_point(|&p| p < (region, node)) as u32;
        let slots: Vec<Vec<u32>> =
            blocks.iter().map(|b| b.nodes.iter().map(|&n| slot(b.region, n)).collect()).collect();
        let slot_law = pairs.iter().map(|&(region, _)| laws[region as usize]).collect();
        let gather = NodeGather::new(pairs.len(), slots.iter().map(|s| &s[..]));
        Self { node_volume: Vec::new(), pressure: vec![0.0; pairs.len()], slot_law, slots, gather }
    }

    /// Sets the volumes of the slots from the quarters of their elements' volumes, block after block.
    pub fn set_volume(&mut self, parts: &[f64]) {
        self.node_volume = (0..self.slot_law.len()).map(|slot| sum_of(&self.gather, parts, slot)).collect();
    }

    /// Pressure of each slot from its blocks' V θ.
    pub fn update_pressure(&mut self, parts: &[f64], is_parallel: bool) {
        let (gather, volume, law) = (&self.gather, &self.node_volume, &self.slot_law);
        let update = |(slot, pressure): (usize, &mut f64)| {
            let change = sum_of(gather, parts, slot) / volume[slot];
            *pressure = with_law!(law[slot], |l| l.pressure(change));
        };
        if is_parallel {
            self.pressure.par_iter_mut().with_min_len(4096).enumerate().for_each(update);
        } else {
            self.pressure.iter_mut().enumerate().for_each(update);
        }
    }
}

#[inline]
fn sum_of(gather: &NodeGather, parts: &[f64], slot: usize) -> f64 {
    gather.of(slot).iter().map(|&place| parts[place as usize]).sum()
}
