//! Three-by-three tensors over any [`Real`].

use std::ops::{Add, Mul, Sub};

use grouser_geometry::nalgebra::Matrix3;

use crate::number::Real;

/// Tensor of second order, `self.0[row][column]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tensor<S>(pub [[S; 3]; 3]);

impl<S: Real> Tensor<S> {
    /// Tensor whose component (row, column) is `f(row, column)`.
    #[inline(always)]
    pub fn from_fn(f: impl Fn(usize, usize) -> S) -> Self {
        Self([[f(0, 0), f(0, 1), f(0, 2)], [f(1, 0), f(1, 1), f(1, 2)], [f(2, 0), f(2, 1), f(2, 2)]])
    }

    /// Zero.
    #[inline(always)]
    pub fn zero() -> Self {
        Self([[S::constant(0.0); 3]; 3])
    }

    /// Identity.
    #[inline(always)]
    pub fn identity() -> Self {
        Self::from_fn(|i, j| S::constant(if i == j { 1.0 } else { 0.0 }))
    }

    /// Tensor times number.
    #[inline(always)]
    pub fn times(&self, factor: S) -> Self {
        Self::from_fn(|i, j| self.0[i][j] * factor)
    }

    /// Transpose.
    #[inline(always)]
    pub fn transpose(&self) -> Self {
        Self::from_fn(|i, j| self.0[j][i])
    }

    /// Sum of the diagonal.
    #[inline(always)]
    pub fn trace(&self) -> S {
        self.0[0][0] + self.0[1][1] + self.0[2][2]
    }

    /// Sum of the products of all components, A : B.
    #[inline(always)]
    pub fn dot(&self, other: &Self) -> S {
        let row = |i: usize| {
            self.0[i][0] * other.0[i][0] + self.0[i][1] * other.0[i][1] + self.0[i][2] * other.0[i][2]
        };
        row(0) + row(1) + row(2)
    }

    /// Cofactors: det(A) A⁻ᵀ, defined for singular tensors too.
    #[inline(always)]
    pub fn cofactor(&self) -> Self {
        let a = &self.0;
        Self::from_fn(|i, j| {
            let (i1, i2, j1, j2) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
            a[i1][j1] * a[i2][j2] - a[i1][j2] * a[i2][j1]
        })
    }

    /// Determinant.
    #[inline(always)]
    pub fn determinant(&self) -> S {
        let a = &self.0;
        a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1])
            + a[0][1] * (a[1][2] * a[2][0] - a[1][0] * a[2][2])
            + a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0])
    }

    /// Symmetric part.
    #[inline(always)]
    pub fn symmetric(&self) -> Self {
        Self::from_fn(|i, j| if i == j { self.0[i][j] } else { (self.0[i][j] + self.0[j][i]).scaled(0.5) })
    }
}

impl Tensor<f64> {
    /// The same components as a matrix.
    pub fn to_matrix(&self) -> Matrix3<f64> {
        Matrix3::from_fn(|i, j| self.0[i][j])
    }

    /// The same components as a tensor.
    pub fn from_matrix(m: &Matrix3<f64>) -> Self {
        Self::from_fn(|i, j| m[(i, j)])
    }
}

impl<S: Real> Add for Tensor<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::from_fn(|i, j| self.0[i][j] + other.0[i][j])
    }
}

impl<S: Real> Sub for Tensor<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::from_fn(|i, j| self.0[i][j] - other.0[i][j])
    }
}

impl<S: Real> Mul for Tensor<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let (a, b) = (&self.0, &other.0);
        Self::from_fn(|i, j| a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j])
    }
}
