//! What the ground under one triangle answers: soil with one array or three, soil that springs, rock.

use crate::pressure::interpolate;

/// Most kinks of the pressure within one triangle that are worked on together.
pub(crate) const KINKS: usize = 8;

/// Kinks that are copied in any case.
pub(crate) const FEW: usize = 4;

/// Where a line bends \[m\] and by how much \[Pa/m\].
pub(crate) type Kink = [f64; 2];
pub(crate) const NO_KINKS: [Kink; KINKS] = [[0.0; 2]; KINKS];

/// Pressure between two sinkages as straight lines: c + k z, and a further slope beyond each kink.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lines<'a> {
    pub c: f64,
    pub k: f64,
    /// The kinks in between, and perhaps others beyond, which do no harm.
    pub kinks: &'a [Kink],
    /// How many there are in between.
    pub n_kinks: usize,
}

/// Numbers of the first and last line of an array of `n` values from sinkage `low` to `high` \[m\].
#[inline(always)]
fn first_and_last(n: usize, per_resolution: f64, [low, high]: [f64; 2]) -> (usize, usize) {
    let last = (n - 2) as f64;
    let number = |z: f64| (z * per_resolution).max(0.0).min(last) as u32 as usize;
    (number(low), number(high))
}

/// Line number `first` of values that `at` reads: its pressure at no sinkage and its slope.
#[inline(always)]
fn line(at: impl Fn(usize) -> f64, first: usize, per_resolution: f64) -> [f64; 2] {
    let slope = at(first + 1) - at(first);
    [at(first) - first as f64 * slope, slope * per_resolution]
}

/// The kink at a value.
#[inline(always)]
fn kink(at: impl Fn(usize) -> f64, value: usize, per_resolution: f64) -> Kink {
    let (before, after) = (at(value) - at(value - 1), at(value + 1) - at(value));
    [value as f64 / per_resolution, (after - before) * per_resolution]
}

/// What the ground under one triangle answers.
pub(crate) trait Response: Copy {
    /// Pressure \[Pa\] and its slope \[Pa/m\] at barycentric `b` and sinkage `z` \[m\].
    fn pressure(&self, b: &[f64; 3], z: f64) -> (f64, f64);
    /// The same for all sinkages between two \[m\], if they lie on few straight lines; `kinks` may hold where they bend.
    #[inline(always)]
    fn lines<'s>(self, _range: [f64; 2], _kinks: &'s mut [Kink; KINKS]) -> Option<Lines<'s>>
    where
        Self: 's,
    {
        None
    }
}

/// Lines and kinks of one array, made once for many triangles.
#[derive(Clone, Debug)]
pub(crate) struct Prepared {
    /// Pressure at no sinkage and slope of the line after each value but the last.
    lines: Vec<[f64; 2]>,
    /// The kink at each value but the last; none at the first, nor at a few beyond the last.
    kinks: Vec<Kink>,
}

impl Prepared {
    pub fn new(pressures: &[f64], per_resolution: f64) -> Self {
        let (at, n) = (|value: usize| pressures[value], pressures.len());
        let kinks = (1..n - 1).map(|value| kink(at, value, per_resolution));
        Self {
            lines: (0..n - 1).map(|first| line(at, first, per_resolution)).collect(),
            kinks: std::iter::once([0.0; 2]).chain(kinks).chain([[0.0; 2]; FEW]).collect(),
        }
    }
}

/// Soil with one prepared array for all triangles.
#[derive(Clone, Copy)]
pub(crate) struct PreparedArray<'a> {
    pub array: OneArray<'a>,
    pub prepared: &'a Prepared,
}

impl Response for PreparedArray<'_> {
    #[inline(always)]
    fn pressure(&self, b: &[f64; 3], z: f64) -> (f64, f64) {
        self.array.pressure(b, z)
    }

    #[inline(always)]
    fn lines<'s>(self, range: [f64; 2], _: &'s mut [Kink; KINKS]) -> Option<Lines<'s>>
    where
        Self: 's,
    {
        let OneArray { pressures, per_resolution } = self.array;
        let (first, last) = first_and_last(pressures.len(), per_resolution, range);
        let [c, k] = self.prepared.lines[first];
        let n_kinks = last - first;
        // At least a few, so that how many need not be known where they are copied.
        let kinks = &self.prepared.kinks[first + 1..][..n_kinks.max(FEW)];
        (n_kinks <= KINKS).then_some(Lines { c, k, kinks, n_kinks })
    }
}

/// The lines of an array of `n` values that `at` reads over a range of sinkage \[m\].
#[inline(always)]
fn lines<'s>(
    at: impl Fn(usize) -> f64,
    n: usize,
    per_resolution: f64,
    range: [f64; 2],
    kinks: &'s mut [Kink; KINKS],
) -> Option<Lines<'s>> {
    let (first, last) = first_and_last(n, per_resolution, range);
    let n_kinks = last - first;
    for (bend, value) in kinks.get_mut(..n_kinks)?.iter_mut().zip(first + 1..) {
        *bend = kink(&at, value, per_resolution);
    }
    let few = kinks.get_mut(..n_kinks.max(FEW))?;
    few[n_kinks..].fill([0.0; 2]);
    let [c, k] = line(&at, first, per_resolution);
    Some(Lines { c, k, kinks: few, n_kinks })
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
    fn lines<'s>(self, range: [f64; 2], kinks: &'s mut [Kink; KINKS]) -> Option<Lines<'s>>
    where
        Self: 's,
    {
        lines(|n| self.pressures[n], self.pressures.len(), self.per_resolution, range, kinks)
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
    fn lines<'s>(self, range: [f64; 2], kinks: &'s mut [Kink; KINKS]) -> Option<Lines<'s>>
    where
        Self: 's,
    {
        let [a, b, c] = self.pressures;
        lines(|n| (a[n] + b[n] + c[n]) / 3.0, a.len(), self.per_resolution, range, kinks)
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
    fn lines<'s>(self, range: [f64; 2], _: &'s mut [Kink; KINKS]) -> Option<Lines<'s>>
    where
        Self: 's,
    {
        (range[0] >= 0.0).then_some(Lines { c: 0.0, k: self.0, kinks: &[[0.0; 2]; FEW], n_kinks: 0 })
    }
}
