//! The active zone: grains at rest and far from tools sleep, at no cost, until something reaches them.
//!
//! ```text
//!   . . . . . . . . . . .      .  asleep, far: no list, no force, no motion; last in the arrays
//!   . . h h h h h . . . .      h  asleep beside somebody awake: listed, its load is watched, it does not move
//!   . h h o o o h h . . .      o  awake
//!   . h o o o o o h . . .
//! ```
//!
//! The equations are in `docs/theory/active_zone.md`; numbers in comments are its steps.

use crate::blocks::Blocks;
use crate::cell_grid::to_f64;
use crate::sleepers::Sleepers;
use crate::{BedSettings, Grains};
use grouser_contact::{ContactLedger, Load, Precision, Real, Vector};
use grouser_geometry::Vec3;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// When grains fall asleep and when they wake.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ActiveZone {
    /// Edge of the blocks that sleep and wake as a whole [m].
    pub block_m: f64,
    /// Speed of a grain's centre, and of its surface by spin, below which it counts as at rest [m/s].
    pub calm_speed: f64,
    /// Time for which every grain of a block must be seen at rest before it falls asleep [s].
    pub calm_time_s: f64,
    /// Out-of-balance force on a sleeping grain, over its weight and the force that its sleeping neighbours carry, beyond
    /// which it wakes [-].
    pub imbalance: f64,
}

/// What the zone did so far, and what it costs in accuracy.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ZoneAccount {
    /// Grains that are awake now.
    pub n_awake: usize,
    /// Impulse that sleeping grains took up without moving [N·s].
    pub withheld: Vec3,
    /// Momentum of grains when they fell asleep [kg·m/s].
    pub momentum_taken: Vec3,
    /// Kinetic energy of grains when they fell asleep [J].
    pub energy_taken: f64,
    /// Sum over sleeping grains beside the zone of their out-of-balance forces, each as a magnitude, in the last step [N].
    pub imbalance: f64,
    /// Blocks that were woken.
    pub n_woken: u64,
    /// Blocks that fell asleep.
    pub n_fallen_asleep: u64,
    /// Sleeping grains that a tool touched far from anybody awake: its reach was not announced in time.
    pub n_surprised: u64,
}

/// A listed grain that sleeps.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Held {
    /// Its place.
    grain: u32,
    /// Force and torque of its sleeping neighbours and of planes.
    carried: [Vec3; 2],
    /// Out-of-balance force at which it wakes [N].
    limit: f64,
}

/// State of a block that sleeps; any other number counts the looks for which it has been calm.
const ASLEEP: u16 = u16::MAX;
/// Looks at the speeds of grains within the calm time.
const LOOKS: u16 = 4;
/// Occasions to wake between two looks.
const WAKINGS: f64 = 4.0;

/// The active zone of a bed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "M: serde::Serialize + serde::de::DeserializeOwned")]
pub(crate) struct Zone<M> {
    settings: ActiveZone,
    blocks: Blocks,
    state: Vec<u16>,
    /// Boxes around tools that must stay awake [m].
    boxes: Vec<[Vec3; 2]>,
    steps_since_look: u32,
    /// Somebody must be woken before the next look is due.
    is_due: bool,
    /// Somebody fell asleep or woke since the lists were made.
    pub has_changed: bool,
    /// Grains from this place on sleep far from anybody awake.
    pub n_listed: usize,
    /// Ranges of grains that move, for each slab.
    pub runs: Vec<Vec<Range<u32>>>,
    held: Vec<Held>,
    /// Force that far sleepers lack of balance, in sum [N].
    far_imbalance: Vec3,
    /// Blocks of held grains that are out of balance.
    tripped: Vec<usize>,
    pub sleepers: Sleepers<M>,
    /// Force of sleeping grains on each plane [N].
    pub plane_forces: Vec<Vec3>,
    /// Elastic energy of contacts among sleeping grains and with planes.
    pub elastic: ContactLedger,
    pub account: ZoneAccount,
}

impl<M: Copy> Zone<M> {
    /// Everybody is awake.
    pub fn new(settings: ActiveZone, n_grains: usize, bed: &BedSettings) -> Self {
        let blocks = Blocks::new(&bed.domain, settings.block_m);
        Self {
            settings,
            state: vec![0; blocks.n()],
            blocks,
            boxes: Vec::new(),
            steps_since_look: 0,
            is_due: false,
            has_changed: false,
            n_listed: n_grains,
            runs: vec![std::iter::once(0..n_grains as u32).collect()],
            held: Vec::new(),
            far_imbalance: Vec3::zeros(),
            tripped: Vec::new(),
            sleepers: Sleepers::none(bed.planes.len()),
            plane_forces: vec![Vec3::zeros(); bed.planes.len()],
            elastic: ContactLedger::default(),
            account: ZoneAccount { n_awake: n_grains, ..Default::default() },
        }
    }

