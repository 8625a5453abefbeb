//! Forces of all listed pairs: filter, gather, contact law on blocks, ordered scatter.
//!
//! Pairs are looked at in list order. Those that touch are gathered, [`BLOCK`] at a time, from the sorted records into
//! one array a component; the law then runs over the block without a branch, which the compiler turns into vector
//! instructions; the results are added to the grains in list order. No fused multiply-add is used, so every
//! instruction set gives the same bytes.

use crate::block::Block;
use crate::shared_grains::SharedGrains;
use crate::slab::{Pair, Slab, SlabSums};
use grouser_contact::{BLOCK, ContactLaw, PairTable, Precision};

/// Runs the expression with `$quads` naming the precision that `$precision` is, where there are registers for it;
/// which one that is is known when compiled.
#[cfg(target_arch = "x86_64")]
macro_rules! in_quads {
    ($precision:ty, $quads:ident => $body:expr) => {{
        let is = std::any::TypeId::of::<$precision>();
        if is == std::any::TypeId::of::<grouser_contact::F64>() {
            type $quads = grouser_contact::F64;
            Some($body)
        } else if is == std::any::TypeId::of::<grouser_contact::Mixed>() {
            type $quads = grouser_contact::Mixed;
            Some($body)
        } else if is == std::any::TypeId::of::<grouser_contact::F32>() {
            type $quads = grouser_contact::F32;
            Some($body)
        } else {
            None
        }
    }};
}
#[cfg(target_arch = "x86_64")]
pub(crate) use in_quads;

/// What a slab's pass needs beside the slab.
pub(crate) struct PassInput<'a, P: Precision, L> {
    pub grains: SharedGrains<P>,
    /// Image number to shift [m]; the fourth number is zero.
    pub shifts: [[P::Coordinate; 4]; 32],
    pub law: L,
    pub table: &'a PairTable<P::Real>,
    pub time_step: P::Real,
    pub has_ledger: bool,
    /// Overlap over the smaller radius beyond which the run is given up [-].
    pub largest_overlap: P::Real,
    pub set: InstructionSet,
}

/// Instruction sets that the pass is compiled for; all give the same bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InstructionSet {
    /// What every machine of this architecture has.
    Baseline,
    /// 256-bit vectors.
    #[cfg(target_arch = "x86_64")]
    Avx2,
    /// 512-bit vectors.
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl InstructionSet {
    /// The widest set that this machine has.
    pub fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            let has_avx512 = is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512vl");
            if has_avx512 {
                return Self::Avx512;
            }
            if is_x86_feature_detected!("avx2") {
                return Self::Avx2;
            }
        }
        Self::Baseline
    }
}

