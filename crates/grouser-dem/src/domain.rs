//! The box that grains live in: periodic or open along each axis.

use grouser_contact::{Real, Vector};
use grouser_geometry::Vec3;
use serde::{Deserialize, Serialize};

/// An axis-aligned box. Along a periodic axis a grain that leaves at one face enters at the other; along an open axis
/// the box only says beyond which place a grain counts as lost.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Domain {
    /// Lower corner [m].
    pub lower: Vec3,
    /// Upper corner [m].
    pub upper: Vec3,
    /// Which axes are periodic.
    pub is_periodic: [bool; 3],
}

impl Domain {
    /// Edge lengths [m].
    pub fn size(&self) -> Vec3 {
        self.upper - self.lower
    }

    /// The period of each axis as the kernels want it.
    pub(crate) fn period<C: Real>(&self) -> Period<C> {
        let size = self.size();
        let length = |axis: usize| if self.is_periodic[axis] { C::from_f64(size[axis]) } else { C::ZERO };
        let inverse = |axis: usize| {
            if self.is_periodic[axis] { C::from_f64(1.0 / size[axis]) } else { C::ZERO }
        };
        Period {
            length: Vector::new(length(0), length(1), length(2)),
            inverse: Vector::new(inverse(0), inverse(1), inverse(2)),
        }
    }

    /// `position` moved into the box along periodic axes.
    pub(crate) fn wrapped<C: Real>(&self, position: Vector<C>) -> Vector<C> {
        let mut place = position.to_array();
        for axis in 0..3 {
            if self.is_periodic[axis] {
                let (low, size) = (self.lower[axis], self.size()[axis]);
                let turns = ((place[axis].to_f64() - low) / size).floor();
                if turns != 0.0 {
                    place[axis] -= C::from_f64(turns * size);
                }
            }
        }
        place.into()
    }

    /// The grain's centre lies beyond an open face by more than `margin` [m].
    pub(crate) fn has_lost(&self, position: Vec3, margin: f64) -> bool {
        (0..3).any(|axis| {
            !self.is_periodic[axis]
                && (position[axis] < self.lower[axis] - margin || position[axis] > self.upper[axis] + margin)
        })
    }
}

/// Nearest-image arithmetic; an open axis has length and inverse zero, and costs the same few operations.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Period<C> {
    length: Vector<C>,
    inverse: Vector<C>,
}

impl<C: Real> Period<C> {
    /// The shortest of the images of `difference`.
    #[inline(always)]
    pub fn nearest(&self, difference: Vector<C>) -> Vector<C> {
        let image = |d: C, length: C, inverse: C| d - length * (d * inverse).round_ties_even();
        Vector::new(
            image(difference.x, self.length.x, self.inverse.x),
            image(difference.y, self.length.y, self.inverse.y),
            image(difference.z, self.length.z, self.inverse.z),
        )
    }
}
