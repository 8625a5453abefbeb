//! Points of the ground under running gear and triangles between them.

use crate::polygon::{Sag, largest};

/// A point of the ground under running gear.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Site {
    /// Node of the terrain.
    pub on_grid: usize,
    /// Place of the underside as drawn \[m\].
    pub position: [f64; 3],
    /// Slope of the underside ∂h/∂x, ∂h/∂y \[-\].
    pub slope: [f64; 2],
    /// Share of the point's cell in which the gear stands on this level.
    pub share: f64,
    /// Height of that level \[m\].
    pub ground: f64,
    /// Which object of the gear lies here.
    pub owner: u16,
}

/// Points of the ground, number by number: the place of the underside, its slope, and so on as in [`Site`].
#[derive(Clone, Debug, Default)]
pub(crate) struct Sites {
    pub position: [Vec<f64>; 3],
    pub slope: [Vec<f64>; 2],
    pub share: Vec<f64>,
    pub ground: Vec<f64>,
    /// Height of the undisturbed ground \[m\].
    pub undisturbed: Vec<f64>,
    pub on_grid: Vec<u32>,
    pub owner: Vec<u16>,
}

impl Sites {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.on_grid.len()
    }

    /// Point `n`.
    #[inline(always)]
    pub fn get(&self, n: usize) -> Site {
        Site {
            on_grid: self.on_grid[n] as usize,
            position: [self.position[0][n], self.position[1][n], self.position[2][n]],
            slope: [self.slope[0][n], self.slope[1][n]],
            share: self.share[n],
            ground: self.ground[n],
            owner: self.owner[n],
        }
    }
}

/// A triangle between three points of the ground.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facet {
    /// Its corners.
    pub sites: [u32; 3],
    /// Object of the gear with the largest share of its corners.
    pub owner: u16,
    /// Whether all corners lie on a rigid object.
    pub is_fixed: bool,
}

/// Triangles, and how the underside sags between the corners of each; nothing for flat undersides.
#[derive(Clone, Debug, Default)]
pub(crate) struct Facets {
    pub facets: Vec<Facet>,
    pub sags: Vec<Sag>,
}

impl Facets {
    /// How the underside of triangle `n` sags.
    #[inline(always)]
    pub fn sag(&self, n: usize) -> Sag {
        self.sags.get(n).copied().unwrap_or_default()
    }

    /// The triangles on which gear presses that lies below the ground by `depths` \[m\] at the points.
    #[inline(always)]
    pub fn pressing(&self, depths: &[f64], found: &mut Vec<u32>) {
        let deepest = |facet: &Facet| largest(facet.sites.map(|site| depths[site as usize]));
        found.clear();
        found.resize(self.facets.len(), 0);
        let mut n = 0;
        // Without a branch: which triangles press is not to be foreseen.
        if self.sags.is_empty() {
            for (k, facet) in self.facets.iter().enumerate() {
                found[n] = k as u32;
                n += 1 - usize::from(deepest(facet) <= 0.0);
            }
        } else {
            for (k, (facet, sag)) in self.facets.iter().zip(&self.sags).enumerate() {
                found[n] = k as u32;
                n += 1 - usize::from(deepest(facet) + sag.most() <= 0.0);
            }
        }
        found.truncate(n);
    }
}

/// The owner with the largest share of three corners.
#[inline(always)]
pub(super) fn owner(corners: [(u16, f64); 3]) -> u16 {
    let [a, b, c] = corners.map(|corner| corner.0);
    if a == b && a == c {
        return a;
    }
    let held = |owner: u16| -> f64 { corners.iter().filter(|c| c.0 == owner).map(|c| c.1).sum() };
    [b, c].into_iter().fold(a, |best, other| if held(other) > held(best) { other } else { best })
}
