//! Gathering: the motion and the orientations of touching grains fill their lanes.

#[cfg(target_arch = "x86_64")]
use super::has_eights;
use super::{Block, FrameOf, has_quaternions};
#[cfg(target_arch = "x86_64")]
use crate::force_pass::in_quads;
use crate::force_pass::{PassInput, Waiting};
#[cfg(target_arch = "x86_64")]
use crate::quads;
use crate::slab::{Pair, Slab};
use grouser_contact::{Blocked, ContactLaw, Frame, Precision, Real};

impl<T: Real, L: ContactLaw<T>> Block<T, L> {
    /// Fills the other lanes with the pairs that wait.
    #[inline(always)]
    pub(super) fn gather<P: Precision<Real = T>, const HAS_QUADS: bool>(
        &mut self,
        waiting: &Waiting,
        slab: &Slab<T, L::Memory>,
        input: &PassInput<P, L>,
    ) {
        let pairs = waiting.pairs();
        let mut is_done = false;
        #[cfg(target_arch = "x86_64")]
        if HAS_QUADS {
            let gathered = in_quads!(P, Q => {
                let [[x, y, z], [x2, y2, z2]] = &mut self.spin;
                let [vx, vy, vz] = &mut self.velocity;
                let [first, second] = &mut self.mass;
                let lanes = quads::MotionLanes {
                    mass: [quads::start(first), quads::start(second)],
                    velocity: [quads::start(vx), quads::start(vy), quads::start(vz)],
                    spin: [
                        [quads::start(x), quads::start(y), quads::start(z)],
                        [quads::start(x2), quads::start(y2), quads::start(z2)],
                    ],
                    frame: [(&raw mut self.frame[0]).cast(), (&raw mut self.frame[1]).cast()],
                };
                let gather = if has_quaternions::<T, L>() { quads::gather::<Q, true> } else { quads::gather::<Q, false> };
                let (spheres, orientations) = (input.grains.spheres().cast(), input.grains.all_orientations());
                // SAFETY: as in `look`; a block has room for all that wait; a block of quaternions is four arrays of lanes; with
                // eights this pass is compiled for AVX-512F and `Q` is `F64`.
                unsafe {
                    if has_eights::<Q>(input.set) {
                        let gather = if has_quaternions::<T, L>() { quads::gather_eight::<true> } else { quads::gather_eight::<false> };
                        let lanes = &*(&raw const lanes).cast();
                        gather(waiting, input.grains.spheres().cast(), orientations, lanes);
                    } else {
                        gather(waiting, spheres, orientations, &lanes);
                    }
                }
            });
            is_done = gathered.is_some();
        }
        if !is_done {
            for (k, &pair) in pairs.iter().enumerate() {
                self.gather_one(pair, input, k);
            }
        }
        self.recall::<P, HAS_QUADS>(waiting.places(), slab);
        if FrameOf::<T, L>::IS_TRACKED && !(is_done && has_quaternions::<T, L>()) {
            self.gather_frames(pairs, input);
        }
        if input.table.n_materials() > 1 {
            for (k, pair) in pairs.iter().enumerate() {
                let [i, j] = pair.grains();
                self.set_pair(
                    k,
                    input.table,
                    input.grains.sphere(i).material,
                    input.grains.sphere(j).material,
                );
            }
        }
    }

    /// Fills the lanes of orientations.
    #[inline(always)]
    fn gather_frames<P: Precision<Real = T>>(&mut self, pairs: &[Pair], input: &PassInput<P, L>) {
        for (group, four) in pairs.chunks(4).enumerate() {
            for body in 0..2 {
                let frame = |n: usize| {
                    let pair = four[n.min(four.len() - 1)];
                    FrameOf::<T, L>::from_quaternion(input.grains.quaternion(pair.grains()[body]))
                };
                let frames = [frame(0), frame(1), frame(2), frame(3)];
                <FrameOf<T, L>>::store_four(frames, &mut self.frame[body], group * 4);
            }
        }
    }

    #[inline(always)]
    fn gather_one<P: Precision<Real = T>>(&mut self, pair: Pair, input: &PassInput<P, L>, k: usize) {
        let [first, second] = pair.grains().map(|grain| input.grains.sphere(grain));
        let velocity = (first.velocity - second.velocity).to_array();
        for axis in 0..3 {
            self.velocity[axis].0[k] = velocity[axis];
        }
        for (body, sphere) in [first, second].into_iter().enumerate() {
            self.mass[body].0[k] = sphere.mass;
            let spin = sphere.spin.to_array();
            for axis in 0..3 {
                self.spin[body][axis].0[k] = spin[axis];
            }
        }
    }
}
