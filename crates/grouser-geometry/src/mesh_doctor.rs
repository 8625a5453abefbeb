//! Finds what is wrong with a triangle surface, and says where, why and what to do.

use std::collections::BTreeMap;

use thiserror::Error;

use crate::{SurfaceTopology, TriangleSurface, Vec3};

/// What the surface is to be used for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Closedness {
    /// A sheet will do: walls, plates without thickness, terrain.
    Optional,
    /// It must enclose a volume: bodies with mass, surfaces to be filled with elements.
    Required,
}

/// Height over longest side below which a triangle counts as having no area.
const ZERO_AREA_RATIO: f64 = 1e-10;

/// One thing wrong with a surface. Triangles and vertices are counted from 0; places are in the units of the surface.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Finding {
    /// No triangle at all.
    #[error(
        "the surface has no triangle ({n_vertices} vertices); usual cause: an export of curves or of an empty selection; \
         remedy: export the shape as a triangle mesh"
    )]
    Empty {
        /// Number of vertices.
        n_vertices: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error(
        "vertex {vertex} at {} is not finite; usual cause: a failed export or a division by zero in the script that \
         wrote the file; remedy: export again, or remove the vertex and its triangles",
        at(position)
    )]
    NonFiniteVertex {
        /// Number of the vertex.
        vertex: usize,
        /// Its coordinates.
        position: Vec3,
    },
    /// A triangle names a vertex that does not exist.
    #[error(
        "triangle {triangle} names vertex {vertex}, but there are only {n_vertices} (0 to {}); usual cause: a truncated \
         file or numbers counted from 1; remedy: export again", n_vertices.saturating_sub(1)
    )]
    VertexOutOfRange {
        /// Number of the triangle.
        triangle: usize,
        /// The vertex number that it asks for.
        vertex: u32,
        /// Number of vertices.
        n_vertices: usize,
    },
    /// A triangle whose corners lie on a line or on one point.
    #[error(
        "triangle {triangle} at {} has no area (height over longest side {height_ratio:.1e}); usual cause: a needle left \
         by CAD tessellation or by rounding to single precision; remedy: merge close vertices (weld) or remesh",
        at(place)
    )]
    ZeroArea {
        /// Number of the triangle.
        triangle: usize,
        /// Its centroid.
        place: Vec3,
        /// Height over longest side; 0 for a triangle that is a point.
        height_ratio: f64,
    },
    /// Two triangles with the same three vertices.
    #[error(
        "triangle {triangle} at {} repeats triangle {first}; usual cause: a part exported twice or faces drawn on both \
         sides; remedy: delete one of the two",
        at(place)
    )]
    DuplicateTriangle {
        /// Number of the later triangle.
        triangle: usize,
        /// Number of the earlier one.
        first: usize,
        /// Centroid of both.
        place: Vec3,
    },
    /// An edge with one triangle only, where a closed surface was asked for.
    #[error(
        "the edge between vertices {} and {} at {} borders triangle {triangle} only: the surface has a hole there; usual \
         cause: a missing cap, or vertices that lie on each other without being merged; remedy: weld the vertices, then \
         close what is still open", vertices[0], vertices[1], at(place)
    )]
    OpenEdge {
        /// Numbers of the two vertices.
        vertices: [u32; 2],
        /// The only triangle.
        triangle: u32,
        /// Middle of the edge.
        place: Vec3,
    },
    /// An edge with more than two triangles.
    #[error(
        "the edge between vertices {} and {} at {} borders {} triangles ({triangles:?}), at most two can bound a solid; \
         usual cause: an inner wall, or two parts that share an edge; remedy: delete the inner wall or separate the parts",
        vertices[0], vertices[1], at(place), triangles.len()
    )]
    NonManifoldEdge {
        /// Numbers of the two vertices.
        vertices: [u32; 2],
        /// All triangles that border it.
        triangles: Vec<u32>,
        /// Middle of the edge.
        place: Vec3,
    },
    /// Two neighbours of which one shows its inside.
    #[error(
        "triangles {} and {} run through their common edge at {} in the same direction, so one of them is inside out; \
         usual cause: a mirrored part; remedy: make the normals consistent (recalculate outside) and export again",
        triangles[0], triangles[1], at(place)
    )]
    InconsistentWinding {
        /// The two triangles.
        triangles: [u32; 2],
        /// Middle of the common edge.
        place: Vec3,
    },
    /// A closed surface whose normals point inwards.
    #[error(
        "triangle 0 and all others face inwards (enclosed volume {volume:.6e}, expected above zero); usual cause: a \
         mirrored part or a left-handed exporter; remedy: flip all triangles"
    )]
    InsideOut {
        /// The enclosed volume, negative.
        volume: f64,
    },
}

