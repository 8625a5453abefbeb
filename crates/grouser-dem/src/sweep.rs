//! One sweep over the slabs of a bed: forces, and the motion of every grain whose forces are complete.
//!
//! ```text
//!   slab     0    1    2    3    4    5         a grain of slab s receives forces from the passes over s − 1 and s;
//!   pass     1st  3rd  2nd  5th  4th  6th       every even slab is passed over before its odd neighbours
//!   motion   0 after 1st; 1 and 2 after 3rd; 3 and 4 after 5th; 5 after 6th
//! ```
//!
//! Each grain sums its forces in the order "even slab, odd slab" whatever the number of threads, and its record is still in
//! the cache when it is moved: one sweep reads and writes each grain once. For several threads the slabs are parted into
//! runs that begin with an even slab; the last odd slab of a run, which writes into the next run, waits for a second turn.

use crate::force_pass::{PassInput, slab_forces};
use crate::integrate::{Motion, Pace};
use crate::plane::Plane;
use crate::slab::Slab;
use grouser_contact::{ContactLaw, Memory, Precision};
use rayon::prelude::*;
use std::ops::Range;

/// Grains that another thread is worth. Measured: a second thread costs 0–3 % of a bed of 250 to 2,000 grains and gains 5–9 % at
/// 4,000. The tests of thread counts have beds of at least three times as many, so that threads do share them.
const GRAINS_PER_THREAD: usize = 500;

/// Threads that work on a bed of so many grains.
fn threads_of(n_grains: usize) -> usize {
    rayon::current_num_threads().min((n_grains / GRAINS_PER_THREAD).max(1))
}

/// Several threads work on a bed of so many grains.
pub(crate) fn is_shared(n_grains: usize) -> bool {
    threads_of(n_grains) > 1
}

/// Forces of all slabs, and `motion` of every grain afterwards, or of the grains in `runs` of each slab alone.
pub(crate) fn sweep<P: Precision, L: ContactLaw<P::Real>>(
    slabs: &mut [Slab<P::Real, L::Memory>],
    is_ring: bool,
    planes: &[Plane],
    input: &PassInput<P, L>,
    motion: &Motion<P::Real>,
    runs: Option<&[Vec<Range<u32>>]>,
) -> Pace {
    let ranges: Vec<_> = slabs.iter().map(Slab::grains).collect();
    let moves = |slab: usize| match runs {
        None => motion.advance(input.grains, ranges[slab % ranges.len()].clone(), input.set),
        Some(runs) => runs[slab % ranges.len()]
            .iter()
            .map(|run| motion.advance(input.grains, run.clone(), input.set))
            .fold(Pace::STILL, Pace::and),
    };
    let n_slabs = slabs.len();
    let n_grains: usize = ranges.iter().map(ExactSizeIterator::len).sum();
    let n_threads = threads_of(n_grains);
    let run_length = run_length(n_slabs, n_threads);
    let is_last = |slab: usize| slab + 1 == n_slabs && !is_ring;

    let first_turn = |run: usize, slabs: &mut [Slab<P::Real, L::Memory>]| {
        let mut pace = Pace::STILL;
        let start = run * run_length;
        for even in (0..slabs.len()).step_by(2) {
            pass(&mut slabs[even], planes, input);
            if even > 0 {
                pass(&mut slabs[even - 1], planes, input);
                pace = pace.and(moves(start + even - 1)).and(moves(start + even));
            } else if start == 0 && !is_ring {
                pace = pace.and(moves(0));
            }
        }
        let end = slabs.len() - 1;
        if end % 2 == 1 && is_last(start + end) {
            pass(&mut slabs[end], planes, input);
            pace = pace.and(moves(start + end));
        }
        pace
    };
    let second_turn = |run: usize, slabs: &mut [Slab<P::Real, L::Memory>]| {
        let end = slabs.len() - 1;
        let slab = run * run_length + end;
        if end.is_multiple_of(2) || is_last(slab) {
            return Pace::STILL;
        }
        pass(&mut slabs[end], planes, input);
        moves(slab).and(moves(slab + 1))
    };
    if n_slabs == 0 {
        return Pace::STILL;
    }
    if n_threads == 1 {
        // Everything is one run, and nobody has to be woken for it.
        return first_turn(0, slabs).and(second_turn(0, slabs));
    }
    let runs = slabs.par_chunks_mut(run_length).enumerate();
    let pace = runs.map(|(run, slabs)| first_turn(run, slabs)).reduce(|| Pace::STILL, Pace::and);
    let runs = slabs.par_chunks_mut(run_length).enumerate();
    pace.and(runs.map(|(run, slabs)| second_turn(run, slabs)).reduce(|| Pace::STILL, Pace::and))
}

/// Slabs of a run: all of them for one thread, otherwise an even number that gives each thread several runs.
fn run_length(n_slabs: usize, n_threads: usize) -> usize {
    if n_threads == 1 {
        return n_slabs.next_multiple_of(2);
    }
    (n_slabs / (4 * n_threads)).next_multiple_of(2).max(2)
}

fn pass<P: Precision, L: ContactLaw<P::Real>>(
    slab: &mut Slab<P::Real, L::Memory>,
    planes: &[Plane],
    input: &PassInput<P, L>,
) where
    L::Memory: Memory<P::Real>,
{
    let mut sums = slab_forces(slab, input);
    for (list, plane) in slab.planes.iter_mut().zip(planes) {
        let of_plane = list.forces(plane, input);
        sums.ledger += of_plane.ledger;
        sums.is_too_deep |= of_plane.is_too_deep;
    }
    slab.sums = sums;
}
