//! How far the surface of the gear has slid over the ground since it entered it.

use grouser_geometry::Vec3;

use crate::contact::FootImprint;
use crate::terrain::Terrain;

/// How gear moves over the ground.
///
/// ```text
///          ↗ travel: (1 − s)(forward + tan β left) per metre of rim      s: slip (ωR − v)/(ωR)
///   ──────→ forward: the direction in which the gear rolls              β: slip angle, positive to the left
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Direction in which the gear rolls (unit vector, along the ground).
    pub forward: Vec3,
    /// Slip s = (ωR − v)/(ωR) \[-\], v along `forward`; at most 1, negative while braking.
    pub slip: f64,
    /// Angle from `forward` to the direction of travel \[rad\], positive to the left.
    pub slip_angle: f64,
}

impl Motion {
    /// Travel of the body per length of rim or belt \[-\].
    pub fn travel(&self) -> Vec3 {
        (self.forward + self.left() * self.slip_angle.tan()) * (1.0 - self.slip)
    }

    /// Direction to the left of `forward` (unit vector, horizontal).
    pub fn left(&self) -> Vec3 {
        Vec3::z().cross(&self.forward).try_normalize(1e-12).unwrap_or_else(Vec3::y)
    }
}

/// Way of the gear's surface from where it entered the ground.
///
/// A point of the rim or belt reaches the ground at the front and runs backwards along the underside with the rim's speed while the
/// body travels: after a length L of underside its shear displacement is L − (1 − s) D along the underside, D the distance of entry
/// and point along `forward`, and (1 − s) tan β L to the side. Every wheel and belt starts at zero where it enters: ground between two
/// wheels is not under load and keeps no shear.
#[derive(Clone, Copy, Debug)]
pub struct ShearPath<'a> {
    /// The gear's underside.
    pub imprint: &'a FootImprint,
    /// The ground.
    pub terrain: &'a Terrain,
    /// Motion of the gear.
    pub motion: Motion,
    /// Gap without gear, between the shoes of a belt, across which the path goes on \[m\].
    pub gap: f64,
}

impl ShearPath<'_> {
    /// Shear displacement along the underside and to the left \[m\] at the point `from` of the underside.
    pub fn displacement(&self, from: Vec3) -> [f64; 2] {
        let (length, distance) = self.since_entry(from);
        let rest = 1.0 - self.motion.slip;
        [length - rest * distance, rest * self.motion.slip_angle.tan() * length]
    }

    /// Length of underside and distance along `forward` \[m\] between the point `from` and where the gear enters the ground.
    fn since_entry(&self, from: Vec3) -> (f64, f64) {
        let grid = self.terrain.grid();
        let step = grid.spacing() / 2.0;
        let forward = self.motion.forward;
        let along = [forward.x, forward.y].map(|c| c / forward.x.hypot(forward.y).max(1e-12));
        let (mut last, mut length, mut gap) = (from, 0.0, 0.0);
        let mut last_depth = f64::INFINITY;
        for k in 1.. {
            let (x, y) = (from.x + along[0] * step * k as f64, from.y + along[1] * step * k as f64);
            let Some((height, depth)) = self.underside(x, y) else {
                gap += step;
                if gap > self.gap {
                    break;
                }
                continue;
            };
            gap = 0.0;
            let here = Vec3::new(x, y, height);
            let way = here - last;
            if depth <= 0.0 {
                // Straight between the last point in the ground and the first above it.
                let share = if last_depth.is_finite() { last_depth / (last_depth - depth) } else { 0.5 };
                length += share * way.norm();
                last += way * share;
                break;
            }
            length += way.norm();
            (last, last_depth) = (here, depth);
        }
        (length, (last - from).dot(&forward))
    }

    /// Height of the lowest gear at a position and its depth below the present ground \[m\]; none where no gear is.
    #[inline(always)]
    fn underside(&self, x: f64, y: f64) -> Option<(f64, f64)> {
        let mut lowest: Option<(f64, f64)> = None;
        for layer in &self.imprint.layers {
            let [x_0, y_0] = layer.position(0, 0);
            let (a, b) = ((x - x_0) / layer.spacing, (y - y_0) / layer.spacing);
            if !(a >= 0.0 && b >= 0.0) {
                continue;
            }
            let (i, j) = (a as usize, b as usize);
            if i + 1 >= layer.n_x || j + 1 >= layer.n_y {
                continue;
            }
            let (u, v) = (a - i as f64, b - j as f64);
            let (mut height, mut ground, mut weight) = (0.0, 0.0, 0.0);
            for (di, dj, w) in
                [(0, 0, (1.0 - u) * (1.0 - v)), (1, 0, u * (1.0 - v)), (0, 1, (1.0 - u) * v), (1, 1, u * v)]
            {
                let node = &layer.nodes[(j + dj) * layer.n_x + i + di];
                if node.is_known && w > 0.0 {
                    let on_grid = (layer.j_0 + j + dj) * self.terrain.grid().n_x() + layer.i_0 + i + di;
                    height += w * node.height;
                    ground += w * self.terrain.height(on_grid);
                    weight += w;
                }
            }
            // A point with less than half of its surroundings known lies beyond the gear.
            if weight < 0.5 {
                continue;
            }
            let (height, ground) = (height / weight, ground / weight);
            if lowest.is_none_or(|(h, _)| height < h) {
                lowest = Some((height, ground - height));
            }
        }
        lowest
    }
}

