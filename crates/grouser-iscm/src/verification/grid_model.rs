//! From a 3-D model to heights at the points of the ground.

use super::Row;
use crate::imprint::Imprint;
use crate::polygon::PartialLoad;
use grouser_geometry::lathe::lathe;
use grouser_geometry::{HeightGrid, Pose, TriangleSurface, Vec3};

/// An inclined plate of two triangles and a lathed wheel, drawn on the grid.
pub fn model_to_grid() -> Vec<Row> {
    let case = "P2 test 3: 3-D model to terrain grid";
    let Ok(grid) = HeightGrid::covering([-1.0, -1.0], [2.0, 2.0], 0.02, |_, _| 0.0) else {
        return vec![Row::new(case, "grid", f64::NAN, 0.0, 0.0, "-", "must exist")];
    };
    let blank = || Imprint::new(&grid, [-0.6, -0.4], [0.6, 0.4], 1.0, PartialLoad::Step);
    // z = 0.1 + 0.2 x − 0.3 y over |x| ≤ 0.31, |y| ≤ 0.21: 31 × 21 nodes.
    let height = |x: f64, y: f64| 0.1 + 0.2 * x - 0.3 * y;
    let corner = |x: f64, y: f64| Vec3::new(x, y, height(x, y));
    let plate = TriangleSurface {
        vertices: vec![corner(-0.31, -0.21), corner(0.31, -0.21), corner(0.31, 0.21), corner(-0.31, 0.21)],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    };
    let mut drawn = blank();
    drawn.draw_surface(&Pose::identity(), &plate, 0);
    let (mut covered, mut off) = (0.0, 0.0_f64);
    for j in 0..drawn.n_y {
        for i in 0..drawn.n_x {
            let node = &drawn.nodes[j * drawn.n_x + i];
            if node.coverage > 0.0 {
                let [x, y] = drawn.position(i, j);
                covered += 1.0;
                off = off.max((node.height - height(x, y)).abs());
            }
        }
    }
    let source = "the plane that the plate lies in";
    let mut rows = vec![
        Row::new(case, "nodes under an inclined plate", covered, 31.0 * 21.0, 0.0, "-", "counted"),
        Row::new(case, "largest height error of the plate", off, 0.0, 1e-12, "m", source),
    ];
    // A wheel of n flat sectors lies within its arc by the sagitta r (1 − cos(π/n)).
    let error = |n: usize| {
        let Ok(wheel) = lathe(&[[0.2, 0.3], [0.2, 0.5], [-0.2, 0.5], [-0.2, 0.3]], n) else {
            return f64::NAN;
        };
        let (mut faceted, mut exact) = (blank(), blank());
        faceted.draw_surface(&Pose::translation(0.003, 0.001, 0.45), &wheel, 0);
        exact.draw_cylinder(Vec3::new(0.003, 0.001, 0.45), Vec3::y(), 0.5, 0.4, 0);
        let near = |k: usize| (drawn.position(k % drawn.n_x, 0)[0] - 0.003).abs() < 0.25;
        let pairs = faceted.nodes.iter().zip(&exact.nodes).enumerate();
        pairs
            .filter(|(k, (a, b))| near(*k) && a.coverage > 0.0 && b.coverage > 0.0)
            .map(|(_, (a, b))| (a.height - b.height).abs())
            .fold(0.0, f64::max)
    };
    let (coarse, fine) = (error(48), error(96));
    rows.push(Row::new(
        case,
        "largest height error of a wheel of 96 sectors",
        fine,
        0.0,
        0.5 * (1.0 - (std::f64::consts::PI / 96.0).cos()) / 30.0_f64.to_radians().cos(),
        "m",
        "sagitta of a sector, 30° from the bottom",
    ));
    rows.push(Row::new(
        case,
        "observed order, 48 to 96 sectors",
        (coarse / fine).log2(),
        2.0,
        0.4,
        "-",
        "chords of an arc",
    ));
    rows
}
