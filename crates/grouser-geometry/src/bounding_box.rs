//! The axis-aligned box around points.

use serde::{Deserialize, Serialize};

use crate::Vec3;

/// Axis-aligned box from `min` to `max` [m].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BoundingBox {
    /// Corner with the smallest coordinates [m].
    pub min: Vec3,
    /// Corner with the largest coordinates [m].
    pub max: Vec3,
}

impl BoundingBox {
    /// The box that holds nothing: `min` is +∞ and `max` −∞, so that the first point taken in sets both.
    pub fn empty() -> Self {
        Self { min: Vec3::repeat(f64::INFINITY), max: Vec3::repeat(f64::NEG_INFINITY) }
    }

    /// The smallest box that holds all `points`; [`BoundingBox::empty`] for none.
    pub fn of<'a>(points: impl IntoIterator<Item = &'a Vec3>) -> Self {
        points.into_iter().fold(Self::empty(), |b, p| Self { min: b.min.inf(p), max: b.max.sup(p) })
    }

    /// Whether no point lies inside.
    pub fn is_empty(&self) -> bool {
        (0..3).any(|i| self.min[i] > self.max[i])
    }

    /// The box larger by `margin` [m] on every side.
    pub fn grown(&self, margin: f64) -> Self {
        Self { min: self.min - Vec3::repeat(margin), max: self.max + Vec3::repeat(margin) }
    }

    /// The smallest box that holds both boxes.
    pub fn union(&self, other: &Self) -> Self {
        Self { min: self.min.inf(&other.min), max: self.max.sup(&other.max) }
    }

    /// Whether the boxes share at least a point.
    pub fn overlaps(&self, other: &Self) -> bool {
        (0..3).all(|i| self.min[i] <= other.max[i] && other.min[i] <= self.max[i])
    }

    /// Whether `point` lies inside or on the boundary.
    pub fn contains(&self, point: &Vec3) -> bool {
        (0..3).all(|i| self.min[i] <= point[i] && point[i] <= self.max[i])
    }

    /// Centre of the box [m].
    pub fn center(&self) -> Vec3 {
        (self.min + self.max) / 2.0
    }

    /// Edge lengths [m].
    pub fn extent(&self) -> Vec3 {
        self.max - self.min
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn box_of_two_points_holds_their_middle_and_not_the_outside() {
        let b = BoundingBox::of(&[Vec3::new(1.0, 5.0, -2.0), Vec3::new(3.0, 4.0, 0.0)]);
        assert_eq!(b.min, Vec3::new(1.0, 4.0, -2.0));
        assert_eq!(b.extent(), Vec3::new(2.0, 1.0, 2.0));
        assert!(b.contains(&b.center()) && !b.contains(&Vec3::new(0.9, 4.5, -1.0)));
        assert!(b.grown(0.2).contains(&Vec3::new(0.9, 4.5, -1.0)));
        assert!(BoundingBox::empty().is_empty() && BoundingBox::empty().union(&b) == b);
    }
}
