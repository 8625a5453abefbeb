//! Force of the ground on running gear by integration over the polygons that it presses (P2 §2.3.2).
//!
//! Steps as in `docs/theory/iscm.md`, F1 to F5.

use grouser_geometry::{Pose, Vec3};
use nalgebra::{Matrix3, Matrix6};

use crate::batch::{Batch, LANES};
use crate::footing::{Facet, Facets, Footing, Sites};
use crate::imprint::{Imprint, MOST_SAG};
use crate::levels::Pressed;
use crate::polygon::{Answer, Corners, PartialLoad, Sag, SubTriangles, integrate};
use crate::response::{
    KINKS, Kink, NO_KINKS, OneArray, Prepared, PreparedArray, Reloaded, Response, Stiff, ThreeArrays,
};
use crate::terrain::{PressedCell, Terrain, Unloading};
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
    /// The lines of the relationship where it is the same everywhere.
    prepared: Option<Prepared>,
}

/// Present state of the points under one imprint, number by number.
#[derive(Default)]
struct Nodes {
    /// Sinkage if the gear stood here \[m\].
    z: Vec<f64>,
    /// Height of the ground then \[m\].
    height: Vec<f64>,
    /// Share of the cell that the gear covers.
    share: Vec<f64>,
    /// Depth of the gear below the present ground \[m\], before it sees its neighbours.
    depth: Vec<f64>,
    /// How far the gear has sunk since it was drawn, at most \[m\].
    sunk: f64,
    /// Working space.
    seen: Vec<f64>,
}

impl Nodes {
    /// Corners of a triangle between three `sites`.
    #[inline(always)]
    fn corners(&self, sites: [usize; 3], sag: Sag) -> Corners {
        let of = |lane: &[f64]| sites.map(|site| lane[site]);
        Corners { z: of(&self.z), share: of(&self.share), depth: of(&self.depth), sag }
    }
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
        let field = terrain.field();
        let prepared =
            (!field.is_per_node()).then(|| Prepared::new(field.of_node(0), 1.0 / field.resolution()));
        Self { layers, reference, tracks: Vec::new(), footings, prepared }
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
        let ground = Ground::new(terrain, self.prepared.as_ref());
        let (mut nodes, mut found, mut batch) = (Nodes::default(), Vec::new(), Batch::new());
        for footing in &self.footings {
            self.stand(footing, motion, &followed, integration.partial, &mut nodes);
            let Nodes { sunk, depth, seen, .. } = &mut nodes;
            let facets = footing.facets(&self.layers, integration.partial, *sunk, depth, seen);
            facets.pressing(&nodes.depth, &mut found);
            let pressed = (facets, &found[..]);
            self.load_footing(
                footing,
                pressed,
                &nodes,
                &ground,
                integration,
                &mut batch,
                &mut load,
                &mut listen,
            );
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
        let mut parts: Vec<(usize, Pressed, bool)> = Vec::new();
        let mut nodes = Nodes::default();
        for footing in &self.footings {
            self.stand(footing, motion, &followed, PartialLoad::Proportional, &mut nodes);
            let Sites { share, ground, on_grid, .. } = &footing.sites;
            parts.reserve(on_grid.len());
            for n in (0..footing.sites.len()).filter(|&n| share[n] > 0.0) {
                let pressed = Pressed { level: footing.level, share: share[n], height: nodes.height[n] };
                parts.push((on_grid[n] as usize, pressed, nodes.height[n] < ground[n]));
            }
        }
        parts.sort_by_key(|(node, ..)| *node);
        let mut print = Footprint::default();
        for cell in parts.chunk_by(|a, b| a.0 == b.0).filter(|cell| cell.iter().any(|part| part.2)) {
            let (node, first) = (cell[0].0, print.parts.len());
            print.parts.extend(cell.iter().map(|(_, pressed, _)| *pressed));
            let parts = first..print.parts.len();
            let after = terrain.pressed(node, &print.parts[parts.clone()]);
            print.cells.push(PrintedCell { node, n_before: terrain.loadings()[node], parts, after });
        }
        print
    }

    /// Rest of the slack tracks after the body moved.
    fn followed(&self, terrain: &Terrain, motion: &Pose) -> Followed {
        let mut followed = Followed::default();
        self.tracks.iter().for_each(|track| track.follow(terrain, motion, &mut followed));
        followed
    }

