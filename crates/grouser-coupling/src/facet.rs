//! A triangle as a place beside it sees it: which of its edges and corners the place has passed.

use crate::closest_point;
use grouser_geometry::Vec3;

/// Corner k of a triangle is where edge k begins; edge k runs to corner k + 1.
#[derive(Clone, Debug)]
pub(crate) struct Facet {
    pub triangle: u32,
    pub corners: [Vec3; 3],
    /// Unit normal; zero for a triangle without area.
    pub normal: Vec3,
    place: Vec3,
    edges: [Vec3; 3],
    /// The place lies beyond the beginning of edge k, seen along it.
    is_ahead: [bool; 3],
    /// The place lies before the end of edge k.
    is_before: [bool; 3],
    /// The place lies inwards of edge k.
    is_inwards: [bool; 3],
}

/// Where a point lies on a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lies {
    Apart,
    Inside,
    OnEdge(usize),
    AtCorner(usize),
}

/// A side of a sector of the triangle, from a point of its boundary.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ray {
    /// Unit vector.
    pub direction: Vec3,
    /// The distance from the place falls along it.
    pub falls: bool,
}

impl Facet {
    pub fn new(triangle: u32, corners: [Vec3; 3], place: &Vec3) -> Self {
        let edges = [0, 1, 2].map(|k: usize| corners[(k + 1) % 3] - corners[k]);
        let normal = edges[0].cross(&edges[1]).try_normalize(0.0).unwrap_or_else(Vec3::zeros);
        Self {
            triangle,
            normal,
            place: *place,
            is_ahead: [0, 1, 2].map(|k: usize| edges[k].dot(&(place - corners[k])) > 0.0),
            is_before: [0, 1, 2].map(|k: usize| edges[k].dot(&(place - corners[(k + 1) % 3])) < 0.0),
            is_inwards: [0, 1, 2].map(|k: usize| normal.cross(&edges[k]).dot(&(place - corners[k])) > 0.0),
            corners,
            edges,
        }
    }

    /// The foot of the place lies inside.
    pub fn holds_foot(&self) -> bool {
        self.is_inwards == [true; 3]
    }

    /// The foot of the place on edge `k` lies between its ends.
    pub fn is_beside(&self, k: usize) -> bool {
        self.is_ahead[k] && self.is_before[k]
    }

    pub fn is_inwards(&self, k: usize) -> bool {
        self.is_inwards[k]
    }

    /// Foot of `place` on the plane of the triangle.
    pub fn foot(&self, place: &Vec3) -> Vec3 {
        place - self.normal * self.normal.dot(&(place - self.corners[0]))
    }

    /// Foot of `place` on the line of edge `k`.
    pub fn foot_on_edge(&self, k: usize, place: &Vec3) -> Vec3 {
        let edge = self.edges[k];
        self.corners[k] + edge * (edge.dot(&(place - self.corners[k])) / edge.norm_squared())
    }

    /// Unit vector along edge `k`; zero for an edge without length.
    pub fn along(&self, k: usize) -> Vec3 {
        self.edges[k].try_normalize(0.0).unwrap_or_else(Vec3::zeros)
    }

    /// Unit vector in the triangle, square to edge `k`.
    pub fn inward(&self, k: usize) -> Vec3 {
        self.normal.cross(&self.along(k))
    }

    /// Where `point` lies, to a `tolerance` [m].
    pub fn lies_on(&self, point: &Vec3, tolerance: f64) -> Lies {
        let is_near = |other: &Vec3| (other - point).norm_squared() < tolerance * tolerance;
        if let Some(k) = self.corners.iter().position(is_near) {
            return Lies::AtCorner(k);
        }
        if !is_near(&closest_point(point, &self.corners).0) {
            return Lies::Apart;
        }
        (0..3).find(|&k| is_near(&self.foot_on_edge(k, point))).map_or(Lies::Inside, Lies::OnEdge)
    }

    /// The two ways along edge `k` from `point` on it.
    pub fn rays_of_edge(&self, k: usize, point: &Vec3) -> [Ray; 2] {
        let along = self.along(k);
        let way = along.dot(&(self.place - point));
        [Ray { direction: along, falls: way > 0.0 }, Ray { direction: -along, falls: way < 0.0 }]
    }

    /// The two edges that meet in corner `k`.
    pub fn rays_of_corner(&self, k: usize) -> [Ray; 2] {
        let before = (k + 2) % 3;
        [
            Ray { direction: self.along(k), falls: self.is_ahead[k] },
            Ray { direction: -self.along(before), falls: self.is_before[before] },
        ]
    }
}
