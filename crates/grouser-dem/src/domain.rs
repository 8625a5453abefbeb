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
        Period { length: [0, 1, 2].map(length), inverse: [0, 1, 2].map(inverse) }
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

/// Nearest-image arithmetic.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Period<C> {
    length: [C; 3],
    inverse: [C; 3],
}

impl<C: Real> Period<C> {
    /// Number of the image that is not shifted.
    pub const ITSELF: u32 = 13;

    /// The shortest of the images of `difference`, and the number of that image: 13 + turns along x + 3 along y + 9 along z.
    #[inline(always)]
    pub fn nearest(&self, difference: Vector<C>) -> (Vector<C>, u32) {
        let (mut difference, mut image, mut digit) =
            (difference.to_array(), C::from_f64(f64::from(Self::ITSELF)), C::ONE);
        for axis in 0..3 {
            let turns = (difference[axis] * self.inverse[axis]).round_ties_even();
            difference[axis] -= self.length[axis] * turns;
            image += digit * turns;
            digit = digit * C::from_f64(3.0);
        }
        // At 1.5 × 2⁵² neighbouring numbers are one apart, so that the last bits are the number; a cast would look for overflow.
        (difference.into(), (image.to_f64() + 6_755_399_441_055_744.0).to_bits() as u32)
    }

    /// What to subtract from a difference to reach each image [m]; image numbers are those of [`Period::nearest`]. A power
    /// of two of them, so that five bits always name one.
    pub fn shifts(&self) -> [[C; 4]; 32] {
        std::array::from_fn(|image| {
            let turns = [image % 3, image / 3 % 3, image / 9];
            let shift = |axis: usize| self.length[axis] * C::from_f64(turns[axis] as f64 - 1.0);
            [shift(0), shift(1), shift(2), C::ZERO]
        })
    }
}
