//! Place and velocity of a rigid body at one instant.

use serde::{Deserialize, Serialize};

use crate::{Orientation, Vec3};

/// Where a rigid body is and how it moves: body frame in the world frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RigidMotion {
    /// Position of the body frame's origin [m].
    pub position: Vec3,
    /// Orientation of the body frame.
    pub orientation: Orientation,
    /// Velocity of the origin [m/s].
    pub velocity: Vec3,
    /// Angular velocity in the world frame [rad/s].
    pub spin: Vec3,
}

impl Default for RigidMotion {
    fn default() -> Self {
        Self::at_rest(Vec3::zeros())
    }
}

impl RigidMotion {
    /// Unturned and at rest at `position` [m].
    pub fn at_rest(position: Vec3) -> Self {
        Self { position, orientation: Orientation::identity(), velocity: Vec3::zeros(), spin: Vec3::zeros() }
    }

    /// World position of a point given in the body frame [m].
    #[inline]
    pub fn point(&self, in_body: &Vec3) -> Vec3 {
        self.position + self.orientation * in_body
    }

    /// Body-frame coordinates of a point of the world [m].
    #[inline]
    pub fn point_in_body(&self, in_world: &Vec3) -> Vec3 {
        self.orientation.inverse_transform_vector(&(in_world - self.position))
    }

    /// Velocity of the body's material at a point of the world [m/s].
    #[inline]
    pub fn velocity_at(&self, in_world: &Vec3) -> Vec3 {
        self.velocity + self.spin.cross(&(in_world - self.position))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_go_to_the_world_and_back_and_move_with_the_spin() {
        let motion = RigidMotion {
            position: Vec3::new(1.0, 0.0, 0.0),
            orientation: Orientation::from_axis_angle(&Vec3::z_axis(), std::f64::consts::FRAC_PI_2),
            velocity: Vec3::new(0.0, 0.0, 1.0),
            spin: Vec3::new(0.0, 0.0, 2.0),
        };
        let tip = motion.point(&Vec3::x());
        assert!((tip - Vec3::new(1.0, 1.0, 0.0)).norm() < 1e-15);
        assert!((motion.point_in_body(&tip) - Vec3::x()).norm() < 1e-15);
        assert!((motion.velocity_at(&tip) - Vec3::new(-2.0, 0.0, 1.0)).norm() < 1e-15);
    }
}
