//! Pressure integrated over one triangle of ground by equal sub-triangles (P2 Eqs. (5)–(8)).

use serde::{Deserialize, Serialize};

use crate::response::{KINKS, Kink, Lines, OneArray, Response};

/// How a triangle is integrated of which only some corners are loaded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum PartialLoad {
    /// P2 Eq. (6): a sub-triangle counts whole or not at all; points of the ground are loaded or not.
    Step,
    /// Shares of the corners interpolated: the covered part of a point's cell is its share.
    #[default]
    Proportional,
}

/// Centres of the R² sub-triangles as barycentric coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct SubTriangles {
    resolution: usize,
    centres: Vec<[f64; 3]>,
}

impl SubTriangles {
    /// Divides the sides of a triangle into `resolution` ≥ 1 parts.
    pub fn new(resolution: usize) -> Self {
        let n = resolution.max(1);
        let thirds = 3.0 * n as f64;
        let mut centres = Vec::with_capacity(n * n);
        for i in 0..n {
            for j in 0..n - i {
                let (a, b) = ((3 * i + 1) as f64 / thirds, (3 * j + 1) as f64 / thirds);
                centres.push([1.0 - a - b, a, b]);
                if i + j + 1 < n {
                    let (a, b) = ((3 * i + 2) as f64 / thirds, (3 * j + 2) as f64 / thirds);
                    centres.push([1.0 - a - b, a, b]);
                }
            }
        }
        Self { resolution: n, centres }
    }

    /// Parts per side.
    pub fn resolution(&self) -> usize {
        self.resolution
    }

    /// Barycentric centres of the sub-triangles, each of the same area.
    pub fn centres(&self) -> &[[f64; 3]] {
        &self.centres
    }
}

/// Corners of a triangle under running gear.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corners {
    /// Sinkage if the ground followed the gear \[m\].
    pub z: [f64; 3],
    /// Share of the corner's cell that the gear covers, or 0 and 1 for [`PartialLoad::Step`].
    pub share: [f64; 3],
    /// Depth of the gear below the present ground \[m\]; negative where it is above, ∞ where it no longer matters.
    pub depth: [f64; 3],
    /// How the underside sags between them.
    pub sag: Sag,
}

/// How a curved underside lies below the straight one between the corners of a triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Sag {
    /// By Σ b_k b_l `products` over the sides 0–1, 1–2, 2–0 \[m\].
    pub products: [f64; 3],
    /// Sinkage and depth are larger than those between the corners by at least and at most this \[m\].
    range: [f64; 2],
}

impl Sag {
    /// Four times how far the underside lies below the middle of each side \[m\].
    pub fn new(products: [f64; 3]) -> Self {
        let least: f64 = products.iter().map(|s| s.min(0.0)).sum();
        let most = products.iter().fold(0.0, |most: f64, &s| most.max(s));
        // Σ b_k b_l is at most a third, each product at most a quarter.
        Self { products, range: [0.25 * least, most / 3.0] }
    }

    /// Sinkage and depth are larger than those between the corners by at least and at most this \[m\].
    #[inline(always)]
    pub fn range(&self) -> [f64; 2] {
        self.range
    }

    /// Whether the underside is flat.
    #[inline(always)]
    pub fn is_none(&self) -> bool {
        self.range == [0.0; 2]
    }
}

#[inline(always)]
pub(crate) fn largest([a, b, c]: [f64; 3]) -> f64 {
    let ab = if a > b { a } else { b };
    if ab > c { ab } else { c }
}

#[inline(always)]
pub(crate) fn smallest([a, b, c]: [f64; 3]) -> f64 {
    let ab = if a < b { a } else { b };
    if ab < c { ab } else { c }
}

/// Means over a triangle of pressure and what follows from it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PolygonLoad {
    /// Mean pressure \[Pa\] over the triangle.
    pub pressure: f64,
    /// Mean of pressure × barycentric coordinate \[Pa\]: where the force acts.
    pub moment: [f64; 3],
    /// Mean of the pressure's derivative with sinkage \[Pa/m\].
    pub stiffness: f64,
}

#[inline(always)]
fn blend(b: &[f64; 3], values: &[f64; 3]) -> f64 {
    b[0] * values[0] + b[1] * values[1] + b[2] * values[2]
}

/// What one triangle gives, or how it is found together with others.
pub(crate) enum Answer<'a> {
    /// The sums over all centres.
    Load(PolygonLoad),
    /// Pressure along straight lines, proportional to what is covered: summed many at a time ([`crate::batch`]).
    OnLines {
        /// The pressure.
        lines: Lines<'a>,
        /// Depth over which contact builds up \[m\].
        contact: f64,
    },
}

