//! What the ground under one triangle answers: soil with one array or three, soil that springs, rock.

use crate::pressure::interpolate;

/// Most kinks of the pressure within one triangle that are worked on together.
pub(crate) const KINKS: usize = 8;

/// Pressure between two sinkages as straight lines: c + k z, and a further slope beyond each kink.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lines {
    pub c: f64,
    pub k: f64,
    pub n_kinks: usize,
    /// Where the line bends \[m\] and by how much \[Pa/m\].
    pub kinks: [(f64, f64); KINKS],
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
