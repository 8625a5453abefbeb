//! Which of the grains of a few cells are near a given one: eight of them at a time.

use crate::domain::Period;
use crate::force_pass::InstructionSet;
use crate::slab::Pair;
use grouser_contact::{Precision, Real, Sphere, Vector};
use std::ops::Range;

/// Candidates that are looked at together.
const GROUP: usize = 8;
/// Near grains of one grain that are kept before they are handed over.
const MOST_NEAR: usize = 128;

/// Places and radii of all grains, one array each, with the room of a group behind the last. Grains that are nobody's
/// candidates are nowhere (NaN).
pub(crate) struct Candidates<C> {
    x: Vec<C>,
    y: Vec<C>,
    z: Vec<C>,
    radius: Vec<C>,
    set: InstructionSet,
}

/// A grain whose partners are sought.
pub(crate) struct Seeker<C> {
    pub grain: u32,
    pub position: Vector<C>,
    /// Its radius and the skin [m].
    pub reach: C,
}

/// Near grains that wait to be handed over.
pub(crate) struct Near {
    pairs: [Pair; MOST_NEAR],
    n: usize,
}

impl Near {
    /// None.
    pub fn none() -> Self {
        Self { pairs: [Pair::new(0, 0, 0); MOST_NEAR], n: 0 }
    }

    /// Appends all to `pairs`.
    pub fn hand_over(&mut self, pairs: &mut Vec<Pair>) {
        pairs.extend_from_slice(&self.pairs[..self.n]);
        self.n = 0;
    }
}

impl<C: Real> Candidates<C> {
    /// All `spheres`, of which those larger than `largest` [m] are not candidates.
    pub fn new<P: Precision<Coordinate = C>>(spheres: &[Sphere<P>], largest: C) -> Self {
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
        Self { x, y, z, radius: column(|sphere| sphere.radius), set: InstructionSet::detect() }
    }

    /// Appends those grains of `range` to `near` whose surfaces are closer than the skin to that of `seeker`; what does not fit
    /// is handed over to `pairs` before.
    pub fn look(
        &self,
        seeker: &Seeker<C>,
        range: Range<u32>,
        period: &Period<C>,
        near: &mut Near,
        pairs: &mut Vec<Pair>,
    ) {
        match self.set {
            InstructionSet::Baseline => self.look_at_groups(seeker, range, period, near, pairs),
            // SAFETY: `detect` found the instructions on this machine.
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx2 => unsafe { self.look_avx2(seeker, range, period, near, pairs) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx512 => unsafe { self.look_avx512(seeker, range, period, near, pairs) },
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn look_avx2(
        &self,
        seeker: &Seeker<C>,
        range: Range<u32>,
        period: &Period<C>,
        near: &mut Near,
        pairs: &mut Vec<Pair>,
    ) {
        self.look_at_groups(seeker, range, period, near, pairs);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,avx512f,avx512dq,avx512vl")]
    fn look_avx512(
        &self,
        seeker: &Seeker<C>,
        range: Range<u32>,
        period: &Period<C>,
        near: &mut Near,
        pairs: &mut Vec<Pair>,
    ) {
        self.look_at_groups(seeker, range, period, near, pairs);
    }

    #[inline(always)]
    fn look_at_groups(
        &self,
        seeker: &Seeker<C>,
        range: Range<u32>,
        period: &Period<C>,
        near: &mut Near,
        pairs: &mut Vec<Pair>,
    ) {
        let mut from = range.start as usize;
        let end = range.end as usize;
        while from < end {
            if near.n > MOST_NEAR - GROUP {
                near.hand_over(pairs);
            }
            let group = from..from + GROUP;
            let (x, y) = (&self.x[group.clone()], &self.y[group.clone()]);
            let (z, radius) = (&self.z[group.clone()], &self.radius[group]);
            let (mut room, mut image) = ([C::ZERO; GROUP], [0_u32; GROUP]);
            for k in 0..GROUP {
                let reach = seeker.reach + radius[k];
                let (difference, its_image) = period.nearest(seeker.position - Vector::new(x[k], y[k], z[k]));
                room[k] = difference.norm_squared() - reach * reach;
                image[k] = its_image;
            }
            // A candidate is written down in any case and counted if it is near: no branch that would be guessed wrong.
            let n = (end - from).min(GROUP);
            for k in 0..GROUP {
                near.pairs[near.n % MOST_NEAR] = Pair::new(seeker.grain, (from + k) as u32, image[k]);
                near.n += usize::from((k < n) & (room[k] < C::ZERO));
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
        let mut candidates = Candidates::new(&spheres, largest);
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
            let (mut near, mut pairs) = (Near::none(), Vec::new());
            for (i, sphere) in spheres.iter().enumerate() {
                let seeker =
                    Seeker { grain: i as u32, position: sphere.position, reach: sphere.radius + skin };
                let (from, middle) = (i as u32 + 1, (i as u32 + 300).min(600));
                candidates.look(&seeker, from..middle, &period, &mut near, &mut pairs);
                candidates.look(&seeker, middle.max(from)..600, &period, &mut near, &mut pairs);
            }
            near.hand_over(&mut pairs);
            assert_eq!(pairs, expected, "{set:?}");
        }
    }

    #[test]
    fn every_precision_and_instruction_set_finds_the_grains_of_a_plain_search() {
        near_grains_are_those_of_a_plain_search::<F64>();
        near_grains_are_those_of_a_plain_search::<Mixed>();
        near_grains_are_those_of_a_plain_search::<F32>();
    }
}
