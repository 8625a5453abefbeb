//! Many polygons worked on together, number by number: F3 to F5 of `docs/theory/iscm.md`.
//!
//! Sums over polygons are added up lane by lane, whatever the instruction set, so that each gives the same bits.

use grouser_geometry::Vec3;
use nalgebra::Matrix6;

use crate::contact::Wrench;
use crate::polygon::{Answer, Corners, PolygonLoad, SubTriangles};
use crate::response::{FEW, KINKS};

/// Polygons of a batch.
pub(crate) const LANES: usize = 32;
/// Polygons whose sums over centres are held at a time.
const WIDTH: usize = 8;

/// One number of each polygon.
type Lane = [f64; LANES];
const ZERO: Lane = [0.0; LANES];

/// Polygons under one layer of running gear.
pub(crate) struct Batch {
    len: usize,
    /// Most kinks of any of them.
    n_kinks: usize,
    is_curved: bool,
    has_lines: bool,
    /// Whether contact builds up in any of them.
    is_shallow: bool,
    z: [Lane; 3],
    share: [Lane; 3],
    depth: [Lane; 3],
    sag: [Lane; 3],
    /// Value at no sinkage and slope of the first line; where it bends and by how much.
    line: [Lane; 2],
    kinks: [[Lane; 2]; KINKS],
    /// One where pressure is summed along lines, zero where sums were given.
    on_lines: Lane,
    /// One where the stiffness counts, zero where something else has answered for it.
    counts: Lane,
    /// Over the depth in which contact builds up \[1/m\].
    per_contact: Lane,
    /// Corners from the reference point, by axis \[m\].
    corners: [[Lane; 3]; 3],
    /// Means over the polygon, as in [`PolygonLoad`].
    pressure: Lane,
    stiffness: Lane,
    moment: [Lane; 3],
    /// What they come to, see [`Collected`].
    collected: Collected,
    /// What all batches came to since it was given away.
    sums: Sums,
}

/// Sums over batches, polygon by polygon.
struct Sums {
    /// Force and moment.
    forces: [Lane; 6],
    /// Columns of the stiffness, down to the diagonal.
    stiffness: [[Lane; 6]; 6],
}

const NO_SUMS: Sums = Sums { forces: [ZERO; 6], stiffness: [[ZERO; 6]; 6] };

/// Force and stiffness of each polygon.
struct Collected {
    /// Where the force acts, from the reference point \[m\].
    arm: [Lane; 3],
    /// Normal of the ground, scaled to a vertical part of one, and its moment, arm × normal \[m\].
    normal: [Lane; 6],
    /// Vertical force \[N\] and stiffness \[N/m\].
    lift: Lane,
    stiffness: Lane,
    /// The stiffness that counts.
    counted: Lane,
}

/// One loaded polygon of a batch.
pub(crate) struct Loaded {
    pub arm: Vec3,
    pub normal: Vec3,
    pub lift: f64,
    pub pressure: f64,
    pub stiffness: f64,
}

impl Batch {
    pub fn new() -> Self {
        Self {
            len: 0,
            n_kinks: 0,
            is_curved: false,
            has_lines: false,
            is_shallow: false,
            z: [ZERO; 3],
            share: [ZERO; 3],
            depth: [ZERO; 3],
            sag: [ZERO; 3],
            line: [ZERO; 2],
            kinks: [[ZERO; 2]; KINKS],
            on_lines: ZERO,
            counts: ZERO,
            per_contact: ZERO,
            corners: [[ZERO; 3]; 3],
            pressure: ZERO,
            stiffness: ZERO,
            moment: [ZERO; 3],
            collected: Collected {
                arm: [ZERO; 3],
                normal: [ZERO; 6],
                lift: ZERO,
                stiffness: ZERO,
                counted: ZERO,
            },
            sums: NO_SUMS,
        }
    }

