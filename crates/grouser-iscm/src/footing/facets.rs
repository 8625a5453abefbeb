//! Points of the ground under running gear and triangles between them.

use crate::polygon::{Sag, largest, smallest};

/// Points of the ground under running gear, number by number.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sites {
    /// Place of the underside as drawn \[m\].
    pub position: [Vec<f64>; 3],
    /// Slope of the underside ∂h/∂x, ∂h/∂y \[-\].
    pub slope: [Vec<f64>; 2],
    /// Height of the undisturbed ground \[m\].
    pub undisturbed: Vec<f64>,
    /// Node of the terrain.
    pub on_grid: Vec<u32>,
    /// Which object of the gear lies here.
    pub owner: Vec<u16>,
}

impl Sites {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.on_grid.len()
    }

    /// Place of the underside of point `n` as drawn \[m\].
    #[inline(always)]
    pub fn position(&self, n: usize) -> [f64; 3] {
        [self.position[0][n], self.position[1][n], self.position[2][n]]
    }
}

/// A triangle between three points of the ground.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facet {
    /// Its corners.
    pub sites: [u32; 3],
    /// One bit for each level of the ground on which it may press.
    pub levels: u8,
    /// Whether all corners lie on a rigid object.
    pub is_fixed: bool,
}

/// Triangles, and how the underside sags between the corners of each; nothing for flat undersides.
#[derive(Clone, Debug, Default)]
pub(crate) struct Facets {
    pub facets: Vec<Facet>,
    pub sags: Vec<Sag>,
}

/// A triangle and one bit for each level of the ground on which it presses.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct OnLevels {
    pub facet: u32,
    pub levels: u8,
}

/// Triangles that press.
#[derive(Debug, Default)]
pub(crate) struct Pressing {
    /// Deep in some levels, so that only the sum of what they share counts.
    pub deep: Vec<OnLevels>,
    /// On one level each: at its edge, or not deep.
    pub partly: Vec<OnLevels>,
    /// Working space.
    below: Vec<u8>,
    beyond: Vec<u8>,
}

impl Facets {
    /// How the underside of triangle `n` sags.
    #[inline(always)]
    pub fn sag(&self, n: usize) -> Sag {
        self.sags.get(n).copied().unwrap_or_default()
    }

    /// The triangles on which gear presses that lies below each level of the ground by `depths` \[m\] at the points; all of what is deeper
    /// than `contact` \[m\] is deep.
    #[inline(always)]
    pub fn pressing(&self, depths: &[Vec<f64>], contact: f64, found: &mut Pressing) {
        let Pressing { deep, partly, below, beyond } = found;
        if self.sags.is_empty() {
            // Which points do can be told beforehand, one bit a level.
            bits(depths, 0.0, below);
            bits(depths, contact, beyond);
            self.find(deep, partly, |_, Facet { sites, .. }| {
                let [a, b, c] = sites.map(|site| below[site as usize]);
                let [d, e, f] = sites.map(|site| beyond[site as usize]);
                [a | b | c, d & e & f]
            });
        } else {
            self.find(deep, partly, |n, Facet { sites, .. }| {
                let [least, most] = self.sags[n].range();
                let mut bits = [0, 0];
                for (level, depths) in depths.iter().enumerate() {
                    let depths = sites.map(|site| depths[site as usize]);
                    bits[0] |= u8::from(largest(depths) + most > 0.0) << level;
                    bits[1] |= u8::from(smallest(depths) + least >= contact) << level;
                }
                bits
            });
        }
    }

    /// Finds triangles of which `of` says on which levels they would press and on which they would be deep.
    #[inline(always)]
    fn find(
        &self,
        deep: &mut Vec<OnLevels>,
        partly: &mut Vec<OnLevels>,
        of: impl Fn(usize, &Facet) -> [u8; 2],
    ) {
        deep.resize(self.facets.len(), OnLevels::default());
        partly.clear();
        let mut n_deep = 0;
        for (n, facet) in self.facets.iter().enumerate() {
            let [presses, is_deep] = of(n, facet);
            let (presses, is_deep) = (presses & facet.levels, presses & is_deep & facet.levels);
            let facet = n as u32;
            // Without a branch: which triangles are deep is not to be foreseen.
            deep[n_deep] = OnLevels { facet, levels: is_deep };
            n_deep += usize::from(is_deep != 0);
            let mut left = presses & !is_deep;
            while left != 0 {
                partly.push(OnLevels { facet, levels: left & left.wrapping_neg() });
                left &= left - 1;
            }
        }
        deep.truncate(n_deep);
    }
}

/// One bit for each level of `depths` \[m\] on which a point lies below the ground, at least as deep as `least` \[m\].
#[inline(always)]
fn bits(depths: &[Vec<f64>], least: f64, bits: &mut Vec<u8>) {
    bits.clear();
    bits.resize(depths.first().map_or(0, Vec::len), 0);
    for (level, depths) in depths.iter().enumerate() {
        for (bits, &depth) in bits.iter_mut().zip(depths) {
            *bits |= u8::from(depth >= least && depth > 0.0) << level;
        }
    }
}
