//! What contacts remember, where it is three or four numbers: from the list to lanes and back.

use super::Quads;
use super::quad::Quad;
use grouser_contact::BLOCK;

/// Fills lanes 0.. with the memory at the places `at`.
///
/// # Safety
/// The machine has AVX2; `at` holds places of the list `memory` of `N` numbers each, three or four; lane arrays hold [`BLOCK`]
/// numbers, and there are at most as many places.
#[target_feature(enable = "avx2")]
pub(crate) unsafe fn recall<Q: Quads, const N: usize>(
    memory: *const Q::Real,
    at: &[u32],
    lanes: [*mut Q::Real; N],
) {
    debug_assert!(at.len() <= BLOCK);
    // SAFETY: by the caller's promise.
    unsafe {
        let row = |k: usize| memory.add(N * at[k.min(at.len() - 1)] as usize);
        for k in (0..at.len()).step_by(4) {
            let rows = [row(k), row(k + 1), row(k + 2), row(k + 3)];
            if N == 3 {
                let columns = Q::Narrow::columns_of_three(rows);
                for (lane, column) in lanes.into_iter().zip(columns) {
                    column.store(lane.add(k));
                }
            } else {
                let [a, b, c, d] = rows;
                let rows = [Q::Narrow::load(a), Q::Narrow::load(b), Q::Narrow::load(c), Q::Narrow::load(d)];
                for (lane, column) in lanes.into_iter().zip(Q::Narrow::transposed(rows)) {
                    column.store(lane.add(k));
                }
            }
        }
    }
}

/// Puts lanes 0.. into the memory at the places `at`, which are all different.
///
/// # Safety
/// As [`recall`].
#[target_feature(enable = "avx2")]
pub(crate) unsafe fn remember<Q: Quads, const N: usize>(
    memory: *mut Q::Real,
    at: &[u32],
    lanes: [*const Q::Real; N],
) {
    debug_assert!(at.len() <= BLOCK);
    // SAFETY: by the caller's promise.
    unsafe {
        let row = |k: usize| memory.add(N * at[k] as usize);
        let n_in_fours = at.len() & !3;
        for k in (0..n_in_fours).step_by(4) {
            let column = |n: usize| Q::Narrow::load(lanes[n].add(k));
            let rows = [row(k), row(k + 1), row(k + 2), row(k + 3)];
            if N == 3 {
                Q::Narrow::store_as_rows([column(0), column(1), column(2)], rows);
            } else {
                let whole = Q::Narrow::transposed([column(0), column(1), column(2), column(3)]);
                for (to, row) in rows.into_iter().zip(whole) {
                    row.store(to);
                }
            }
        }
        for k in n_in_fours..at.len() {
            for (axis, lane) in lanes.into_iter().enumerate() {
                *row(k).add(axis) = *lane.add(k);
            }
        }
    }
}