    /// Adds a polygon whose corners lie at `points` from the reference point \[m\]; its stiffness may not count.
    #[inline(always)]
    pub fn push(&mut self, points: &[[f64; 3]; 3], corners: &Corners, answer: &Answer, counts: bool) {
        let n = self.len;
        // So that no store below looks for itself.
        assert!(n < LANES, "a batch holds {LANES} polygons");
        self.len += 1;
        self.counts[n] = f64::from(u8::from(counts));
        for k in 0..3 {
            for axis in 0..3 {
                self.corners[k][axis][n] = points[k][axis];
            }
        }
        let (given, on_lines) = match answer {
            Answer::Load(load) => (*load, 0.0),
            Answer::OnLines { .. } => (PolygonLoad::default(), 1.0),
        };
        self.pressure[n] = given.pressure;
        self.stiffness[n] = given.stiffness;
        for k in 0..3 {
            self.moment[k][n] = given.moment[k];
        }
        self.on_lines[n] = on_lines;
        if let Answer::OnLines { lines, contact } = answer {
            self.per_contact[n] = 1.0 / contact.max(1e-300);
            self.has_lines = true;
            self.is_shallow |= corners.depth[0] < f64::INFINITY;
            self.is_curved |= !corners.sag.is_none();
            for k in 0..3 {
                self.z[k][n] = corners.z[k];
                self.share[k][n] = corners.share[k];
                self.depth[k][n] = corners.depth[k];
                self.sag[k][n] = corners.sag.products[k];
            }
            self.line[0][n] = lines.c;
            self.line[1][n] = lines.k;
            self.n_kinks = self.n_kinks.max(lines.n_kinks);
            // The few with a count that is known, so that they are copied without a branch.
            let (few, others) = lines.kinks.split_at(FEW);
            for (kink, &[at, bend]) in self.kinks.iter_mut().zip(few) {
                kink[0][n] = at;
                kink[1][n] = bend;
            }
            for (kink, &[at, bend]) in self.kinks[FEW..].iter_mut().zip(others) {
                kink[0][n] = at;
                kink[1][n] = bend;
            }
        }
    }

