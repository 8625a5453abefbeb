//! What the ground of one cell remembers: which share of it lies how deep.
//!
//! Where in its cell a level lies is not known. Gear and ground are both sorted by depth and lie one on the other: the lowest part of the
//! gear on the deepest part of the ground, so that each part finds its own print again (G1 in `docs/theory/iscm.md`).

use serde::{Deserialize, Serialize};

/// Most levels that a cell remembers: prints of grousers, of plates, and what lies beside them.
pub(crate) const MOST_LEVELS: usize = 3;
/// Share of a cell below which a level is not told from its neighbour.
const SLIVER: f64 = 1e-6;
/// Share of a cell below which gear that reaches over to another level still stands on its own.
const OVERHANG: f64 = 0.02;
/// Largest share of gear that counts as such.
const LARGEST_OVERHANG: f64 = 0.15;
/// Root of what may be moved so that two levels count as one (Ward's criterion) \[m\].
const LEVEL: f64 = 5e-5;

/// A share of a cell that was pressed equally deep.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Level {
    /// Share of the cell.
    pub share: f64,
    /// Depth below the undisturbed ground \[m\].
    pub sinkage: f64,
    /// Deepest that it has been under load \[m\].
    pub deepest: f64,
}

impl Level {
    /// The mean of two.
    fn joined(self, other: Self) -> Self {
        let share = self.share + other.share;
        let mean = |a: f64, b: f64| if share > 0.0 { (self.share * a + other.share * b) / share } else { a };
        Self { share, sinkage: mean(self.sinkage, other.sinkage), deepest: mean(self.deepest, other.deepest) }
    }

    /// What joining two moves, by share and squared way (Ward's criterion).
    fn apart(self, other: Self) -> f64 {
        let share = (self.share + other.share).max(1e-300);
        self.share * other.share / share * (self.sinkage - other.sinkage).powi(2)
    }
}

/// A part of the gear that came to stand on one level of a cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pressed {
    /// The level.
    pub level: usize,
    /// Share of the cell.
    pub share: f64,
    /// Height of its underside \[m\].
    pub height: f64,
}

/// Levels of a cell, the deepest first; shares add up to one and are zero for those that there are not.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Levels([Level; MOST_LEVELS]);

impl Default for Levels {
    fn default() -> Self {
        let mut levels = [Level::default(); MOST_LEVELS];
        levels[0].share = 1.0;
        Self(levels)
    }
}

impl Levels {
    /// Whether the whole cell is level.
    #[inline(always)]
    pub fn is_one(&self) -> bool {
        self.0[1].share == 0.0
    }

    /// Level `n`, or the highest one below it.
    #[inline(always)]
    pub fn get(&self, n: usize) -> &Level {
        let last = (1..=n).take_while(|&k| self.0[k].share > 0.0).last().unwrap_or(0);
        &self.0[last]
    }

    /// Mean sinkage by shares \[m\].
    pub fn mean_sinkage(&self) -> f64 {
        self.0.iter().map(|level| level.share * level.sinkage).sum()
    }

    /// G1: how much of each level gear covers that takes the shares from `low` to `high` of the cell, lower gear first.
    #[inline(always)]
    pub fn overlaps(&self, low: f64, high: f64) -> [f64; MOST_LEVELS] {
        let mut overlaps = [0.0; MOST_LEVELS];
        let mut below = 0.0;
        // Without a branch: how many levels there are is not to be foreseen. Above the last one nothing is left.
        for k in 0..MOST_LEVELS {
            let is_last = k + 1 == MOST_LEVELS || self.0[k + 1].share == 0.0;
            let upper = if is_last { f64::INFINITY } else { below + self.0[k].share };
            let overlap = high.min(upper) - low.max(below);
            overlaps[k] = if overlap > 0.0 { overlap } else { 0.0 };
            below = upper;
        }
        without_overhangs(overlaps, high - low)
    }