#[cfg(test)]
mod tests {
    use grouser_geometry::{HeightGrid, Pose};

    use super::*;
    use crate::gear::{Foot, Wheel};
    use crate::polygon::PartialLoad;
    use crate::pressure::{Linear, PressureArray, PressureField, PressureLaw};

    fn ground(spacing: f64) -> Terrain {
        let grid = HeightGrid::covering([-0.5, -0.5], [1.0, 1.0], spacing, |_, _| 0.0).unwrap();
        let law = PressureLaw::Linear(Linear { stiffness: 1e6 });
        Terrain::new(grid, PressureField::uniform(PressureArray::new(&law, 0.005, 0.5).unwrap())).unwrap()
    }

    /// Error of j at 20° before the lowest point against R [(θ_f − θ) − (1 − s)(sin θ_f − sin θ)], all headings.
    fn error(spacing: f64, slip: f64) -> f64 {
        let (radius, sinkage) = (0.2_f64, 0.05);
        let terrain = ground(spacing);
        let foot =
            Foot { body: 0, wheels: vec![Wheel::cylinder(Vec3::zeros(), radius, 0.2)], belts: Vec::new() };
        let entry = ((radius - sinkage) / radius).acos();
        let angle = 20_f64.to_radians();
        let exact = radius * ((entry - angle) - (1.0 - slip) * (entry.sin() - angle.sin()));
        let error_at = |heading: f64| {
            let turn = grouser_geometry::Orientation::from_axis_angle(&Vec3::z_axis(), heading);
            let centre = Vec3::new(0.003, 0.001, radius - sinkage);
            let pose = Pose::from_parts(centre.into(), turn);
            let imprint = foot.imprint(&terrain, &pose, 0.0, PartialLoad::Proportional);
            let forward = turn * Vec3::x();
            let motion = Motion { forward, slip, slip_angle: 0.0 };
            let path = ShearPath { imprint: &imprint, terrain: &terrain, motion, gap: 0.0 };
            let from = centre + forward * (radius * angle.sin()) - Vec3::z() * (radius * angle.cos());
            (path.displacement(from)[0] - exact).abs()
        };
        (0..8).map(|k| error_at(0.3 * f64::from(k))).fold(0.0, f64::max)
    }

    #[test]
    fn the_displacement_under_a_wheel_is_that_of_wong_and_reece_in_every_heading() {
        for slip in [-0.3, 0.0, 0.4, 1.0] {
            let (coarse, fine) = (error(0.01, slip), error(0.0025, slip));
            assert!(fine < 4e-5, "slip {slip}: {fine} m");
            assert!((coarse / fine).log2() / 2.0 > 1.3, "slip {slip}: {coarse} {fine}");
        }
    }
}
