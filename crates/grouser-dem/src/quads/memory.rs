//! What contacts remember, where it is one vector: from the list to lanes and back.

use super::Quads;
use super::quad::Quad;
use grouser_contact::BLOCK;

/// Fills lanes 0.. with the memory at the places `at`.
///
/// # Safety
/// The machine has AVX2; `at` holds places of the list `memory` of three numbers each; lane arrays hold [`BLOCK`] numbers, and
/// there are at most as many places.
#[target_feature(enable = "avx2")]
pub(crate) unsafe fn recall<Q: Quads>(memory: *const Q::Real, at: &[u32], lanes: [*mut Q::Real; 3]) {
    debug_assert!(at.len() <= BLOCK);
    // SAFETY: by the caller's promise.
    unsafe {
        let row = |k: usize| memory.add(3 * at[k.min(at.len() - 1)] as usize);
        for k in (0..at.len()).step_by(4) {
            let columns = Q::Narrow::columns_of_three([row(k), row(k + 1), row(k + 2), row(k + 3)]);
            for (lane, column) in lanes.into_iter().zip(columns) {
                column.store(lane.add(k));
            }
        }
    }
}

/// Puts lanes 0.. into the memory at the places `at`, which are all different.
///
/// # Safety
/// As [`recall`].
#[target_feature(enable = "avx2")]
pub(crate) unsafe fn remember<Q: Quads>(memory: *mut Q::Real, at: &[u32], lanes: [*const Q::Real; 3]) {
    debug_assert!(at.len() <= BLOCK);
    // SAFETY: by the caller's promise.
    unsafe {
        let row = |k: usize| memory.add(3 * at[k] as usize);
        let n_in_fours = at.len() & !3;
        for k in (0..n_in_fours).step_by(4) {
            let [x, y, z] = lanes;
            let columns = [Q::Narrow::load(x.add(k)), Q::Narrow::load(y.add(k)), Q::Narrow::load(z.add(k))];
            Q::Narrow::store_as_rows(columns, [row(k), row(k + 1), row(k + 2), row(k + 3)]);
        }
        for k in n_in_fours..at.len() {
            for (axis, lane) in lanes.into_iter().enumerate() {
                *row(k).add(axis) = *lane.add(k);
            }
        }
    }
}
