//! What pairs remember, carried over from old lists to new ones.
//!
//! Grains are sorted anew with the lists. Pairs of the lowest size level that touched are taken one after the other and looked
//! for in the new lists; most of what is listed does not touch and is not looked for. Pairs of large grains, which are few, are
//! looked for in the old lists.

use crate::large_grains::LargeGrains;
use crate::slab::Slab;
use grouser_contact::{Memory, Real};
use rayon::prelude::*;

/// The old lists of the lowest size level and where their grains have gone.
pub(crate) struct OldLists<'a, T: Real, M> {
    slabs: &'a [Slab<T, M>],
    /// Old slab of each old grain.
    slab_of: Vec<u32>,
    /// Old number of each new grain.
    order: &'a [u32],
    /// New number of each old grain.
    place_of: Vec<u32>,
}

/// A grain that is not listed any more.
const NOWHERE: u32 = u32::MAX;

/// A pair listed by the other grain first than before: new numbers, and the memory seen from the first.
type Turned<M> = (u32, u32, M);

impl<'a, T: Real, M: Memory<T>> OldLists<'a, T, M> {
    /// `order[new]` is the old number of a grain, below `n_grains`.
    pub fn new(slabs: &'a [Slab<T, M>], order: &'a [u32], n_grains: usize) -> Self {
        let mut slab_of = Vec::with_capacity(slabs.iter().map(|slab| slab.n_grains as usize).sum());
        for (index, slab) in slabs.iter().enumerate() {
            slab_of.resize(slab_of.len() + slab.n_grains as usize, index as u32);
        }
        let mut place_of = vec![NOWHERE; n_grains];
        for (new, &old) in order.iter().enumerate() {
            place_of[old as usize] = new as u32;
        }
        Self { slabs, slab_of, order, place_of }
    }

    /// Fills the memory of new slabs that stand at the lowest level.
    pub fn carry_over(&self, slabs: &mut [Slab<T, M>]) {
        let turned: Vec<Vec<Turned<M>>> =
            slabs.par_iter_mut().map(|slab| self.carry_over_to_first_grains(slab)).collect();
        for (first, second, memory) in turned.into_iter().flatten() {
            let slab = slabs.partition_point(|slab| slab.grains().end <= first);
            let Some(slab) = slabs.get_mut(slab) else { continue };
            if let Some(place) = slab.find(first, second) {
                slab.remember(place, memory);
            }
        }
    }

    /// Fills the memory of pairs whose first grain has remained the first, and gives the others that the slab's grains were
    /// first in.
    fn carry_over_to_first_grains(&self, slab: &mut Slab<T, M>) -> Vec<Turned<M>> {
        let mut turned = Vec::new();
        for first in slab.grains() {
            let old_first = self.order[first as usize];
            let Some(&old_slab) = self.slab_of.get(old_first as usize) else { continue };
            let old = &self.slabs[old_slab as usize];
            for old_place in old.row(old_first).filter(|&place| old.has_touched(place)) {
                let second = self.place_of[old.pairs[old_place].grains()[1] as usize];
                let memory = old.memory[old_place];
                match slab.find(first, second) {
                    Some(place) => slab.remember(place, memory),
                    None if second == NOWHERE => {}
                    None => turned.push((second, first, memory.seen_from_the_other())),
                }
            }
        }
        turned
    }

    /// Fills the memory of new slabs of large grains.
    pub fn carry_over_large(&self, level: &mut LargeGrains<T, M>, before: &LargeGrains<T, M>) {
        level.slabs.par_iter_mut().for_each(|slab| {
            for place in 0..slab.pairs.len() {
                let [i, j] = slab.pairs[place].grains().map(|grain| self.order[grain as usize]);
                if let Some(memory) = before.recall(i, j) {
                    slab.remember(place, memory);
                }
            }
        });
    }

