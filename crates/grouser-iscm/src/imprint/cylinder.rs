//! Underside of a perfect cylinder.

use grouser_geometry::Vec3;

use super::{Imprint, cell_width, overlap};
use crate::polygon::PartialLoad;

impl Imprint {
    /// Draws a cylinder of `radius` and `width` \[m\] around `centre` with the unit vector `axle`.
    pub fn draw_cylinder(&mut self, centre: Vec3, axle: Vec3, radius: f64, width: f64, owner: u16) {
        let (a, half) = (axle, width / 2.0);
        let reach =
            |k: usize| (1.0 - a[k] * a[k]).max(0.0).sqrt() * radius + a[k].abs() * (half + self.spacing);
        let (r_x, r_y) = (reach(0), reach(1));
        let [is, js] = self.range([centre.x - r_x, centre.y - r_y], [centre.x + r_x, centre.y + r_y]);
        let flat = 1.0 - a.z * a.z; // 0 for an upright axle
        if flat < 1e-6 {
            return;
        }
        let cell = self.spacing * cell_width(&a);
        for j in js {
            for i in is.clone() {
                let [x, y] = self.position(i, j);
                let (d_x, d_y) = (x - centre.x, y - centre.y);
                // |d − (d·a) a| = r with d = (d_x, d_y, ζ): the lower root.
                let e = a.x * d_x + a.y * d_y;
                let discriminant =
                    e * e * a.z * a.z - flat * (d_x * d_x + d_y * d_y - e * e - radius * radius);
                if discriminant <= 0.0 {
                    continue;
                }
                let zeta = (e * a.z - discriminant.sqrt()) / flat;
                let s = e + a.z * zeta;
                let is_inside = s.abs() <= half + 1e-9;
                let coverage = match self.partial {
                    PartialLoad::Step => f64::from(u8::from(is_inside)),
                    PartialLoad::Proportional => overlap(s, cell, -half, half),
                };
                let height = centre.z + zeta;
                if coverage == 0.0 || height > self.ceiling {
                    continue;
                }
                let normal = Vec3::new(d_x, d_y, zeta) - a * s;
                if normal.z < -1e-3 * radius {
                    let slope = [-normal.x / normal.z, -normal.y / normal.z];
                    self.add(j * self.n_x + i, (coverage, is_inside), height, slope, owner);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use grouser_geometry::HeightGrid;

    use super::*;

    #[test]
    fn a_level_cylinder_has_the_height_of_its_arc_and_covers_its_width() {
        let grid = HeightGrid::covering([-1.0, -1.0], [2.0, 2.0], 0.03, |_, _| 0.0).unwrap();
        let mut imprint = Imprint::new(&grid, [-0.6, -0.3], [0.6, 0.3], 0.3, PartialLoad::Proportional);
        imprint.draw_cylinder(Vec3::new(0.01, 0.004, 0.45), Vec3::y(), 0.5, 0.5, 3);
        for j in 0..imprint.n_y {
            for i in 0..imprint.n_x {
                let node = imprint.nodes[j * imprint.n_x + i];
                let [x, _] = imprint.position(i, j);
                if node.coverage > 0.0 {
                    let exact = 0.45 - (0.25 - (x - 0.01_f64).powi(2)).sqrt();
                    assert!((node.height - exact).abs() < 1e-12 && node.owner == 3);
                    assert!((node.slope[0] - (x - 0.01) / (0.45 - exact)).abs() < 1e-9);
                }
            }
        }
        let column = imprint.n_x / 2;
        let covered: f64 = (0..imprint.n_y).map(|j| imprint.nodes[j * imprint.n_x + column].coverage).sum();
        assert!((covered * 0.03 - 0.5).abs() < 1e-12, "width covered {}", covered * 0.03);
    }
}
