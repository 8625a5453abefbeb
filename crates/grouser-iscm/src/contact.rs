//! Force of the ground on running gear by integration over the polygons that it presses (P2 §2.3.2).
//!
//! Steps as in `docs/theory/iscm.md`, F1 to F5.

use grouser_geometry::{Pose, Vec3};
use nalgebra::{Matrix3, Matrix6, Vector6};

use crate::imprint::{Imprint, MOST_SAG};
use crate::polygon::{
    Corners, OneArray, PartialLoad, PolygonLoad, Reloaded, Stiff, SubTriangles, ThreeArrays, integrate,
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
    /// Deepest sinkage of soil under load \[m\].
    pub deepest: f64,
    /// Polygons that carry load.
    pub n_polygons: usize,
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
}

/// Present state of a node under one imprint.
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

/// Whether the gear presses nowhere between these corners: none is covered, or all lie below the gear by more than it sags in between.
#[inline(always)]
fn is_free(corners: &[Node], sag: f64) -> bool {
    corners.iter().all(|c| c.share == 0.0) || corners.iter().all(|c| c.depth <= -sag)
}

impl FootImprint {
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
        let mut load =
            FootLoad { wrench: Wrench::default(), stiffness: Matrix6::zeros(), deepest: 0.0, n_polygons: 0 };
        let followed = self.followed(terrain, motion);
        load.stiffness += followed.stiffness;
        for layer in 0..self.layers.len() {
            let (nodes, deepest) = self.nodes(layer, terrain, motion, &followed, integration.partial);
            if let Some(deepest) = deepest {
                load.deepest = load.deepest.max(deepest);
                self.load_layer(layer, &nodes, terrain, integration, &mut load, &mut listen);
            }
        }
        load.stiffness.fill_lower_triangle_with_upper_triangle();
        load
    }

    /// Leaves the footprint: points inside the outline of the gear go down to its underside.
    pub fn stamp(&self, terrain: &mut Terrain, motion: &Pose) {
        let followed = self.followed(terrain, motion);
        for layer in 0..self.layers.len() {
            let (nodes, _) = self.nodes(layer, terrain, motion, &followed, PartialLoad::Proportional);
            let imprint = &self.layers[layer];
            let n_grid = terrain.grid().n_x();
            for j in 0..imprint.n_y {
                for i in 0..imprint.n_x {
                    let n = j * imprint.n_x + i;
                    if imprint.nodes[n].is_inside && nodes[n].depth > 0.0 {
                        terrain.stamp((imprint.j_0 + j) * n_grid + imprint.i_0 + i, nodes[n].height);
                    }
                }
            }
        }
    }

    /// Rest of the slack tracks after the body moved.
    fn followed(&self, terrain: &Terrain, motion: &Pose) -> Followed {
        let mut followed = Followed::default();
        self.tracks.iter().for_each(|track| track.follow(terrain, motion, &mut followed));
        followed
    }

    /// F1, F2: sinkage, height and share of every node of a layer, and the deepest sinkage if the gear touches the ground at all.
    fn nodes(
        &self,
        layer: usize,
        terrain: &Terrain,
        motion: &Pose,
        followed: &Followed,
        partial: PartialLoad,
    ) -> (Vec<Node>, Option<f64>) {
        let imprint = &self.layers[layer];
        let turn: Matrix3<f64> = motion.rotation.to_rotation_matrix().matrix() - Matrix3::identity();
        let shift = motion.translation.vector;
        let is_moved = turn != Matrix3::zeros() || shift != Vec3::zeros();
        let has_shifts = !followed.shifts.is_empty() && layer + 1 < self.layers.len();
        let n_grid = terrain.grid().n_x();
        let original = terrain.grid().heights();
        let mut nodes = vec![Node::default(); imprint.nodes.len()];
        let mut deepest = None;
        for j in 0..imprint.n_y {
            let row = (imprint.j_0 + j) * n_grid + imprint.i_0;
            for i in 0..imprint.n_x {
                let (n, node) = (j * imprint.n_x + i, row + i);
                let gear = &imprint.nodes[n];
                let z_0 = original[node];
                let ground = terrain.height(node);
                if !gear.is_known {
                    nodes[n] = Node { z: z_0 - ground, height: ground, share: 0.0, depth: 0.0 };
                    continue;
                }
                let mut h = gear.height;
                if is_moved {
                    let [x, y] = imprint.position(i, j);
                    let d = turn * Vec3::new(x, y, h) + shift;
                    h += d.z - gear.slope[0] * d.x - gear.slope[1] * d.y;
                }
                if has_shifts && let Some(shift) = followed.shift(gear.owner) {
                    let [x, y] = imprint.position(i, j);
                    let d = shift.at(Vec3::new(x, y, gear.height));
                    h += d.z - gear.slope[0] * d.x - gear.slope[1] * d.y;
                }
                let is_loaded = h < ground && gear.coverage > 0.0;
                let mut share = 0.0;
                if gear.coverage > 0.0 {
                    share = self.uncovered(layer, imprint.i_0 + i, imprint.j_0 + j) * gear.coverage;
                }
                if partial == PartialLoad::Step {
                    // As printed: a point is loaded and follows the gear, or is not and stays.
                    share = if is_loaded { share.round() } else { 0.0 };
                    h = h.min(ground);
                }
                if h < ground + MOST_SAG * imprint.spacing {
                    let is_soil = share > 0.0 && !terrain.is_fixed(node);
                    deepest = Some(deepest.unwrap_or(0.0_f64).max(if is_soil { z_0 - h } else { 0.0 }));
                }
                nodes[n] = Node { z: z_0 - h, height: h, share, depth: ground - h };
            }
        }
        if !imprint.edges.is_empty() {
            let own: Vec<f64> = nodes.iter().map(|node| node.depth).collect();
            for edge in &imprint.edges {
                nodes[edge.node].depth = edge.seen.iter().map(|&(m, weight)| weight * own[m]).sum();
            }
        }
        (nodes, deepest)
    }

    /// Share of a node's cell that the layers below leave free.
    #[inline(always)]
    pub(crate) fn uncovered(&self, layer: usize, i: usize, j: usize) -> f64 {
        let mut free = 1.0;
        for below in &self.layers[..layer] {
            let (a, b) = (i.wrapping_sub(below.i_0), j.wrapping_sub(below.j_0));
            if a < below.n_x && b < below.n_y {
                free *= 1.0 - below.nodes[b * below.n_x + a].coverage;
            }
        }
        free
    }

    /// F3 to F5: integrates over all polygons of a layer, with the fastest instructions of the machine, none of them fused: the
    /// same bits everywhere.
    fn load_layer(
        &self,
        layer: usize,
        nodes: &[Node],
        terrain: &Terrain,
        integration: &Integration,
        load: &mut FootLoad,
        listen: &mut impl FnMut(&LoadedPolygon),
    ) {
        #[cfg(target_arch = "x86_64")]
        {
            #[target_feature(enable = "avx2")]
            fn wide(
                foot: &FootImprint,
                layer: usize,
                nodes: &[Node],
                terrain: &Terrain,
                integration: &Integration,
                load: &mut FootLoad,
                listen: &mut impl FnMut(&LoadedPolygon),
            ) {
                foot.polygons(layer, nodes, terrain, integration, load, listen);
            }
            if is_x86_feature_detected!("avx2") {
                // SAFETY: the instructions were just found on this machine.
                return unsafe { wide(self, layer, nodes, terrain, integration, load, listen) };
            }
        }
        self.polygons(layer, nodes, terrain, integration, load, listen);
    }

    #[inline(always)]
    fn polygons(
        &self,
        layer: usize,
        nodes: &[Node],
        terrain: &Terrain,
        integration: &Integration,
        load: &mut FootLoad,
        listen: &mut impl FnMut(&LoadedPolygon),
    ) {
        let imprint = &self.layers[layer];
        // Shoes are flat, wheels lie in the last layer.
        let is_curved = integration.partial == PartialLoad::Proportional && layer + 1 == self.layers.len();
        let most_sag = if is_curved { MOST_SAG * imprint.spacing } else { 0.0 };
        let (n_x, n_grid) = (imprint.n_x, terrain.grid().n_x());
        for j in 0..imprint.n_y.saturating_sub(1) {
            for i in 0..n_x.saturating_sub(1) {
                let n = j * n_x + i;
                let cell = [nodes[n], nodes[n + 1], nodes[n + n_x], nodes[n + n_x + 1]];
                if is_free(&cell, most_sag) {
                    continue;
                }
                // Diagonals alternate so that no direction is preferred.
                let (i_g, j_g) = (imprint.i_0 + i, imprint.j_0 + j);
                let triangles: [[(usize, usize); 3]; 2] = if (i_g + j_g) % 2 == 0 {
                    [[(0, 0), (1, 0), (1, 1)], [(0, 0), (1, 1), (0, 1)]]
                } else {
                    [[(0, 0), (1, 0), (0, 1)], [(1, 0), (1, 1), (0, 1)]]
                };
                for corners in &triangles {
                    let [p, q, r] = *corners;
                    let at = [cell[p.0 + 2 * p.1], cell[q.0 + 2 * q.1], cell[r.0 + 2 * r.1]];
                    if is_free(&at, most_sag) {
                        continue;
                    }
                    // Written out: closures over arrays are not inlined into code for wider vectors.
                    let [a, b, c] = &at;
                    let on_window = |(a, b): (usize, usize)| (i + a, j + b);
                    let corners_at = Corners {
                        z: [a.z, b.z, c.z],
                        share: [a.share, b.share, c.share],
                        depth: [a.depth, b.depth, c.depth],
                        sag: if is_curved {
                            imprint.sag([on_window(p), on_window(q), on_window(r)])
                        } else {
                            [0.0; 3]
                        },
                    };
                    if corners_at.is_free() {
                        continue;
                    }
                    let on_grid = |(a, b): (usize, usize)| (j_g + b) * n_grid + i_g + a;
                    let on_grid = [on_grid(p), on_grid(q), on_grid(r)];
                    let answer = answer(terrain, &on_grid, &corners_at, integration);
                    self.collect(layer, (i, j), corners, &at, answer, load, listen);
                }
            }
        }
    }

    /// F5: force, position and stiffness of one polygon.
    #[inline(always)]
    fn collect(
        &self,
        layer: usize,
        (i, j): (usize, usize),
        corners: &[(usize, usize); 3],
        at: &[Node; 3],
        answer: PolygonLoad,
        load: &mut FootLoad,
        listen: &mut impl FnMut(&LoadedPolygon),
    ) {
        if answer.pressure <= 0.0 && answer.stiffness <= 0.0 {
            return;
        }
        let imprint = &self.layers[layer];
        let d = imprint.spacing;
        let area = d * d / 2.0;
        let point = |k: usize| {
            let [x, y] = imprint.position(i + corners[k].0, j + corners[k].1);
            Vec3::new(x, y, at[k].height)
        };
        let points = [point(0), point(1), point(2)];
        let normal = (points[1] - points[0]).cross(&(points[2] - points[0])) / (d * d);
        let force = normal * (answer.pressure * area); // P2 Eq. (7)
        // P2 Eq. (8); a polygon that just touches answers from its middle.
        let per_pressure = 1.0 / answer.pressure;
        let [m_0, m_1, m_2] = answer.moment;
        let weights = if answer.pressure > 0.0 {
            [m_0 * per_pressure, m_1 * per_pressure, m_2 * per_pressure]
        } else {
            [1.0 / 3.0; 3]
        };
        let position = points[0] * weights[0] + points[1] * weights[1] + points[2] * weights[2];
        let arm = position - self.reference;
        load.wrench += Wrench { force, moment: arm.cross(&force) };
        let stiffness = area * answer.stiffness.max(0.0);
        let owners =
            [0, 1, 2].map(|k| imprint.nodes[(j + corners[k].1) * imprint.n_x + i + corners[k].0].owner);
        let held =
            |k: usize| -> f64 { (0..3).filter(|&l| owners[l] == owners[k]).map(|l| at[l].share).sum() };
        let owner = owners[(1..3).fold(0, |best, k| if held(k) > held(best) { k } else { best })];
        // Slack tracks have answered for theirs.
        let is_followed = layer + 1 < self.layers.len() && self.tracks.iter().any(|track| track.owns(owner));
        if !is_followed {
            let turned = arm.cross(&normal);
            let w = Vector6::new(normal.x, normal.y, normal.z, turned.x, turned.y, turned.z);
            for (column, &w_j) in w.iter().enumerate() {
                let s_j = stiffness * w_j;
                for row in 0..=column {
                    load.stiffness[(row, column)] += s_j * w[row];
                }
            }
        }
        load.n_polygons += 1;
        let share = at.iter().map(|c| c.share).sum::<f64>() / 3.0;
        listen(&LoadedPolygon {
            layer,
            owner,
            force,
            position,
            pressure: if share > 0.0 { answer.pressure / share } else { 0.0 },
            area: share * area,
            normal,
            stiffness,
        });
    }
}

