//! Which of the grains of a few cells are near a given one: eight of them at a time.

use crate::domain::Period;
use crate::force_pass::InstructionSet;
use crate::leeway::{Leeways, nearest_on_the_way};
use crate::slab::Pair;
use grouser_contact::{Precision, Real, Sphere, Vector};
use std::ops::Range;

/// Candidates that are looked at together.
const GROUP: usize = 8;
/// Pairs that are kept before they are appended to the list.
const MOST_LAST: usize = 128;

/// Places and radii of all grains, one array each, with the room of a group behind the last. Grains that are nobody's
/// candidates are nowhere (NaN).
pub(crate) struct Candidates<C> {
    x: Vec<C>,
    y: Vec<C>,
    z: Vec<C>,
    /// Radius and leeway [m].
    reach: Vec<C>,
    /// How far each drifts along x, y and z [m]; empty where nobody does.
    drift: [Vec<C>; 3],
    period: Period<C>,
    set: InstructionSet,
}

/// A grain whose partners are sought.
pub(crate) struct Seeker<C> {
    pub grain: u32,
    pub position: Vector<C>,
    /// Its radius and leeway [m].
    pub reach: C,
    /// How far it drifts [m].
    pub drift: Vector<C>,
}

/// Pairs that have been found, the last ones in a row of fixed length: a list that may grow would be asked at each.
pub(crate) struct Found {
    pairs: Vec<Pair>,
    last: [Pair; MOST_LAST],
    n_last: usize,
}

impl Found {
    /// None.
    pub fn none() -> Self {
        Self { pairs: Vec::new(), last: [Pair::new(0, 0, 0); MOST_LAST], n_last: 0 }
    }

    /// All of them.
    pub fn pairs(&mut self) -> &mut Vec<Pair> {
        self.pairs.extend_from_slice(&self.last[..self.n_last]);
        self.n_last = 0;
        &mut self.pairs
    }
}

impl<C: Real> Candidates<C> {
    /// All `spheres`, of which those larger than `largest` [m] are not candidates.
    pub fn new<P: Precision<Coordinate = C>>(
        spheres: &[Sphere<P>],
        leeways: &Leeways<C>,
        largest: C,
        period: Period<C>,
    ) -> Self {
        let nowhere = C::from_f64(f64::NAN);
        let column = |component: fn(&Sphere<P>) -> C| {
            let padding = std::iter::repeat_n(nowhere, GROUP);
            spheres.iter().map(component).chain(padding).collect::<Vec<C>>()
        };
        let mut reach = column(|sphere| sphere.radius);
        for (grain, reach) in reach.iter_mut().take(spheres.len()).enumerate() {
            *reach += leeways.of(grain);
        }
        let mut drift = [Vec::new(), Vec::new(), Vec::new()];
        if leeways.some_drift() {
            for (axis, drift) in drift.iter_mut().enumerate() {
                let drifts = (0..spheres.len()).map(|grain| leeways.drift_of(grain).to_array()[axis]);
                drift.extend(drifts.chain(std::iter::repeat_n(nowhere, GROUP)));
            }
        }
        let mut x = column(|sphere| sphere.position.x);
        for (x, _) in x.iter_mut().zip(spheres).filter(|(_, sphere)| sphere.radius > largest) {
            *x = nowhere;
        }
        let (y, z) = (column(|sphere| sphere.position.y), column(|sphere| sphere.position.z));
        Self { x, y, z, reach, drift, period, set: InstructionSet::detect() }
    }

    /// A grain as a seeker.
    pub fn seeker(&self, grain: u32) -> Seeker<C> {
        let place = grain as usize;
        let along = |axis: usize| self.drift[axis].get(place).copied().unwrap_or(C::ZERO);
        Seeker {
            grain,
            position: Vector::new(self.x[place], self.y[place], self.z[place]),
            reach: self.reach[place],
            drift: Vector::new(along(0), along(1), along(2)),
        }
    }

