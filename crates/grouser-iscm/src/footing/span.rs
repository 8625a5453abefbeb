//! How far any part of running gear sinks when its body moves, at most.

use grouser_geometry::Vec3;
use nalgebra::Matrix3;

use crate::imprint::{Imprint, ImprintNode};

/// A box around gear within reach of the ground, and its largest slopes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    low: Vec3,
    high: Vec3,
    slope: [f64; 2],
}

impl Default for Span {
    fn default() -> Self {
        Self { low: Vec3::repeat(f64::INFINITY), high: Vec3::repeat(f64::NEG_INFINITY), slope: [0.0; 2] }
    }
}

impl Span {
    /// Adds the sides of a layer's window.
    pub fn add_window(&mut self, layer: &Imprint) {
        for [x, y] in [layer.position(0, 0), layer.position(layer.n_x, layer.n_y)] {
            (self.low.x, self.low.y) = (self.low.x.min(x), self.low.y.min(y));
            (self.high.x, self.high.y) = (self.high.x.max(x), self.high.y.max(y));
        }
    }

    /// Adds height and slope of gear at a node.
    #[inline(always)]
    pub fn add(&mut self, node: &ImprintNode) {
        (self.low.z, self.high.z) = (self.low.z.min(node.height), self.high.z.max(node.height));
        self.slope = [0, 1].map(|k| self.slope[k].max(node.slope[k].abs()));
    }

    /// The farthest that a point of the gear sinks where it moves by d = `turn` · p + `shift` \[m\]; undersides follow it in first order.
    pub fn sinks(&self, turn: &Matrix3<f64>, shift: &Vec3) -> f64 {
        if self.low.z > self.high.z {
            return 0.0;
        }
        let (middle, half) = ((self.low + self.high) / 2.0, (self.high - self.low) / 2.0);
        let (d, spread) = (turn * middle + shift, turn.abs() * half);
        let sideways = |k: usize| self.slope[k] * (d[k].abs() + spread[k]);
        spread.z - d.z + sideways(0) + sideways(1)
    }
}

#[cfg(test)]
mod tests {
    use grouser_geometry::{HeightGrid, Pose};
    use proptest::prelude::*;

    use super::*;
    use crate::polygon::PartialLoad;

    proptest! {
        #[test]
        fn no_point_sinks_farther(
            pitch in -0.01..0.01f64, roll in -0.01..0.01f64, x in -2e-3..2e-3f64, z in -2e-3..2e-3f64, tilt in -0.4..0.4f64,
        ) {
            let grid = HeightGrid::covering([-1.0, -1.0], [2.0, 2.0], 0.05, |_, _| 0.0).unwrap();
            let mut layer = Imprint::new(&grid, [-0.6, -0.3], [0.6, 0.3], 1.0, PartialLoad::Proportional);
            layer.draw_cylinder(Vec3::new(0.01, 0.0, 0.5), Vec3::new(0.0, tilt.cos(), tilt.sin()), 0.5, 0.5, 0);
            let mut span = Span::default();
            span.add_window(&layer);
            let covered = || layer.nodes.iter().enumerate().filter(|(_, node)| node.coverage > 0.0);
            covered().for_each(|(_, node)| span.add(node));
            let rotation = nalgebra::UnitQuaternion::from_euler_angles(roll, pitch, 0.0);
            let motion = Pose::from_parts(Vec3::new(x, 0.0, z).into(), rotation);
            let turn = motion.rotation.to_rotation_matrix().matrix() - Matrix3::identity();
            let most = span.sinks(&turn, &motion.translation.vector);
            let deepest = covered().fold(f64::NEG_INFINITY, |deepest, (n, node)| {
                let [x, y] = layer.position(n % layer.n_x, n / layer.n_x);
                let d = turn * Vec3::new(x, y, node.height) + motion.translation.vector;
                deepest.max(node.slope[0] * d.x + node.slope[1] * d.y - d.z)
            });
            prop_assert!(deepest <= most + 1e-12, "{deepest} beyond {most}");
            // What only sinks does so by no more.
            prop_assert!((span.sinks(&Matrix3::zeros(), &Vec3::new(0.0, 0.0, z)) + z).abs() < 1e-15);
        }
    }
}
