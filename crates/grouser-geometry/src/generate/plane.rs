use super::{ShapeError, counted, positive};
use crate::{TriangleSurface, Vec3};

/// Rectangle on z = 0 around the origin, normal up, cut into `n_x` × `n_y` cells of two triangles each.
///
/// `size_x`, `size_y`: edge lengths [m].
pub fn plane(size_x: f64, size_y: f64, n_x: usize, n_y: usize) -> Result<TriangleSurface, ShapeError> {
    positive("plane", &[("size along x", size_x), ("size along y", size_y)])?;
    counted("plane", "number of cells along x", n_x, 1, 10_000)?;
    counted("plane", "number of cells along y", n_y, 1, 10_000)?;
    let at = |i: usize, n: usize| i as f64 / n as f64 - 0.5;
    let vertices = (0..=n_y)
        .flat_map(|j| (0..=n_x).map(move |i| Vec3::new(size_x * at(i, n_x), size_y * at(j, n_y), 0.0)))
        .collect();
    let number = |i: usize, j: usize| (j * (n_x + 1) + i) as u32;
    let triangles = (0..n_y)
        .flat_map(|j| (0..n_x).map(move |i| (i, j)))
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect();
    Ok(TriangleSurface { vertices, triangles })
}