    /// Adds those grains of `range` to `found` that may come to touch `seeker`.
    pub fn look(&self, seeker: &Seeker<C>, range: Range<u32>, found: &mut Found) {
        match self.set {
            InstructionSet::Baseline => self.look_at_all(seeker, range, found),
            // SAFETY: `detect` found the instructions on this machine.
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx2 => unsafe { self.look_avx2(seeker, range, found) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx512 => unsafe { self.look_avx512(seeker, range, found) },
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn look_avx2(&self, seeker: &Seeker<C>, range: Range<u32>, found: &mut Found) {
        self.look_at_all(seeker, range, found);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,avx512f,avx512dq,avx512vl")]
    fn look_avx512(&self, seeker: &Seeker<C>, range: Range<u32>, found: &mut Found) {
        self.look_at_all(seeker, range, found);
    }

    #[inline(always)]
    fn look_at_all(&self, seeker: &Seeker<C>, range: Range<u32>, found: &mut Found) {
        if self.drift[0].is_empty() {
            self.look_at_groups::<false>(seeker, range, found);
        } else {
            self.look_at_groups::<true>(seeker, range, found);
        }
    }

    #[inline(always)]
    fn look_at_groups<const DRIFTS: bool>(&self, seeker: &Seeker<C>, range: Range<u32>, found: &mut Found) {
        let mut from = range.start as usize;
        let end = range.end as usize;
        while from < end {
            if found.n_last > MOST_LAST - GROUP {
                found.pairs();
            }
            let group = from..from + GROUP;
            let (x, y) = (&self.x[group.clone()], &self.y[group.clone()]);
            let (z, reach) = (&self.z[group.clone()], &self.reach[group.clone()]);
            let [dx, dy, dz] = &self.drift;
            let none: &[C] = &[];
            let drift =
                if DRIFTS { [&dx[group.clone()], &dy[group.clone()], &dz[group.clone()]] } else { [none; 3] };
            let (mut room, mut image) = ([C::ZERO; GROUP], [0_u32; GROUP]);
            for k in 0..GROUP {
                let reach = seeker.reach + reach[k];
                let (difference, its_image) =
                    self.period.nearest(seeker.position - Vector::new(x[k], y[k], z[k]));
                let distance_squared = if DRIFTS {
                    let drift = Vector::new(drift[0][k], drift[1][k], drift[2][k]);
                    nearest_on_the_way(difference, seeker.drift - drift)
                } else {
                    difference.norm_squared()
                };
                room[k] = distance_squared - reach * reach;
                image[k] = its_image;
            }
            // A candidate is written down in any case and counted if it is near: no branch that would be guessed wrong.
            let n = (end - from).min(GROUP);
            for k in 0..GROUP {
                found.last[found.n_last % MOST_LAST] = Pair::new(seeker.grain, (from + k) as u32, image[k]);
                found.n_last += usize::from((k < n) & (room[k] < C::ZERO));
            }
            from += GROUP;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Domain;
    use grouser_contact::{F32, F64, Mixed};
    use grouser_geometry::Vec3;

    fn near_grains_are_those_of_a_plain_search<P: Precision>(drift: bool) {
        let domain = Domain {
            lower: Vec3::zeros(),
            upper: Vec3::new(1.0, 1.0, 2.0),
            is_periodic: [true, true, false],
        };
        let number = |n: usize| (n as f64 * n as f64 * 0.618_034 + n as f64 * 0.291).fract();
        let coordinate = P::Coordinate::from_f64;
        let spheres: Vec<Sphere<P>> = (0..600)
            .map(|n| {
                let place = [number(n), number(7 * n + 3), 2.0 * number(31 * n + 5)].map(coordinate);
                let radius = coordinate(0.05 + 0.05 * number(11 * n));
                let velocity = Vector::new(5.0 * number(3 * n), 2.0, number(5 * n)).cast();
                Sphere { position: place.into(), radius, velocity, ..Sphere::default() }
            })
            .collect();
        let (largest, period) = (coordinate(0.09), domain.period());
        let mut leeways = Leeways::new(0.15, 0.01);
        for _ in 0..2 {
            leeways.plan(&spheres, &period, 2000);
            leeways.foresee(&spheres, &domain, 0.2, drift);
            leeways.reorder(&spheres, &(0..600).collect::<Vec<u32>>());
            leeways.are_used_up(&spheres, &period, 0.0, 1e-3);
        }
        assert_eq!(leeways.some_drift(), drift);
        let all = (0..600).map(|grain| leeways.of(grain).to_f64());
        assert!(all.clone().fold(0.0, f64::max) > 1.2 * all.fold(1.0, f64::min), "leeways differ");
        let mut candidates = Candidates::new(&spheres, &leeways, largest, period);
        let mut expected = Vec::new();
        for (i, sphere) in spheres.iter().enumerate().filter(|(_, sphere)| sphere.radius <= largest) {
            for (j, other) in spheres.iter().enumerate().skip(i + 1) {
                let (difference, image) = period.nearest(sphere.position - other.position);
                let reach = (sphere.radius + leeways.of(i)) + (other.radius + leeways.of(j));
                let apart = nearest_on_the_way(difference, leeways.drift_of(i) - leeways.drift_of(j));
                if apart < reach * reach && other.radius <= largest {
                    expected.push(Pair::new(i as u32, j as u32, image));
                }
            }
        }
        assert!(expected.len() > 500 && expected.iter().any(|pair| pair.image() != 13));
        for set in [InstructionSet::Baseline, InstructionSet::detect()] {
            candidates.set = set;
            let mut found = Found::none();
            for i in (0..600).filter(|&i| spheres[i].radius <= largest) {
                let seeker = candidates.seeker(i as u32);
                let (from, middle) = (i as u32 + 1, (i as u32 + 300).min(600));
                candidates.look(&seeker, from..middle, &mut found);
                candidates.look(&seeker, middle.max(from)..600, &mut found);
            }
            assert_eq!(found.pairs(), &expected, "{set:?}");
        }
    }

    #[test]
    fn every_precision_and_instruction_set_finds_the_grains_of_a_plain_search() {
        near_grains_are_those_of_a_plain_search::<F64>(false);
        near_grains_are_those_of_a_plain_search::<F64>(true);
        near_grains_are_those_of_a_plain_search::<Mixed>(false);
        near_grains_are_those_of_a_plain_search::<Mixed>(true);
        near_grains_are_those_of_a_plain_search::<F32>(false);
        near_grains_are_those_of_a_plain_search::<F32>(true);
    }
}