    /// F1, F2: sinkage, height and share of every point of a footing.
    fn stand(
        &self,
        footing: &Footing,
        motion: &Pose,
        followed: &Followed,
        partial: PartialLoad,
        nodes: &mut Nodes,
    ) {
        let turn: Matrix3<f64> = motion.rotation.to_rotation_matrix().matrix() - Matrix3::identity();
        let shift = motion.translation.vector;
        let Sites { position: [x, y, z], slope: [slope_x, slope_y], share, ground, undisturbed, .. } =
            &footing.sites;
        let n = footing.sites.len();
        // First the rise of each point, then its height.
        nodes.height.clear();
        let rises = (0..n).map(|n| {
            let position = Vec3::new(x[n], y[n], z[n]);
            let d = turn * position + shift;
            d.z - slope_x[n] * d.x - slope_y[n] * d.y
        });
        nodes.height.extend(rises);
        let mut sunk = 0.0_f64;
        for (height, z) in nodes.height.iter_mut().zip(z) {
            *height += z;
        }
        if !followed.shifts.is_empty() && footing.layer + 1 < self.layers.len() {
            for n in 0..n {
                let site = footing.sites.get(n);
                if let Some(shift) = followed.shift(site.owner) {
                    let d = shift.at(site.position.into());
                    nodes.height[n] += d.z - site.slope[0] * d.x - site.slope[1] * d.y;
                }
            }
        }
        for (height, z) in nodes.height.iter().zip(z) {
            sunk = if z - height > sunk { z - height } else { sunk };
        }
        nodes.sunk = sunk;
        nodes.share.clear();
        nodes.share.extend(share);
        if partial == PartialLoad::Step {
            // As printed: a point is loaded and follows the gear, or is not and stays.
            for n in 0..n {
                nodes.share[n] = if nodes.height[n] < ground[n] { share[n].round() } else { 0.0 };
                nodes.height[n] = nodes.height[n].min(ground[n]);
            }
        }
        nodes.z.clear();
        nodes.z.extend(undisturbed.iter().zip(&nodes.height).map(|(z_0, height)| z_0 - height));
        nodes.depth.clear();
        nodes.depth.extend(ground.iter().zip(&nodes.height).map(|(ground, height)| ground - height));
    }

    /// Deepest sinkage of soil under the gear where it was drawn \[m\].
    pub(crate) fn deepest(&self, terrain: &Terrain, partial: PartialLoad) -> f64 {
        let followed = self.followed(terrain, &Pose::identity());
        let mut nodes = Nodes::default();
        self.footings.iter().fold(0.0, |deepest, footing| {
            self.stand(footing, &Pose::identity(), &followed, partial, &mut nodes);
            let sag = MOST_SAG * self.layers[footing.layer].spacing;
            let Sites { ground, on_grid, .. } = &footing.sites;
            let is_soil = |&n: &usize| {
                nodes.share[n] > 0.0
                    && nodes.height[n] < ground[n] + sag
                    && !terrain.is_fixed(on_grid[n] as usize)
            };
            (0..footing.sites.len()).filter(is_soil).fold(deepest, |deepest, n| nodes.z[n].max(deepest))
        })
    }

    /// F3 to F5: integrates over the polygons of a footing that were `found` to press.
    fn load_footing(
        &self,
        footing: &Footing,
        (facets, found): (&Facets, &[u32]),
        nodes: &Nodes,
        ground: &Ground,
        integration: &Integration,
        batch: &mut Batch,
        load: &mut FootLoad,
        listen: &mut impl FnMut(&LoadedPolygon),
    ) {
        let layer = footing.layer;
        // Slack tracks have answered for theirs.
        let may_follow = layer + 1 < self.layers.len() && !self.tracks.is_empty();
        let mut kinks = NO_KINKS;
        let [x, y] = [&footing.sites.position[0], &footing.sites.position[1]];
        for pressed in found.chunks(LANES) {
            for &n in pressed {
                let facet = &facets.facets[n as usize];
                let sites = facet.sites.map(|site| site as usize);
                let corners = nodes.corners(sites, facets.sag(n as usize));
                let on_grid = || sites.map(|site| footing.sites.on_grid[site] as usize);
                let answer = ground.answer(facet.is_fixed, on_grid, &corners, integration, &mut kinks);
                let point = |site: usize| {
                    let height = nodes.height[site];
                    [x[site] - self.reference.x, y[site] - self.reference.y, height - self.reference.z]
                };
                let follows = may_follow && self.tracks.iter().any(|track| track.owns(facet.owner));
                batch.push(&sites.map(point), &corners, &answer, !follows);
            }
            let pressed = pressed.iter().map(|&n| &facets.facets[n as usize]);
            self.collect(layer, nodes, integration, batch, pressed, load, listen);
        }
    }

