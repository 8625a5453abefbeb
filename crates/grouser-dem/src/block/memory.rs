//! What contacts remember, from the list to lanes and back.

use super::Block;
#[cfg(target_arch = "x86_64")]
use super::is_same;
#[cfg(target_arch = "x86_64")]
use crate::force_pass::in_quads;
#[cfg(target_arch = "x86_64")]
use crate::quads;
use crate::slab::Slab;
#[cfg(target_arch = "x86_64")]
use grouser_contact::{BLOCK, Vector};
use grouser_contact::{Blocked, ContactLaw, Precision, Real};

/// A contact remembers one vector and no more; known when compiled.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn remembers_a_vector<T: Real, L: ContactLaw<T>>() -> bool {
    is_same::<L::Memory, Vector<T>>() || is_same::<L::Memory, (Vector<T>, ())>()
}

/// A contact remembers a vector and a number; known when compiled.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn remembers_four_numbers<T: Real, L: ContactLaw<T>>() -> bool {
    is_same::<L::Memory, (Vector<T>, T)>()
}

/// Starts of `N` arrays of lanes that follow each other.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn lanes_from<U, const N: usize>(first: *mut U) -> [*mut U; N] {
    let mut lanes = [first; N];
    for n in 1..N {
        lanes[n] = first.wrapping_add(n * BLOCK);
    }
    lanes
}

/// Starts of the lanes of a vector and a number, in the order in which a contact remembers the four numbers.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn lanes_of_four<T: Real, U>(block: *mut <(Vector<T>, T) as Blocked<T>>::Block) -> [*mut U; 4] {
    // SAFETY: places of fields, of which nothing is read.
    let (vector, number) = unsafe { (&raw mut (*block).0, &raw mut (*block).1) };
    let ([x, y, z], number) = (lanes_from(vector.cast()), number.cast());
    if std::mem::offset_of!((Vector<T>, T), 1) == 0 { [number, x, y, z] } else { [x, y, z, number] }
}

impl<T: Real, L: ContactLaw<T>> Block<T, L> {
    /// Fills the lanes of memory.
    #[inline(always)]
    pub(super) fn recall<P: Precision<Real = T>, const HAS_QUADS: bool>(
        &mut self,
        places: &[u32],
        slab: &Slab<T, L::Memory>,
    ) {
        #[cfg(target_arch = "x86_64")]
        if HAS_QUADS && remembers_a_vector::<T, L>() {
            let lanes: *mut T = (&raw mut self.memory).cast();
            let recalled = in_quads!(P, Q => {
                let lanes: [*mut <Q as Precision>::Real; 3] = lanes_from(lanes.cast());
                // SAFETY: as in `gather`; memory is vectors, a block of them three arrays of lanes, and `Q` is `P`.
                unsafe { quads::recall::<Q, 3>(slab.memory.as_ptr().cast(), places, lanes) };
            });
            if recalled.is_some() {
                return;
            }
        }
        #[cfg(target_arch = "x86_64")]
        if HAS_QUADS && remembers_four_numbers::<T, L>() {
            let block = (&raw mut self.memory).cast();
            let recalled = in_quads!(P, Q => {
                let lanes: [*mut <Q as Precision>::Real; 4] = lanes_of_four::<T, _>(block);
                // SAFETY: as above, with a vector and a number each.
                unsafe { quads::recall::<Q, 4>(slab.memory.as_ptr().cast(), places, lanes) };
            });
            if recalled.is_some() {
                return;
            }
        }
        for (group, four) in places.chunks(4).enumerate() {
            // Written out here and below: closures over arrays are not inlined into the vectorised pass.
            let memory = |n: usize| slab.memory[four[n.min(four.len() - 1)] as usize];
            L::Memory::store_four([memory(0), memory(1), memory(2), memory(3)], &mut self.memory, group * 4);
        }
    }

    /// Empties the lanes of memory into the list.
    #[inline(always)]
    pub(super) fn remember<P: Precision<Real = T>, const HAS_QUADS: bool>(
        &mut self,
        places: &[u32],
        slab: &mut Slab<T, L::Memory>,
    ) {
        #[cfg(target_arch = "x86_64")]
        if HAS_QUADS && remembers_a_vector::<T, L>() {
            let lanes: *mut T = (&raw mut self.memory).cast();
            let remembered = in_quads!(P, Q => {
                let lanes: [*mut <Q as Precision>::Real; 3] = lanes_from(lanes.cast());
                let lanes = lanes.map(<*mut _>::cast_const);
                // SAFETY: as in `recall`; a pair is in a block once.
                unsafe { quads::remember::<Q, 3>(slab.memory.as_mut_ptr().cast(), places, lanes) };
            });
            if remembered.is_some() {
                return;
            }
        }
        #[cfg(target_arch = "x86_64")]
        if HAS_QUADS && remembers_four_numbers::<T, L>() {
            let block = (&raw mut self.memory).cast();
            let remembered = in_quads!(P, Q => {
                let lanes: [*mut <Q as Precision>::Real; 4] = lanes_of_four::<T, _>(block);
                let lanes = lanes.map(<*mut _>::cast_const);
                // SAFETY: as above.
                unsafe { quads::remember::<Q, 4>(slab.memory.as_mut_ptr().cast(), places, lanes) };
            });
            if remembered.is_some() {
                return;
            }
        }
        for (k, &place) in places.iter().enumerate() {
            slab.memory[place as usize] = L::Memory::load(&self.memory, k);
        }
    }
}
