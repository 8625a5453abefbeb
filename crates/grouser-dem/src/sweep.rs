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
//! runs that begin with an even slab. The last odd slab of a run, which writes into the next run, waits for the even ones on
//! both sides, which are passed over first; whoever has finished a run takes those that need not wait any more.

use crate::block::Block;
use crate::force_pass::{PassInput, slab_forces};
use crate::integrate::{Motion, Pace};
use crate::plane::Plane;
use crate::slab::Slab;
use grouser_contact::{ContactLaw, Memory, Precision, Real};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU32, Ordering};

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
    let is_last = |slab: usize| slab + 1 == n_slabs && !is_ring;
    if n_slabs == 0 {
        return Pace::STILL;
    }

    // The last odd slab of a run waits for its own run's last even slab and the next run's first one.
    let mut waiting = Vec::new();
    let mut runs = Vec::new();
    let starts = starts_of_runs(slabs, n_threads);
    let mut rest = slabs;
    for (run, &start) in starts.iter().enumerate() {
        let end = starts.get(run + 1).copied().unwrap_or(n_slabs);
        let slabs = rest.split_off_mut(..end - start).expect("runs part the slabs");
        let waits = slabs.len().is_multiple_of(2) && !is_last(end - 1);
        let (own, last) = slabs.split_at_mut(slabs.len() - usize::from(waits));
        let slab = Mutex::new(last.first_mut());
        waiting.push(WaitingSlab { number: end - 1, n_missing: AtomicU32::new(2), slab });
        runs.push(Run { number: run, start, slabs: own });
    }
    let n_runs = runs.len();
    let work = |Run { number: run, start, slabs: own }: Run<'_, Slab<P::Real, L::Memory>>| {
        let end = own.len() - 1;
        let last_even = end & !1;
        let block = &mut Block::new(input.table);
        pass(&mut own[0], block, planes, input);
        waiting[(run + n_runs - 1) % n_runs].has_one_less_to_wait_for();
        if last_even > 0 {
            pass(&mut own[last_even], block, planes, input);
        }
        waiting[run].has_one_less_to_wait_for();
        let mut pace = if start == 0 && !is_ring { moves(0) } else { Pace::STILL };
        for even in (2..=last_even).step_by(2) {
            if even < last_even {
                pass(&mut own[even], block, planes, input);
            }
            pass(&mut own[even - 1], block, planes, input);
            pace = pace.and(moves(start + even - 1)).and(moves(start + even));
        }
        if end % 2 == 1 {
            pass(&mut own[end], block, planes, input);
            pace = pace.and(moves(start + end));
        }
        // Whoever is done takes slabs that need not wait any more; the last one finds all of them so.
        for waiting in waiting[run..].iter().chain(&waiting[..run]) {
            if let Some(slab) = waiting.take_if_ready() {
                pass(slab, block, planes, input);
                pace = pace.and(moves(waiting.number)).and(moves(waiting.number + 1));
            }
        }
        pace
    };
    if n_threads == 1 {
        // Nobody has to be woken.
        return runs.into_iter().map(work).fold(Pace::STILL, Pace::and);
    }
    runs.into_par_iter().with_max_len(1).map(work).reduce(|| Pace::STILL, Pace::and)
}

/// Slabs that one task passes over.
struct Run<'a, S> {
    number: usize,
    /// Number of the first slab.
    start: usize,
    slabs: &'a mut [S],
}

/// A slab that is passed over once two others have been.
struct WaitingSlab<'a, S> {
    number: usize,
    n_missing: AtomicU32,
    slab: Mutex<Option<&'a mut S>>,
}

impl<'a, S> WaitingSlab<'a, S> {
    /// Another slab that this one waits for has been passed over.
    fn has_one_less_to_wait_for(&self) {
        self.n_missing.fetch_sub(1, Ordering::AcqRel);
    }

    /// The slab, once, when nothing is missing any more.
    fn take_if_ready(&self) -> Option<&'a mut S> {
        if self.n_missing.load(Ordering::Acquire) > 0 {
            return None;
        }
        self.slab.lock().expect("nobody panics while holding it").take()
    }
}

/// First slabs of the runs, all of them even: one run for each thread, with about the same number of pairs.
fn starts_of_runs<T: Real, M>(slabs: &[Slab<T, M>], n_threads: usize) -> Vec<usize> {
    let n_pairs: usize = slabs.iter().map(|slab| slab.pairs.len()).sum();
    let mut starts = vec![0];
    let mut before = 0;
    for (number, slab) in slabs.iter().enumerate() {
        let share = n_pairs * starts.len() / n_threads;
        // Half of the pair of slabs that begins here lies below the share at most.
        let is_nearest = before + slab.pairs.len() > share && starts.len() < n_threads;
        if number > 0 && number.is_multiple_of(2) && is_nearest {
            starts.push(number);
        }
        before += slab.pairs.len();
    }
    starts
}

fn pass<P: Precision, L: ContactLaw<P::Real>>(
    slab: &mut Slab<P::Real, L::Memory>,
    block: &mut Block<P::Real, L>,
    planes: &[Plane],
    input: &PassInput<P, L>,
) where
    L::Memory: Memory<P::Real>,
{
    let mut sums = slab_forces(slab, block, input);
    for (list, plane) in slab.planes.iter_mut().zip(planes) {
        let of_plane = list.forces(plane, input);
        sums.ledger += of_plane.ledger;
        sums.is_too_deep |= of_plane.is_too_deep;
    }
    slab.sums = sums;
}