    /// Blocks that meet `boxes` [m] stay awake from now on, in place of those named before.
    pub fn keep_awake(&mut self, boxes: Vec<[Vec3; 2]>) {
        self.is_due |=
            boxes.iter().any(|b| self.blocks.in_box(b).into_iter().any(|block| self.state[block] == ASLEEP));
        self.boxes = boxes;
    }

    /// Wakes everybody.
    pub fn wake_all(&mut self) {
        (0..self.blocks.n()).for_each(|block| self.wake(block));
    }

    fn wake(&mut self, block: usize) {
        if self.state[block] == ASLEEP {
            self.account.n_woken += 1;
            self.has_changed = true;
        }
        self.state[block] = 0;
    }

    /// Step 2: the loads on sleeping grains beside the zone, once the forces of a step are complete. Clears them.
    pub fn watch<P: Precision>(&mut self, grains: &mut Grains<P>, gravity: Vec3, time_step: f64) {
        let (mut withheld, mut imbalance) = (self.far_imbalance, 0.0);
        for held in &self.held {
            let place = held.grain as usize;
            let load = std::mem::take(&mut grains.loads[place]);
            let sphere = &grains.spheres[place];
            let force = vec3(load.force) + held.carried[0] + gravity * sphere.mass.to_f64();
            let torque = vec3(load.torque) + held.carried[1];
            withheld += force;
            imbalance += force.norm();
            let turning = torque.norm() / sphere.radius.to_f64();
            if force.norm() > held.limit || turning > held.limit {
                self.tripped.push(self.blocks.of(to_f64(sphere)));
                self.is_due = true;
            }
        }
        self.account.withheld += withheld * time_step;
        self.account.imbalance = imbalance;
    }

    /// Grains that sleep neither move nor keep an acceleration, whatever a corrector over all grains made of them.
    pub fn hold_still<P: Precision>(&mut self, grains: &mut Grains<P>) {
        self.look_for_surprises(grains);
        let held = self.held.iter().map(|held| held.grain as usize);
        for place in held.chain(self.n_listed..grains.len()) {
            grains.spheres[place].velocity = Vector::ZERO;
            grains.spheres[place].spin = Vector::ZERO;
            grains.accelerations[place] = [Vector::ZERO; 2];
        }
    }

    /// Tools that touch sleeping grains which nobody watches.
    fn look_for_surprises<P: Precision>(&mut self, grains: &mut Grains<P>) {
        for place in self.n_listed..grains.len() {
            if grains.loads[place] != Load::default() {
                grains.loads[place] = Load::default();
                self.account.n_surprised += 1;
                self.tripped.push(self.blocks.of(to_f64(&grains.spheres[place])));
                self.is_due = true;
            }
        }
    }

    /// Steps 3 and 4: who wakes, and now and then who falls asleep.
    pub fn look<P: Precision>(&mut self, grains: &mut Grains<P>, time_step: f64) {
        self.steps_since_look += 1;
        let steps_per_look = (self.settings.calm_time_s / (f64::from(LOOKS) * time_step)).ceil().max(1.0);
        let is_regular = f64::from(self.steps_since_look) >= steps_per_look;
        // Between two looks some wakings at a time: each of them makes the lists anew.
        let steps_per_waking = (steps_per_look / WAKINGS).floor().max(1.0);
        let may_wake = f64::from(self.steps_since_look) % steps_per_waking == 0.0;
        if !(is_regular || self.is_due && may_wake) {
            return;
        }
        if is_regular {
            self.look_for_surprises(grains);
        }
        self.wake_where_grains_came(grains);
        // 3. Who is out of balance wakes with its block; so do tools' boxes.
        let mut flags = vec![false; self.blocks.n()];
        for block in std::mem::take(&mut self.tripped) {
            flags[block] = true;
        }
        let boxes = std::mem::take(&mut self.boxes);
        for block in boxes.iter().flat_map(|b| self.blocks.in_box(b)) {
            flags[block] = true;
        }
        self.boxes = boxes;
        (0..flags.len()).filter(|&block| flags[block]).for_each(|block| self.wake(block));
        self.is_due = false;
        if is_regular {
            self.steps_since_look = 0;
            self.settle_down(grains, flags);
        }
    }

    /// 4. Blocks whose grains have all been calm for long enough fall asleep.
    fn settle_down<P: Precision>(&mut self, grains: &Grains<P>, mut is_busy: Vec<bool>) {
        let limit = self.settings.calm_speed.powi(2);
        let runs = std::mem::take(&mut self.runs);
        for place in runs.iter().flatten().cloned().flatten() {
            let sphere = &grains.spheres[place as usize];
            let turning = sphere.radius.to_f64().powi(2) * sphere.spin.norm_squared().to_f64();
            let block = self.blocks.of(to_f64(sphere));
            is_busy[block] |= sphere.velocity.norm_squared().to_f64().max(turning) > limit;
        }
        self.runs = runs;
        for (state, is_busy) in self.state.iter_mut().zip(is_busy).filter(|(state, _)| **state != ASLEEP) {
            *state = if is_busy { 0 } else { *state + 1 };
            if *state > LOOKS {
                *state = ASLEEP;
                self.has_changed = true;
                self.account.n_fallen_asleep += 1;
            }
        }
    }