/// F3, F4: the ground's answer under one polygon.
#[inline(always)]
fn answer(
    terrain: &Terrain,
    on_grid: &[usize; 3],
    corners: &Corners,
    integration: &Integration,
) -> PolygonLoad {
    let (sub, partial) = (&integration.sub_triangles, integration.partial);
    if on_grid.iter().all(|&node| terrain.is_fixed(node)) {
        return integrate(sub, Stiff(Terrain::FIXED_STIFFNESS), corners, partial, 0.0); // P2 Eq. (4)
    }
    let field = terrain.field();
    let per_resolution = 1.0 / field.resolution();
    let (elastic, contact) = match terrain.unloading() {
        Unloading::Plastic { contact_distance } => (None, contact_distance),
        Unloading::Elastic { stiffness } => {
            (Some((stiffness, on_grid.map(|node| terrain.sinkage()[node]))), 0.0)
        }
    };
    if field.is_per_node() {
        let virgin = ThreeArrays { pressures: on_grid.map(|node| field.of_node(node)), per_resolution };
        match elastic {
            None => integrate(sub, virgin, corners, partial, contact),
            Some((stiffness, residual)) => {
                integrate(sub, Reloaded { virgin, stiffness, residual }, corners, partial, 0.0)
            }
        }
    } else {
        let virgin = OneArray { pressures: field.of_node(0), per_resolution };
        match elastic {
            None => integrate(sub, virgin, corners, partial, contact),
            Some((stiffness, residual)) => {
                integrate(sub, Reloaded { virgin, stiffness, residual }, corners, partial, 0.0)
            }
        }
    }
}
