//! Rotation of rigid bodies, written once for one grain and for four or eight at a time: the same operations in the same order.
//!
//! ```text
//!   m′ = m + Δt m̄ × ω̄,  m̄ = (m + m′)/2 = J ω̄       implicit midpoint rule in the body frame, m = J ω
//!   q′ = (1, ½ω Δt) q, of unit length again         rational (Cayley) rotation by the spin ω in the world frame
//! ```
//! Two equal moments of inertia J = (a, a, c) leave the spin about the third axis alone, and the midpoint rule is linear:
//! ω̄₁ = (ω₁ + κ ω₂)/(1 + κ²), ω̄₂ = (ω₂ − κ ω₁)/(1 + κ²), ω̄₃ = ω₃ with κ = ½Δt (a − c) ω₃/a.

use std::ops::{Add, Div, Mul, Sub};

/// A number, or one for each of several grains.
pub(crate) trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// The same for every grain.
    fn of(value: f64) -> Self;
    /// Square root.
    fn root(self) -> Self;
}

impl Number for f64 {
    #[inline(always)]
    fn of(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn root(self) -> Self {
        self.sqrt()
    }
}

/// The body axes in the world frame.
#[derive(Clone, Copy)]
pub(crate) struct Axes<N>([[N; 3]; 3]);

impl<N: Number> Axes<N> {
    /// Of a quaternion (i, j, k, real part).
    #[inline(always)]
    pub fn of([x, y, z, w]: [N; 4]) -> Self {
        let (x2, y2, z2) = (x + x, y + y, z + z);
        let (xx, yy, zz) = (x * x2, y * y2, z * z2);
        let (xy, xz, yz) = (x * y2, x * z2, y * z2);
        let (wx, wy, wz) = (w * x2, w * y2, w * z2);
        let one = N::of(1.0);
        Self([
            [one - (yy + zz), xy + wz, xz - wy],
            [xy - wz, one - (xx + zz), yz + wx],
            [xz + wy, yz - wx, one - (xx + yy)],
        ])
    }

    /// Components along the body axes.
    #[inline(always)]
    pub fn to_body(self, v: [N; 3]) -> [N; 3] {
        let Self([a, b, c]) = self;
        [dot(a, v), dot(b, v), dot(c, v)]
    }

    /// The vector of these components along the body axes.
    #[inline(always)]
    pub fn to_world(self, [u, v, w]: [N; 3]) -> [N; 3] {
        let Self([a, b, c]) = self;
        [a[0] * u + b[0] * v + c[0] * w, a[1] * u + b[1] * v + c[1] * w, a[2] * u + b[2] * v + c[2] * w]
    }

    /// The vector whose components along the body axes are those of `v` times `factors`: J ω, or J⁻¹ L.
    #[inline(always)]
    pub fn stretched(self, v: [N; 3], [u, v2, w]: [f64; 3]) -> [N; 3] {
        let [a, b, c] = self.to_body(v);
        self.to_world([a * N::of(u), b * N::of(v2), c * N::of(w)])
    }
}

#[inline(always)]
fn dot<N: Number>(a: [N; 3], b: [N; 3]) -> N {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// a + b s.
#[inline(always)]
pub(crate) fn plus_scaled<N: Number>(a: [N; 3], b: [N; 3], s: N) -> [N; 3] {
    [a[0] + b[0] * s, a[1] + b[1] * s, a[2] + b[2] * s]
}

/// ω̄ of the midpoint rule where the moments about the two axes other than `axis` are equal; `moments` J and `momentum` m are in
/// the body frame.
#[inline(always)]
pub(crate) fn middle_about_axis<N: Number>(
    axis: usize,
    moments: [f64; 3],
    momentum: [N; 3],
    half_step: f64,
) -> [N; 3] {
    let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
    let across = moments[j];
    let along = momentum[axis] * N::of(1.0 / moments[axis]);
    let (first, second) = (momentum[j] * N::of(1.0 / across), momentum[k] * N::of(1.0 / across));
    let turn = along * N::of(half_step * (across - moments[axis]) / across);
    let one = N::of(1.0);
    let share = one / (one + turn * turn);
    let mut middle = [along; 3];
    middle[j] = (first + turn * second) * share;
    middle[k] = (second - turn * first) * share;
    middle
}

/// The quaternion `[x, y, z, w]` turned by `spin` [rad/s] over two half steps [s].
#[inline(always)]
pub(crate) fn turned<N: Number>([x, y, z, w]: [N; 4], spin: [N; 3], half_step: f64) -> [N; 4] {
    let half_step = N::of(half_step);
    let [a, b, c] = [spin[0] * half_step, spin[1] * half_step, spin[2] * half_step];
    let i = x + a * w + b * z - c * y;
    let j = y - a * z + b * w + c * x;
    let k = z + a * y - b * x + c * w;
    let real = w - a * x - b * y - c * z;
    let scale = N::of(1.0) / ((i * i + j * j) + (k * k + real * real)).root();
    [i * scale, j * scale, k * scale, real * scale]
}
