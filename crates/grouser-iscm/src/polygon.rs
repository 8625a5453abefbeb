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

/// Centres worked on together.
const LANES: usize = 4;

/// Barycentric coordinates of four centres.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Four {
    b: [[f64; LANES]; 3],
    /// 1 for a centre, 0 for none.
    weight: [f64; LANES],
}

impl Four {
    fn new(centres: &[[f64; 3]]) -> Self {
        let at = |lane: usize, k: usize| centres.get(lane).map_or(1.0 / 3.0, |b| b[k]);
        Self {
            b: std::array::from_fn(|k| std::array::from_fn(|lane| at(lane, k))),
            weight: std::array::from_fn(|lane| f64::from(u8::from(lane < centres.len()))),
        }
    }

    #[inline(always)]
    fn blend(&self, values: &[f64; 3]) -> [f64; LANES] {
        let mut blended = [0.0; LANES];
        for n in 0..LANES {
            blended[n] = self.b[0][n] * values[0] + self.b[1][n] * values[1] + self.b[2][n] * values[2];
        }
        blended
    }
}

/// Centres of the R² sub-triangles as barycentric coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct SubTriangles {
    resolution: usize,
    centres: Vec<[f64; 3]>,
    /// The centres by fours, filled up with centres of no weight.
    fours: Vec<Four>,
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
        let fours = centres.chunks(LANES).map(Four::new).collect();
        Self { resolution: n, centres, fours, second, third }
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

/// Most kinks of the pressure within one triangle that are worked on together.
const KINKS: usize = 8;

/// Pressure between two sinkages as straight lines: c + k z, and a further slope beyond each kink.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lines {
    c: f64,
    k: f64,
    n_kinks: usize,
    /// Where the line bends \[m\] and by how much \[Pa/m\].
    kinks: [(f64, f64); KINKS],
}

impl Lines {
    #[inline(always)]
    fn straight(c: f64, k: f64) -> Self {
        Self { c, k, n_kinks: 0, kinks: [(0.0, 0.0); KINKS] }
    }

    /// The lines of an array that `at` reads (value number n), from sinkage `low` to `high` \[m\].
    #[inline(always)]
    fn of_array(
        at: impl Fn(usize) -> f64,
        n: usize,
        per_resolution: f64,
        [low, high]: [f64; 2],
    ) -> Option<Self> {
        let first = ((low * per_resolution).max(0.0) as usize).min(n - 2);
        let last = ((high * per_resolution).max(0.0) as usize).min(n - 2);
        if last - first > KINKS {
            return None;
        }
        let (mut here, mut next) = (at(first), at(first + 1));
        let mut slope = next - here;
        let mut lines = Self::straight(here - first as f64 * slope, slope * per_resolution);
        for value in first + 1..=last {
            (here, next) = (next, at(value + 1));
            lines.kinks[lines.n_kinks] =
                (value as f64 / per_resolution, (next - here - slope) * per_resolution);
            lines.n_kinks += 1;
            slope = next - here;
        }
        Some(lines)
    }
}

