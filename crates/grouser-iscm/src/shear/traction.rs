//! Shear forces of the ground on one piece of running gear.

use grouser_geometry::Vec3;

use super::{JanosiHanamoto, Motion, ShearPath};
use crate::contact::{FootImprint, LoadedPolygon, Wrench};
use crate::terrain::Terrain;

/// What shear does to running gear. Works are per metre of rim or belt: power over ωR.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Traction {
    /// Shear force and its moment about the reference point of the imprints.
    pub wrench: Wrench,
    /// Force along the rim or belt \[N\]: torque at the axle over the rolling radius.
    pub rim_force: f64,
    /// Work lost in shearing \[J/m\], never negative.
    pub shear_loss: f64,
}

impl std::ops::AddAssign for Traction {
    fn add_assign(&mut self, other: Self) {
        self.wrench += other.wrench;
        self.rim_force += other.rim_force;
        self.shear_loss += other.shear_loss;
    }
}

/// Shear on the gear whose `polygons` the ground loads; `gap` \[m\] as in [`ShearPath`], the pitch of a belt.
pub fn foot_traction(
    imprint: &FootImprint,
    terrain: &Terrain,
    polygons: &[LoadedPolygon],
    law: &JanosiHanamoto,
    motion: Motion,
    gap: f64,
) -> Traction {
    let path = ShearPath { imprint, terrain, motion, gap };
    let mut sum = Traction::default();
    for polygon in polygons {
        sum += polygon_traction(&path, polygon, law, imprint.reference);
    }
    sum
}

/// Shear on one polygon.
#[inline(always)]
pub(crate) fn polygon_traction(
    path: &ShearPath<'_>,
    polygon: &LoadedPolygon,
    law: &JanosiHanamoto,
    reference: Vec3,
) -> Traction {
    if polygon.pressure <= 0.0 {
        return Traction::default();
    }
    let motion = &path.motion;
    let normal = polygon.normal.normalize();
    // Along the underside in the plane of rolling, and to the left of it.
    let left = motion.left();
    let tangent = left.cross(&normal).try_normalize(1e-9).unwrap_or(motion.forward);
    let side = normal.cross(&tangent);
    let [j_x, j_y] = path.displacement(polygon.position);
    let j = j_x.hypot(j_y);
    if j == 0.0 {
        return Traction::default();
    }
    let surface = polygon.area * polygon.normal.norm();
    let stress = law.stress(polygon.pressure, j);
    // The rim slides backwards by j_x and the body to the left by j_y: the ground pushes against both.
    let (along, across) = (surface * stress * j_x / j, -surface * stress * j_y / j);
    let force = tangent * along + side * across;
    let travel = motion.travel();
    let sliding = [1.0 - travel.dot(&tangent), -travel.dot(&side)];
    Traction {
        wrench: Wrench { force, moment: (polygon.position - reference).cross(&force) },
        rim_force: along,
        shear_loss: along * sliding[0] + across * sliding[1],
    }
}
