//! Force of the ground on running gear by integration over the polygons that it presses (P2 §2.3.2).
//!
//! Steps as in `docs/theory/iscm.md`, F1 to F5.

use grouser_geometry::{Pose, Vec3};
use nalgebra::{Matrix3, Matrix6};

use crate::batch::{Batch, LANES};
use crate::footing::{Facet, Footing, Site};
use crate::imprint::{Imprint, MOST_SAG};
use crate::levels::Pressed;
use crate::polygon::{Answer, Corners, PartialLoad, SubTriangles, integrate};
use crate::response::{OneArray, Reloaded, Response, Stiff, ThreeArrays};
use crate::terrain::{Terrain, Unloading};
use crate::track::{DrawnTrack, Followed};

/// How forces are integrated.
#[derive(Clone, Debug)]
pub struct Integration {
    /// Sub-triangles of a polygon.
    pub sub_triangles: SubTriangles,
    /// Treatment of partially loaded polygons.
    pub partial: PartialLoad,
}

/// Force and moment about a reference point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench {
    /// Force \[N\].
    pub force: Vec3,
    /// Moment about the reference point \[N·m\].
    pub moment: Vec3,
}

impl std::ops::AddAssign for Wrench {
    fn add_assign(&mut self, other: Self) {
        self.force += other.force;
        self.moment += other.moment;
    }
}

/// What the ground does to one piece of running gear.
#[derive(Clone, Debug)]
pub struct FootLoad {
    /// Force and moment about the reference point of the imprints.
    pub wrench: Wrench,
    /// −∂(force, moment)/∂(displacement, rotation) about the reference point \[N/m, N, N·m\].
    pub stiffness: Matrix6<f64>,
}

/// A loaded polygon, as handed to a listener.
#[derive(Clone, Copy, Debug)]
pub struct LoadedPolygon {
    /// Imprint that loads it, counted from the lowest.
    pub layer: usize,
    /// Owner with the largest share of its corners.
    pub owner: u16,
    /// Force on the gear \[N\], P2 Eq. (7).
    pub force: Vec3,
    /// Where it acts \[m\], P2 Eq. (8).
    pub position: Vec3,
    /// Mean pressure over the loaded part's polygon \[Pa\].
    pub pressure: f64,
    /// Loaded part of its horizontal area \[m²\].
    pub area: f64,
    /// Outward normal of the ground, scaled to a vertical part of one.
    pub normal: Vec3,
    /// Vertical stiffness \[N/m\].
    pub stiffness: f64,
}

/// Imprints of one piece of running gear, lowest first: grousers, shoes, wheels. What a lower one covers is gone for the others.
#[derive(Clone, Debug)]
pub struct FootImprint {
    /// The imprints.
    pub layers: Vec<Imprint>,
    /// Where moments are taken about \[m\].
    pub reference: Vec3,
    /// Slack tracks: their shoes give way to the ground.
    pub tracks: Vec<DrawnTrack>,
    /// What of each imprint can press, by level of the ground.
    pub(crate) footings: Vec<Footing>,
}

/// Present state of a point under one imprint.
#[derive(Clone, Copy, Default)]
struct Node {
    /// Sinkage if the gear stood here \[m\].
    z: f64,
    /// Height of the ground then \[m\].
    height: f64,
    /// Share of the cell that the gear covers.
    share: f64,
    /// Depth of the gear below the present ground \[m\].
    depth: f64,
}

impl FootImprint {
    /// Running gear drawn as `layers`, the lowest first and wheels last, over the present ground of a terrain.
    pub(crate) fn new(
        layers: Vec<Imprint>,
        reference: Vec3,
        terrain: &Terrain,
        partial: PartialLoad,
    ) -> Self {
        let footings = Footing::of(&layers, terrain, partial);
        Self { layers, reference, tracks: Vec::new(), footings }
    }

    /// Force of the `terrain` on the gear after it moved by `motion` since the imprints were drawn.
    ///
    /// `motion` is small: undersides follow it in first order, h + d_z − ∂h/∂x d_x − ∂h/∂y d_y. Every loaded polygon is shown to `listen`.
    pub fn load(
        &self,
        terrain: &Terrain,
        motion: &Pose,
        integration: &Integration,
        mut listen: impl FnMut(&LoadedPolygon),
    ) -> FootLoad {
        let followed = self.followed(terrain, motion);
        let mut load = FootLoad { wrench: Wrench::default(), stiffness: followed.stiffness };
        for footing in &self.footings {
            let (nodes, sunk) = self.nodes(footing, terrain, motion, &followed, integration.partial);
            self.load_footing(footing, &nodes, sunk, terrain, integration, &mut load, &mut listen);
        }
        load.stiffness.fill_lower_triangle_with_upper_triangle();
        load
    }