/// Examines `surface` and returns all that is wrong with it, worst kind first and then by number; empty if it is sound.
///
/// Sheets may always have open rims and may meet along one edge; with [`Closedness::Required`] every edge must lie
/// between exactly two triangles and the normals must point outwards.
pub fn examine(surface: &TriangleSurface, closedness: Closedness) -> Vec<Finding> {
    let mut findings = unusable_numbers(surface);
    if !findings.is_empty() {
        return findings; // nothing below can be computed from them
    }
    findings.extend(zero_areas(surface));
    findings.extend(duplicates(surface));
    findings.extend(edges(surface, closedness));
    if closedness == Closedness::Required && findings.is_empty() && surface.volume() < 0.0 {
        findings.push(Finding::InsideOut { volume: surface.volume() });
    }
    findings
}

fn unusable_numbers(surface: &TriangleSurface) -> Vec<Finding> {
    let n_vertices = surface.vertices.len();
    if surface.triangles.is_empty() {
        return vec![Finding::Empty { n_vertices }];
    }
    let not_finite = (surface.vertices.iter().enumerate())
        .filter(|(_, p)| p.iter().any(|x| !x.is_finite()))
        .map(|(vertex, &position)| Finding::NonFiniteVertex { vertex, position });
    let out_of_range = surface.triangles.iter().enumerate().flat_map(|(triangle, corners)| {
        (corners.iter().filter(|&&v| v as usize >= n_vertices))
            .map(move |&vertex| Finding::VertexOutOfRange { triangle, vertex, n_vertices })
    });
    not_finite.chain(out_of_range).collect()
}

fn zero_areas(surface: &TriangleSurface) -> impl Iterator<Item = Finding> {
    (0..surface.triangles.len()).filter_map(|triangle| {
        let [a, b, c] = surface.corners(triangle);
        let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
        let height_ratio = if longest > 0.0 {
            2.0 * surface.area_vector(triangle).norm() / (longest * longest)
        } else {
            0.0
        };
        let place = surface.triangle_center(triangle);
        (height_ratio <= ZERO_AREA_RATIO).then_some(Finding::ZeroArea { triangle, place, height_ratio })
    })
}

fn duplicates(surface: &TriangleSurface) -> impl Iterator<Item = Finding> {
    let mut seen = BTreeMap::new();
    surface.triangles.iter().enumerate().filter_map(move |(triangle, corners)| {
        let mut key = *corners;
        key.sort_unstable();
        let first = *seen.entry(key).or_insert(triangle);
        let place = surface.triangle_center(triangle);
        (first != triangle).then_some(Finding::DuplicateTriangle { triangle, first, place })
    })
}

fn edges(surface: &TriangleSurface, closedness: Closedness) -> Vec<Finding> {
    let topology = SurfaceTopology::new(surface);
    let is_closed_required = closedness == Closedness::Required;
    let finding = |e: usize| {
        let vertices = topology.edges()[e].vertices;
        let place = (surface.vertices[vertices[0] as usize] + surface.vertices[vertices[1] as usize]) / 2.0;
        match topology.uses(e) {
            [only] if is_closed_required => {
                Some(Finding::OpenEdge { vertices, triangle: only.triangle, place })
            }
            [a, b] if a.is_forward == b.is_forward => {
                Some(Finding::InconsistentWinding { triangles: [a.triangle, b.triangle], place })
            }
            uses if uses.len() > 2 && is_closed_required => {
                let triangles = uses.iter().map(|u| u.triangle).collect();
                Some(Finding::NonManifoldEdge { vertices, triangles, place })
            }
            _ => None,
        }
    };
    (0..topology.edges().len()).filter_map(finding).collect()
}

fn at(p: &Vec3) -> String {
    format!("({:.6}, {:.6}, {:.6})", p.x, p.y, p.z)
}
