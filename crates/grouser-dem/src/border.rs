//! The border of the active zone: sleeping grains that awake ones press on.

use crate::Grains;
use crate::cell_grid::to_f64;
use crate::zone_blocks::Blocks;
use grouser_contact::{Precision, Real};
use grouser_geometry::Vec3;
use serde::{Deserialize, Serialize};

/// A sleeping block with grains beside awake ones.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Pressed {
    block: u32,
    /// Mass of its grains at the border [kg].
    mass: f64,
    /// Force of awake grains and tools on it in this step [N].
    now: Vec3,
    /// The same at the first look after the zone changed last.
    before: Option<Vec3>,
}

/// Grains at the border, and the blocks that they belong to.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Border {
    /// Place of each grain and the number of its block in `pressed`.
    grains: Vec<(u32, u32)>,
    /// By rising block.
    pressed: Vec<Pressed>,
}

impl Border {
    /// The border anew, of the grains at places `held`. Forces to compare with are kept unless the zone has changed.
    pub fn renew<P: Precision>(
        &mut self,
        held: impl Iterator<Item = u32>,
        grains: &Grains<P>,
        blocks: &Blocks,
        has_changed: bool,
    ) {
        let of = |place: u32| (blocks.of(to_f64(&grains.spheres[place as usize])) as u32, place);
        let mut by_block: Vec<(u32, u32)> = held.map(of).collect();
        by_block.sort_unstable();
        let old = std::mem::take(&mut self.pressed);
        self.grains.clear();
        for (block, place) in by_block {
            if self.pressed.last().is_none_or(|last| last.block != block) {
                let before = old.binary_search_by_key(&block, |pressed| pressed.block).ok();
                let before = before.filter(|_| !has_changed).and_then(|index| old[index].before);
                self.pressed.push(Pressed { block, mass: 0.0, now: Vec3::zeros(), before });
            }
            let index = self.pressed.len() - 1;
            self.pressed[index].mass += grains.spheres[place as usize].mass.to_f64();
            self.grains.push((place, index as u32));
        }
    }

    /// Takes the loads of one step off the grains at the border; gives their sum [N].
    pub fn take_up<P: Precision>(&mut self, grains: &mut Grains<P>) -> Vec3 {
        for pressed in &mut self.pressed {
            pressed.now = Vec3::zeros();
        }
        for &(place, index) in &self.grains {
            let load = std::mem::take(&mut grains.loads[place as usize]);
            let force = load.force.cast::<f64>();
            self.pressed[index as usize].now += Vec3::new(force.x, force.y, force.z);
        }
        self.pressed.iter().map(|pressed| pressed.now).sum()
    }

    /// Blocks whose force differs from that to compare with by more than `share` of it and of the weight of their grains at the
    /// border, under gravity of size `gravity` [m/s²]. The first look after a change only takes note.
    pub fn changed(&mut self, share: f64, gravity: f64) -> Vec<u32> {
        let mut changed = Vec::new();
        for pressed in &mut self.pressed {
            let before = *pressed.before.get_or_insert(pressed.now);
            if (pressed.now - before).norm() > share * (before.norm() + pressed.mass * gravity) {
                changed.push(pressed.block);
            }
        }
        changed
    }

    /// Memory held [bytes].
    pub fn bytes(&self) -> usize {
        8 * self.grains.capacity() + size_of::<Pressed>() * self.pressed.capacity()
    }
}
