//! Pressure integrated over one triangle of ground by equal sub-triangles (P2 Eqs. (5)–(8)).

use serde::{Deserialize, Serialize};

use crate::pressure::interpolate;

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
    /// Means of bᵢ bⱼ over the centres.
    second: [[f64; 3]; 3],
    /// Means of bᵢ bⱼ bₖ over the centres.
    third: [[[f64; 3]; 3]; 3],
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
        let (mut second, mut third) = ([[0.0; 3]; 3], [[[0.0; 3]; 3]; 3]);
        let share = 1.0 / (n * n) as f64;
        for b in &centres {
            for k in 0..3 {
                for l in 0..3 {
                    second[k][l] += b[k] * b[l] * share;
                    for m in 0..3 {
                        third[k][l][m] += b[k] * b[l] * b[m] * share;
                    }
                }
            }
        }
        Self { resolution: n, centres, second, third }
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

/// What the ground under one triangle answers.
pub(crate) trait Response: Copy {
    /// Pressure \[Pa\] and its slope \[Pa/m\] at barycentric `b` and sinkage `z` \[m\].
    fn pressure(&self, b: &[f64; 3], z: f64) -> (f64, f64);
    /// Pressure at zero \[Pa\] and slope \[Pa/m\] of the line on which the answer lies for all sinkages between those of `z`.
    #[inline(always)]
    fn line(&self, _z: &[f64; 3]) -> Option<(f64, f64)> {
        None
    }
}

/// Soil with one array for the whole triangle.
#[derive(Clone, Copy)]
pub(crate) struct OneArray<'a> {
    pub pressures: &'a [f64],
    pub per_resolution: f64,
}

impl Response for OneArray<'_> {
    #[inline(always)]
    fn pressure(&self, _: &[f64; 3], z: f64) -> (f64, f64) {
        let (p, slope) = interpolate(self.pressures, z * self.per_resolution);
        (p, slope * self.per_resolution)
    }

    #[inline(always)]
    fn line(&self, z: &[f64; 3]) -> Option<(f64, f64)> {
        let t = z.map(|z| z * self.per_resolution);
        let low = t[0].min(t[1]).min(t[2]);
        if low < 0.0 {
            return None;
        }
        let k = low as usize;
        if t[0].max(t[1]).max(t[2]) > (k + 1) as f64 || k + 1 >= self.pressures.len() {
            return None;
        }
        let slope = self.pressures[k + 1] - self.pressures[k];
        Some((self.pressures[k] - k as f64 * slope, slope * self.per_resolution))
    }
}

/// Soil with an array per corner, averaged (P2 §2.3.2.3).
#[derive(Clone, Copy)]
pub(crate) struct ThreeArrays<'a> {
    pub pressures: [&'a [f64]; 3],
    pub per_resolution: f64,
}

impl Response for ThreeArrays<'_> {
    #[inline(always)]
    fn pressure(&self, _: &[f64; 3], z: f64) -> (f64, f64) {
        let t = z * self.per_resolution;
        let [a, b, c] = self.pressures.map(|array| interpolate(array, t));
        ((a.0 + b.0 + c.0) / 3.0, (a.1 + b.1 + c.1) / 3.0 * self.per_resolution)
    }
}

/// Soil that was loaded before and springs along a straight line up to its virgin curve.
#[derive(Clone, Copy)]
pub(crate) struct Reloaded<R> {
    pub virgin: R,
    pub stiffness: f64,
    pub residual: [f64; 3],
}

impl<R: Response> Response for Reloaded<R> {
    #[inline(always)]
    fn pressure(&self, b: &[f64; 3], z: f64) -> (f64, f64) {
        let residual = b[0] * self.residual[0] + b[1] * self.residual[1] + b[2] * self.residual[2];
        let spring = self.stiffness * (z - residual).max(0.0);
        let virgin = self.virgin.pressure(b, z);
        if spring < virgin.0 { (spring, self.stiffness) } else { virgin }
    }
}

/// Ground of constant stiffness: rock and stump.
#[derive(Clone, Copy)]
pub(crate) struct Stiff(pub f64);

impl Response for Stiff {
    #[inline(always)]
    fn pressure(&self, _: &[f64; 3], z: f64) -> (f64, f64) {
        (self.0 * z.max(0.0), self.0)
    }

    #[inline(always)]
    fn line(&self, z: &[f64; 3]) -> Option<(f64, f64)> {
        (z[0] >= 0.0 && z[1] >= 0.0 && z[2] >= 0.0).then_some((0.0, self.0))
    }
}

/// Corners of a triangle under running gear.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corners {
    /// Sinkage if the ground followed the gear \[m\].
    pub z: [f64; 3],
    /// Share of the corner's cell that the gear covers, or 0 and 1 for [`PartialLoad::Step`].
    pub share: [f64; 3],
    /// Depth of the gear below the present ground \[m\]; negative where it is above.
    pub depth: [f64; 3],
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