    /// G2: leaves the footprint; each part of the gear presses the levels that it stands on down to its underside.
    pub fn stamp(&self, terrain: &mut Terrain, motion: &Pose) {
        self.print(terrain, motion).leave(terrain);
    }

    /// The footprint: what it presses, as it stands on the ground on which it was drawn.
    pub(crate) fn print(&self, terrain: &Terrain, motion: &Pose) -> Footprint {
        let followed = self.followed(terrain, motion);
        let mut parts: Vec<(usize, Pressed)> = Vec::new();
        let mut pressed_nodes: Vec<usize> = Vec::new();
        for footing in &self.footings {
            let (nodes, _) = self.nodes(footing, terrain, motion, &followed, PartialLoad::Proportional);
            for (site, node) in footing.sites.iter().zip(nodes).filter(|(site, _)| site.share > 0.0) {
                let pressed = Pressed { level: footing.level, share: site.share, height: node.height };
                parts.push((site.on_grid, pressed));
                if node.height < site.ground {
                    pressed_nodes.push(site.on_grid);
                }
            }
        }
        pressed_nodes.sort_unstable();
        pressed_nodes.dedup();
        parts.retain(|(node, _)| pressed_nodes.binary_search(node).is_ok());
        parts.sort_by_key(|(node, _)| *node);
        Footprint(parts)
    }

    /// Rest of the slack tracks after the body moved.
    fn followed(&self, terrain: &Terrain, motion: &Pose) -> Followed {
        let mut followed = Followed::default();
        self.tracks.iter().for_each(|track| track.follow(terrain, motion, &mut followed));
        followed
    }

    /// F1, F2: sinkage, height and share of every point of a footing, and how far the gear has sunk since it was drawn, at most \[m\].
    fn nodes(
        &self,
        footing: &Footing,
        terrain: &Terrain,
        motion: &Pose,
        followed: &Followed,
        partial: PartialLoad,
    ) -> (Vec<Node>, f64) {
        let turn: Matrix3<f64> = motion.rotation.to_rotation_matrix().matrix() - Matrix3::identity();
        let shift = motion.translation.vector;
        let has_shifts = !followed.shifts.is_empty() && footing.layer + 1 < self.layers.len();
        let original = terrain.grid().heights();
        let mut sunk = 0.0_f64;
        let stand = |site: &Site| {
            let (z_0, ground) = (original[site.on_grid], site.ground);
            let position = Vec3::from(site.position);
            let rise = |d: Vec3| d.z - site.slope[0] * d.x - site.slope[1] * d.y;
            let mut h = position.z + rise(turn * position + shift);
            if has_shifts && let Some(shift) = followed.shift(site.owner) {
                h += rise(shift.at(position));
            }
            sunk = sunk.max(position.z - h);
            match partial {
                PartialLoad::Proportional => {
                    Node { z: z_0 - h, height: h, share: site.share, depth: ground - h }
                }
                // As printed: a point is loaded and follows the gear, or is not and stays.
                PartialLoad::Step => {
                    let share = if h < ground { site.share.round() } else { 0.0 };
                    let h = h.min(ground);
                    Node { z: z_0 - h, height: h, share, depth: ground - h }
                }
            }
        };
        let mut nodes: Vec<Node> = footing.sites.iter().map(stand).collect();
        let seen: Vec<(u32, f64)> = footing.seen_depths(|site| nodes[site as usize].depth).collect();
        for (site, depth) in seen {
            nodes[site as usize].depth = depth;
        }
        (nodes, sunk)
    }

    /// Deepest sinkage of soil under the gear where it was drawn \[m\].
    pub(crate) fn deepest(&self, terrain: &Terrain, partial: PartialLoad) -> f64 {
        let followed = self.followed(terrain, &Pose::identity());
        self.footings.iter().fold(0.0, |deepest, footing| {
            let (nodes, _) = self.nodes(footing, terrain, &Pose::identity(), &followed, partial);
            let sag = MOST_SAG * self.layers[footing.layer].spacing;
            let sites = footing.sites.iter().zip(&nodes);
            let is_soil = |(site, node): &(&Site, &Node)| {
                node.share > 0.0 && node.height < site.ground + sag && !terrain.is_fixed(site.on_grid)
            };
            sites.filter(is_soil).fold(deepest, |deepest, (_, node)| node.z.max(deepest))
        })
    }

