//! Verlet lists over the sorted bed; how long they hold is told by the leeways of the grains.

use crate::active_zone::Zone;
use crate::candidates::Candidates;
use crate::carry_over::{OldLists, wake};
use crate::cell_grid::CellGrid;
use crate::large_grains::{LargeGrains, lists_of_large_grains};
use crate::leeway::Leeways;
use crate::plane::{Plane, PlaneList};
use crate::size_levels::SizeLevels;
use crate::slab::{Slab, layers_of_slabs};
use crate::{Domain, Grains};
use grouser_contact::{Memory, Precision, Real};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Grains of a slab: few enough for the second-level cache, enough that the tasks outweigh their management.
const GRAINS_PER_SLAB: usize = 512;
/// Leeway of grains until the first lists have been used, over the smallest radius [-].
const FIRST_LEEWAY: f64 = 0.1;

/// The lists and the record of when they were made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "M: Memory<P::Real>")]
pub(crate) struct Neighbours<P: Precision, M> {
    /// Pairs of the lowest size level: all of them where sizes differ little.
    pub slabs: Vec<Slab<P::Real, M>>,
    /// The last slab's pairs end in the first one.
    pub is_ring: bool,
    /// Pairs of each level above; the larger grain of a pair decides.
    pub large: Vec<LargeGrains<P::Real, M>>,
    levels: SizeLevels,
    /// How far each grain may go before the lists are made anew.
    leeways: Leeways<P::Coordinate>,
    /// How often the lists were made.
    pub n_rebuilds: u64,
}

impl<P: Precision, M: Memory<P::Real>> Neighbours<P, M> {
    /// No lists yet; the first look makes them.
    pub fn new(grains: &Grains<P>) -> Self {
        let radii = grains.spheres.iter().map(|sphere| sphere.radius.to_f64());
        Self {
            slabs: Vec::new(),
            is_ring: false,
            large: Vec::new(),
            levels: SizeLevels::new(&grains.spheres),
            leeways: Leeways::new(
                2.0 * radii.sum::<f64>() / grains.len() as f64,
                FIRST_LEEWAY * grains.smallest_radius,
            ),
            n_rebuilds: 0,
        }
    }

    /// The slabs of every level.
    pub fn all_slabs(&self) -> impl Iterator<Item = &Slab<P::Real, M>> {
        self.slabs.iter().chain(self.large.iter().flat_map(|level| &level.slabs))
    }

    /// Mean gap up to which a pair is listed [m].
    pub fn skin(&self) -> f64 {
        self.leeways.skin()
    }

    /// Records that no grain moved further than `travel` [m] in this step of `time_step` [s], and says whether the lists are too old.
    pub fn are_too_old(&mut self, grains: &Grains<P>, domain: &Domain, travel: f64, time_step: f64) -> bool {
        self.leeways.are_used_up(&grains.spheres, &domain.period(), travel, time_step)
    }

    /// Sorts the grains and makes the lists anew; every touching pair keeps its memory. Grains that sleep far from anybody
    /// awake are not listed.
    pub fn rebuild(
        &mut self,
        grains: &mut Grains<P>,
        domain: &Domain,
        planes: &[Plane],
        zone: Option<&mut Zone<M>>,
    ) {
        let n_pairs: usize = self.all_slabs().map(|slab| slab.pairs.len()).sum();
        self.leeways.plan(&grains.spheres, &domain.period(), n_pairs);
        match zone {
            None => self.sort_and_list(grains, domain, planes, None, Vec::new()),
            Some(zone) if !zone.has_changed => {
                self.sort_and_list(grains, domain, planes, Some(zone), Vec::new());
            }
            Some(zone) => {
                let order = self.part(grains, zone);
                self.sort_and_list(grains, domain, planes, Some(zone), order);
            }
        }
    }

    /// Parts the grains into those to be listed and those that sleep far from anybody awake; gives the order.
    fn part(&self, grains: &mut Grains<P>, zone: &mut Zone<M>) -> Vec<u32> {
        let is_asleep = zone.fall_asleep_and_wake(grains);
        zone.sleepers.take(&self.all_slabs().collect::<Vec<_>>(), &grains.ids, &is_asleep);
        let is_listed = zone.to_be_listed(grains, &is_asleep);
        let (mut order, far): (Vec<u32>, Vec<u32>) =
            (0..grains.len() as u32).partition(|&place| is_listed[place as usize]);
        zone.is_asleep = order.iter().map(|&place| is_asleep[place as usize]).collect();
        order.extend(far);
        grains.reorder(&order);
        order
    }

