//! The wheel on a terrain grid, in its own steady rut: the model of a vehicle's wheel with shear.

use grouser_geometry::{HeightGrid, Pose, Vec3};
use serde::{Deserialize, Serialize};

use super::search::sinkage_in_balance;
use super::{OperatingPoint, PressurePeak, SingleWheel, WheelError, WheelSoil};
use crate::contact::{Integration, LoadedPolygon};
use crate::gear::{Foot, Wheel};
use crate::polygon::{PartialLoad, SubTriangles};
use crate::pressure::{PressureArray, PressureError, PressureField};
use crate::shear::{Motion, ShearPath, polygon_traction};
use crate::terrain::{Terrain, Unloading};

/// Fineness of the grid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GridSettings {
    /// Spacing of the terrain \[m\].
    pub spacing: f64,
    /// Distance of the values of the pressure array in sinkage \[m\].
    pub sinkage_resolution: f64,
    /// Parts per side of a polygon; even.
    pub integration_resolution: usize,
}

impl GridSettings {
    /// Settings whose sinkage and drawbar pull differ by less than 1 % from those of a grid four times finer.
    pub fn for_wheel(wheel: &SingleWheel) -> Self {
        let spacing = wheel.acting_radius() / 32.0;
        Self { spacing, sinkage_resolution: spacing / 8.0, integration_resolution: 2 }
    }
}

/// Steady state under the wheel's load at `slip` and `slip_angle` \[rad\].
///
/// The wheel rolls along x. The node row under the axle lies at the lowest point; behind it the ground is a rut.
pub fn operating_point(
    wheel: &SingleWheel,
    soil: &WheelSoil,
    slip: f64,
    slip_angle: f64,
    settings: &GridSettings,
) -> Result<OperatingPoint, WheelError> {
    wheel.check(soil, slip, slip_angle)?;
    let bench = Bench::new(wheel, soil, slip, slip_angle, settings)?;
    let mut n_evaluations = 0;
    let force = |sinkage| {
        n_evaluations += 1;
        bench.at_sinkage(sinkage).vertical_force
    };
    let deepest = (0.9 * wheel.acting_radius()).min(bench.ground.field().max_sinkage());
    // The closed form is close: it costs a hundredth.
    let guess = super::closed_form::operating_point(wheel, soil, slip, slip_angle)?.sinkage.min(deepest);
    let sinkage = sinkage_in_balance(force, wheel.load, guess, deepest, 1e-7)?;
    Ok(OperatingPoint { n_evaluations, ..bench.at_sinkage(sinkage) })
}

/// Flat ground and the wheel above it.
struct Bench<'a> {
    wheel: &'a SingleWheel,
    soil: &'a WheelSoil,
    slip: f64,
    slip_angle: f64,
    foot: Foot,
    ground: Terrain,
    integration: Integration,
}

impl<'a> Bench<'a> {
    fn new(
        wheel: &'a SingleWheel,
        soil: &'a WheelSoil,
        slip: f64,
        slip_angle: f64,
        settings: &GridSettings,
    ) -> Result<Self, WheelError> {
        let (radius, d) = (wheel.acting_radius(), settings.spacing);
        if !(d > 0.0 && d <= radius / 4.0 && d >= radius / 1000.0) {
            let expected = "between a thousandth and a quarter of the wheel's radius";
            return Err(WheelError::Value { quantity: "terrain spacing", value: d, expected });
        }
        // A row of nodes at x = 0, a margin of two cells around the wheel.
        let [n_x, n_y] = [radius, wheel.width / 2.0].map(|half| (half / d).ceil() as usize + 2);
        let origin = [n_x, n_y].map(|n| -(n as f64) * d);
        let grid =
            HeightGrid::new(2 * n_x + 1, 2 * n_y + 1, d, origin, vec![0.0; (2 * n_x + 1) * (2 * n_y + 1)])
                .map_err(|_| WheelError::Value {
                    quantity: "terrain spacing",
                    value: d,
                    expected: "a length that makes a grid around the wheel",
                })?;
        let array = PressureArray::new(&soil.pressure, settings.sinkage_resolution, radius)?;
        let unloading = match soil.rebound {
            // At steady state contact does not build up: all of it has been there before.
            None => Unloading::Plastic { contact_distance: 1e-12 * radius },
            Some(stiffness) => Unloading::Elastic { stiffness },
        };
        let ground = Terrain::new(grid, PressureField::uniform(array))
            .and_then(|terrain| terrain.with_unloading(unloading))
            .map_err(|_| PressureError::None)?;
        let foot = Foot {
            body: 0,
            wheels: vec![Wheel::cylinder(Vec3::zeros(), radius, wheel.width)],
            belts: Vec::new(),
        };
        let integration = Integration {
            sub_triangles: SubTriangles::new(settings.integration_resolution),
            partial: PartialLoad::Proportional,
        };
        Ok(Self { wheel, soil, slip, slip_angle, foot, ground, integration })
    }