    /// F4, F5: force, position and stiffness of a batch of `pressed` polygons; empties the batch.
    #[inline(always)]
    fn collect<'a>(
        &self,
        layer: usize,
        nodes: &Nodes,
        integration: &Integration,
        batch: &mut Batch,
        pressed: impl Iterator<Item = &'a Facet>,
        load: &mut FootLoad,
        listen: &mut impl FnMut(&LoadedPolygon),
    ) {
        let spacing = self.layers[layer].spacing;
        batch.answer(&integration.sub_triangles, spacing, &mut load.wrench, &mut load.stiffness);
        for (n, facet) in pressed.enumerate() {
            let Some(polygon) = batch.loaded(n) else { continue };
            let share = facet.sites.iter().map(|&site| nodes.share[site as usize]).sum::<f64>() / 3.0;
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

/// What gear presses, cell by cell in the order of the nodes.
#[derive(Default)]
pub(crate) struct Footprint {
    cells: Vec<PrintedCell>,
    parts: Vec<Pressed>,
}

/// A cell of the terrain, the parts of the gear in it, and what becomes of it if nothing presses it before.
struct PrintedCell {
    node: usize,
    /// Footprints that had deepened it then.
    n_before: u32,
    parts: std::ops::Range<usize>,
    after: Option<PressedCell>,
}

impl Footprint {
    /// Presses.
    pub fn leave(&self, terrain: &mut Terrain) {
        for PrintedCell { node, n_before, parts, after } in &self.cells {
            if terrain.loadings()[*node] == *n_before {
                after.iter().for_each(|after| terrain.set_pressed(*node, after));
            } else {
                terrain.press(*node, &self.parts[parts.clone()]); // Another foot stands here too.
            }
        }
    }
}

/// What presses back.
struct Ground<'a> {
    terrain: &'a Terrain,
    /// Values of the arrays per sinkage \[1/m\].
    per_resolution: f64,
    /// The lines of the relationship where it is the same everywhere.
    prepared: Option<&'a Prepared>,
}

impl<'a> Ground<'a> {
    fn new(terrain: &'a Terrain, prepared: Option<&'a Prepared>) -> Self {
        Self { terrain, per_resolution: 1.0 / terrain.field().resolution(), prepared }
    }

    /// F3, F4: the ground's answer under one polygon with its corners at nodes `on_grid`, all on rigid objects or not. `kinks` is working
    /// space.
    #[inline(always)]
    fn answer<'s>(
        &self,
        is_fixed: bool,
        on_grid: impl Fn() -> [usize; 3],
        corners: &Corners,
        integration: &Integration,
        kinks: &'s mut [Kink; KINKS],
    ) -> Answer<'s>
    where
        'a: 's,
    {
        let Self { terrain, per_resolution, prepared } = *self;
        let (sub, partial) = (&integration.sub_triangles, integration.partial);
        if is_fixed {
            return integrate(sub, Stiff(Terrain::FIXED_STIFFNESS), corners, partial, 0.0, kinks); // P2 Eq. (4)
        }
        let field = terrain.field();
        if let Some(prepared) = prepared {
            let array = OneArray { pressures: field.of_node(0), per_resolution };
            self.soil(PreparedArray { array, prepared }, corners, integration, kinks)
        } else {
            let pressures = on_grid().map(|node| field.of_node(node));
            self.soil(ThreeArrays { pressures, per_resolution }, corners, integration, kinks)
        }
    }

    #[inline(always)]
    fn soil<'s>(
        &self,
        virgin: impl Response + 's,
        corners: &Corners,
        Integration { sub_triangles, partial }: &Integration,
        kinks: &'s mut [Kink; KINKS],
    ) -> Answer<'s> {
        match self.terrain.unloading() {
            Unloading::Plastic { contact_distance } => {
                integrate(sub_triangles, virgin, corners, *partial, contact_distance, kinks)
            }
            Unloading::Elastic { stiffness } => {
                let residual = [0, 1, 2].map(|k| corners.z[k] - corners.depth[k]);
                let ground = Reloaded { virgin, stiffness, residual };
                integrate(sub_triangles, ground, corners, *partial, 0.0, kinks)
            }
        }
    }
}