    /// Sorts listed grains and makes the lists. `parted` is the order in which grains have just been parted, or nothing.
    fn sort_and_list(
        &mut self,
        grains: &mut Grains<P>,
        domain: &Domain,
        planes: &[Plane],
        zone: Option<&mut Zone<M>>,
        parted: Vec<u32>,
    ) {
        let n_listed = zone.as_ref().map_or(grains.len(), |zone| zone.n_listed());
        let widest = 2.0 * self.levels.largest(self.levels.n() - 1);
        self.leeways.foresee(&grains.spheres[..n_listed], domain, widest, zone.is_none());
        let range = 2.0 * self.levels.largest(0) + self.leeways.widest_gap();
        let mut grid = CellGrid::new(&grains.spheres[..n_listed], domain, range);
        let cells: Vec<u32> = grains.spheres[..n_listed].iter().map(|sphere| grid.cell_of(sphere)).collect();
        let mut order = grid.sort(&cells);
        grains.reorder(&order);
        self.leeways.reorder(&grains.spheres[..n_listed], &order);
        let is_asleep: Vec<bool> = match &zone {
            None => Vec::new(),
            Some(zone) => order.iter().map(|&place| zone.is_asleep[place as usize]).collect(),
        };
        if !parted.is_empty() {
            order.iter_mut().for_each(|place| *place = parted[*place as usize]);
        }
        let largest = P::Coordinate::from_f64(self.levels.largest(0));
        let spheres = &grains.spheres[..n_listed];
        let leeways = &self.leeways;
        let candidates = Candidates::new(spheres, leeways, largest, domain.period());
        let mut slabs: Vec<Slab<P::Real, M>> = layers_of_slabs(&grid, GRAINS_PER_SLAB, 1)
            .into_par_iter()
            .map(|layers| Slab::build(&grid, layers, spheres, &candidates, largest, &is_asleep))
            .collect();
        let mut large = lists_of_large_grains(&self.levels, &grid, spheres, domain, leeways, &is_asleep);
        // Memory comes from the old lists, or from those who slept.
        let old = OldLists::new(&self.slabs, &order, grains.len());
        let slept = zone.as_ref().filter(|_| !parted.is_empty()).map(|zone| &zone.sleepers);
        old.carry_over(&mut slabs);
        for (level, before) in large.iter_mut().zip(&self.large) {
            old.carry_over_large(level, before);
        }
        if let Some(slept) = slept {
            let ids = &grains.ids;
            let of_sleepers = |i: u32, j: u32| slept.recall(ids[i as usize], ids[j as usize]);
            let all = slabs.iter_mut().chain(large.iter_mut().flat_map(|level| &mut level.slabs));
            all.par_bridge().for_each(|slab| wake(slab, of_sleepers));
        }
        for slab in &mut slabs {
            let list = |(index, plane)| {
                let remembered = |grain: u32| {
                    let old = old.plane_memory(index, grain);
                    old.or_else(|| slept?.recall_plane(index, grains.ids[grain as usize])).unwrap_or_default()
                };
                let moving = slab.grains().filter(|&grain| is_asleep.get(grain as usize) != Some(&true));
                PlaneList::build(plane, moving, spheres, leeways, remembered)
            };
            slab.planes = planes.iter().enumerate().map(list).collect();
        }
        self.slabs = slabs;
        self.large = large;
        self.is_ring = grid.is_slab_axis_periodic() && self.slabs.len() > 1;
        if let Some(zone) = zone {
            if !parted.is_empty() {
                let mut sleeps = vec![true; grains.len()];
                for place in (0..n_listed).filter(|&place| !is_asleep[place]) {
                    sleeps[grains.ids[place] as usize] = false;
                }
                zone.sleepers.forget_awake(&sleeps);
            }
            zone.is_asleep = is_asleep;
            let slabs = self.slabs.iter().map(Slab::grains);
            let pairs = self.all_slabs().flat_map(|slab| slab.pairs.iter().map(|pair| pair.grains()));
            zone.number_anew(slabs, pairs, grains);
        }
        self.n_rebuilds += 1;
    }

