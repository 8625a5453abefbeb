//! Elastic contact of two spheres: H. Hertz, 1881; P0 Eqs. (16), (21), (22).

use crate::Real;

/// Secant stiffness k = 4/3 E* √(R* δ) [N/m]: the elastic force is k δ.
///
/// `normal_modulus` is 4/3 E* [Pa], `contact_radius` √(R* δ) [m].
///
/// Chung & Ooi (2011), test 1: two glass spheres of 10 mm meet at 20 m/s; the largest overlap is 0.2741127 mm.
/// ```
/// # use grouser_contact::hertz_stiffness;
/// let (effective_young, effective_radius, overlap) = (25.0e9, 5.0e-3, 0.2741127e-3_f64);
/// let force = hertz_stiffness(4.0 / 3.0 * effective_young, (effective_radius * overlap).sqrt()) * overlap;
/// assert!((force - 10_696.889).abs() < 0.01);
/// ```
#[inline(always)]
pub fn hertz_stiffness<T: Real>(normal_modulus: T, contact_radius: T) -> T {
    normal_modulus * contact_radius
}

/// Stored energy 2/5 k δ² [J] of the secant stiffness `stiffness` [N/m] at `overlap` [m].
#[inline(always)]
pub fn hertz_energy<T: Real>(stiffness: T, overlap: T) -> T {
    T::from_f64(0.4) * stiffness * overlap * overlap
}