    /// What new grain `grain` remembers of plane `plane`, if it was listed there.
    pub fn plane_memory(&self, plane: usize, grain: u32) -> Option<M> {
        let old = self.order[grain as usize];
        let slab = &self.slabs[*self.slab_of.get(old as usize)? as usize];
        slab.planes.get(plane)?.memory_of(old)
    }
}

/// Fills the memory of pairs that have not touched in the old lists from `slept`, by new numbers.
pub(crate) fn wake<T: Real, M: Memory<T>>(slab: &mut Slab<T, M>, slept: impl Fn(u32, u32) -> Option<M>) {
    for place in 0..slab.pairs.len() {
        let [i, j] = slab.pairs[place].grains();
        if slab.has_touched(place) {
            continue;
        }
        if let Some(memory) = slept(i, j) {
            slab.remember(place, memory);
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::neighbours::Neighbours;
    use crate::{Domain, Grains};
    use grouser_contact::{F64, Sphere, Vector};
    use grouser_geometry::Vec3;
    use std::collections::HashSet;

    /// What a pair of grains with these permanent numbers remembers, seen from the first.
    fn memory(i: u32, j: u32) -> Vector<f64> {
        Vector::new(f64::from(i) - f64::from(j), 0.0, 0.0)
    }

    #[test]
    fn every_pair_that_touched_keeps_its_memory_and_no_other_gets_any() {
        let domain = Domain {
            lower: Vec3::zeros(),
            upper: Vec3::new(2.0, 1.0, 1.0),
            is_periodic: [true, true, false],
        };
        let number = |n: usize| (n as f64 * n as f64 * 0.618_034 + n as f64 * 0.291).fract();
        let spheres: Vec<Sphere> = (0..4000)
            .map(|n| Sphere {
                position: Vector::new(2.0 * number(n), number(7 * n + 3), number(31 * n + 5)),
                radius: if n % 100 == 0 { 0.12 } else { 0.03 },
                ..Sphere::default()
            })
            .collect();
        let mut grains = Grains::<F64>::new(spheres);
        let mut lists = Neighbours::<F64, Vector<f64>>::new(&grains);
        lists.rebuild(&mut grains, &domain, &[], None);
        let ids = grains.ids.clone();
        let mut touching = HashSet::new();
        let large = lists.large.iter_mut().flat_map(|level| &mut level.slabs);
        for slab in lists.slabs.iter_mut().chain(large) {
            for place in 0..slab.pairs.len() {
                let [i, j] = slab.pairs[place].grains().map(|grain| ids[grain as usize]);
                if (i + j) % 3 != 0 {
                    slab.remember(place, memory(i, j));
                    touching.insert([i, j]);
                }
            }
        }
        // Everybody crosses a good part of the bed and the border of the period, so that some pairs are listed the other way round.
        for sphere in &mut grains.spheres {
            sphere.position.x = (sphere.position.x + 0.77) % 2.0;
            sphere.position.y = (sphere.position.y + 0.31) % 1.0;
        }
        lists.rebuild(&mut grains, &domain, &[], None);
        let id = |grain: u32| grains.ids[grain as usize];
        let (mut n_kept, mut n_turned) = (0, 0);
        for slab in lists.all_slabs() {
            for place in 0..slab.pairs.len() {
                let [i, j] = slab.pairs[place].grains().map(id);
                let is_turned = touching.contains(&[j, i]);
                let is_kept = is_turned || touching.contains(&[i, j]);
                assert_eq!(slab.has_touched(place), is_kept, "grains {i} and {j}");
                let expected = if is_kept { memory(i, j) } else { Vector::ZERO };
                assert_eq!(slab.memory[place], expected, "grains {i} and {j}");
                n_kept += usize::from(is_kept);
                n_turned += usize::from(is_turned);
            }
        }
        assert!(lists.slabs.len() > 2 && !lists.large.is_empty() && n_turned > 100, "{n_turned} turned");
        assert_eq!(n_kept, touching.len(), "pairs that touched and are listed still");
    }
}
