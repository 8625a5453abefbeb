//! Underside of a flat plate: what track shoes and grousers are made of.

use grouser_geometry::{Pose, Vec3};
use serde::{Deserialize, Serialize};

use super::{Imprint, cell_width, overlap};
use crate::polygon::PartialLoad;

/// A rectangle of a shoe that faces the ground.
///
/// ```text
///   z ↑ towards the wheel          frame of a shoe: origin on the link line in mid-shoe,
///     o──→ x along the track       y along the axle, the ground lies at negative z
///   ━━━━━━━━  plate at z = −depth
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plate {
    /// Range along the track \[m\].
    pub along: [f64; 2],
    /// Range along the axle \[m\].
    pub across: [f64; 2],
    /// Distance below the link line \[m\].
    pub depth: f64,
}

impl Imprint {
    /// Draws a plate of a shoe at `pose`.
    pub fn draw_plate(&mut self, pose: &Pose, plate: &Plate, owner: u16) {
        let rotation = pose.rotation.to_rotation_matrix();
        let m = rotation.matrix();
        let (e_x, e_y, n): (Vec3, Vec3, Vec3) = (m.column(0).into(), m.column(1).into(), m.column(2).into());
        if n.z < 0.2 {
            return; // on edge or upside down: it does not face the ground
        }
        let o = pose.translation.vector - n * plate.depth;
        if o.z - e_x.z.abs() * plate.along[1].max(-plate.along[0]) > self.ceiling {
            return;
        }
        let (horizontal_x, horizontal_y) = ((1.0 - e_x.z * e_x.z).sqrt(), (1.0 - e_y.z * e_y.z).sqrt());
        let (cell_x, cell_y) = (self.spacing * cell_width(&e_x), self.spacing * cell_width(&e_y));
        let margin = match self.partial {
            PartialLoad::Step => 0.0,
            PartialLoad::Proportional => self.spacing * std::f64::consts::FRAC_1_SQRT_2,
        };
        let (mut min, mut max) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for u in plate.along {
            for v in plate.across {
                let corner = o + e_x * u + e_y * v;
                for k in 0..2 {
                    // Half a cell beyond the corner along both sides.
                    let beyond = margin * ((e_x[k] / horizontal_x).abs() + (e_y[k] / horizontal_y).abs());
                    min[k] = min[k].min(corner[k] - beyond);
                    max[k] = max[k].max(corner[k] + beyond);
                }
            }
        }
        let slope = [-n.x / n.z, -n.y / n.z];
        let [is, js] = self.range(min, max);
        for j in js {
            for i in is.clone() {
                let [x, y] = self.position(i, j);
                let rise = slope[0] * (x - o.x) + slope[1] * (y - o.y);
                let p = Vec3::new(x - o.x, y - o.y, rise);
                let (u, v) = (p.dot(&e_x), p.dot(&e_y));
                let inside = |t: f64, range: [f64; 2]| t >= range[0] - 1e-9 && t <= range[1] + 1e-9;
                let is_inside = inside(u, plate.along) && inside(v, plate.across);
                let coverage = match self.partial {
                    PartialLoad::Step => f64::from(u8::from(is_inside)),
                    PartialLoad::Proportional => {
                        overlap(u, cell_x, plate.along[0], plate.along[1])
                            * overlap(v, cell_y, plate.across[0], plate.across[1])
                    }
                };
                if coverage > 0.0 && o.z + rise <= self.ceiling {
                    self.add(j * self.n_x + i, (coverage, is_inside), o.z + rise, slope, owner);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use grouser_geometry::HeightGrid;
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_plate_covers_its_projected_area_in_every_direction(
            heading in 0.0..std::f64::consts::TAU, pitch in -0.5..0.5f64, x in -0.1..0.1f64, y in -0.1..0.1f64,
        ) {
            let grid = HeightGrid::covering([-1.0, -1.0], [2.0, 2.0], 0.02, |_, _| 0.0).unwrap();
            let mut imprint = Imprint::new(&grid, [-0.6, -0.6], [0.6, 0.6], 1.0, PartialLoad::Proportional);
            let rotation = nalgebra::UnitQuaternion::from_axis_angle(&Vec3::z_axis(), heading)
                * nalgebra::UnitQuaternion::from_axis_angle(&Vec3::y_axis(), pitch);
            let pose = Pose::from_parts(Vec3::new(x, y, 0.1).into(), rotation);
            let plate = Plate { along: [-0.25, 0.25], across: [-0.3, 0.3], depth: 0.02 };
            imprint.draw_plate(&pose, &plate, 0);
            let covered: f64 = imprint.nodes.iter().map(|n| n.coverage).sum::<f64>() * 0.02 * 0.02;
            let exact = 0.5 * 0.6 * pitch.cos();
            prop_assert!((covered / exact - 1.0).abs() < 4e-3, "{covered} for {exact}");
        }
    }
}