/// Integrates over one triangle; contact builds up over `contact` \[m\] of depth.
#[inline(always)]
pub(crate) fn integrate(
    sub: &SubTriangles,
    ground: impl Response,
    corners: &Corners,
    partial: PartialLoad,
    contact: f64,
) -> PolygonLoad {
    let Corners { z, share, depth } = corners;
    let is_deep = partial == PartialLoad::Step || depth.iter().all(|&g| g >= contact);
    let is_full = *share == [1.0; 3] && is_deep;
    let is_smooth = is_full || (is_deep && partial == PartialLoad::Proportional);
    if is_smooth && let Some((c, k)) = ground.line(z) {
        return on_a_line(sub, c, k, z, share, is_full);
    }
    let mut load = PolygonLoad::default();
    for b in &sub.centres {
        let (multiplier, growth) = if is_full {
            (1.0, 0.0)
        } else {
            let l_c = blend(b, share); // P2 Eq. (6)
            match partial {
                PartialLoad::Step if l_c >= 0.5 - 1e-12 => (1.0, 0.0),
                PartialLoad::Step => continue,
                PartialLoad::Proportional => {
                    let g = blend(b, depth);
                    if g <= 0.0 {
                        continue;
                    } else if g < contact {
                        (l_c * g / contact, l_c / contact)
                    } else {
                        (l_c, 0.0)
                    }
                }
            }
        };
        let (p, slope) = ground.pressure(b, blend(b, z));
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

/// The sums over all centres in closed form where pressure is c + k z: the same numbers as centre by centre, but for rounding.
#[inline(always)]
fn on_a_line(
    sub: &SubTriangles,
    c: f64,
    k: f64,
    z: &[f64; 3],
    share: &[f64; 3],
    is_full: bool,
) -> PolygonLoad {
    let unshared = sub.second.map(|m| c / 3.0 + k * blend(&m, z));
    if is_full {
        let pressure = c + k * (z[0] + z[1] + z[2]) / 3.0;
        return PolygonLoad { pressure, moment: unshared, stiffness: k };
    }
    let moment = [0, 1, 2].map(|m| {
        (0..3).map(|i| share[i] * (c * sub.second[i][m] + k * blend(&sub.third[i][m], z))).sum::<f64>()
    });
    let pressure = blend(share, &unshared);
    PolygonLoad { pressure, moment, stiffness: k * (share[0] + share[1] + share[2]) / 3.0 }
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
    let corners = Corners { z, share, depth: z };
    area * integrate(sub, ground, &corners, PartialLoad::Step, 0.0).pressure
}

#[cfg(test)]
mod tests {
    use super::*;

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
            let corners = Corners { z: [1.0; 3], share, depth: [1.0; 3] };
            integrate(&sub, Stiff(1.0), &corners, PartialLoad::Step, 0.0).pressure
        };
        for r in [2, 4, 6, 12] {
            assert!((covered(r, [1.0, 0.0, 0.0]) - 0.25).abs() < 1e-12);
            assert!((covered(r, [0.0, 1.0, 1.0]) - 0.75).abs() < 1e-12);
        }
        assert!((covered(3, [1.0, 0.0, 0.0]) - 0.25).abs() > 0.02);
    }

    #[test]
    fn the_short_cut_on_a_line_equals_the_sum() {
        #[derive(Clone, Copy)]
        struct Long(f64, f64);
        impl Response for Long {
            fn pressure(&self, _: &[f64; 3], z: f64) -> (f64, f64) {
                (self.0 + self.1 * z, self.1)
            }
        }
        let (sub, z) = (SubTriangles::new(4), [0.01, 0.05, 0.02]);
        let per_resolution = 1.0 / 0.1;
        let array = OneArray { pressures: &[0.0, 1e5, 3e5], per_resolution };
        for (shift, c, k) in [(0.0, 0.0, 1e6), (0.1, -1e5, 2e6)] {
            let z = z.map(|z| z + shift);
            for share in [[1.0; 3], [0.2, 1.0, 0.7], [0.0, 0.3, 0.0]] {
                let corners = Corners { z, share, depth: z };
                let short = integrate(&sub, array, &corners, PartialLoad::Proportional, 1e-4);
                let long = integrate(&sub, Long(c, k), &corners, PartialLoad::Proportional, 1e-4);
                assert!((short.pressure - long.pressure).abs() < 1e-9 * long.pressure);
                assert!((short.stiffness - long.stiffness).abs() < 1e-9 * long.stiffness);
                for i in 0..3 {
                    assert!((short.moment[i] - long.moment[i]).abs() < 1e-9 * long.pressure);
                }
            }
        }
    }
}
