//! Force of the ground on running gear by integration over the polygons that it presses (P2 §2.3.2).
//!
//! Steps as in `docs/theory/iscm.md`, F1 to F5.

mod footprint;

use std::sync::OnceLock;

use grouser_geometry::{Pose, Vec3};
use nalgebra::{Matrix3, Matrix6};

use crate::batch::{Batch, LANES};
use crate::footing::{CLOSE, Facets, Footing, OnLevels, Pressing, Reach, Sites, Span, Standing};
use crate::imprint::{Imprint, MOST_SAG};
use crate::levels::MOST_LEVELS;
use crate::polygon::{Answer, Corners, PartialLoad, Sag, SubTriangles, integrate};
use crate::response::{
    KINKS, Kink, NO_KINKS, OneArray, Prepared, PreparedArray, Reloaded, Response, Stiff, ThreeArrays,
};
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

/// A loaded polygon.
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
    /// What of each imprint can press, of slack tracks also once they have sunk by more than [`CLOSE`].
    pub(crate) footings: Vec<Footing>,
    /// The same for gear that sinks by more, made when it does.
    far: OnceLock<Vec<Footing>>,
    /// Bounds how far it sinks.
    span: Span,
    partial: PartialLoad,
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
    /// Where that is, from the reference point of the imprints, and the sinkage \[m\].
    places: Vec<[f64; 4]>,
    /// Depth of the gear below each level of the present ground \[m\], before it sees its neighbours.
    depths: [Vec<f64>; MOST_LEVELS],
    /// How far the gear has sunk since it was drawn, at most \[m\].
    sunk: f64,
    /// For P2's step, which points are loaded.
    is_loaded: Vec<f64>,
    /// Working space.
    seen: Vec<f64>,
}

impl Nodes {
    /// Corners of a triangle between three `sites` of a footing where it presses on `levels`: on one, or deep in all of them.
    #[inline(always)]
    fn corners(&self, footing: &Footing, sites: [usize; 3], levels: u8, is_deep: bool, sag: Sag) -> Corners {
        let z = sites.map(|site| self.places[site][3]);
        let (mut share, mut depth) = ([0.0; 3], [f64::INFINITY; 3]);
        let mut left = levels;
        while left != 0 {
            let level = left.trailing_zeros() as usize;
            left &= left - 1;
            let of = if self.is_loaded.is_empty() { &footing.levels[level].share } else { &self.is_loaded };
            (0..3).for_each(|k| share[k] += of[sites[k]]);
            if !is_deep {
                depth = sites.map(|site| self.depths[level][site]);
            }
        }
        Corners { z, share, depth, sag }
    }
}

impl FootImprint {
    /// Running gear drawn as `layers`, the lowest first and wheels last, over the present ground of a terrain.
    pub(crate) fn new(
        layers: Vec<Imprint>,
        reference: Vec3,
        terrain: &Terrain,
        partial: PartialLoad,
        reach: Reach,
    ) -> Self {
        let (footings, span) = Footing::of(&layers, terrain, partial, reach);
        let field = terrain.field();
        let prepared =
            (!field.is_per_node()).then(|| Prepared::new(field.of_node(0), 1.0 / field.resolution()));
        Self {
            layers,
            reference,
            tracks: Vec::new(),
            footings,
            far: OnceLock::new(),
            span,
            partial,
            prepared,
        }
    }

    /// What can press after the gear moved by `motion` since it was drawn over the same `terrain`.
    fn footings_after(&self, motion: &Pose, terrain: &Terrain) -> &[Footing] {
        let turn = motion.rotation.to_rotation_matrix().matrix() - Matrix3::identity();
        if !self.tracks.is_empty() || self.span.sinks(&turn, &motion.translation.vector) < CLOSE {
            return &self.footings;
        }
        self.far.get_or_init(|| Footing::of(&self.layers, terrain, self.partial, Reach::Far).0)
    }

