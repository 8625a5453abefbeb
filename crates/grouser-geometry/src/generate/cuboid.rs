use super::{ShapeError, positive};
use crate::{TriangleSurface, Vec3};

/// Closed box of edge lengths `size` [m], 12 triangles, standing on z = 0 around the z axis.
pub fn cuboid(size: Vec3) -> Result<TriangleSurface, ShapeError> {
    positive("box", &[("size along x", size.x), ("size along y", size.y), ("size along z", size.z)])?;
    let corner = |i: usize| {
        let side = |bit: usize| if i >> bit & 1 == 1 { 0.5 } else { -0.5 };
        Vec3::new(side(0) * size.x, side(1) * size.y, (side(2) + 0.5) * size.z)
    };
    // Corners numbered by bits: x, y, z; each face runs anticlockwise seen from outside.
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Ok(TriangleSurface { vertices: (0..8).map(corner).collect(), triangles })
}