    /// F3 to F5: integrates over all polygons of a footing.
    fn load_footing(
        &self,
        footing: &Footing,
        nodes: &[Node],
        sunk: f64,
        terrain: &Terrain,
        integration: &Integration,
        load: &mut FootLoad,
        listen: &mut impl FnMut(&LoadedPolygon),
    ) {
        let layer = footing.layer;
        let ground = Ground::new(terrain);
        // Slack tracks have answered for theirs.
        let may_follow = layer + 1 < self.layers.len() && !self.tracks.is_empty();
        let mut batch = Batch::new();
        let mut pressed: [Option<&Facet>; LANES] = [None; LANES];
        for facet in footing.facets(&self.layers, integration.partial, sunk) {
            let [a, b, c] = facet.sites.map(|site| &nodes[site as usize]);
            let corners = Corners {
                z: [a.z, b.z, c.z],
                share: [a.share, b.share, c.share],
                depth: [a.depth, b.depth, c.depth],
                sag: facet.sag,
            };
            if corners.is_free() {
                continue;
            }
            let sites = facet.sites.map(|site| &footing.sites[site as usize]);
            let answer = ground.answer(&sites.map(|site| site.on_grid), &corners, integration);
            let point = |site: &Site, node: &Node| {
                let [x, y, _] = site.position;
                [x - self.reference.x, y - self.reference.y, node.height - self.reference.z]
            };
            let follows = may_follow && self.tracks.iter().any(|track| track.owns(facet.owner));
            pressed[batch.len()] = Some(facet);
            let points = [point(sites[0], a), point(sites[1], b), point(sites[2], c)];
            batch.push(&points, &corners, &answer, !follows);
            if batch.is_full() {
                self.collect(layer, nodes, integration, &mut batch, &pressed, load, listen);
            }
        }
        self.collect(layer, nodes, integration, &mut batch, &pressed, load, listen);
    }

    /// F4, F5: force, position and stiffness of a batch of `pressed` polygons; empties the batch.
    #[inline(always)]
    fn collect(
        &self,
        layer: usize,
        nodes: &[Node],
        integration: &Integration,
        batch: &mut Batch,
        pressed: &[Option<&Facet>; LANES],
        load: &mut FootLoad,
        listen: &mut impl FnMut(&LoadedPolygon),
    ) {
        let spacing = self.layers[layer].spacing;
        batch.answer(&integration.sub_triangles, spacing, &mut load.wrench, &mut load.stiffness);
        for (n, facet) in pressed[..batch.len()].iter().enumerate() {
            let (Some(facet), Some(polygon)) = (facet, batch.loaded(n)) else { continue };
            let share = facet.sites.iter().map(|&site| nodes[site as usize].share).sum::<f64>() / 3.0;
            listen(&LoadedPolygon {
                layer,
                owner: facet.owner,
                force: polygon.normal * polygon.lift,
                position: self.reference + polygon.arm,
                pressure: if share > 0.0 { polygon.pressure / share } else { 0.0 },
                area: share * spacing * spacing / 2.0,
                normal: polygon.normal,
                stiffness: polygon.stiffness,
            });
        }
        batch.clear();
    }
}

/// Parts of gear and the nodes of the terrain that they press, in the order of the nodes.
pub(crate) struct Footprint(Vec<(usize, Pressed)>);

impl Footprint {
    /// Presses.
    pub fn leave(&self, terrain: &mut Terrain) {
        for cell in self.0.chunk_by(|a, b| a.0 == b.0) {
            terrain.press(cell[0].0, cell.iter().map(|(_, pressed)| *pressed));
        }
    }
}

/// What presses back.
struct Ground<'a> {
    terrain: &'a Terrain,
    /// Values of the arrays per sinkage \[1/m\].
    per_resolution: f64,
}

impl<'a> Ground<'a> {
    fn new(terrain: &'a Terrain) -> Self {
        Self { terrain, per_resolution: 1.0 / terrain.field().resolution() }
    }

    /// F3, F4: the ground's answer under one polygon.
    #[inline(always)]
    fn answer(&self, on_grid: &[usize; 3], corners: &Corners, integration: &Integration) -> Answer {
        let Self { terrain, per_resolution } = *self;
        let (sub, partial) = (&integration.sub_triangles, integration.partial);
        if on_grid.iter().all(|&node| terrain.is_fixed(node)) {
            return integrate(sub, Stiff(Terrain::FIXED_STIFFNESS), corners, partial, 0.0); // P2 Eq. (4)
        }
        let field = terrain.field();
        if field.is_per_node() {
            let pressures = on_grid.map(|node| field.of_node(node));
            self.soil(ThreeArrays { pressures, per_resolution }, corners, integration)
        } else {
            let pressures = field.of_node(0);
            self.soil(OneArray { pressures, per_resolution }, corners, integration)
        }
    }

    #[inline(always)]
    fn soil(
        &self,
        virgin: impl Response,
        corners: &Corners,
        Integration { sub_triangles, partial }: &Integration,
    ) -> Answer {
        match self.terrain.unloading() {
            Unloading::Plastic { contact_distance } => {
                integrate(sub_triangles, virgin, corners, *partial, contact_distance)
            }
            Unloading::Elastic { stiffness } => {
                let residual = [0, 1, 2].map(|k| corners.z[k] - corners.depth[k]);
                integrate(sub_triangles, Reloaded { virgin, stiffness, residual }, corners, *partial, 0.0)
            }
        }
    }
}
