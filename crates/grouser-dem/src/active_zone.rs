//! The active zone: grains at rest and out of reach of every tool are held in place, at no cost, until something reaches them.
//!
//! ```text
//!   . . . . . . . . . . .      .  asleep: no list, no force, no motion; last in the arrays
//!   . . h h h h h . . . .      h  asleep beside somebody awake: listed, infinitely heavy
//!   . h h o o o h h . . .      o  awake
//!   . h o o T o o h . . .      T  tool
//! ```
//!
//! The algorithm is in `docs/theory/active_zone.md`; numbers in comments are its steps.

use crate::BedSettings;
use crate::Grains;
use crate::border::Border;
use crate::cell_grid::to_f64;
use crate::sleepers::Sleepers;
use crate::zone_blocks::Blocks;
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
    pub rest_speed: f64,
    /// Time for which every grain of a block must be seen at rest before it falls asleep [s].
    pub rest_time_s: f64,
    /// Change of the force on a sleeping block by its awake neighbours, over that force when the block fell asleep and the
    /// block's weight, beyond which it wakes [-]; infinite: never.
    pub wake: f64,
}

/// What the zone did so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ZoneAccount {
    /// Grains that are awake now.
    pub n_awake: usize,
    /// Impulse that sleeping grains took up from awake ones and from tools [N·s].
    pub border_impulse: Vec3,
    /// Momentum of grains when they fell asleep [kg·m/s].
    pub momentum_taken: Vec3,
    /// Kinetic energy of grains when they fell asleep [J].
    pub energy_taken: f64,
    /// How often the zone changed: each time costs about as much as making all lists anew.
    pub n_changes: u64,
    /// Blocks woken because the force on them changed, or because moving grains came into them.
    pub n_woken: u64,
    /// Sleeping grains that a tool touched far from anybody awake: its reach was not announced in time.
    pub n_surprised: u64,
}

/// State of a block that sleeps; any other number counts the looks for which it has been at rest.
const ASLEEP: u16 = u16::MAX;
/// Looks at the speeds of grains within the time of rest.
const LOOKS: u16 = 4;

/// Distance from awake blocks within which sleeping grains are listed, in radii of the largest grain: two of them, twice the largest
/// leeway, and the depth to which moving grains may come into sleeping blocks.
const NEAR: f64 = 4.0;