/// Integrates over one triangle, or says along which lines; contact builds up over `contact` \[m\] of depth. `kinks` is working space.
#[inline(always)]
pub(crate) fn integrate<'a>(
    sub: &SubTriangles,
    ground: impl Response + 'a,
    corners: &Corners,
    partial: PartialLoad,
    contact: f64,
    kinks: &'a mut [Kink; KINKS],
) -> Answer<'a> {
    let Corners { z, sag, .. } = corners;
    let [least, most] = sag.range;
    match ground.lines([smallest(*z) + least, largest(*z) + most], kinks) {
        Some(lines) if partial == PartialLoad::Proportional => Answer::OnLines { lines, contact },
        _ => Answer::Load(by_centres(sub, ground, corners, partial, contact)),
    }
}

/// Centre by centre: the definition.
#[inline(always)]
pub(crate) fn by_centres(
    sub: &SubTriangles,
    ground: impl Response,
    Corners { z, share, depth, sag: Sag { products: sag, .. } }: &Corners,
    partial: PartialLoad,
    contact: f64,
) -> PolygonLoad {
    let mut load = PolygonLoad::default();
    for b in &sub.centres {
        let below = b[0] * b[1] * sag[0] + b[1] * b[2] * sag[1] + b[2] * b[0] * sag[2];
        let l_c = blend(b, share); // P2 Eq. (6)
        let (multiplier, growth) = match partial {
            PartialLoad::Step if l_c >= 0.5 - 1e-12 => (1.0, 0.0),
            PartialLoad::Step => continue,
            PartialLoad::Proportional => match blend(b, depth) + below {
                g if g <= 0.0 => continue,
                g if g < contact => (l_c * g / contact, l_c / contact),
                _ => (l_c, 0.0),
            },
        };
        let (p, slope) = ground.pressure(b, blend(b, z) + below);
        let f = p * multiplier;
        load.pressure += f;
        load.stiffness += slope * multiplier + p * growth;
        for k in 0..3 {
            load.moment[k] += f * b[k];
        }
    }
    let n = 1.0 / sub.centres.len() as f64;
    load.pressure *= n;
    load.stiffness *= n;
    load.moment = load.moment.map(|m| m * n);
    load
}

/// Force \[N\] over a triangle of horizontal area `area` \[m²\] with corner sinkages `z` \[m\]; corners carry load where `is_loaded`.
///
/// P2 Eqs. (5), (6): the vertical part of the polygon's force. The pressure array is read as in a run.
pub fn polygon_force(
    sub: &SubTriangles,
    array: &crate::pressure::PressureArray,
    z: [f64; 3],
    is_loaded: [bool; 3],
    area: f64,
) -> f64 {
    let ground = OneArray { pressures: array.pressures(), per_resolution: 1.0 / array.resolution() };
    let share = is_loaded.map(|l| f64::from(u8::from(l)));
    let corners = Corners { z, share, depth: z, sag: Sag::default() };
    area * by_centres(sub, ground, &corners, PartialLoad::Step, 0.0).pressure
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::Stiff;

    #[test]
    fn sub_triangles_tile_the_triangle() {
        for r in 1..9 {
            let sub = SubTriangles::new(r);
            assert_eq!(sub.centres().len(), r * r);
            let sum = sub.centres().iter().fold([0.0; 3], |s, b| [s[0] + b[0], s[1] + b[1], s[2] + b[2]]);
            for s in sum {
                assert!((s / (r * r) as f64 - 1.0 / 3.0).abs() < 1e-12);
            }
            assert!(sub.centres().iter().all(|b| b.iter().all(|&x| x > 0.0)));
        }
    }

    #[test]
    fn the_step_takes_a_quarter_or_three_quarters_for_even_resolutions_only() {
        let covered = |r: usize, share: [f64; 3]| {
            let sub = SubTriangles::new(r);
            let corners = Corners { z: [1.0; 3], share, depth: [1.0; 3], sag: Sag::default() };
            by_centres(&sub, Stiff(1.0), &corners, PartialLoad::Step, 0.0).pressure
        };
        for r in [2, 4, 6, 12] {
            assert!((covered(r, [1.0, 0.0, 0.0]) - 0.25).abs() < 1e-12);
            assert!((covered(r, [0.0, 1.0, 1.0]) - 0.75).abs() < 1e-12);
        }
        assert!((covered(3, [1.0, 0.0, 0.0]) - 0.25).abs() > 0.02);
    }
}
