//! What the ground does to a tire: tractive effort, running resistance and drawbar pull by both definitions.

use grouser_coupling::Seen;
use grouser_geometry::Vec3;
use serde::{Deserialize, Serialize};

/// Forces of the ground on a tire, summed over the steps of a sample.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Traction {
    /// Sums over steps: forces along x that push forwards, and backwards [N].
    forward: f64,
    backward: f64,
    force: Vec3,
    moment: Vec3,
    n_steps: u64,
    /// Force of the present step [N].
    now: Vec3,
    /// Contact points of the present step [m].
    points: Vec<[f64; 2]>,
}

/// Means over the steps of a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MeanTraction {
    /// Gross tractive effort T_H = Σ f_x > 0 [N], P0 section 5.1.
    pub gross: f64,
    /// Running resistance T_R = Σ f_x < 0 [N].
    pub resistance: f64,
    /// Force on the tire [N].
    pub force: Vec3,
    /// Torque of the drive about the axle, against the ground's [N·m].
    pub torque: f64,
}

impl Traction {
    /// Begins a step.
    pub fn begin_step(&mut self) {
        self.now = Vec3::zeros();
        self.points.clear();
        self.n_steps += 1;
    }

    /// Adds a contact; moments are about the axle at `axle` [m].
    pub fn add(&mut self, seen: &Seen, axle: &Vec3) {
        // What takes back a part of forward forces belongs to them.
        let along = seen.force.x;
        *(if along * seen.weight > 0.0 { &mut self.forward } else { &mut self.backward }) += along;
        self.force += seen.force;
        self.moment += (seen.point - axle).cross(&seen.force);
        self.now += seen.force;
        self.points.push([seen.point.x, seen.point.y]);
    }

    /// Force of the present step [N].
    pub fn last(&self) -> Vec3 {
        self.now
    }

    /// Area of the convex hull of the present contact points, seen from above [m²].
    pub fn patch_area(&self) -> f64 {
        hull_area(&self.points)
    }

    /// Means since the last call.
    pub fn take_means(&mut self) -> MeanTraction {
        let share = 1.0 / self.n_steps.max(1) as f64;
        let means = MeanTraction {
            gross: self.forward * share,
            resistance: self.backward * share,
            force: self.force * share,
            torque: -self.moment.y * share,
        };
        let (now, points) = (self.now, std::mem::take(&mut self.points));
        *self = Self { now, points, ..Self::default() };
        means
    }
}

/// Area of the convex hull of some points (A. M. Andrew's chain, 1979).
fn hull_area(points: &[[f64; 2]]) -> f64 {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let turn =
        |a: [f64; 2], b: [f64; 2], c: [f64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let chain = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for point in points {
            while chain.len() >= 2 && turn(chain[chain.len() - 2], chain[chain.len() - 1], point) <= 0.0 {
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut hull = chain(&mut sorted.iter().copied());
    hull.extend(chain(&mut sorted.iter().rev().copied()));
    let n = hull.len();
    (0..n).map(|i| hull[i][0] * hull[(i + 1) % n][1] - hull[i][1] * hull[(i + 1) % n][0]).sum::<f64>() / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hull_of_a_square_with_points_inside_has_the_squares_area() {
        let points = [[0.0, 0.0], [1.0, 0.0], [0.5, 0.5], [1.0, 1.0], [0.2, 0.7], [0.0, 1.0], [0.5, 0.0]];
        assert!((hull_area(&points) - 1.0).abs() < 1e-15);
        assert_eq!(hull_area(&points[..1]), 0.0);
    }

    #[test]
    fn a_wheel_pulled_forwards_at_its_foot_needs_the_torque_of_its_radius() {
        let mut traction = Traction::default();
        traction.begin_step();
        let axle = Vec3::new(1.0, 0.0, 0.3);
        let mut push = |x: f64, force: Vec3| {
            traction.add(&Seen { grain: 0, point: Vec3::new(x, 0.0, 0.0), force, weight: 1.0 }, &axle);
        };
        push(1.0, Vec3::new(100.0, 0.0, 500.0));
        push(1.0, Vec3::new(-40.0, 0.0, 0.0));
        let mean = traction.take_means();
        assert_eq!((mean.gross, mean.resistance, mean.force.z), (100.0, -40.0, 500.0));
        // M = R (T_H − |T_R|) when every force acts right below the axle.
        assert!((mean.torque - 0.3 * 60.0).abs() < 1e-12);
    }
}
