//! Degrees of freedom of a body.

use serde::{Deserialize, Serialize};

use crate::VelocityProfile;

/// One of the six degrees of freedom, along or about a world axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Degree {
    /// Translation along x.
    X,
    /// Translation along y.
    Y,
    /// Translation along z.
    Z,
    /// Rotation about x.
    AboutX,
    /// Rotation about y.
    AboutY,
    /// Rotation about z.
    AboutZ,
}

impl Degree {
    /// All six, translations first.
    pub const ALL: [Self; 6] = [Self::X, Self::Y, Self::Z, Self::AboutX, Self::AboutY, Self::AboutZ];

    /// Axis 0, 1 or 2.
    #[inline]
    pub fn axis(self) -> usize {
        self as usize % 3
    }

    /// Whether it is a rotation.
    #[inline]
    pub fn is_rotation(self) -> bool {
        self as usize >= 3
    }
}

/// What decides the motion along one degree of freedom.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Freedom {
    /// Held.
    #[default]
    Fixed,
    /// Moved by a drive of any strength.
    Prescribed(VelocityProfile),
    /// Moved by the loads: Newton's and Euler's equations.
    Free,
}
