//! Value and derivative: forward differentiation without rounding error of differences.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::Real;

/// Number a + b ε with ε² = 0: `value` a and `derivative` b along one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual {
    /// Value.
    pub value: f64,
    /// Derivative along the chosen direction.
    pub derivative: f64,
}

impl Dual {
    #[inline(always)]
    fn chain(self, value: f64, slope: f64) -> Self {
        Self { value, derivative: slope * self.derivative }
    }
}

impl Add for Dual {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self { value: self.value + o.value, derivative: self.derivative + o.derivative }
    }
}

impl Sub for Dual {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self { value: self.value - o.value, derivative: self.derivative - o.derivative }
    }
}

impl Mul for Dual {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Self {
            value: self.value * o.value,
            derivative: self.derivative * o.value + self.value * o.derivative,
        }
    }
}

impl Div for Dual {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        let quotient = self.value / o.value;
        Self { value: quotient, derivative: (self.derivative - quotient * o.derivative) / o.value }
    }
}

impl Neg for Dual {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, derivative: -self.derivative }
    }
}

impl Real for Dual {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self { value, derivative: 0.0 }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, 0.5 / root)
    }
    #[inline(always)]
    fn cbrt(self) -> Self {
        let root = self.value.cbrt();
        self.chain(root, 1.0 / (3.0 * root * root))
    }
    #[inline(always)]
    fn ln(self) -> Self {
        self.chain(self.value.ln(), 1.0 / self.value)
    }
    #[inline(always)]
    fn norm_above(components: &[[Self; 3]; 3], bound: f64) -> bool {
        let square = |c: &Self| c.value * c.value + c.derivative * c.derivative;
        components.as_flattened().iter().map(square).sum::<f64>() > bound * bound
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_agree_with_central_differences() {
        fn f<S: Real>(x: S) -> S {
            (x * x + x.ln() / x.sqrt() - -x.cbrt()).scaled(3.0)
        }
        let x = Dual { value: 1.3, derivative: 1.0 };
        let h = 1e-5;
        assert!((f(x).derivative - (f(1.3 + h) - f(1.3 - h)) / (2.0 * h)).abs() < 1e-8);
        assert_eq!(f(x).value, f(1.3));
    }
}
