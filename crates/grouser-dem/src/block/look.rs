//! Looking at pairs: those that touch fill the lanes of positions.

#[cfg(target_arch = "x86_64")]
use super::has_eights;
use super::{Block, has_quads};
#[cfg(target_arch = "x86_64")]
use crate::force_pass::in_quads;
use crate::force_pass::{PassInput, Waiting};
#[cfg(target_arch = "x86_64")]
use crate::quads;
use crate::slab::Pair;
use grouser_contact::{ContactLaw, Precision, Real, Vector};

/// Centre to centre [m] of a pair, and (x² + y²) + (z² − reach²) [m²]: negative where it touches.
#[inline(always)]
fn relative_place<P: Precision, L>(
    pair: Pair,
    input: &PassInput<P, L>,
) -> (Vector<P::Coordinate>, P::Coordinate) {
    let [first, second] = pair.grains().map(|grain| input.grains.sphere(grain));
    let [x, y, z, _] = input.shifts[pair.image()];
    let difference = first.position - second.position - Vector::new(x, y, z);
    let reach = first.radius + second.radius;
    let Vector { x, y, z } = difference;
    (difference, (x * x + y * y) + (z * z - reach * reach))
}

impl<T: Real, L: ContactLaw<T>> Block<T, L> {
    /// Looks at pairs from `next` on, four at a time, until all are seen or the block is full; touching ones fill the lanes
    /// of positions. Gives the first pair that was not looked at.
    #[inline(always)]
    pub(crate) fn look<P: Precision<Real = T>, const HAS_QUADS: bool>(
        &mut self,
        pairs: &[Pair],
        memory: &[L::Memory],
        mut next: usize,
        from: u32,
        touching: &mut u64,
        waiting: &mut Waiting,
        input: &PassInput<P, L>,
    ) -> usize {
        #[cfg(target_arch = "x86_64")]
        if HAS_QUADS {
            let seen = in_quads!(P, Q => {
                let places = quads::Places::<Q> {
                    spheres: input.grains.spheres().cast(),
                    shifts: input.shifts.as_ptr().cast(),
                    memory: memory.as_ptr().cast(),
                    memory_bytes: size_of::<L::Memory>(),
                };
                let [x, y, z] = &mut self.difference;
                let [first, second] = &mut self.radius;
                let lanes = quads::PlaceLanes {
                    difference: [quads::start(x), quads::start(y), quads::start(z)],
                    excess: quads::start(&mut self.excess),
                    radius: [quads::start(first), quads::start(second)],
                };
                // SAFETY: this pass is compiled for AVX2, with eights for AVX-512F and AVX-512VL, and `Q` is `F64` then; `Q` is
                // `P`; lists hold numbers of grains.
                unsafe {
                    if has_eights::<Q>(input.set) {
                        let (places, lanes) = (&*(&raw const places).cast(), &*(&raw const lanes).cast());
                        next = quads::look_eight(pairs, next, from, touching, waiting, places, lanes);
                    }
                    quads::look::<Q>(pairs, next, from, touching, waiting, &places, &lanes)
                }
            });
            next = seen.unwrap_or(next);
        }
        let is_rest = pairs.len() - next < 4;
        while next < pairs.len() && waiting.has_room() && (is_rest || !HAS_QUADS || !has_quads::<P>()) {
            let end = pairs.len().min(next + 4);
            for (bit, &pair) in pairs.iter().enumerate().take(end).skip(next) {
                let touches = self.look_at_one(pair, input, waiting.n());
                *touching |= u64::from(touches) << bit;
                waiting.append_one(touches, from + bit as u32, pair);
            }
            next = end;
        }
        next
    }

    /// Fills the position lanes `k` with a pair and says whether it touches.
    #[inline(always)]
    fn look_at_one<P: Precision<Real = T>>(&mut self, pair: Pair, input: &PassInput<P, L>, k: usize) -> bool {
        let [first, second] = pair.grains().map(|grain| input.grains.sphere(grain));
        let narrow = |c: P::Coordinate| T::from_f64(c.to_f64());
        let (difference, room) = relative_place(pair, input);
        self.excess.0[k] = -narrow(room);
        let difference = difference.to_array();
        for axis in 0..3 {
            self.difference[axis].0[k] = narrow(difference[axis]);
        }
        self.radius[0].0[k] = narrow(first.radius);
        self.radius[1].0[k] = narrow(second.radius);
        room < P::Coordinate::ZERO
    }
}
