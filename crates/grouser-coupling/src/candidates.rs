//! Which triangles each grain may touch soon: parry's bounding-volume hierarchy, asked only now and then.

use crate::closest_point;
use grouser_contact::{Precision, Real, Sphere};
use grouser_geometry::{TriangleSurface, Vec3};
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector as Glam;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};
use serde::{Deserialize, Serialize};

/// Share of the mean radius that grains and surface may approach each other before the hierarchy is asked again; 0 asks it
/// at every step. The contacts are the same for every margin: what is listed is measured anew at each step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Margin(pub f64);

impl Margin {
    /// A quarter of the mean radius.
    pub const DEFAULT: Self = Self(0.25);
}

impl Default for Margin {
    fn default() -> Self {
        Self::DEFAULT
    }
}

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
    /// How often the hierarchy was asked.
    n_refreshes: u64,
    #[serde(skip)]
    hierarchy: Option<Bvh>,
    #[serde(skip)]
    has_deformed: bool,
}

impl Candidates {
    /// Grains that may touch now, with their triangles.
    pub fn iter(&self) -> impl Iterator<Item = (&Near, &[u32])> {
        self.near
            .iter()
            .map(|near| (near, &self.triangles[near.triangles.start as usize..near.triangles.end as usize]))
    }

    /// How often the list was made anew.
    pub fn n_refreshes(&self) -> u64 {
        self.n_refreshes
    }

    /// The triangles have changed: the hierarchy is refitted before it is asked again.
    pub fn surface_has_deformed(&mut self) {
        self.has_deformed = true;
    }

    /// Makes the list anew when grains were sorted anew or `travel` [m], what grains and surface may have approached each
    /// other by in this step, uses up its margin.
    pub fn refresh<P: Precision>(
        &mut self,
        surface: &TriangleSurface,
        in_frame: impl Fn(&Vec3) -> Vec3,
        (spheres, ids): (&[Sphere<P>], &[u32]),
        travel: f64,
        Margin(share): Margin,
    ) {
        self.room -= travel;
        let is_in_order = self.near.iter().all(|near| ids.get(near.index as usize) == Some(&near.id));
        if self.room > 0.0 && is_in_order {
            return;
        }
        self.n_refreshes += 1;
        let hierarchy = self.hierarchy.get_or_insert_with(|| hierarchy(surface));
        if std::mem::take(&mut self.has_deformed) {
            refit(hierarchy, surface);
        }
        let bounds = hierarchy.root_aabb();
        let mean_radius =
            spheres.iter().map(|sphere| sphere.radius.to_f64()).sum::<f64>() / spheres.len() as f64;
        // The travel of this step is already in the positions; the next steps have the whole margin.
        let margin = (share * mean_radius).max(2.0 * travel);
        self.room = if share > 0.0 { margin } else { 0.0 };
        self.near.clear();
        self.triangles.clear();
        let mut found: Vec<(u32, u32, Vec<u32>)> = Vec::new();
        for (index, sphere) in spheres.iter().enumerate() {
            let centre = in_frame(&centre(sphere));
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
    let boxes: Vec<Aabb> = (0..surface.triangles.len()).map(|triangle| box_of(surface, triangle)).collect();
    Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes)
}

/// Gives every box of the hierarchy its present size; the tree stays as it is.
fn refit(hierarchy: &mut Bvh, surface: &TriangleSurface) {
    for triangle in 0..surface.triangles.len() {
        hierarchy.insert_or_update_partially(box_of(surface, triangle), triangle as u32, 0.0);
    }
    hierarchy.refit(&mut BvhWorkspace::default());
}

fn box_of(surface: &TriangleSurface, triangle: usize) -> Aabb {
    let [a, b, c] = surface.corners(triangle);
    let (low, high) = (a.inf(&b).inf(&c), a.sup(&b).sup(&c));
    Aabb::new(Glam::new(low.x, low.y, low.z), Glam::new(high.x, high.y, high.z))
}

fn overlap(a: &Aabb, b: &Aabb) -> bool {
    (a.mins.x <= b.maxs.x && b.mins.x <= a.maxs.x)
        && (a.mins.y <= b.maxs.y && b.mins.y <= a.maxs.y)
        && (a.mins.z <= b.maxs.z && b.mins.z <= a.maxs.z)
}