    /// Force of the `terrain` on the gear after it moved by `motion` since the imprints were drawn.
    ///
    /// `motion` is small: undersides follow it in first order, h + d_z − ∂h/∂x d_x − ∂h/∂y d_y.
    pub fn load(&self, terrain: &Terrain, motion: &Pose, integration: &Integration) -> FootLoad {
        self.load_and_show(terrain, motion, integration, None)
    }

    /// The loaded polygons behind [`FootImprint::load`].
    pub fn polygons(
        &self,
        terrain: &Terrain,
        motion: &Pose,
        integration: &Integration,
    ) -> Vec<LoadedPolygon> {
        let mut polygons = Vec::new();
        self.load_and_show(terrain, motion, integration, Some(&mut polygons));
        polygons
    }

    fn load_and_show(
        &self,
        terrain: &Terrain,
        motion: &Pose,
        integration: &Integration,
        mut polygons: Option<&mut Vec<LoadedPolygon>>,
    ) -> FootLoad {
        let followed = self.followed(terrain, motion);
        let ground = Ground::new(terrain, self.prepared.as_ref());
        let (mut nodes, mut found, mut batch) = (Nodes::default(), Pressing::default(), Batch::new());
        for footing in self.footings_after(motion, terrain) {
            self.stand(footing, motion, &followed, integration.partial, &mut nodes);
            let ready = footing.ready(&self.layers, integration.partial, nodes.sunk);
            for (edges, depths) in ready.edges.iter().zip(&mut nodes.depths) {
                edges.see(depths, &mut nodes.seen);
            }
            let facets = &ready.facets;
            let depths = &nodes.depths[..footing.levels.len()];
            facets.pressing(depths, ground.deep(integration.partial), &mut found);
            for (pressed, is_deep) in [(&found.deep, true), (&found.partly, false)] {
                let of = Triangles { footing, facets, pressed, is_deep };
                self.load_triangles(&of, &nodes, &ground, integration, &mut batch, &mut polygons);
            }
        }
        let (wrench, stiffness) = batch.give();
        let mut load = FootLoad { wrench, stiffness: followed.stiffness + stiffness };
        load.stiffness.fill_lower_triangle_with_upper_triangle();
        load
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
        let Sites { position: [x, y, z], slope: [slope_x, slope_y], undisturbed, .. } = &footing.sites;
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
                if let Some(shift) = followed.shift(footing.sites.owner[n]) {
                    let d = shift.at(footing.sites.position(n).into());
                    nodes.height[n] += d.z - slope_x[n] * d.x - slope_y[n] * d.y;
                }
            }
        }
        for (height, z) in nodes.height.iter().zip(z) {
            sunk = if z - height > sunk { z - height } else { sunk };
        }
        nodes.sunk = sunk;
        nodes.is_loaded.clear();
        if let (PartialLoad::Step, Some(Standing { share, ground, .. })) = (partial, footing.levels.first()) {
            // As printed: a point is loaded and follows the gear, or is not and stays; a cell is covered whole or not, so it is level.
            for n in 0..n {
                nodes.is_loaded.push(if nodes.height[n] < ground[n] { share[n].round() } else { 0.0 });
                nodes.height[n] = nodes.height[n].min(ground[n]);
            }
        }
        nodes.z.clear();
        nodes.z.extend(undisturbed.iter().zip(&nodes.height).map(|(z_0, height)| z_0 - height));
        let o = self.reference;
        let at = x.iter().zip(y).zip(&nodes.height).zip(&nodes.z);
        nodes.places.clear();
        nodes.places.extend(at.map(|(((x, y), height), &z)| [x - o.x, y - o.y, height - o.z, z]));
        for (standing, depths) in footing.levels.iter().zip(&mut nodes.depths) {
            standing.depths(&nodes.height, depths);
        }
    }

    /// Deepest sinkage of soil under the gear where it was drawn \[m\].
    pub(crate) fn deepest(&self, terrain: &Terrain, partial: PartialLoad) -> f64 {
        let followed = self.followed(terrain, &Pose::identity());
        let mut nodes = Nodes::default();
        self.footings.iter().fold(0.0, |deepest, footing| {
            self.stand(footing, &Pose::identity(), &followed, partial, &mut nodes);
            let sag = MOST_SAG * self.layers[footing.layer].spacing;
            let on_grid = &footing.sites.on_grid;
            let presses = |n: usize| {
                let on = |standing: &Standing| {
                    standing.share[n] > 0.0 && nodes.height[n] < standing.ground[n] + sag
                };
                footing.levels.iter().any(on)
            };
            let is_soil = |&n: &usize| presses(n) && !terrain.is_fixed(on_grid[n] as usize);
            (0..footing.sites.len()).filter(is_soil).fold(deepest, |deepest, n| nodes.z[n].max(deepest))
        })
    }

    /// F3 to F5: integrates over triangles that press.
    fn load_triangles(
        &self,
        of: &Triangles,
        nodes: &Nodes,
        ground: &Ground,
        integration: &Integration,
        batch: &mut Batch,
        polygons: &mut Option<&mut Vec<LoadedPolygon>>,
    ) {
        let Triangles { footing, facets, is_deep, .. } = *of;
        // Slack tracks have answered for theirs.
        let may_follow = footing.layer + 1 < self.layers.len() && !self.tracks.is_empty();
        let mut kinks = NO_KINKS;
        for pressed in of.pressed.chunks(LANES) {
            for &OnLevels { facet: n, levels } in pressed {
                let facet = &facets.facets[n as usize];
                let sites = facet.sites.map(|site| site as usize);
                let corners = nodes.corners(footing, sites, levels, is_deep, facets.sag(n as usize));
                let on_grid = || sites.map(|site| footing.sites.on_grid[site] as usize);
                let answer = ground.answer(facet.is_fixed, on_grid, &corners, integration, &mut kinks);
                let follows = may_follow && self.tracks.iter().any(|track| track.owns(footing.owner(sites)));
                let points = sites.map(|site| nodes.places[site]).map(|[x, y, z, _]| [x, y, z]);
                batch.push(&points, &corners, &answer, !follows);
            }
            let spacing = self.layers[footing.layer].spacing;
            batch.answer(&integration.sub_triangles, spacing);
            if let Some(polygons) = polygons {
                self.show(of, pressed, nodes, batch, polygons);
            }
            batch.clear();
        }
    }

    /// Adds the polygons of a batch.
    fn show(
        &self,
        &Triangles { footing, facets, is_deep, .. }: &Triangles,
        pressed: &[OnLevels],
        nodes: &Nodes,
        batch: &Batch,
        polygons: &mut Vec<LoadedPolygon>,
    ) {
        let spacing = self.layers[footing.layer].spacing;
        for (n, &OnLevels { facet, levels }) in pressed.iter().enumerate() {
            let Some(polygon) = batch.loaded(n) else { continue };
            let facet = &facets.facets[facet as usize];
            let sites = facet.sites.map(|site| site as usize);
            let corners = nodes.corners(footing, sites, levels, is_deep, Sag::default());
            let share = corners.share.iter().sum::<f64>() / 3.0;
            polygons.push(LoadedPolygon {
                layer: footing.layer,
                owner: footing.owner(sites),
                force: polygon.normal * polygon.lift,
                position: self.reference + polygon.arm,
                pressure: if share > 0.0 { polygon.pressure / share } else { 0.0 },
                area: share * spacing * spacing / 2.0,
                normal: polygon.normal,
                stiffness: polygon.stiffness,
            });
        }
    }
}

/// Triangles of a footing that press, alike.
struct Triangles<'a> {
    footing: &'a Footing,
    facets: &'a Facets,
    pressed: &'a [OnLevels],
    /// Whether they are deeper at all corners than contact builds up.
    is_deep: bool,
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

    /// Depth \[m\] beyond which it no longer matters how deep in its ground gear lies, but for its sinkage.
    fn deep(&self, partial: PartialLoad) -> f64 {
        match self.terrain.unloading() {
            _ if partial == PartialLoad::Step => f64::INFINITY,
            Unloading::Plastic { contact_distance } => contact_distance,
            Unloading::Elastic { .. } => f64::INFINITY,
        }
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