/// The active zone of a bed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "M: serde::Serialize + serde::de::DeserializeOwned")]
pub(crate) struct Zone<M> {
    settings: ActiveZone,
    blocks: Blocks,
    state: Vec<u16>,
    /// Blocks with sleeping grains.
    has_sleepers: Vec<bool>,
    /// Bounding boxes of tools [m], and the distance within which nobody sleeps [m].
    boxes: Vec<[Vec3; 2]>,
    reach: f64,
    steps_since_look: u32,
    looks_since_sleep: u16,
    /// Somebody must be woken now.
    is_due: bool,
    /// Somebody is to fall asleep or to wake when the lists are made next.
    pub has_changed: bool,
    /// Which of the listed grains are asleep, by place; grains behind them all are.
    pub is_asleep: Vec<bool>,
    /// Ranges of grains that move, for each slab.
    pub runs: Vec<Vec<Range<u32>>>,
    border: Border,
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
            has_sleepers: vec![false; blocks.n()],
            blocks,
            boxes: Vec::new(),
            reach: 0.0,
            steps_since_look: 0,
            looks_since_sleep: 0,
            is_due: false,
            has_changed: false,
            is_asleep: vec![false; n_grains],
            runs: vec![std::iter::once(0..n_grains as u32).collect()],
            border: Border::default(),
            sleepers: Sleepers::none(bed.planes.len()),
            plane_forces: vec![Vec3::zeros(); bed.planes.len()],
            elastic: ContactLedger::default(),
            account: ZoneAccount { n_awake: n_grains, ..Default::default() },
        }
    }

    /// Number of listed grains.
    pub fn n_listed(&self) -> usize {
        self.is_asleep.len()
    }

    /// Ranges of grains that move.
    pub fn moving(&self) -> impl Iterator<Item = Range<usize>> {
        self.runs.iter().flatten().map(|run| run.start as usize..run.end as usize)
    }

    /// 1. Blocks within `reach` [m] of `boxes` [m] are awake from now on, in place of those named before.
    pub fn keep_awake(&mut self, boxes: Vec<[Vec3; 2]>, reach: f64) {
        (self.boxes, self.reach) = (boxes, reach);
        let mut near = self.boxes.iter().flat_map(|tool| self.blocks.within(tool, reach));
        self.is_due |= near.any(|block| self.state[block] == ASLEEP);
    }

    /// Wakes everybody.
    pub fn wake_all(&mut self) {
        self.state.fill(0);
        self.has_changed = true;
    }

    /// After each step: takes up the loads on sleeping grains, and now and then decides who wakes and who falls asleep.
    pub fn look<P: Precision>(&mut self, grains: &mut Grains<P>, time_step: f64, gravity: f64) {
        // 2. The border takes up what it receives.
        self.account.border_impulse += self.border.take_up(grains) * time_step;
        self.steps_since_look += 1;
        let steps_per_look =
            (self.settings.rest_time_s / (f64::from(LOOKS) * time_step)).ceil().max(1.0) as u32;
        let is_regular = self.steps_since_look >= steps_per_look;
        if !is_regular && !self.is_due {
            return;
        }
        let mut wakes = vec![false; self.blocks.n()];
        for block in self.boxes.iter().flat_map(|tool| self.blocks.within(tool, self.reach)) {
            wakes[block] = true;
        }
        self.is_due = false;
        if is_regular {
            self.steps_since_look = 0;
            // 3. Whose load has changed wakes.
            for block in self.border.changed(self.settings.wake, gravity) {
                wakes[block as usize] = true;
                self.account.n_woken += 1;
            }
            self.look_for_surprises(grains, &mut wakes);
        }
        for (block, _) in wakes.iter().enumerate().filter(|&(_, wakes)| *wakes) {
            self.has_changed |= self.state[block] == ASLEEP;
            self.state[block] = 0;
        }
        if is_regular {
            self.settle_down(grains, wakes);
        }
    }

    /// 4. Blocks whose grains have all been at rest for long enough fall asleep.
    fn settle_down<P: Precision>(&mut self, grains: &Grains<P>, mut is_busy: Vec<bool>) {
        let mut is_empty = vec![true; self.blocks.n()];
        for place in self.runs.iter().flatten().cloned().flatten() {
            let sphere = &grains.spheres[place as usize];
            let block = self.blocks.of(to_f64(sphere));
            is_busy[block] |= !self.is_at_rest(sphere);
            is_empty[block] = false;
        }
        // All of them at once: each change has its price.
        self.looks_since_sleep += 1;
        let is_time = self.looks_since_sleep >= LOOKS;
        if is_time {
            self.looks_since_sleep = 0;
        }
        for (block, state) in self.state.iter_mut().enumerate().filter(|(_, state)| **state != ASLEEP) {
            *state = if is_busy[block] { 0 } else { (*state + 1).min(LOOKS) };
            if is_time && *state == LOOKS {
                *state = ASLEEP;
                self.has_changed |= !is_empty[block];
            }
        }
    }

    fn is_at_rest<P: Precision>(&self, sphere: &grouser_contact::Sphere<P>) -> bool {
        let turning = sphere.radius.to_f64().powi(2) * sphere.spin.norm_squared().to_f64();
        sphere.velocity.norm_squared().to_f64().max(turning) <= self.settings.rest_speed.powi(2)
    }

    /// Tools that touch sleeping grains beside which nobody is awake.
    fn look_for_surprises<P: Precision>(&mut self, grains: &mut Grains<P>, wakes: &mut [bool]) {
        let n_listed = self.n_listed();
        let asleep = (0..n_listed).filter(|&place| self.is_asleep[place]).chain(n_listed..grains.len());
        for place in asleep {
            if grains.loads[place] != Load::default() {
                grains.loads[place] = Load::default();
                self.account.n_surprised += 1;
                wakes[self.blocks.of(to_f64(&grains.spheres[place]))] = true;
            }
        }
    }

    /// 5. Sleeping blocks that moving grains have come into by more than a radius wake, if there are sleeping grains around.
    pub fn wake_where_grains_came<P: Precision>(&mut self, grains: &Grains<P>) {
        let depth = grains.largest_radius;
        for place in self.runs.iter().flatten().cloned().flatten() {
            let centre = to_f64(&grains.spheres[place as usize]);
            let mut around = self.blocks.around(centre, depth);
            let is_deep = around.all(|block| self.state[block] == ASLEEP);
            let mut around = self.blocks.around(centre, NEAR * depth);
            if is_deep && around.any(|block| self.has_sleepers[block]) {
                self.state[self.blocks.of(centre)] = 0;
                self.has_changed = true;
                self.account.n_woken += 1;
            }
        }
    }

    /// The first part of a change: who is asleep from now on, by place. Stops those who fall asleep.
    pub fn fall_asleep_and_wake<P: Precision>(&mut self, grains: &mut Grains<P>) -> Vec<bool> {
        let mut is_asleep = std::mem::take(&mut self.is_asleep);
        is_asleep.resize(grains.len(), true);
        for (place, sleeps) in is_asleep.iter_mut().enumerate() {
            let sphere = &grains.spheres[place];
            let block_sleeps = self.state[self.blocks.of(to_f64(sphere))] == ASLEEP;
            if *sleeps || !block_sleeps {
                *sleeps = block_sleeps;
            } else if self.is_at_rest(sphere) {
                *sleeps = true;
                self.stop(grains, place);
            }
        }
        self.has_sleepers.fill(false);
        for (sphere, _) in grains.spheres.iter().zip(&is_asleep).filter(|(_, sleeps)| **sleeps) {
            self.has_sleepers[self.blocks.of(to_f64(sphere))] = true;
        }
        self.account.n_changes += 1;
        is_asleep
    }

    /// The second part: which grains are to be listed, by place.
    pub fn to_be_listed<P: Precision>(&self, grains: &Grains<P>, is_asleep: &[bool]) -> Vec<bool> {
        let reach = NEAR * grains.largest_radius;
        let is_near = |centre| self.blocks.around(centre, reach).any(|block| self.state[block] != ASLEEP);
        let listed =
            |(sphere, &sleeps): (&grouser_contact::Sphere<P>, &bool)| !sleeps || is_near(to_f64(sphere));
        grains.spheres.iter().zip(is_asleep).map(listed).collect()
    }

    /// Accounts for what a grain had when it fell asleep, and stops it.
    fn stop<P: Precision>(&mut self, grains: &mut Grains<P>, place: usize) {
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

    /// Takes note of the new lists: `slabs` are the ranges of their grains, `pairs` all listed pairs.
    pub fn number_anew<P: Precision>(
        &mut self,
        slabs: impl Iterator<Item = Range<u32>>,
        pairs: impl Iterator<Item = [u32; 2]>,
        grains: &Grains<P>,
    ) {
        self.runs.clear();
        for range in slabs {
            let mut runs: Vec<Range<u32>> = Vec::new();
            for place in range.filter(|&place| !self.is_asleep[place as usize]) {
                match runs.last_mut() {
                    Some(run) if run.end == place => run.end += 1,
                    _ => runs.push(place..place + 1),
                }
            }
            self.runs.push(runs);
        }
        self.account.n_awake = self.runs.iter().flatten().map(ExactSizeIterator::len).sum();
        let mut is_beside = vec![false; self.n_listed()];
        for [i, j] in pairs.map(|pair| pair.map(|place| place as usize)) {
            is_beside[i] |= self.is_asleep[i];
            is_beside[j] |= self.is_asleep[j];
        }
        let held = (0..self.n_listed() as u32).filter(|&place| is_beside[place as usize]);
        self.border.renew(held, grains, &self.blocks, self.has_changed);
        self.has_changed = false;
    }

    /// Memory held [bytes].
    pub fn bytes(&self) -> usize {
        2 * self.state.capacity() + self.is_asleep.capacity() + self.border.bytes() + self.sleepers.bytes()
    }
}

fn vec3<T: Real>(v: Vector<T>) -> Vec3 {
    let v = v.cast::<f64>();
    Vec3::new(v.x, v.y, v.z)
}
