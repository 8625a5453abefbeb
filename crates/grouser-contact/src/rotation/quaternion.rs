//! Unit quaternion of any [`Real`], for kernels.

use crate::{Blocked, Frame, Lanes, Real, Vector};
use serde::{Deserialize, Serialize};

/// Turns the body frame into the world frame: (i, j, k, real part).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Quaternion<T>(pub [T; 4]);

impl<T: Real> Default for Quaternion<T> {
    fn default() -> Self {
        Self([T::ZERO, T::ZERO, T::ZERO, T::ONE])
    }
}

impl<T: Real> Quaternion<T> {
    /// The body axes E₁, E₂, E₃ in the world frame, P1 Eqs. (8)–(10).
    #[inline(always)]
    pub fn axes(&self) -> [Vector<T>; 3] {
        let [x, y, z, w] = self.0;
        let (x2, y2, z2) = (x + x, y + y, z + z);
        let (xx, yy, zz) = (x * x2, y * y2, z * z2);
        let (xy, xz, yz) = (x * y2, x * z2, y * z2);
        let (wx, wy, wz) = (w * x2, w * y2, w * z2);
        let one = T::ONE;
        [
            Vector::new(one - (yy + zz), xy + wz, xz - wy),
            Vector::new(xy - wz, one - (xx + zz), yz + wx),
            Vector::new(xz + wy, yz - wx, one - (xx + yy)),
        ]
    }
}

impl<T: Real> Blocked<T> for Quaternion<T> {
    type Block = [Lanes<T>; 4];
    #[inline(always)]
    fn store(self, block: &mut Self::Block, k: usize) {
        for (lanes, component) in block.iter_mut().zip(self.0) {
            lanes.0[k] = component;
        }
    }
    #[inline(always)]
    fn store_four(four: [Self; 4], block: &mut Self::Block, k: usize) {
        let [a, b, c, d] = [&four[0].0, &four[1].0, &four[2].0, &four[3].0];
        for (component, lanes) in block.iter_mut().enumerate() {
            lanes.0[k..k + 4].copy_from_slice(&[a[component], b[component], c[component], d[component]]);
        }
    }
    #[inline(always)]
    fn load(block: &Self::Block, k: usize) -> Self {
        Self([block[0].0[k], block[1].0[k], block[2].0[k], block[3].0[k]])
    }
}

impl<T: Real> Frame<T> for Quaternion<T> {
    const IS_TRACKED: bool = true;
    #[inline(always)]
    fn from_quaternion(quaternion: [f64; 4]) -> Self {
        let [x, y, z, w] = quaternion;
        Self([T::from_f64(x), T::from_f64(y), T::from_f64(z), T::from_f64(w)])
    }
}