    /// Forces and works at a sinkage.
    fn at_sinkage(&self, sinkage: f64) -> OperatingPoint {
        let radius = self.wheel.acting_radius();
        let mut ground = self.ground.clone();
        let (n_x, n_nodes) = (ground.grid().n_x(), ground.grid().n_nodes());
        let middle = n_x / 2;
        for node in (0..n_nodes).filter(|node| node % n_x <= middle) {
            ground.stamp(node, -sinkage);
        }
        let rut_depth = ground.sinkage()[0];
        let pose = Pose::translation(0.0, 0.0, radius - sinkage);
        let imprint = self.foot.imprint(&ground, &pose, 0.0, self.integration.partial);
        let slip = self.wheel.acting_slip(self.slip);
        let motion = Motion { forward: Vec3::x(), slip, slip_angle: self.slip_angle };
        let path = ShearPath { imprint: &imprint, terrain: &ground, motion, gap: 0.0 };
        let mut polygons = imprint.polygons(&ground, &Pose::identity(), &self.integration);

        let travel = motion.travel();
        let (mut normal, mut shear) = (Vec3::zeros(), Vec3::zeros());
        let (mut rim_force, mut sheared, mut compacted) = (0.0, 0.0, 0.0);
        for polygon in &mut polygons {
            self.shift_peak(polygon, sinkage);
            normal += polygon.force;
            compacted -= polygon.force.dot(&travel);
            let traction = polygon_traction(&path, polygon, &self.soil.shear, imprint.reference);
            shear += traction.wrench.force;
            rim_force += traction.rim_force;
            sheared += traction.shear_loss;
        }
        let force = normal + shear;
        let faster = radius / self.wheel.radius;
        OperatingPoint {
            slip: self.slip,
            slip_angle: self.slip_angle,
            sinkage,
            rut_depth,
            vertical_force: force.z,
            drawbar_pull: force.x,
            thrust: shear.x,
            compaction_resistance: -normal.x,
            lateral_force: force.y,
            torque: rim_force * radius,
            axle_work: rim_force * faster,
            drawbar_work: (1.0 - self.slip) * (force.x + self.slip_angle.tan() * force.y),
            compaction_loss: compacted * faster,
            shear_loss: sheared * faster,
            n_evaluations: 1,
        }
    }

    /// Scales a polygon behind the stress peak of Wong and Reece to the pressure that stands mirrored before it.
    fn shift_peak(&self, polygon: &mut LoadedPolygon, sinkage: f64) {
        let PressurePeak::WongReece { c_1, c_2 } = self.soil.peak else { return };
        let radius = self.wheel.acting_radius();
        let entry = (1.0 - sinkage / radius).acos();
        let peak = (c_1 + c_2 * self.slip.abs()) * entry;
        let theta = (polygon.position.x / radius).clamp(0.0, 1.0).asin();
        if theta >= peak {
            return;
        }
        let mirrored = entry - theta / peak * (entry - peak);
        let pressure =
            |theta: f64| self.soil.pressure.pressure((radius * (theta.cos() - entry.cos())).max(0.0));
        let ratio = pressure(mirrored) / pressure(theta);
        polygon.force *= ratio;
        polygon.pressure *= ratio;
    }
}