    /// G2: the levels after `parts` pressed on them; `pressed` gives what a level becomes that a part presses, nothing where it stands above.
    /// `all` is working space.
    pub fn after(
        &self,
        parts: &[Pressed],
        pressed: impl Fn(&Level, f64) -> Option<Level>,
        all: &mut Vec<Level>,
    ) -> Option<Self> {
        let mut left = self.0;
        all.clear();
        for part in parts {
            let level = self.get(part.level);
            let share = part.share.min(left[part.level].share);
            if share > SLIVER
                && let Some(level) = pressed(level, part.height)
            {
                all.push(Level { share, ..level });
                left[part.level].share -= share;
            }
        }
        if all.is_empty() {
            return None;
        }
        all.extend(left.into_iter().filter(|level| level.share > SLIVER));
        all.sort_by(|a, b| b.sinkage.total_cmp(&a.sinkage));
        while all.len() > 1 {
            let pairs = all.windows(2).enumerate();
            let cost = |pair: &[Level]| {
                let is_sliver = pair.iter().any(|level| level.share < SLIVER);
                if is_sliver { 0.0 } else { pair[0].apart(pair[1]) }
            };
            let Some((n, least)) = pairs.map(|(n, pair)| (n, cost(pair))).min_by(|a, b| a.1.total_cmp(&b.1))
            else {
                break;
            };
            if all.len() <= MOST_LEVELS && least > LEVEL * LEVEL {
                break;
            }
            all[n] = all[n].joined(all[n + 1]);
            all.remove(n + 1);
        }
        let whole: f64 = all.iter().map(|level| level.share).sum();
        let mut levels = [Level::default(); MOST_LEVELS];
        for (level, &of) in levels.iter_mut().zip(&*all) {
            *level = Level { share: of.share / whole, ..of };
        }
        Some(Self(levels))
    }
}

/// Gives what lies barely on a level to the others, so that nothing jumps: between one and two times what counts as barely by halves.
#[inline(always)]
fn without_overhangs(mut overlaps: [f64; MOST_LEVELS], whole: f64) -> [f64; MOST_LEVELS] {
    let least = OVERHANG.min(LARGEST_OVERHANG * whole);
    if overlaps.iter().all(|&overlap| overlap == 0.0 || overlap >= 2.0 * least) {
        return overlaps;
    }
    for overlap in &mut overlaps {
        *overlap = overlap.min((2.0 * (*overlap - least)).max(0.0));
    }
    let left: f64 = overlaps.iter().sum();
    overlaps.map(|overlap| overlap * whole / left)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Shares 0.3, 0.4 and 0.3 at depths of 0.13, 0.10 and 0.07 m.
    fn prints() -> Levels {
        let level = |share, sinkage| Level { share, sinkage, deepest: sinkage };
        Levels([level(0.3, 0.13), level(0.4, 0.10), level(0.3, 0.07)])
    }

    #[test]
    fn gear_stands_on_the_levels_without_a_jump_and_with_all_that_it_covers() {
        let levels = prints();
        let n = 2000;
        let mut before: Option<[f64; MOST_LEVELS]> = None;
        for k in 0..=n {
            // A part of half of the cell moves over it from one end to the other.
            let low = 0.5 * f64::from(k) / f64::from(n);
            let overlaps = levels.overlaps(low, low + 0.5);
            assert!((overlaps.iter().sum::<f64>() - 0.5).abs() < 1e-12, "{overlaps:?}");
            if let Some(before) = before.replace(overlaps) {
                let moved = before.iter().zip(overlaps).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(moved < 3.0 * 0.5 / f64::from(n), "{moved} from {before:?} to {overlaps:?}");
            }
        }
    }

    #[test]
    fn parts_find_their_own_prints_and_overhangs_press_nothing() {
        let levels = prints();
        for (part, [low, high]) in [[0.0, 0.3], [0.3, 0.7], [0.7, 1.0]].into_iter().enumerate() {
            for off in [-4e-3, 0.0, 4e-3] {
                let (low, high) = (f64::max(low + off, 0.0), f64::min(high + off, 1.0));
                let overlaps = levels.overlaps(low, high);
                assert!((overlaps[part] - (high - low)).abs() < 1e-12, "{part} by {off}: {overlaps:?}");
            }
        }
    }

    #[test]
    fn presses_keep_the_volume_of_four_levels_that_become_three() {
        let pressed = |level: &Level, height: f64| {
            (-height > level.sinkage).then_some(Level { sinkage: -height, deepest: -height, ..*level })
        };
        let parts =
            [Pressed { level: 2, share: 0.1, height: -0.2 }, Pressed { level: 0, share: 0.3, height: -0.01 }];
        let after = prints().after(&parts, pressed, &mut Vec::new()).unwrap();
        let volume = |levels: &Levels| levels.0.iter().map(|level| level.share * level.sinkage).sum::<f64>();
        assert!((volume(&after) - volume(&prints()) - 0.1 * (0.2 - 0.07)).abs() < 1e-12, "{after:?}");
        // The two nearest by share and depth are joined: what was left at 0.07 m and what lay at 0.10 m.
        assert!((after.get(2).sinkage - (0.2 * 0.07 + 0.4 * 0.10) / 0.6).abs() < 1e-12, "{after:?}");
        assert!(after.get(0).sinkage == 0.2 && after.get(1).sinkage == 0.13, "{after:?}");
        assert!(prints().after(&parts[1..], pressed, &mut Vec::new()).is_none());
    }
}