    /// Memory held by the lists [bytes].
    pub fn bytes(&self) -> usize {
        self.all_slabs().map(Slab::bytes).sum::<usize>() + self.leeways.bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cell_grid::to_f64;
    use grouser_contact::{F32, F64, Sphere, Vector};
    use grouser_geometry::Vec3;
    use std::collections::HashSet;

    const TIME_STEP: f64 = 2e-4;
    const RADIUS: f64 = 0.03;

    /// A number in [0, 1) that looks random.
    fn number(n: usize) -> f64 {
        (n as f64 * n as f64 * 0.618_034 + n as f64 * 0.291).fract()
    }

    /// Velocity [m/s] of grain `id` at `place` in step `step`: sheared flow that falls in one neighbourhood and rises in others, some fast
    /// beside it who turn back without warning; the flow turns back in step 150.
    fn velocity(id: usize, place: Vec3, step: usize) -> Vec3 {
        let own = Vec3::new(number(3 * id), number(5 * id), number(7 * id)) * 2.0 - Vec3::repeat(1.0);
        let is_fast = id.is_multiple_of(50);
        let own = own
            * if !is_fast {
                0.1
            } else if (step / 45).is_multiple_of(2) {
                0.7
            } else {
                -0.7
            };
        let flow = Vec3::new(3.0 + place.z, 0.0, if place.y < 0.55 { -1.0 } else { 1.0 });
        own + if step < 150 { flow } else { -flow }
    }

    /// Small grains and some larger ones in the flow of [`velocity`], for 300 steps: whoever touches is listed. Lists are made less often
    /// than if balls stayed, of the largest leeway for everybody.
    fn lists_hold_until_they_are_made_anew<P: Precision>() {
        let upper = Vec3::new(1.6, 1.1, 1.1);
        let domain = Domain { lower: Vec3::zeros(), upper, is_periodic: [true, true, false] };
        let floor = Plane { point: Vec3::zeros(), normal: Vec3::z(), material: 0 };
        let coordinate = P::Coordinate::from_f64;
        let sphere = |n: usize| Sphere {
            position: [1.6 * number(n), 1.1 * number(7 * n + 3), 1.1 * number(31 * n + 5)]
                .map(coordinate)
                .into(),
            radius: coordinate(if n.is_multiple_of(15) { 2.1 * RADIUS } else { RADIUS }),
            ..Sphere::<P>::default()
        };
        let mut grains = Grains::<P>::new((0..3000).map(sphere).collect());
        let mut lists = Neighbours::<P, Vector<P::Real>>::new(&grains);
        let period = domain.period::<P::Coordinate>();
        let (mut way_since, mut n_if_balls_stayed, mut n_touching) = (0.0, 0, 0);
        for step in 0..300 {
            let mut travel = 0.0_f64;
            for (sphere, &id) in grains.spheres.iter_mut().zip(&grains.ids) {
                let velocity = velocity(id as usize, to_f64(sphere), step);
                let way = velocity * TIME_STEP;
                sphere.velocity = Vector::new(velocity.x, velocity.y, velocity.z).cast();
                sphere.position += Vector::new(way.x, way.y, way.z).cast();
                travel = travel.max(way.norm());
            }
            way_since += travel;
            if way_since > 0.5 * RADIUS {
                (way_since, n_if_balls_stayed) = (0.0, n_if_balls_stayed + 1);
            }
            if lists.are_too_old(&grains, &domain, 1.001 * travel, TIME_STEP) {
                let n_grains = grains.len();
                grains.wrap(&domain, n_grains);
                lists.rebuild(&mut grains, &domain, &[floor], None);
            }
            let pairs = lists.all_slabs().flat_map(|slab| &slab.pairs);
            let listed: HashSet<[u32; 2]> = pairs.map(|pair| pair.grains()).collect();
            let near_floor = lists.slabs.iter().flat_map(|slab| &slab.planes[0].grains);
            let near_floor: HashSet<u32> = near_floor.copied().collect();
            if step % 5 > 0 {
                continue;
            }
            for (i, a) in (0..).zip(&grains.spheres) {
                let is_on_floor = a.position.z < a.radius;
                assert!(!is_on_floor || near_floor.contains(&i), "grain {i} and the floor in step {step}");
                for (j, b) in (0..).zip(&grains.spheres).skip(i as usize + 1) {
                    if period.nearest(a.position - b.position).0.norm() < a.radius + b.radius {
                        let is_listed = listed.contains(&[i, j]) || listed.contains(&[j, i]);
                        assert!(is_listed, "grains {i} and {j} in step {step}");
                        n_touching += 1;
                    }
                }
            }
        }
        assert!(n_touching > 10_000 && !lists.large.is_empty(), "{n_touching} touching");
        let n_lists = lists.n_rebuilds;
        assert!(n_lists * 4 < n_if_balls_stayed * 3, "{n_lists} lists, {n_if_balls_stayed} if balls stayed");
    }

    #[test]
    fn lists_of_every_precision_hold_until_they_are_made_anew() {
        lists_hold_until_they_are_made_anew::<F64>();
        lists_hold_until_they_are_made_anew::<F32>();
    }
}