    /// Sleeping blocks that moving grains have come into wake.
    pub fn wake_where_grains_came<P: Precision>(&mut self, grains: &Grains<P>) {
        if self.account.n_awake == grains.len() && self.account.n_fallen_asleep == 0 {
            return;
        }
        let runs = std::mem::take(&mut self.runs);
        for place in runs.iter().flatten().cloned().flatten() {
            let block = self.blocks.of(to_f64(&grains.spheres[place as usize]));
            if self.state[block] == ASLEEP {
                self.wake(block);
            }
        }
        self.runs = runs;
    }

    /// Whether each of the first `n` grains lies in a sleeping block, and whether in one near somebody awake.
    pub fn partition<P: Precision>(&self, grains: &Grains<P>, n: usize) -> (Vec<bool>, Vec<bool>) {
        let awake: Vec<bool> = self.state.iter().map(|&state| state != ASLEEP).collect();
        // Two of the largest grains and the widest skin.
        let near = self.blocks.grown(awake.clone(), 3.0 * grains.largest_radius);
        let block = |sphere| self.blocks.of(to_f64(sphere));
        let blocks: Vec<usize> = grains.spheres[..n].iter().map(block).collect();
        (
            blocks.iter().map(|&block| !awake[block]).collect(),
            blocks.iter().map(|&block| near[block]).collect(),
        )
    }

    /// Accounts for what a grain had when it fell asleep, and stops it.
    pub fn stop<P: Precision>(&mut self, grains: &mut Grains<P>, place: usize) {
        let sphere = &grains.spheres[place];
        let mass = sphere.mass.to_f64();
        let spin_energy = 0.5 * grains.spin_momentum(place).dot(&vec3(sphere.spin));
        let velocity = vec3(sphere.velocity);
        self.account.momentum_taken += velocity * mass;
        self.account.energy_taken += 0.5 * mass * velocity.norm_squared() + spin_energy;
        grains.spheres[place].velocity = Vector::ZERO;
        grains.spheres[place].spin = Vector::ZERO;
        grains.accelerations[place] = [Vector::ZERO; 2];
    }

    /// Takes note of the new places of grains: `slabs` are their ranges, `is_asleep` is by place, `order` holds old places.
    pub fn number_anew(
        &mut self,
        slabs: impl Iterator<Item = Range<u32>>,
        is_asleep: &[bool],
        order: &[u32],
    ) {
        self.runs.clear();
        let mut held = Vec::new();
        for range in slabs {
            let mut runs: Vec<Range<u32>> = Vec::new();
            for place in range {
                if is_asleep[place as usize] {
                    held.push(place);
                } else {
                    match runs.last_mut() {
                        Some(run) if run.end == place => run.end += 1,
                        _ => runs.push(place..place + 1),
                    }
                }
            }
            self.runs.push(runs);
        }
        self.account.n_awake = self.runs.iter().flatten().map(|run| run.len()).sum();
        // Who is held changes only when somebody falls asleep or wakes; then all are weighed anew.
        let before = std::mem::take(&mut self.held);
        let as_before = |grain: u32| {
            let found = before.binary_search_by_key(&order[grain as usize], |held| held.grain);
            found.ok().map(|place| Held { grain, ..before[place] })
        };
        let not_weighed = |grain| Held { grain, carried: [Vec3::zeros(); 2], limit: f64::INFINITY };
        self.held =
            held.into_iter().map(|grain| as_before(grain).unwrap_or_else(|| not_weighed(grain))).collect();
    }

    /// Places of listed grains that sleep.
    pub fn held(&self) -> impl Iterator<Item = usize> {
        self.held.iter().map(|held| held.grain as usize)
    }

    /// Step 1: what sleeping neighbours and planes carry of each held grain, found in the loads of `grains`.
    pub fn weigh<P: Precision>(&mut self, grains: &Grains<P>, gravity: Vec3) {
        for held in &mut self.held {
            let place = held.grain as usize;
            let load = &grains.loads[place];
            held.carried = [vec3(load.force), vec3(load.torque)];
            let weight = grains.spheres[place].mass.to_f64() * gravity.norm();
            held.limit = self.settings.imbalance * (weight + held.carried[0].norm());
        }
        self.far_imbalance = Vec3::zeros();
        for place in self.n_listed..grains.len() {
            let weight = gravity * grains.spheres[place].mass.to_f64();
            self.far_imbalance += vec3(grains.loads[place].force) + weight;
        }
        self.has_changed = false;
    }

    /// Memory held [bytes].
    pub fn bytes(&self) -> usize {
        2 * self.state.capacity() + size_of::<Held>() * self.held.capacity() + self.sleepers.bytes()
    }
}

fn vec3<T: Real>(v: Vector<T>) -> Vec3 {
    let v = v.cast::<f64>();
    Vec3::new(v.x, v.y, v.z)
}