/// What the ground under one triangle answers.
pub(crate) trait Response: Copy {
    /// Pressure \[Pa\] and its slope \[Pa/m\] at barycentric `b` and sinkage `z` \[m\].
    fn pressure(&self, b: &[f64; 3], z: f64) -> (f64, f64);
    /// The same for all sinkages between two \[m\], if they lie on few straight lines.
    #[inline(always)]
    fn lines(&self, _range: [f64; 2]) -> Option<Lines> {
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
    fn lines(&self, range: [f64; 2]) -> Option<Lines> {
        Lines::of_array(|n| self.pressures[n], self.pressures.len(), self.per_resolution, range)
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

    #[inline(always)]
    fn lines(&self, range: [f64; 2]) -> Option<Lines> {
        let [a, b, c] = self.pressures;
        Lines::of_array(|n| (a[n] + b[n] + c[n]) / 3.0, a.len(), self.per_resolution, range)
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
    fn lines(&self, range: [f64; 2]) -> Option<Lines> {
        (range[0] >= 0.0).then(|| Lines::straight(0.0, self.0))
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
    /// How a curved underside lies below the straight one between its corners: by Σ b_k b_l `sag` over the sides 0–1, 1–2, 2–0 \[m\].
    pub sag: [f64; 3],
}

impl Corners {
    /// Sinkage and depth are larger than those between the corners by at least and at most this \[m\].
    #[inline(always)]
    fn sag_range(&self) -> [f64; 2] {
        let [a, b, c] = self.sag;
        // Σ b_k b_l is at most a third, each product at most a quarter.
        [0.25 * (a.min(0.0) + b.min(0.0) + c.min(0.0)), a.max(b).max(c).max(0.0) / 3.0]
    }

    /// Whether the gear presses nowhere.
    #[inline(always)]
    pub fn is_free(&self) -> bool {
        let [g_0, g_1, g_2] = self.depth;
        g_0.max(g_1).max(g_2) + self.sag_range()[1] <= 0.0
    }
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
    let Corners { z, share, depth, sag } = corners;
    let [least, most] = corners.sag_range();
    let is_deep = partial == PartialLoad::Step || depth.iter().all(|&g| g + least >= contact);
    let is_full = *share == [1.0; 3] && is_deep;
    let is_smooth = is_full || (is_deep && partial == PartialLoad::Proportional);
    let range = [z[0].min(z[1]).min(z[2]) + least, z[0].max(z[1]).max(z[2]) + most];
    match ground.lines(range) {
        Some(lines) if is_smooth && lines.n_kinks == 0 && (is_full || *sag == [0.0; 3]) => {
            on_a_line(sub, lines.c, lines.k, corners, is_full)
        }
        Some(lines) if partial == PartialLoad::Proportional => on_lines(sub, &lines, corners, contact),
        _ => by_centres(sub, ground, corners, partial, contact, is_full),
    }
}

/// Centre by centre: the definition.
#[inline(always)]
fn by_centres(
    sub: &SubTriangles,
    ground: impl Response,
    Corners { z, share, depth, sag }: &Corners,
    partial: PartialLoad,
    contact: f64,
    is_full: bool,
) -> PolygonLoad {
    let mut load = PolygonLoad::default();
    for b in &sub.centres {
        let below = b[0] * b[1] * sag[0] + b[1] * b[2] * sag[1] + b[2] * b[0] * sag[2];
        let (multiplier, growth) = if is_full {
            (1.0, 0.0)
        } else {
            let l_c = blend(b, share); // P2 Eq. (6)
            match partial {
                PartialLoad::Step if l_c >= 0.5 - 1e-12 => (1.0, 0.0),
                PartialLoad::Step => continue,
                PartialLoad::Proportional => {
                    let g = blend(b, depth) + below;
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

/// The same sums, four centres at a time, where the pressure lies on straight lines: the same numbers but for rounding.
#[inline(always)]
fn on_lines(
    sub: &SubTriangles,
    lines: &Lines,
    Corners { z, share, depth, sag }: &Corners,
    contact: f64,
) -> PolygonLoad {
    let per_contact = 1.0 / contact.max(1e-300);
    let (mut pressure, mut stiffness) = ([0.0; LANES], [0.0; LANES]);
    let (mut moment_0, mut moment_1) = ([0.0; LANES], [0.0; LANES]);
    let kinks = &lines.kinks[..lines.n_kinks];
    for four in &sub.fours {
        let (mut z, mut g, l_c) = (four.blend(z), four.blend(depth), four.blend(share));
        if *sag != [0.0; 3] {
            let b = &four.b;
            for n in 0..LANES {
                let below =
                    b[0][n] * b[1][n] * sag[0] + b[1][n] * b[2][n] * sag[1] + b[2][n] * b[0][n] * sag[2];
                z[n] += below;
                g[n] += below;
            }
        }
        let (mut p, mut slope) = ([0.0; LANES], [lines.k; LANES]);
        for n in 0..LANES {
            p[n] = lines.c + lines.k * z[n];
        }
        for &(at, bend) in kinks {
            for n in 0..LANES {
                let beyond = z[n] - at;
                p[n] += bend * if beyond > 0.0 { beyond } else { 0.0 };
                slope[n] += if beyond > 0.0 { bend } else { 0.0 };
            }
        }
        for n in 0..LANES {
            let share = l_c[n] * four.weight[n];
            let built_up = g[n] * per_contact;
            let (positive, rising) =
                if built_up > 0.0 { (built_up, share * per_contact) } else { (0.0, 0.0) };
            let (built_up, growth) = if positive < 1.0 { (positive, rising) } else { (1.0, 0.0) };
            let f = p[n] * share * built_up;
            pressure[n] += f;
            moment_0[n] += f * four.b[0][n];
            moment_1[n] += f * four.b[1][n];
            stiffness[n] += slope[n] * share * built_up + p[n] * growth;
        }
    }
    let n = 1.0 / sub.centres.len() as f64;
    let mean = |lanes: [f64; LANES]| ((lanes[0] + lanes[1]) + (lanes[2] + lanes[3])) * n;
    let (pressure, moment_0, moment_1) = (mean(pressure), mean(moment_0), mean(moment_1));
    let moment = [moment_0, moment_1, pressure - moment_0 - moment_1];
    PolygonLoad { pressure, moment, stiffness: mean(stiffness) }
}

/// The sums over all centres in closed form where pressure is c + k z: the same numbers as centre by centre, but for rounding.
#[inline(always)]
fn on_a_line(
    sub: &SubTriangles,
    c: f64,
    k: f64,
    Corners { z, share, sag, .. }: &Corners,
    is_full: bool,
) -> PolygonLoad {
    let unshared = sub.second.map(|m| c / 3.0 + k * blend(&m, z));
    if is_full {
        let (second, third) = (&sub.second, &sub.third);
        let below = sag[0] * second[0][1] + sag[1] * second[1][2] + sag[2] * second[2][0];
        let below_at = |m: usize| sag[0] * third[0][1][m] + sag[1] * third[1][2][m] + sag[2] * third[2][0][m];
        let pressure = c + k * ((z[0] + z[1] + z[2]) / 3.0 + below);
        let moment = [0, 1, 2].map(|m| unshared[m] + k * below_at(m));
        return PolygonLoad { pressure, moment, stiffness: k };
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
    let corners = Corners { z, share, depth: z, sag: [0.0; 3] };
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
            let corners = Corners { z: [1.0; 3], share, depth: [1.0; 3], sag: [0.0; 3] };
            integrate(&sub, Stiff(1.0), &corners, PartialLoad::Step, 0.0).pressure
        };
        for r in [2, 4, 6, 12] {
            assert!((covered(r, [1.0, 0.0, 0.0]) - 0.25).abs() < 1e-12);
            assert!((covered(r, [0.0, 1.0, 1.0]) - 0.75).abs() < 1e-12);
        }
        assert!((covered(3, [1.0, 0.0, 0.0]) - 0.25).abs() > 0.02);
    }

    #[test]
    fn four_at_a_time_equal_centre_by_centre() {
        let pressures: Vec<f64> = (0..30).map(|k| 1e4 * f64::from(k) + 3e3 * f64::from(k * k % 7)).collect();
        let array = OneArray { pressures: &pressures, per_resolution: 200.0 };
        for resolution in [1, 2, 3, 4, 5] {
            let sub = SubTriangles::new(resolution);
            for (z, share, depth) in [
                ([0.01, 0.031, 0.022], [1.0; 3], [0.01, 0.02, 0.01]),
                ([0.01, 0.031, 0.022], [0.0, 1.0, 0.6], [-0.001, 0.003, 0.0005]),
                ([-0.002, 0.004, 0.009], [1.0; 3], [-0.002, 0.004, 0.0009]),
                ([0.13, 0.149, 0.16], [0.5, 1.0, 0.0], [4e-4, -1e-4, 2e-4]),
            ] {
                let corners = Corners { z, share, depth, sag: [0.0; 3] };
                let partial = PartialLoad::Proportional;
                let fast = integrate(&sub, array, &corners, partial, 1e-3);
                let exact = by_centres(&sub, array, &corners, partial, 1e-3, false);
                let near =
                    |a: f64, b: f64| (a - b).abs() <= 1e-9 * exact.pressure.max(exact.stiffness * 1e-3);
                assert!(near(fast.pressure, exact.pressure), "{fast:?} {exact:?}");
                assert!((0..3).all(|k| near(fast.moment[k], exact.moment[k])), "{fast:?} {exact:?}");
                let scale = exact.stiffness.abs();
                assert!((fast.stiffness - exact.stiffness).abs() <= 1e-9 * scale, "{fast:?} {exact:?}");
            }
        }
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
                let corners = Corners { z, share, depth: z, sag: [0.0; 3] };
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
