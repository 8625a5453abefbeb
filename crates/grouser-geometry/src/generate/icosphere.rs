use std::collections::HashMap;

use super::{ShapeError, counted, positive};
use crate::{TriangleSurface, Vec3};

/// Closed sphere of `radius` [m]: an icosahedron whose triangles are cut into four `n_subdivisions` times, all vertices
/// on the sphere; 20·4ⁿ triangles.
pub fn icosphere(radius: f64, n_subdivisions: usize) -> Result<TriangleSurface, ShapeError> {
    positive("icosphere", &[("radius", radius)])?;
    counted("icosphere", "number of subdivisions", n_subdivisions, 0, 9)?;
    let mut sphere = icosahedron();
    for _ in 0..n_subdivisions {
        sphere = subdivided(&sphere);
    }
    Ok(sphere.scaled(radius))
}

fn icosahedron() -> TriangleSurface {
    let golden = (1.0 + 5f64.sqrt()) / 2.0;
    let rectangle = |i: usize| {
        let (a, b) = (if i & 1 == 0 { 1.0 } else { -1.0 }, if i & 2 == 0 { golden } else { -golden });
        match i / 4 {
            0 => Vec3::new(a, b, 0.0),
            1 => Vec3::new(0.0, a, b),
            _ => Vec3::new(b, 0.0, a),
        }
    };
    let vertices: Vec<Vec3> = (0..12).map(|i| rectangle(i).normalize()).collect();
    // Faces are the triples of mutually nearest vertices, turned outwards.
    let is_near = |i: usize, j: usize| (vertices[i] - vertices[j]).norm() < 1.1;
    let mut triangles = Vec::with_capacity(20);
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                if is_near(i, j) && is_near(j, k) && is_near(k, i) {
                    let is_outward = vertices[i].dot(&vertices[j].cross(&vertices[k])) > 0.0;
                    let (b, c) = if is_outward { (j, k) } else { (k, j) };
                    triangles.push([i as u32, b as u32, c as u32]);
                }
            }
        }
    }
    TriangleSurface { vertices, triangles }
}

fn subdivided(sphere: &TriangleSurface) -> TriangleSurface {
    let mut vertices = sphere.vertices.clone();
    let mut middles: HashMap<(u32, u32), u32> = HashMap::new();
    let mut middle = |a: u32, b: u32| {
        *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
            vertices.push((vertices[a as usize] + vertices[b as usize]).normalize());
            vertices.len() as u32 - 1
        })
    };
    let mut triangles = Vec::with_capacity(4 * sphere.triangles.len());
    for &[a, b, c] in &sphere.triangles {
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    TriangleSurface { vertices, triangles }
}
