//! Contacts between grains that sleep: kept by permanent numbers, looked at only when somebody falls asleep or wakes.

use crate::domain::Period;
use crate::grains::Grains;
use crate::plane::PlaneList;
use crate::slab::{Pair, Slab};
use grouser_contact::{Memory, Precision, Real};
use serde::{Deserialize, Serialize};

/// A contact between two sleeping grains, by their permanent numbers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "M: serde::Serialize + serde::de::DeserializeOwned")]
struct Asleep<M> {
    grains: [u32; 2],
    memory: M,
}

/// Contacts among sleeping grains, and of sleeping grains with planes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "M: serde::Serialize + serde::de::DeserializeOwned")]
pub(crate) struct Sleepers<M> {
    /// By rising first and second grain.
    contacts: Vec<Asleep<M>>,
    /// For each plane what grains remember of it, by rising grain.
    planes: Vec<Vec<(u32, M)>>,
}

impl<M: Copy> Sleepers<M> {
    /// Nobody sleeps.
    pub fn none(n_planes: usize) -> Self {
        Self { contacts: Vec::new(), planes: vec![Vec::new(); n_planes] }
    }

    /// Number of contacts among sleeping grains.
    pub fn n_contacts(&self) -> usize {
        self.contacts.len()
    }

    /// Contacts as permanent numbers.
    pub fn contacts(&self) -> impl Iterator<Item = [u32; 2]> {
        self.contacts.iter().map(|contact| contact.grains)
    }

    /// Takes over contacts of listed grains whose partners both sleep now; `is_asleep` by place.
    pub fn take<T: Real>(&mut self, slabs: &[&Slab<T, M>], ids: &[u32], is_asleep: &[bool])
    where
        M: Memory<T>,
    {
        let sleeps = |place: u32| is_asleep[place as usize];
        for slab in slabs {
            for (place, pair) in slab.pairs.iter().enumerate().filter(|(place, _)| slab.has_touched(*place)) {
                let [i, j] = pair.grains();
                if sleeps(i) && sleeps(j) {
                    let grains = [ids[i as usize], ids[j as usize]];
                    self.contacts.push(Asleep { grains, memory: slab.memory[place] });
                }
            }
            for (of_plane, list) in self.planes.iter_mut().zip(&slab.planes) {
                let near = list.grains.iter().zip(&list.memory).filter(|&(&grain, _)| sleeps(grain));
                of_plane.extend(near.map(|(&grain, &memory)| (ids[grain as usize], memory)));
            }
        }
        // A stable sort takes little time over what is sorted already.
        self.contacts.sort_by_key(|contact| contact.grains);
        self.planes.iter_mut().for_each(|of_plane| of_plane.sort_unstable_by_key(|&(id, _)| id));
    }

    /// Forgets the contacts of grains that are awake; `is_asleep` by permanent number.
    pub fn forget_awake(&mut self, is_asleep: &[bool]) {
        let sleeps = |id: u32| is_asleep[id as usize];
        self.contacts.retain(|contact| contact.grains.into_iter().all(sleeps));
        self.planes.iter_mut().for_each(|of_plane| of_plane.retain(|&(id, _)| sleeps(id)));
    }

    /// What the grains with these permanent numbers remember of each other, seen from the first; `None` when they do not touch.
    pub fn recall<T: Real>(&self, first: u32, second: u32) -> Option<M>
    where
        M: Memory<T>,
    {
        let seek = |grains: [u32; 2]| {
            let place = self.contacts.binary_search_by_key(&grains, |contact| contact.grains).ok()?;
            Some(self.contacts[place].memory)
        };
        seek([first, second]).or_else(|| seek([second, first]).map(M::seen_from_the_other))
    }

    /// What a grain remembers of a plane.
    pub fn recall_plane(&self, plane: usize, id: u32) -> Option<M> {
        let of_plane = self.planes.get(plane)?;
        Some(of_plane[of_plane.binary_search_by_key(&id, |&(id, _)| id).ok()?].1)
    }

    /// All contacts as one slab, which also lists the grains at planes.
    pub fn slab<P: Precision>(&self, grains: &Grains<P>, period: &Period<P::Coordinate>) -> Slab<P::Real, M>
    where
        M: Memory<P::Real>,
    {
        let place = places(&grains.ids);
        let spheres = &grains.spheres;
        let pair = |contact: &Asleep<M>| {
            let [i, j] = contact.grains.map(|id| place[id as usize]);
            let difference = spheres[i as usize].position - spheres[j as usize].position;
            Pair::new(i, j, period.nearest(difference).1)
        };
        let pairs = self.contacts.iter().map(pair).collect();
        let mut slab = Slab::of_pairs(0, grains.len() as u32, Vec::new(), pairs);
        slab.memory = self.contacts.iter().map(|contact| contact.memory).collect();
        slab.planes = self
            .planes
            .iter()
            .map(|of_plane| {
                let (grains, memory) =
                    of_plane.iter().map(|&(id, memory)| (place[id as usize], memory)).unzip();
                PlaneList::of(grains, memory)
            })
            .collect();
        slab
    }

    /// Memory held [bytes].
    pub fn bytes(&self) -> usize {
        size_of::<Asleep<M>>() * self.contacts.capacity()
            + size_of::<(u32, M)>() * self.planes.iter().map(Vec::capacity).sum::<usize>()
    }
}

/// Place of each permanent number.
pub(crate) fn places(ids: &[u32]) -> Vec<u32> {
    let mut places = vec![0; ids.len()];
    for (place, &id) in ids.iter().enumerate() {
        places[id as usize] = place as u32;
    }
    places
}
