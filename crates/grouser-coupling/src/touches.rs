//! Where a sphere touches a surface: the critical points of the distance from its centre (`docs/theory/surfaces.md`).

use crate::facet::{Facet, Lies};
use crate::{Feature, closest_point};
use grouser_geometry::{TriangleSurface, Vec3};

/// Places closer to each other than this share of the sphere's radius are one place.
const ONE_PLACE: f64 = 1e-6;
/// Which side of a plane the centre is on is asked of a place this share of the radius beside it, in a direction that no mesh
/// is made for: a centre exactly above an edge or a vertex then lies on one side for everybody.
const BESIDE: f64 = 1e-9;
/// Unit vectors whose scalar product is larger than this are one direction.
const ONE_DIRECTION: f64 = 1.0 - 1e-12;

/// Where a sphere touches a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// Number of a triangle that the point lies on.
    pub triangle: u32,
    /// Critical point of the distance from the centre [m].
    pub point: Vec3,
    /// Part of the triangle that the point lies on.
    pub feature: Feature,
    /// Distance of the point from the centre [m].
    pub distance: f64,
    /// How often its force counts: 1 at a minimum of the distance, −1 at a saddle, 1 at a maximum.
    pub weight: f64,
    /// No point of the surface beside it is closer to the centre.
    pub is_minimum: bool,
}

/// Touches of a sphere with the triangles `candidates` of `surface`: the minima of the distance, nearest first, then what
/// they count twice: saddles between them, and maxima.
///
/// The weighted sum of any function of the distance that vanishes at `radius` is a continuous function of the centre and of the
/// vertices: where critical points appear or vanish their weights cancel.
pub fn touches(surface: &TriangleSurface, candidates: &[u32], centre: &Vec3, radius: f64) -> Vec<Touch> {
    let nearest = |&triangle: &u32| {
        let (point, feature) = closest_point(centre, &surface.corners(triangle as usize));
        let distance = (centre - point).norm();
        (distance < radius).then_some(Touch {
            triangle,
            point,
            feature,
            distance,
            weight: 1.0,
            is_minimum: true,
        })
    };
    let touched: Vec<Touch> = candidates.iter().filter_map(nearest).collect();
    if touched.len() <= 1 {
        return touched;
    }
    let beside = centre + Vec3::new(0.534, 0.267, 0.802) * (BESIDE * radius);
    let facets: Vec<Facet> = touched
        .iter()
        .map(|touch| Facet::new(touch.triangle, surface.corners(touch.triangle as usize), &beside))
        .collect();
    let mut found = Critical { facets: &facets, centre, radius, touches: Vec::new() };
    found.edges();
    found.faces();
    found.vertices();
    let mut touches = found.touches;
    touches.sort_by(|a, b| {
        (b.is_minimum.cmp(&a.is_minimum))
            .then(a.distance.total_cmp(&b.distance))
            .then(a.feature.cmp(&b.feature))
            .then(a.triangle.cmp(&b.triangle))
    });
    touches
}

/// Directions in the surface along which the distance falls.
#[derive(Clone, Copy, Debug, Default)]
struct Falling {
    /// There are some.
    any: bool,
    /// Their Euler characteristic: how many separate sectors they fill, 0 where they go all around.
    characteristic: i32,
}

/// The critical points on triangles that a sphere touches. Each is weighed by 1 − χ, χ being the Euler characteristic of the directions
/// in the surface along which the distance falls.
struct Critical<'a> {
    facets: &'a [Facet],
    centre: &'a Vec3,
    radius: f64,
    touches: Vec<Touch>,
}