    /// F3 to F5 over ground of `spacing` \[m\], with the widest vectors of the machine; sums grow until [`Batch::give`]. Products and sums
    /// are fused where written so, and each instruction set gives the same bits.
    pub fn answer(&mut self, sub: &SubTriangles, spacing: f64) {
        #[cfg(target_arch = "x86_64")]
        {
            // SAFETY: the instructions were just found on this machine.
            if has_avx512() {
                return unsafe { self.answer_avx512(sub, spacing) };
            }
            // SAFETY: as above.
            if has_avx2() {
                return unsafe { self.answer_avx2(sub, spacing) };
            }
        }
        self.answer_portable(sub, spacing);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma,avx512f,avx512dq,avx512vl")]
    fn answer_avx512(&mut self, sub: &SubTriangles, spacing: f64) {
        self.answer_portable(sub, spacing);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn answer_avx2(&mut self, sub: &SubTriangles, spacing: f64) {
        self.answer_portable(sub, spacing);
    }

    /// Compiled for what every machine has, and into the above for what theirs have.
    #[inline(always)]
    fn answer_portable(&mut self, sub: &SubTriangles, spacing: f64) {
        match (self.has_lines, self.is_shallow) {
            (false, _) => (),
            (true, false) => self.integrate::<true>(sub),
            (true, true) => self.integrate::<false>(sub),
        }
        self.collect(spacing);
        self.add_up();
    }

    /// F3, F4: means over the polygons; eight at a time, whose sums stay in registers.
    #[inline(always)]
    fn integrate<const IS_DEEP: bool>(&mut self, sub: &SubTriangles) {
        for first in (0..self.len).step_by(WIDTH) {
            if self.is_curved {
                self.integrate_from::<IS_DEEP, true>(sub, first);
            } else {
                self.integrate_from::<IS_DEEP, false>(sub, first);
            }
        }
    }

    #[inline(always)]
    fn integrate_from<const IS_DEEP: bool, const IS_CURVED: bool>(
        &mut self,
        sub: &SubTriangles,
        first: usize,
    ) {
        let eight =
            |lane: &Lane| -> [f64; WIDTH] { lane[first..first + WIDTH].try_into().unwrap_or_default() };
        let of = |lanes: &[Lane; 3]| [eight(&lanes[0]), eight(&lanes[1]), eight(&lanes[2])];
        let (z_of, share_of, depth_of, sag_of) =
            (of(&self.z), of(&self.share), of(&self.depth), of(&self.sag));
        let (line, on_lines, per_contact) =
            ([eight(&self.line[0]), eight(&self.line[1])], eight(&self.on_lines), eight(&self.per_contact));
        let (mut pressure, mut stiffness, mut moment) =
            (eight(&self.pressure), eight(&self.stiffness), of(&self.moment));
        let per_centre = 1.0 / sub.centres().len() as f64;
        let [mut z, mut g, mut p, mut slope] = [[0.0; WIDTH]; 4];
        for &b in sub.centres() {
            let between = [b[0] * b[1], b[1] * b[2], b[2] * b[0]];
            for n in 0..WIDTH {
                z[n] = blend(b, [z_of[0][n], z_of[1][n], z_of[2][n]]);
                if !IS_DEEP {
                    g[n] = blend(b, [depth_of[0][n], depth_of[1][n], depth_of[2][n]]);
                }
                if IS_CURVED {
                    let below = blend(between, [sag_of[0][n], sag_of[1][n], sag_of[2][n]]);
                    z[n] += below;
                    g[n] += if IS_DEEP { 0.0 } else { below };
                }
                p[n] = line[1][n].mul_add(z[n], line[0][n]);
                slope[n] = line[1][n];
            }
            for [at, bend] in &self.kinks[..self.n_kinks] {
                let (at, bend) = (&at[first..first + WIDTH], &bend[first..first + WIDTH]);
                for n in 0..WIDTH {
                    let beyond = z[n] - at[n];
                    p[n] = bend[n].mul_add(if beyond > 0.0 { beyond } else { 0.0 }, p[n]);
                    slope[n] += if beyond > 0.0 { bend[n] } else { 0.0 };
                }
            }
            for n in 0..WIDTH {
                let l_c = blend(b, [share_of[0][n], share_of[1][n], share_of[2][n]]);
                let share = l_c * on_lines[n] * per_centre;
                let (multiplier, rising) = if IS_DEEP {
                    (share, 0.0)
                } else {
                    let built_up = g[n] * per_contact[n];
                    let positive = if built_up > 0.0 { built_up } else { 0.0 };
                    let rises = built_up > 0.0 && built_up < 1.0;
                    let rising = if rises { share * per_contact[n] } else { 0.0 };
                    (share * if positive < 1.0 { positive } else { 1.0 }, rising)
                };
                let f = p[n] * multiplier;
                pressure[n] += f;
                moment[0][n] = f.mul_add(b[0], moment[0][n]);
                moment[1][n] = f.mul_add(b[1], moment[1][n]);
                moment[2][n] = f.mul_add(b[2], moment[2][n]);
                stiffness[n] = slope[n].mul_add(multiplier, stiffness[n]);
                if !IS_DEEP {
                    stiffness[n] = p[n].mul_add(rising, stiffness[n]);
                }
            }
        }
        self.pressure[first..first + WIDTH].copy_from_slice(&pressure);
        self.stiffness[first..first + WIDTH].copy_from_slice(&stiffness);
        for (lane, moment) in self.moment.iter_mut().zip(&moment) {
            lane[first..first + WIDTH].copy_from_slice(moment);
        }
    }

    /// F5: forces, positions and stiffnesses over ground of `spacing` \[m\].
    #[inline(always)]
    fn collect(&mut self, spacing: f64) {
        let per_square = 1.0 / (spacing * spacing);
        let half_square = 0.5 * spacing * spacing;
        let [p, q, r] = &self.corners;
        let Collected { arm, normal, lift, stiffness, counted } = &mut self.collected;
        for n in 0..LANES {
            let a = [q[0][n] - p[0][n], q[1][n] - p[1][n], q[2][n] - p[2][n]];
            let b = [r[0][n] - p[0][n], r[1][n] - p[1][n], r[2][n] - p[2][n]];
            let u = [
                (a[1] * b[2] - a[2] * b[1]) * per_square,
                (a[2] * b[0] - a[0] * b[2]) * per_square,
                (a[0] * b[1] - a[1] * b[0]) * per_square,
            ];
            // P2 Eq. (8); a polygon that just touches answers from its middle.
            let pressure = self.pressure[n];
            let per_pressure = 1.0 / pressure;
            let weight = |moment: f64| if pressure > 0.0 { moment * per_pressure } else { 1.0 / 3.0 };
            let (w_0, w_1, w_2) =
                (weight(self.moment[0][n]), weight(self.moment[1][n]), weight(self.moment[2][n]));
            let at = [
                p[0][n] * w_0 + q[0][n] * w_1 + r[0][n] * w_2,
                p[1][n] * w_0 + q[1][n] * w_1 + r[1][n] * w_2,
                p[2][n] * w_0 + q[2][n] * w_1 + r[2][n] * w_2,
            ];
            let is_loaded = pressure > 0.0 || self.stiffness[n] > 0.0;
            let area = if is_loaded { half_square } else { 0.0 };
            lift[n] = pressure * area; // P2 Eq. (7)
            for axis in 0..3 {
                arm[axis][n] = at[axis];
                normal[axis][n] = u[axis];
            }
            normal[3][n] = at[1] * u[2] - at[2] * u[1];
            normal[4][n] = at[2] * u[0] - at[0] * u[2];
            normal[5][n] = at[0] * u[1] - at[1] * u[0];
            stiffness[n] = area * if self.stiffness[n] > 0.0 { self.stiffness[n] } else { 0.0 };
            counted[n] = self.counts[n] * stiffness[n];
        }
        // Lanes without a polygon hold an old one.
        lift[self.len..].fill(0.0);
        counted[self.len..].fill(0.0);
    }

    /// Polygon `n` where it is loaded, after [`Batch::answer`].
    #[inline(always)]
    pub fn loaded(&self, n: usize) -> Option<Loaded> {
        let Collected { arm, normal, lift, stiffness, .. } = &self.collected;
        let vector = |lanes: &[Lane]| Vec3::new(lanes[0][n], lanes[1][n], lanes[2][n]);
        (self.pressure[n] > 0.0 || self.stiffness[n] > 0.0).then(|| Loaded {
            arm: vector(arm),
            normal: vector(normal),
            lift: lift[n],
            pressure: self.pressure[n],
            stiffness: stiffness[n],
        })
    }

    /// Adds what the polygons come to.
    #[inline(always)]
    fn add_up(&mut self) {
        let Collected { normal, lift, counted, .. } = &self.collected;
        let Sums { forces, stiffness } = &mut self.sums;
        for (sum, normal) in forces.iter_mut().zip(normal) {
            add_products(sum, normal, lift);
        }
        let mut scaled = ZERO;
        for (column, sums) in stiffness.iter_mut().enumerate() {
            for n in 0..LANES {
                scaled[n] = counted[n] * normal[column][n];
            }
            for (sum, normal) in sums[..=column].iter_mut().zip(normal) {
                add_products(sum, normal, &scaled);
            }
        }
    }

    /// Gives the sums away: force and moment, and the upper half of the stiffness.
    pub fn give(&mut self) -> (Wrench, Matrix6<f64>) {
        let Sums { forces, stiffness } = std::mem::replace(&mut self.sums, NO_SUMS);
        let [f_x, f_y, f_z, m_x, m_y, m_z] = forces.map(|sums| sums.iter().sum());
        let wrench = Wrench { force: Vec3::new(f_x, f_y, f_z), moment: Vec3::new(m_x, m_y, m_z) };
        (wrench, Matrix6::from_fn(|row, column| stiffness[column][row].iter().sum()))
    }

    /// Empties the batch.
    pub fn clear(&mut self) {
        for kink in &mut self.kinks[FEW..self.n_kinks.max(FEW)] {
            kink[1] = ZERO;
        }
        (self.len, self.n_kinks) = (0, 0);
        (self.is_curved, self.has_lines, self.is_shallow) = (false, false, false);
        self.on_lines = ZERO;
    }
}

/// Whether this machine has the vectors of four numbers that [`Batch::answer`] uses.
#[cfg(target_arch = "x86_64")]
fn has_avx2() -> bool {
    is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma")
}

/// Whether this machine has the vectors of eight numbers that [`Batch::answer`] uses.
#[cfg(target_arch = "x86_64")]
fn has_avx512() -> bool {
    has_avx2()
        && is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512vl")
}

/// Σ b v, fused.
#[inline(always)]
fn blend(b: [f64; 3], v: [f64; 3]) -> f64 {
    b[2].mul_add(v[2], b[1].mul_add(v[1], b[0] * v[0]))
}

/// Adds the products of `a` and `b`.
#[inline(always)]
fn add_products(sums: &mut Lane, a: &Lane, b: &Lane) {
    for n in 0..LANES {
        sums[n] = a[n].mul_add(b[n], sums[n]);
    }
}

#[cfg(test)]
mod tests;
