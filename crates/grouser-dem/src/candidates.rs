//! Which of the grains of a few cells are near a given one: eight of them at a time.

use crate::domain::Period;
use crate::force_pass::InstructionSet;
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
    radius: Vec<C>,
    period: Period<C>,
    set: InstructionSet,
}

/// A grain whose partners are sought.
pub(crate) struct Seeker<C> {
    pub grain: u32,
    pub position: Vector<C>,
    /// Its radius and the skin [m].
    pub reach: C,
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
    pub fn new<P: Precision<Coordinate = C>>(spheres: &[Sphere<P>], largest: C, period: Period<C>) -> Self {
        let nowhere = C::from_f64(f64::NAN);
        let column = |component: fn(&Sphere<P>) -> C| {
            let padding = std::iter::repeat_n(nowhere, GROUP);
            spheres.iter().map(component).chain(padding).collect::<Vec<C>>()
        };
        let mut x = column(|sphere| sphere.position.x);
        for (x, _) in x.iter_mut().zip(spheres).filter(|(_, sphere)| sphere.radius > largest) {
            *x = nowhere;
        }
        let (y, z) = (column(|sphere| sphere.position.y), column(|sphere| sphere.position.z));
        Self { x, y, z, radius: column(|sphere| sphere.radius), period, set: InstructionSet::detect() }
    }

    /// Adds those grains of `range` to `found` whose surfaces are closer than the skin to that of `seeker`.
    pub fn look(&self, seeker: &Seeker<C>, range: Range<u32>, found: &mut Found) {
        match self.set {
            InstructionSet::Baseline => self.look_at_groups(seeker, range, found),
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
        self.look_at_groups(seeker, range, found);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,avx512f,avx512dq,avx512vl")]
    fn look_avx512(&self, seeker: &Seeker<C>, range: Range<u32>, found: &mut Found) {
        self.look_at_groups(seeker, range, found);
    }

    #[inline(always)]
    fn look_at_groups(&self, seeker: &Seeker<C>, range: Range<u32>, found: &mut Found) {
        let mut from = range.start as usize;
        let end = range.end as usize;
        while from < end {
            if found.n_last > MOST_LAST - GROUP {
                found.pairs();
            }
            let group = from..from + GROUP;
            let (x, y) = (&self.x[group.clone()], &self.y[group.clone()]);
            let (z, radius) = (&self.z[group.clone()], &self.radius[group]);
            let (mut room, mut image) = ([C::ZERO; GROUP], [0_u32; GROUP]);
            for k in 0..GROUP {
                let reach = seeker.reach + radius[k];
                let (difference, its_image) =
                    self.period.nearest(seeker.position - Vector::new(x[k], y[k], z[k]));
                room[k] = difference.norm_squared() - reach * reach;
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

    fn near_grains_are_those_of_a_plain_search<P: Precision>() {
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
                Sphere { position: place.into(), radius, ..Sphere::default() }
            })
            .collect();
        let (skin, largest) = (coordinate(0.01), coordinate(0.09));
        let period = domain.period();
        let mut candidates = Candidates::new(&spheres, largest, period);
        let mut expected = Vec::new();
        for (i, sphere) in spheres.iter().enumerate() {
            for (j, other) in spheres.iter().enumerate().skip(i + 1) {
                let (difference, image) = period.nearest(sphere.position - other.position);
                let reach = sphere.radius + skin + other.radius;
                if difference.norm_squared() < reach * reach && other.radius <= largest {
                    expected.push(Pair::new(i as u32, j as u32, image));
                }
            }
        }
        assert!(expected.len() > 500 && expected.iter().any(|pair| pair.image() != 13));
        for set in [InstructionSet::Baseline, InstructionSet::detect()] {
            candidates.set = set;
            let mut found = Found::none();
            for (i, sphere) in spheres.iter().enumerate() {
                let seeker =
                    Seeker { grain: i as u32, position: sphere.position, reach: sphere.radius + skin };
                let (from, middle) = (i as u32 + 1, (i as u32 + 300).min(600));
                candidates.look(&seeker, from..middle, &mut found);
                candidates.look(&seeker, middle.max(from)..600, &mut found);
            }
            assert_eq!(found.pairs(), &expected, "{set:?}");
        }
    }

    #[test]
    fn every_precision_and_instruction_set_finds_the_grains_of_a_plain_search() {
        near_grains_are_those_of_a_plain_search::<F64>();
        near_grains_are_those_of_a_plain_search::<Mixed>();
        near_grains_are_those_of_a_plain_search::<F32>();
    }
}
