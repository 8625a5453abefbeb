//! Verlet lists over the sorted bed, with a skin that tunes itself.

use crate::active_zone::Zone;
use crate::candidates::Candidates;
use crate::carry_over::{OldLists, wake};
use crate::cell_grid::CellGrid;
use crate::large_grains::{LargeGrains, lists_of_large_grains};
use crate::plane::{Plane, PlaneList};
use crate::size_levels::SizeLevels;
use crate::slab::{Slab, layers_of_slabs};
use crate::{Domain, Grains};
use grouser_contact::{Memory, Precision, Real, Vector};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Grains of a slab: few enough for the second-level cache, enough that the tasks outweigh their management.
const GRAINS_PER_SLAB: usize = 512;
/// Cost of a rebuild per grain, in units of one look at a pair in the force pass (measured, `docs/performance.md`).
const REBUILD_COST: f64 = 80.0;

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
    mean_radius: f64,
    /// Gap up to which a pair is listed [m].
    skin: f64,
    /// Upper bound of what any grain has moved since the lists were made [m].
    moved: f64,
    /// Positions at the last rebuild.
    reference: Vec<Vector<P::Coordinate>>,
    steps_since_rebuild: u32,
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
            mean_radius: radii.sum::<f64>() / grains.len() as f64,
            skin: 0.2 * grains.smallest_radius,
            moved: f64::INFINITY,
            reference: Vec::new(),
            steps_since_rebuild: 0,
            n_rebuilds: 0,
        }
    }

    /// The slabs of every level.
    pub fn all_slabs(&self) -> impl Iterator<Item = &Slab<P::Real, M>> {
        self.slabs.iter().chain(self.large.iter().flat_map(|level| &level.slabs))
    }

    /// Gap up to which a pair is listed [m].
    pub fn skin(&self) -> f64 {
        self.skin
    }

    /// Records that no grain moved further than `travel` [m] in this step, and says whether the lists are too old.
    /// The sum of travels is an upper bound; only when it is used up are the true displacements looked at.
    pub fn are_too_old(&mut self, grains: &Grains<P>, domain: &Domain, travel: f64) -> bool {
        self.steps_since_rebuild += 1;
        self.moved += travel;
        if self.moved < 0.5 * self.skin {
            return false;
        }
        if self.reference.is_empty() {
            return true;
        }
        let period = domain.period::<P::Coordinate>();
        let farthest =
            grains.spheres.iter().zip(&self.reference).fold(P::Coordinate::ZERO, |most, (sphere, &old)| {
                period.nearest(sphere.position - old).0.norm_squared().max(most)
            });
        self.moved = farthest.to_f64().sqrt();
        // Look again before half of what is left can be used up; a list about to expire is made anew at once.
        self.moved + travel >= 0.5 * self.skin
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
        self.tune_skin();
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
        let range = 2.0 * self.levels.largest(0) + self.skin;
        let mut grid = CellGrid::new(&grains.spheres[..n_listed], domain, range);
        let cells: Vec<u32> = grains.spheres[..n_listed].iter().map(|sphere| grid.cell_of(sphere)).collect();
        let mut order = grid.sort(&cells);
        grains.reorder(&order);
        let is_asleep: Vec<bool> = match &zone {
            None => Vec::new(),
            Some(zone) => order.iter().map(|&place| zone.is_asleep[place as usize]).collect(),
        };
        if !parted.is_empty() {
            order.iter_mut().for_each(|place| *place = parted[*place as usize]);
        }
        let [skin, largest] = [self.skin, self.levels.largest(0)].map(P::Coordinate::from_f64);
        let spheres = &grains.spheres[..n_listed];
        let candidates = Candidates::new(spheres, largest, domain.period());
        let mut slabs: Vec<Slab<P::Real, M>> = layers_of_slabs(&grid, GRAINS_PER_SLAB, 1)
            .into_par_iter()
            .map(|layers| Slab::build(&grid, layers, spheres, &candidates, skin, largest, &is_asleep))
            .collect();
        let mut large = lists_of_large_grains(&self.levels, &grid, spheres, domain, self.skin, &is_asleep);
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
                PlaneList::build(plane, moving, spheres, self.skin, remembered)
            };
            slab.planes = planes.iter().enumerate().map(list).collect();
        }
        self.slabs = slabs;
        self.large = large;
        self.is_ring = grid.is_slab_axis_periodic() && self.slabs.len() > 1;
        self.reference.clear();
        self.reference.extend(spheres.iter().map(|sphere| sphere.position));
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
        self.moved = 0.0;
        self.steps_since_rebuild = 0;
        self.n_rebuilds += 1;
    }

    /// Balances looks at pairs, which grow with the skin s like p₀ (1 + s/2r)³, against rebuilds, which come every
    /// s/(2u) steps when the fastest grain moves u a step: the least cost has p₀ 3/(2r) (1 + s/2r)² = 2 u B / s². Here r is
    /// the mean radius.
    fn tune_skin(&mut self) {
        if self.steps_since_rebuild == 0 || self.slabs.is_empty() {
            return;
        }
        let n_grains = self.reference.len() as f64;
        let diameter = 2.0 * self.mean_radius;
        let n_pairs: usize = self.all_slabs().map(|slab| slab.pairs.len()).sum();
        let pairs_without_skin = n_pairs as f64 / n_grains / (1.0 + self.skin / diameter).powi(3);
        let per_step = self.moved / f64::from(self.steps_since_rebuild);
        let mut skin = self.skin;
        for _ in 0..8 {
            let growth = 3.0 * pairs_without_skin.max(0.5) / diameter * (1.0 + skin / diameter).powi(2);
            skin = (2.0 * per_step * REBUILD_COST / growth).sqrt();
        }
        let gently = skin.clamp(0.5 * self.skin, 2.0 * self.skin);
        self.skin = gently.clamp(2e-3 * diameter, 0.5 * diameter);
    }

    /// Memory held by the lists [bytes].
    pub fn bytes(&self) -> usize {
        self.all_slabs().map(Slab::bytes).sum::<usize>()
            + size_of::<Vector<P::Coordinate>>() * self.reference.capacity()
    }
}
