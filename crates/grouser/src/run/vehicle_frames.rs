//! Ground and machine as ParaView sees them.

use crate::output::{PointField, PolyData};
use grouser_geometry::{Orientation, Pose, TriangleSurface, Vec3};
use grouser_iscm::gear::{Belt, Fit, Foot, ShoeShape, WheelShape};
use grouser_iscm::imprint::Plate;
use grouser_iscm::machine::Machine;
use grouser_iscm::run::{RunSettings, RunState};
use grouser_iscm::track::TrackShape;

/// Flat sectors of a wheel as shown.
const N_SECTORS: usize = 48;

/// Ground with its sinkage, and all running gear where it stands.
pub fn frames(
    machine: &Machine,
    state: &RunState,
    settings: &RunSettings,
) -> Vec<(&'static str, PolyData<'static>)> {
    let travel = state.distance(settings);
    let poses = machine.mechanism.poses(&state.configuration);
    let mut gear = Shown::default();
    for (number, foot) in machine.feet.iter().enumerate() {
        let shapes = state.configuration.tracks.get(machine.slack_belts(number)).unwrap_or_default();
        gear.foot(foot, &poses[foot.body], travel, shapes, number);
    }
    vec![("ground", ground(state)), ("machine", gear.into_frame())]
}

fn ground(state: &RunState) -> PolyData<'static> {
    let terrain = &state.terrain;
    let grid = terrain.grid();
    let (n_x, n_y) = (grid.n_x(), grid.n_y());
    let points = (0..grid.n_nodes()).map(|node| {
        let [x, y] = grid.position(node % n_x, node / n_x);
        [x, y, terrain.height(node)]
    });
    let mut triangles = Vec::with_capacity(2 * (n_x - 1) * (n_y - 1));
    for j in 0..n_y - 1 {
        for i in 0..n_x - 1 {
            let [a, b, c, d] =
                [j * n_x + i, j * n_x + i + 1, (j + 1) * n_x + i, (j + 1) * n_x + i + 1].map(|n| n as u32);
            triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
    let loadings = terrain.loadings().iter().map(|&n| f64::from(n)).collect();
    PolyData {
        time: 0.0,
        points: points.collect(),
        triangles,
        fields: vec![
            ("sinkage", PointField::Scalar(terrain.sinkage().to_vec())),
            ("loadings", PointField::Scalar(loadings)),
        ],
    }
}

/// Surfaces put together.
#[derive(Default)]
struct Shown {
    points: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    gear: Vec<f64>,
}

impl Shown {
    fn add(&mut self, surface: &TriangleSurface, pose: &Pose, number: usize) {
        let first = self.points.len() as u32;
        for vertex in &surface.vertices {
            let p = pose.rotation * vertex + pose.translation.vector;
            self.points.push([p.x, p.y, p.z]);
            self.gear.push(number as f64);
        }
        self.triangles.extend(surface.triangles.iter().map(|t| t.map(|v| first + v)));
    }

    fn foot(&mut self, foot: &Foot, body: &Pose, travel: f64, shapes: &[TrackShape], number: usize) {
        for wheel in &foot.wheels {
            let spin = Orientation::from_axis_angle(&Vec3::y_axis(), travel / wheel.radius);
            let pose = body * Pose::from_parts(wheel.centre.into(), spin);
            match &wheel.shape {
                WheelShape::Cylinder { width } => {
                    let (w, r) = (width / 2.0, wheel.radius);
                    let section = [[w, 0.4 * r], [w, r], [-w, r], [-w, 0.4 * r]];
                    if let Ok(surface) = grouser_geometry::lathe::lathe(&section, N_SECTORS) {
                        self.add(&surface, &pose, number);
                    }
                }
                WheelShape::Surface(surface) => self.add(surface, &pose, number),
            }
        }
        let mut shapes = shapes.iter();
        for belt in &foot.belts {
            let shape = (belt.fit == Fit::Slack).then(|| shapes.next()).flatten();
            let joints = belt.joints(&foot.wheels, body, travel, shape);
            self.belt(belt, foot, body, &joints, number);
        }
    }

    fn belt(&mut self, belt: &Belt, foot: &Foot, body: &Pose, joints: &[[f64; 2]], number: usize) {
        let y = belt.lateral(&foot.wheels);
        for (n, a) in joints.iter().enumerate() {
            let b = joints[(n + 1) % joints.len()];
            let turn = Orientation::from_axis_angle(&Vec3::y_axis(), -(b[1] - a[1]).atan2(b[0] - a[0]));
            let middle = Vec3::new((a[0] + b[0]) / 2.0, y, (a[1] + b[1]) / 2.0);
            let pose = body * Pose::from_parts(middle.into(), turn);
            match &belt.shoe.shape {
                ShoeShape::Steel { plates, grousers } => {
                    plates.iter().chain(grousers).for_each(|plate| self.plate(plate, &pose, number));
                }
                ShoeShape::Band { width, depth, .. } => {
                    let half = belt.pitch / 2.0;
                    let across = [-width / 2.0, width / 2.0];
                    self.plate(&Plate { along: [-half, half], across, depth: *depth }, &pose, number);
                }
                ShoeShape::Surface(surface) => self.add(surface, &pose, number),
            }
        }
    }

    /// A plate as a box from the link line down to its underside.
    fn plate(&mut self, plate: &Plate, pose: &Pose, number: usize) {
        let size = Vec3::new(
            plate.along[1] - plate.along[0],
            plate.across[1] - plate.across[0],
            plate.depth.max(1e-3),
        );
        let Ok(surface) = grouser_geometry::generate::cuboid(size) else { return };
        let bounds = surface.bounding_box().center();
        let middle = Vec3::new(
            (plate.along[0] + plate.along[1]) / 2.0,
            (plate.across[0] + plate.across[1]) / 2.0,
            -plate.depth / 2.0,
        );
        let shift = middle - bounds;
        self.add(&surface, &(pose * Pose::translation(shift.x, shift.y, shift.z)), number);
    }

    fn into_frame(self) -> PolyData<'static> {
        PolyData {
            time: 0.0,
            points: self.points,
            triangles: self.triangles,
            fields: vec![("gear", PointField::Scalar(self.gear))],
        }
    }
}
