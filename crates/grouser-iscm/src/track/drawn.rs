//! A slack track as it was drawn on the ground, and how it gives way when the body moves.

use grouser_geometry::{Pose, Vec3};
use nalgebra::{Matrix6, Vector6};

use super::{Chain, Lay, Touch, TrackShape};
use crate::contact::FootImprint;
use crate::footing::{Sites, Standing, WITHIN_REACH};
use crate::gear::{Belt, Wheel};
use crate::mechanism::GRAVITY;
use crate::pressure::interpolate;
use crate::terrain::{Terrain, Unloading};

/// A slack track on drawn imprints.
#[derive(Clone, Debug)]
pub struct DrawnTrack {
    /// Owners of its shoes in the imprints: the first and how many.
    owners: std::ops::Range<u16>,
    /// Every joint (x, z) in the body's frame \[m\].
    pub joints: Vec<[f64; 2]>,
    /// The section below the axles with its ends, and the links to its first joint.
    lower: Vec<[f64; 2]>,
    first_place: f64,
    /// Link of the chain that each shoe is.
    links: Vec<Option<usize>>,
    chain: Chain,
    /// Origin of the body, and the directions x and z of its plane \[m\].
    origin: Vec3,
    axes: [Vec3; 2],
    /// Lateral position in the body's frame \[m\].
    lateral: f64,
    touches: Vec<Touch>,
    nodes: Vec<TouchedNode>,
    /// Rest of the lower section while the body stands where it was drawn; where the search begins once it has moved.
    at_rest: Vec<[f64; 2]>,
}

/// A point of the ground under a shoe.
#[derive(Clone, Copy, Debug)]
struct TouchedNode {
    on_grid: usize,
    /// Underside as drawn \[m\].
    position: Vec3,
    slope: [f64; 2],
    /// Height of the level of the ground that the shoe stands on \[m\].
    ground: f64,
    /// Part of its cell in which it does \[m²\].
    area: f64,
}

/// How a shoe moves beside its body: displacement at r is `shift` + `change` (`along` · (r − `joint`)).
#[derive(Clone, Copy, Debug)]
pub struct ShoeShift {
    joint: Vec3,
    along: Vec3,
    shift: Vec3,
    change: Vec3,
}

impl ShoeShift {
    /// Displacement of the shoe at `r` \[m\].
    #[inline(always)]
    pub fn at(&self, r: Vec3) -> Vec3 {
        self.shift + self.change * self.along.dot(&(r - self.joint))
    }
}

/// Tracks of a foot after its body moved.
#[derive(Clone, Debug, Default)]
pub struct Followed {
    /// First owner and motion of each shoe beside the body; none for shoes that move with it.
    pub shifts: Vec<(u16, Vec<Option<ShoeShift>>)>,
    /// −∂(force, moment)/∂(displacement, rotation) of the body by the tracks.
    pub stiffness: Matrix6<f64>,
}

impl Followed {
    /// Motion of the shoe `owner` beside its body.
    #[inline(always)]
    pub fn shift(&self, owner: u16) -> Option<&ShoeShift> {
        self.shifts.iter().find_map(|(first, shoes)| {
            shoes.get(owner.checked_sub(*first)? as usize).and_then(Option::as_ref)
        })
    }
}

impl DrawnTrack {
    /// T1: the joints of a slack belt on a body at `pose`, with its lower section along an earlier `shape`.
    pub fn new(
        belt: &Belt,
        wheels: &[Wheel],
        pose: &Pose,
        travel: f64,
        shape: Option<&TrackShape>,
        first: u16,
    ) -> Self {
        let circles = belt.circles(wheels);
        let lay = Lay::new(&circles, belt.n_shoes, belt.pitch);
        let free = lay.free_joints(travel);
        let lower = lay.lower(&free, shape);
        let down = pose.rotation.inverse() * -Vec3::z();
        let joints = lay.joints(travel, &lower, belt_down(down));
        let lengths = lay.lengths(&free);
        let weight =
            |length: &f64| [down.x, down.z].map(|d| d * belt.shoe.mass * GRAVITY * length / belt.pitch);
        let weights = lengths.iter().map(weight).collect();
        let mut links = vec![None; belt.n_shoes];
        for (n, (joint, _)) in free.iter().enumerate().take(free.len().saturating_sub(1)) {
            links[*joint] = Some(n + 1);
        }
        Self {
            owners: first..first + belt.n_shoes as u16,
            joints,
            links,
            chain: Chain { lengths, weights, circles },
            first_place: free.first().map_or(0.0, |joint| joint.1),
            at_rest: lower.clone(),
            lower,
            origin: pose.translation.vector,
            axes: [pose.rotation * Vec3::x(), pose.rotation * Vec3::z()],
            lateral: belt.lateral(wheels),
            touches: Vec::new(),
            nodes: Vec::new(),
        }
    }

    /// Whether a shoe is one of this track's.
    #[inline(always)]
    pub fn owns(&self, owner: u16) -> bool {
        self.owners.contains(&owner)
    }

    fn world(&self, [x, z]: [f64; 2]) -> Vec3 {
        let across = self.axes[1].cross(&self.axes[0]);
        self.origin + self.axes[0] * x + self.axes[1] * z + across * self.lateral
    }

