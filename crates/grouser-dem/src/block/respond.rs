//! The contact law on the lanes of a block, a group of them at a time.

use super::{Block, FrameOf, GROUP, turns_as_sphere};
use grouser_contact::{Blocked, Body, Contact, ContactLaw, Lanes, Real, RotationLaw, Vector};

impl<T: Real, L: ContactLaw<T>> Block<T, L> {
    /// Where and how deep the grains of lanes `from..from + GROUP` touch. Those from `used` on hold leftovers, whose results nobody
    /// may see.
    #[inline(always)]
    pub(super) fn touch(&mut self, from: usize, used: usize, largest_overlap: T) {
        let lanes =
            |group: &[Lanes<T>; 3], k: usize| Vector::new(group[0].0[k], group[1].0[k], group[2].0[k]);
        for lane in 0..GROUP {
            let k = from + lane;
            let (radii, masses) =
                ([self.radius[0].0[k], self.radius[1].0[k]], [self.mass[0].0[k], self.mass[1].0[k]]);
            let (reach, total_mass) = (radii[0] + radii[1], masses[0] + masses[1]);
            let difference = lanes(&self.difference, k);
            let distance = difference.norm();
            // One division serves 1/distance, the overlap excess/(reach + distance), R* and m*.
            let edge = reach + distance;
            let (lengths, sums) = (distance * edge, reach * total_mass);
            let inverse = T::ONE / (lengths * sums);
            let normal = (difference * (inverse * edge * sums)).to_array();
            let overlap = self.excess.0[k] * (inverse * distance * sums);
            for axis in 0..3 {
                self.difference[axis].0[k] = normal[axis];
            }
            self.excess.0[k] = overlap;
            self.effective_radius.0[k] = radii[0] * radii[1] * (inverse * lengths * total_mass);
            self.effective_mass.0[k] = masses[0] * masses[1] * (inverse * lengths * reach);
            let half = T::from_f64(0.5);
            self.arm[0].0[k] = radii[0] - half * overlap;
            self.arm[1].0[k] = radii[1] - half * overlap;
            let depth = overlap - largest_overlap * radii[0].min(radii[1]);
            let depth = if k < used { depth } else { T::ZERO };
            self.depth.0[lane] = depth.max(self.depth.0[lane]);
        }
    }

    /// The contact law on lanes `from..from + GROUP`, of which those below `used` hold contacts.
    #[inline(always)]
    pub(super) fn respond<const LEDGER: bool>(&mut self, from: usize, used: usize, law: &L, time_step: T) {
        let lanes =
            |group: &[Lanes<T>; 3], k: usize| Vector::new(group[0].0[k], group[1].0[k], group[2].0[k]);
        let half = T::from_f64(0.5);
        for lane in 0..GROUP {
            let k = from + lane;
            let (radii, masses) =
                ([self.radius[0].0[k], self.radius[1].0[k]], [self.mass[0].0[k], self.mass[1].0[k]]);
            let normal = lanes(&self.difference, k);
            let arms = [self.arm[0].0[k], self.arm[1].0[k]];
            let (spin_first, spin_second) = (lanes(&self.spin[0], k), lanes(&self.spin[1], k));
            let body = |b: usize, spin| Body {
                arm: arms[b],
                spin,
                inverse_moment: T::ONE / (masses[b] * radii[b] * radii[b]),
                frame: <FrameOf<T, L>>::load(&self.frame[b], k),
            };
            let bodies = [body(0, spin_first), body(1, spin_second)];
            let centres = lanes(&self.velocity, k);
            let contact = Contact {
                overlap: self.excess.0[k],
                normal,
                velocity: law.rotation().velocity_in_parts(normal, centres, &bodies),
                normal_spin: half * (spin_first + spin_second).dot(normal),
                effective_radius: self.effective_radius.0[k],
                effective_mass: self.effective_mass.0[k],
                time_step,
            };
            let pair = grouser_contact::PairProperties {
                normal_modulus: self.normal_modulus.0[k],
                tangential_modulus: self.tangential_modulus.0[k],
                damping: self.damping.0[k],
                tangential_damping_ratio: self.tangential_damping_ratio.0[k],
                friction: self.friction.0[k],
            };
            let (response, memory) = law.respond(&contact, &pair, L::Memory::load(&self.memory, k));
            // Lanes beyond the contacts of this block hold leftovers, whose results nobody may see.
            let or_nothing = |value: T| if k < used { value } else { T::ZERO };
            if turns_as_sphere::<T, L>() {
                memory.store(&mut self.memory, k);
            } else {
                let (couples, memory) = law.couples(&contact, &pair, &response, &bodies, memory);
                memory.store(&mut self.memory, k);
                for (lanes, torque) in self.spin.iter_mut().zip(couples.torques) {
                    for (lane, component) in lanes.iter_mut().zip(torque.to_array()) {
                        lane.0[k] = component;
                    }
                }
                if LEDGER {
                    self.ledger[5].0[lane] += or_nothing(couples.spent);
                }
            }
            let force = (normal * response.normal_force + response.tangential_force).to_array();
            for axis in 0..3 {
                self.difference[axis].0[k] = force[axis];
            }
            if turns_as_sphere::<T, L>() {
                let couple = normal.cross(response.tangential_force).to_array();
                for axis in 0..3 {
                    self.velocity[axis].0[k] = couple[axis];
                }
            }
            if LEDGER {
                let energy = response.energy;
                let terms = [
                    energy.normal_elastic,
                    energy.tangential_elastic,
                    energy.normal_damping,
                    energy.tangential,
                    energy.sliding,
                ];
                for (sum, term) in self.ledger.iter_mut().zip(terms) {
                    sum.0[lane] += or_nothing(term);
                }
            }
        }
    }
}
