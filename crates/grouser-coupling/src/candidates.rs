//! Which triangles each grain may touch soon: parry's bounding-volume hierarchy, asked only now and then.

use crate::closest_point;
use grouser_contact::{Precision, Real, Sphere};
use grouser_geometry::{RigidMotion, TriangleSurface, Vec3};
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector as Glam;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy};
use serde::{Deserialize, Serialize};

/// Share of the mean radius that grains and surface may approach each other before the hierarchy is asked again.
const MARGIN: f64 = 0.25;

/// A grain and the triangles near it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Near {
    /// Permanent number of the grain.
    pub id: u32,
    /// Its place in the present order.
    pub index: u32,
    /// First of its triangles, and one past the last, in [`Candidates::triangles`].
    pub triangles: std::ops::Range<u32>,
}

/// Grains near a surface, by rising permanent number.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Candidates {
    near: Vec<Near>,
    triangles: Vec<u32>,
    /// What may still be travelled before the list is too old [m].
    room: f64,
    #[serde(skip)]
    hierarchy: Option<Bvh>,
}

impl Candidates {
    /// Grains that may touch now, with their triangles.
    pub fn iter(&self) -> impl Iterator<Item = (&Near, &[u32])> {
        self.near
            .iter()
            .map(|near| (near, &self.triangles[near.triangles.start as usize..near.triangles.end as usize]))
    }

    /// Makes the list anew when grains were sorted anew or `travel` [m], what grains and surface may have approached each
    /// other by in this step, uses up its margin.
    pub fn refresh<P: Precision>(
        &mut self,
        surface: &TriangleSurface,
        motion: &RigidMotion,
        (spheres, ids): (&[Sphere<P>], &[u32]),
        travel: f64,
    ) {
        self.room -= travel;
        let is_in_order = self.near.iter().all(|near| ids.get(near.index as usize) == Some(&near.id));
        if self.room > 0.0 && is_in_order {
            return;
        }
        let hierarchy = self.hierarchy.get_or_insert_with(|| hierarchy(surface));
        let bounds = hierarchy.root_aabb();
        let mean_radius =
            spheres.iter().map(|sphere| sphere.radius.to_f64()).sum::<f64>() / spheres.len() as f64;
        // The travel of this step is already in the positions; the next steps have the whole margin.
        let margin = (MARGIN * mean_radius).max(2.0 * travel);
        self.room = margin;
        self.near.clear();
        self.triangles.clear();
        let mut found: Vec<(u32, u32, Vec<u32>)> = Vec::new();
        for (index, sphere) in spheres.iter().enumerate() {
            let centre = motion.point_in_body(&centre(sphere));
            let reach = sphere.radius.to_f64() + margin;
            let place = Glam::new(centre.x, centre.y, centre.z);
            let around = Aabb::new(place - Glam::splat(reach), place + Glam::splat(reach));
            if !overlap(&bounds, &around) {
                continue;
            }
            let is_near = |&triangle: &u32| {
                let (point, _) = closest_point(&centre, &surface.corners(triangle as usize));
                (point - centre).norm() < reach
            };
            let mut triangles: Vec<u32> = hierarchy.intersect_aabb(&around).filter(is_near).collect();
            if !triangles.is_empty() {
                triangles.sort_unstable();
                found.push((ids[index], index as u32, triangles));
            }
        }
        found.sort_unstable_by_key(|&(id, ..)| id);
        for (id, index, triangles) in found {
            let first = self.triangles.len() as u32;
            self.triangles.extend(triangles);
            self.near.push(Near { id, index, triangles: first..self.triangles.len() as u32 });
        }
    }
}

/// Centre in double precision [m].
pub(crate) fn centre<P: Precision>(sphere: &Sphere<P>) -> Vec3 {
    let place = sphere.position;
    Vec3::new(place.x.to_f64(), place.y.to_f64(), place.z.to_f64())
}

fn hierarchy(surface: &TriangleSurface) -> Bvh {
    let boxes: Vec<Aabb> = (0..surface.triangles.len())
        .map(|triangle| {
            let [a, b, c] = surface.corners(triangle);
            let (low, high) = (a.inf(&b).inf(&c), a.sup(&b).sup(&c));
            Aabb::new(Glam::new(low.x, low.y, low.z), Glam::new(high.x, high.y, high.z))
        })
        .collect();
    Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes)
}

fn overlap(a: &Aabb, b: &Aabb) -> bool {
    (a.mins.x <= b.maxs.x && b.mins.x <= a.maxs.x)
        && (a.mins.y <= b.maxs.y && b.mins.y <= a.maxs.y)
        && (a.mins.z <= b.maxs.z && b.mins.z <= a.maxs.z)
}