impl Critical<'_> {
    fn is_one_place(&self, a: &Vec3, b: &Vec3) -> bool {
        (a - b).norm_squared() < (ONE_PLACE * self.radius).powi(2)
    }

    fn push(&mut self, triangle: u32, point: Vec3, feature: Feature, falling: Falling) {
        let distance = (self.centre - point).norm();
        if falling.characteristic != 1 && distance < self.radius {
            let weight = f64::from(1 - falling.characteristic);
            self.touches.push(Touch { triangle, point, feature, distance, weight, is_minimum: !falling.any });
        }
    }

    /// A foot inside a face is a minimum; sheets that lie on each other count once.
    fn faces(&mut self) {
        for facet in self.facets.iter().filter(|facet| facet.holds_foot()) {
            let point = facet.foot(self.centre);
            let is_on_another = self
                .touches
                .iter()
                .any(|touch| touch.feature == Feature::Face && self.is_one_place(&touch.point, &point));
            let is_at_saddle = || {
                self.touches.iter().any(|touch| touch.weight < 0.0 && self.is_one_place(&touch.point, &point))
            };
            if !is_on_another || is_at_saddle() {
                self.push(facet.triangle, point, Feature::Face, Falling::default());
            }
        }
    }

    /// Of the faces that meet at an edge, those whose foot lies inwards of it fall.
    fn edges(&mut self) {
        let mut seen: Vec<(Vec3, Vec3)> = Vec::new();
        for facet in self.facets {
            for k in (0..3).filter(|&k| facet.is_beside(k)) {
                let (point, along) = (facet.foot_on_edge(k, self.centre), facet.along(k));
                let is_one = |at: &Vec3, direction: &Vec3| {
                    self.is_one_place(at, &point) && direction.dot(&along).abs() > ONE_DIRECTION
                };
                if seen.iter().any(|(at, direction)| is_one(at, direction)) {
                    continue;
                }
                seen.push((point, along));
                let (mut owners, mut walls): (Vec<(&Facet, usize)>, Vec<Vec3>) = (Vec::new(), Vec::new());
                for other in self.facets {
                    let own = (0..3).find(|&j| {
                        other.is_beside(j) && is_one(&other.foot_on_edge(j, self.centre), &other.along(j))
                    });
                    let is_new = |inward: &Vec3| {
                        !owners.iter().any(|(owner, i)| owner.inward(*i).dot(inward) > ONE_DIRECTION)
                    };
                    match own {
                        Some(j) if is_new(&other.inward(j)) => owners.push((other, j)),
                        Some(_) => (),
                        None if other.lies_on(&point, ONE_PLACE * self.radius) == Lies::Inside => {
                            walls.push(other.normal);
                        }
                        None => (),
                    }
                }
                let is_in_wall =
                    |facet: &Facet| walls.iter().any(|wall| wall.dot(&facet.normal).abs() > ONE_DIRECTION);
                let falling = owners.iter().filter(|(facet, j)| facet.is_inwards(*j) && !is_in_wall(facet));
                let n_falling = (falling.count() + planes(&walls)) as i32;
                let falling = Falling { any: n_falling > 0, characteristic: n_falling };
                self.push(facet.triangle, point, Feature::Edge, falling);
            }
        }
    }

    /// Around a vertex sectors of faces and the rays between them fall.
    fn vertices(&mut self) {
        let mut seen: Vec<Vec3> = Vec::new();
        for facet in self.facets {
            for vertex in facet.corners {
                let is_far = (vertex - self.centre).norm_squared() >= self.radius * self.radius;
                if is_far || seen.iter().any(|other| self.is_one_place(other, &vertex)) {
                    continue;
                }
                seen.push(vertex);
                let falling = self.falling_around(&vertex);
                self.push(facet.triangle, vertex, Feature::Vertex, falling);
            }
        }
    }

    /// Around a vertex: sectors, less the falling rays that join them.
    fn falling_around(&self, vertex: &Vec3) -> Falling {
        let (mut walls, mut sectors) = (Vec::new(), Vec::new());
        for facet in self.facets {
            match facet.lies_on(vertex, ONE_PLACE * self.radius) {
                Lies::Apart => (),
                Lies::Inside => walls.push(facet.normal),
                Lies::OnEdge(k) => sectors.push((facet.normal, facet.rays_of_edge(k, vertex))),
                Lies::AtCorner(k) => sectors.push((facet.normal, facet.rays_of_corner(k))),
            }
        }
        sectors.retain(|(normal, _)| !walls.iter().any(|wall| wall.dot(normal).abs() > ONE_DIRECTION));
        let mut rays: Vec<(Vec3, i32)> = Vec::new();
        let mut n_falling = planes(&walls) as i32;
        for (_, sector) in &sectors {
            n_falling += i32::from(sector.iter().any(|ray| ray.falls));
            for ray in sector.iter().filter(|ray| ray.falls) {
                match rays.iter_mut().find(|(direction, _)| direction.dot(&ray.direction) > ONE_DIRECTION) {
                    Some((_, n_sectors)) => *n_sectors += 1,
                    None => rays.push((ray.direction, 1)),
                }
            }
        }
        let n_joints: i32 = rays.iter().map(|(_, n_sectors)| n_sectors - 1).sum();
        Falling { any: n_falling > 0, characteristic: n_falling - n_joints }
    }
}

/// How many different planes have these normals and a point in common.
fn planes(normals: &[Vec3]) -> usize {
    let is_new = |(k, normal): &(usize, &Vec3)| {
        !normals[..*k].iter().any(|earlier| earlier.dot(normal).abs() > ONE_DIRECTION)
    };
    normals.iter().enumerate().filter(is_new).count()
}
