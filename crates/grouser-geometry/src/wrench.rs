//! Force and moment on a body.

use std::ops::{Add, AddAssign, Neg, Sub};

use serde::{Deserialize, Serialize};

use crate::Vec3;

/// Force and its moment about a stated point, in the world frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Wrench {
    /// Force [N].
    pub force: Vec3,
    /// Moment about the point that the owner states [N·m].
    pub moment: Vec3,
}

impl Wrench {
    /// Wrench about `about` of a force that acts at `point`.
    #[inline]
    pub fn of_force_at(force: Vec3, point: &Vec3, about: &Vec3) -> Self {
        Self { force, moment: (point - about).cross(&force) }
    }

    /// The same load with its moment taken about `to` instead of `from`.
    #[inline]
    pub fn moved(&self, from: &Vec3, to: &Vec3) -> Self {
        Self { force: self.force, moment: self.moment + (from - to).cross(&self.force) }
    }
}

impl Add for Wrench {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { force: self.force + other.force, moment: self.moment + other.moment }
    }
}

impl Sub for Wrench {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self { force: self.force - other.force, moment: self.moment - other.moment }
    }
}

impl Neg for Wrench {
    type Output = Self;
    fn neg(self) -> Self {
        Self { force: -self.force, moment: -self.moment }
    }
}

impl AddAssign for Wrench {
    fn add_assign(&mut self, other: Self) {
        self.force += other.force;
        self.moment += other.moment;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moving_the_point_and_back_changes_nothing_and_the_lever_is_right() {
        let (at, about) = (Vec3::new(2.0, 0.0, 0.0), Vec3::zeros());
        let wrench = Wrench::of_force_at(Vec3::new(0.0, 3.0, 0.0), &at, &about);
        assert_eq!(wrench.moment, Vec3::new(0.0, 0.0, 6.0));
        assert_eq!(wrench.moved(&about, &at).moment, Vec3::zeros());
        assert_eq!(wrench.moved(&about, &at).moved(&at, &about), wrench);
    }
}