    /// T2: where the ground can press on the shoes, as they are drawn in `imprint`.
    pub fn find_touches(&mut self, imprint: &FootImprint, terrain: &Terrain) {
        let joints: Vec<Vec3> = self.lower.iter().map(|j| self.world(*j)).collect();
        let n_layers = imprint.layers.len();
        for footing in imprint.footings.iter().filter(|footing| footing.layer + 1 < n_layers) {
            let cell = imprint.layers[footing.layer].spacing.powi(2);
            let Sites { on_grid, slope, owner, .. } = &footing.sites;
            for Standing { share, ground } in &footing.levels {
                let is_ours = |&n: &usize| share[n] > 0.0 && self.owners.contains(&owner[n]);
                for n in (0..owner.len()).filter(is_ours) {
                    let position = Vec3::from(footing.sites.position(n));
                    if position.z > ground[n] + WITHIN_REACH {
                        continue;
                    }
                    let slope = [slope[0][n], slope[1][n]];
                    let normal = Vec3::new(-slope[0], -slope[1], 1.0);
                    let arm = (position - imprint.reference).cross(&normal);
                    let link = self.links[(owner[n] - self.owners.start) as usize];
                    let way = link.map_or(0.0, |a| {
                        let along = joints[a + 1] - joints[a];
                        (position - joints[a]).dot(&along) / along.norm_squared()
                    });
                    self.touches.push(Touch {
                        link,
                        share: way,
                        normal: [normal.dot(&self.axes[0]), normal.dot(&self.axes[1])],
                        with_body: Vector6::new(normal.x, normal.y, normal.z, arm.x, arm.y, arm.z),
                    });
                    self.nodes.push(TouchedNode {
                        on_grid: on_grid[n] as usize,
                        position,
                        slope,
                        ground: ground[n],
                        area: share[n] * cell,
                    });
                }
            }
        }
        self.at_rest = self.rest(terrain, &Pose::identity()).joints;
    }

    /// T3, T4: the track's rest after the body moved from where it was drawn: joints of the lower section, and what the body feels.
    fn rest(&self, terrain: &Terrain, motion: &Pose) -> super::chain::Settled {
        let nodes: Vec<(usize, f64, f64, f64)> = self
            .nodes
            .iter()
            .map(|node| {
                let d = motion.rotation * node.position + motion.translation.vector - node.position;
                let height = node.position.z + d.z - node.slope[0] * d.x - node.slope[1] * d.y;
                (node.on_grid, height, node.ground, node.area)
            })
            .collect();
        self.chain.settle(&self.lower, &self.at_rest, &self.touches, |n, rise| {
            let (on_grid, height, ground, area) = nodes[n];
            if height + rise >= ground {
                return (0.0, 0.0);
            }
            let (p, slope) = answer(terrain, on_grid, height + rise, ground);
            (p * area, slope * area)
        })
    }

    /// The lower section with its ends after the body moved, a `share` of the way from where it was drawn to its rest.
    pub fn shape(&self, terrain: &Terrain, motion: &Pose, share: f64) -> TrackShape {
        let rest = self.rest(terrain, motion).joints;
        let gone = |(a, b): (&[f64; 2], &[f64; 2])| [0, 1].map(|k| a[k] + share * (b[k] - a[k]));
        let points = self.lower.iter().zip(&rest).map(gone).collect();
        TrackShape { first: self.first_place, points }
    }

    /// Adds how the shoes move beside the body, and what the body feels.
    pub fn follow(&self, terrain: &Terrain, motion: &Pose, followed: &mut Followed) {
        let rest = self.rest(terrain, motion);
        let moved: Vec<Vec3> = rest
            .joints
            .iter()
            .zip(&self.lower)
            .map(|(a, b)| self.axes[0] * (a[0] - b[0]) + self.axes[1] * (a[1] - b[1]))
            .collect();
        let shift = |link: &Option<usize>| {
            link.map(|a| {
                let (joint, next) = (self.world(self.lower[a]), self.world(self.lower[a + 1]));
                let along = (next - joint) / (next - joint).norm_squared();
                ShoeShift { joint, along, shift: moved[a], change: moved[a + 1] - moved[a] }
            })
        };
        followed.shifts.push((self.owners.start, self.links.iter().map(shift).collect()));
        followed.stiffness += rest.stiffness;
    }
}

/// Down in the plane of the belt, a unit vector.
pub(crate) fn belt_down(down: Vec3) -> [f64; 2] {
    let length = down.x.hypot(down.z).max(1e-12);
    [down.x / length, down.z / length]
}

/// Pressure \[Pa\] of the ground at a node under gear whose underside lies at `height` \[m\], and its slope \[Pa/m\].
fn answer(terrain: &Terrain, node: usize, height: f64, ground: f64) -> (f64, f64) {
    let z = terrain.grid().heights()[node] - height;
    let depth = ground - height;
    if depth <= 0.0 {
        return (0.0, 0.0);
    }
    if terrain.is_fixed(node) {
        return (Terrain::FIXED_STIFFNESS * z, Terrain::FIXED_STIFFNESS);
    }
    let per_resolution = 1.0 / terrain.field().resolution();
    let (p, slope) = interpolate(terrain.field().of_node(node), z * per_resolution);
    let slope = slope * per_resolution;
    match terrain.unloading() {
        Unloading::Plastic { contact_distance } if depth < contact_distance => {
            let built = depth / contact_distance;
            (p * built, slope * built + p / contact_distance)
        }
        Unloading::Plastic { .. } => (p, slope),
        Unloading::Elastic { stiffness } => {
            let spring = stiffness * depth;
            if spring < p { (spring, stiffness) } else { (p, slope) }
        }
    }
}
