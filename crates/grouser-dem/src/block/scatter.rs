//! Scattering: forces and torques are added to the grains in the order of the list.

use super::{Block, turns_as_sphere};
use crate::force_pass::Waiting;
#[cfg(target_arch = "x86_64")]
use crate::force_pass::in_quads;
#[cfg(target_arch = "x86_64")]
use crate::quads;
use crate::shared_grains::SharedGrains;
use crate::slab::Slab;
use grouser_contact::{ContactLaw, Lanes, Precision, Real, Vector};

impl<T: Real, L: ContactLaw<T>> Block<T, L> {
    #[inline(always)]
    pub(super) fn scatter<P: Precision<Real = T>, const HAS_QUADS: bool>(
        &mut self,
        waiting: &Waiting,
        slab: &mut Slab<T, L::Memory>,
        grains: SharedGrains<P>,
    ) {
        let pairs = waiting.pairs();
        self.remember::<P, HAS_QUADS>(waiting.places(), slab);
        if !turns_as_sphere::<T, L>() {
            #[cfg(target_arch = "x86_64")]
            if HAS_QUADS {
                let [fx, fy, fz] = &mut self.difference;
                let [[ax, ay, az], [bx, by, bz]] = &mut self.spin;
                let scattered = in_quads!(P, Q => {
                    let forces = [quads::start(fx), quads::start(fy), quads::start(fz)];
                    let first = [quads::start(ax), quads::start(ay), quads::start(az)];
                    let second = [quads::start(bx), quads::start(by), quads::start(bz)];
                    let loads = grains.loads().cast();
                    // SAFETY: as below.
                    unsafe {
                        quads::scatter_torques::<Q>(pairs, loads, forces, [first, second]);
                    }
                });
                if scattered.is_some() {
                    return;
                }
            }
            for (k, pair) in pairs.iter().enumerate() {
                let [i, j] = pair.grains();
                let at = |lanes: &[Lanes<T>; 3]| Vector::new(lanes[0].0[k], lanes[1].0[k], lanes[2].0[k]);
                let force: Vector<T> = at(&self.difference);
                grains.add_load(i, force, at(&self.spin[0]));
                grains.add_load(j, -force, at(&self.spin[1]));
            }
            return;
        }
        #[cfg(target_arch = "x86_64")]
        if HAS_QUADS {
            let scattered = in_quads!(P, Q => {
                let [fx, fy, fz] = &mut self.difference;
                let [cx, cy, cz] = &mut self.velocity;
                let [first, second] = &mut self.arm;
                let forces = [quads::start(fx), quads::start(fy), quads::start(fz)];
                let couples = [quads::start(cx), quads::start(cy), quads::start(cz)];
                let arms = [quads::start(first), quads::start(second)];
                // SAFETY: as in `gather`; no other slab works on these grains now.
                unsafe {
                    quads::scatter::<Q>(pairs, grains.loads().cast(), forces, couples, arms);
                }
            });
            if scattered.is_some() {
                return;
            }
        }
        for (k, pair) in pairs.iter().enumerate() {
            let [i, j] = pair.grains();
            let [fx, fy, fz] = &self.difference;
            let force = Vector::new(fx.0[k], fy.0[k], fz.0[k]);
            let [cx, cy, cz] = &self.velocity;
            let couple = Vector::new(cx.0[k], cy.0[k], cz.0[k]);
            grains.add_load(i, force, couple * -self.arm[0].0[k]);
            grains.add_load(j, -force, couple * -self.arm[1].0[k]);
        }
    }
}