/// Adds the forces of all touching pairs of `slab` to its grains and those of the next slab, by way of `block`.
pub(crate) fn slab_forces<P: Precision, L: ContactLaw<P::Real>>(
    slab: &mut Slab<P::Real, L::Memory>,
    block: &mut Block<P::Real, L>,
    input: &PassInput<P, L>,
) -> SlabSums {
    match input.set {
        InstructionSet::Baseline => dispatch_ledger::<P, L, false>(slab, block, input),
        // SAFETY: `detect` found the instructions on this machine.
        #[cfg(target_arch = "x86_64")]
        InstructionSet::Avx2 => unsafe { slab_forces_avx2(slab, block, input) },
        // SAFETY: as above.
        #[cfg(target_arch = "x86_64")]
        InstructionSet::Avx512 => unsafe { slab_forces_avx512(slab, block, input) },
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn slab_forces_avx2<P: Precision, L: ContactLaw<P::Real>>(
    slab: &mut Slab<P::Real, L::Memory>,
    block: &mut Block<P::Real, L>,
    input: &PassInput<P, L>,
) -> SlabSums {
    dispatch_ledger::<P, L, true>(slab, block, input)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,avx512f,avx512dq,avx512vl")]
fn slab_forces_avx512<P: Precision, L: ContactLaw<P::Real>>(
    slab: &mut Slab<P::Real, L::Memory>,
    block: &mut Block<P::Real, L>,
    input: &PassInput<P, L>,
) -> SlabSums {
    dispatch_ledger::<P, L, true>(slab, block, input)
}

#[inline(always)]
fn dispatch_ledger<P: Precision, L: ContactLaw<P::Real>, const HAS_QUADS: bool>(
    slab: &mut Slab<P::Real, L::Memory>,
    block: &mut Block<P::Real, L>,
    input: &PassInput<P, L>,
) -> SlabSums {
    if input.has_ledger {
        pass::<P, L, HAS_QUADS, true>(slab, block, input)
    } else {
        pass::<P, L, HAS_QUADS, false>(slab, block, input)
    }
}

/// Touching pairs that wait for a full block; the lanes of their positions are filled already.
pub(crate) struct Waiting {
    /// Where they stand in the list.
    places: [u32; BLOCK],
    /// Behind those that wait there are pairs of grains that exist, too.
    pairs: [Pair; BLOCK],
    n: usize,
}

impl Waiting {
    /// Nobody waits.
    #[inline(always)]
    fn new() -> Self {
        Self { places: [0; BLOCK], pairs: [Pair::new(0, 0, 0); BLOCK], n: 0 }
    }

    /// Those that wait, and behind them some more: whole groups of whatever size divides a block.
    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    pub fn pairs_in_groups<const N: usize>(&self) -> &[[Pair; N]] {
        const { assert!(BLOCK.is_multiple_of(N)) };
        &self.pairs.as_chunks().0[..self.n.div_ceil(N)]
    }

    /// Where those that wait stand in the list.
    #[inline(always)]
    pub fn places(&self) -> &[u32] {
        &self.places[..self.n]
    }

    /// Those that wait.
    #[inline(always)]
    pub fn pairs(&self) -> &[Pair] {
        &self.pairs[..self.n]
    }

    /// How many wait.
    #[inline(always)]
    pub fn n(&self) -> usize {
        self.n & (BLOCK - 1)
    }

    /// Four more will fit.
    #[inline(always)]
    pub fn has_room(&self) -> bool {
        self.n <= BLOCK - 4
    }

    /// Eight more will fit.
    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    pub fn has_room_for_eight(&self) -> bool {
        self.n <= BLOCK - 8
    }

    /// Appends the first `n` of eight pairs and their places; there is room for eight.
    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    pub fn append_of_eight(&mut self, places: [u32; 8], pairs: [Pair; 8], n: usize) {
        let end = self.n().min(BLOCK - 8);
        self.places[end..end + 8].copy_from_slice(&places);
        self.pairs[end..end + 8].copy_from_slice(&pairs);
        self.n += n;
    }

    /// Appends the pair at `place` if it touches.
    #[inline(always)]
    pub fn append_one(&mut self, touches: bool, place: u32, pair: Pair) {
        let n = self.n();
        (self.places[n], self.pairs[n]) = (place, pair);
        self.n += usize::from(touches);
    }

    /// Appends the pairs at `from + n` for every bit n of a mask of four bits; `pairs` has them in front. There is room for four.
    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    pub fn append_four(&mut self, mask: usize, from: u32, pairs: [Pair; 4]) {
        const ORDER: [[u8; 4]; 16] = places_of_bits();
        let four = ORDER[mask & 15].map(|place| from + u32::from(place));
        let n = self.n().min(BLOCK - 4);
        self.places[n..n + 4].copy_from_slice(&four);
        self.pairs[n..n + 4].copy_from_slice(&pairs);
        self.n += mask.count_ones() as usize;
    }
}

/// For each mask of four bits the numbers of its bits, first ones first.
#[cfg(target_arch = "x86_64")]
const fn places_of_bits() -> [[u8; 4]; 16] {
    let mut table = [[0; 4]; 16];
    let mut mask = 0;
    while mask < 16 {
        let (mut bit, mut n) = (0, 0);
        while bit < 4 {
            if mask >> bit & 1 == 1 {
                table[mask][n] = bit as u8;
                n += 1;
            }
            bit += 1;
        }
        mask += 1;
    }
    table
}

#[inline(always)]
fn pass<P: Precision, L: ContactLaw<P::Real>, const HAS_QUADS: bool, const LEDGER: bool>(
    slab: &mut Slab<P::Real, L::Memory>,
    block: &mut Block<P::Real, L>,
    input: &PassInput<P, L>,
) -> SlabSums {
    block.forget_sums();
    let mut waiting = Waiting::new();
    for word in 0..slab.touched.len() {
        let from = word * 64;
        let end = slab.pairs.len().min(from + 64);
        let (mut touching, mut next) = (0_u64, 0);
        while from + next < end {
            if !waiting.has_room() {
                block.work::<P, HAS_QUADS, LEDGER>(&waiting, slab, input);
                waiting.n = 0;
            }
            let pairs = &slab.pairs[from..end];
            let (memory, from) = (&slab.memory, from as u32);
            next = block.look::<P, HAS_QUADS>(pairs, memory, next, from, &mut touching, &mut waiting, input);
        }
        // Pairs that have just parted forget.
        let mut parted = slab.touched[word] & !touching;
        while parted != 0 {
            slab.memory[from + parted.trailing_zeros() as usize] = L::Memory::default();
            parted &= parted - 1;
        }
        slab.touched[word] = touching;
    }
    block.work::<P, HAS_QUADS, LEDGER>(&waiting, slab, input);
    block.totals(input.time_step)
}
