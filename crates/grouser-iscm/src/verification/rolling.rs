//! Rolling resistance and runs.

use grouser_geometry::{Pose, Vec3};

use super::{Row, component_vehicle, flat_ground};
use crate::contact::FootImprint;
use crate::equilibrium::SearchSettings;
use crate::gear::{Foot, Wheel};
use crate::rolling_resistance::foot_resistance;
use crate::route::Route;
use crate::run::{RunSettings, RunState};

/// A bogie turned 8° nose down on flat ground, rolling along itself: sin 8° for every wheel.
pub fn bogie_rolling_down() -> Vec<Row> {
    let case = "P2 test 19: rolling resistance of a bogie";
    let terrain = flat_ground(0.01, 5.0);
    let angle = 8.0_f64.to_radians();
    let wheels = [-0.75, 0.75].map(|x| Wheel::cylinder(Vec3::new(x, 0.0, 0.0), 0.5, 0.5)).to_vec();
    let foot = Foot { body: 0, wheels, belts: Vec::new() };
    let turn = grouser_geometry::Orientation::from_axis_angle(&Vec3::y_axis(), angle);
    let pose = Pose::from_parts(Vec3::new(0.0031, 0.002, 0.36).into(), turn);
    let settings = SearchSettings::default();
    let imprint: FootImprint = foot.imprint(&terrain, &pose, 0.0, settings.partial);
    let mut polygons = Vec::new();
    imprint.load(&terrain, &Pose::identity(), &settings.integration(), |p| polygons.push(*p));
    let rolling = turn * Vec3::x();
    let wheels = foot_resistance(&foot, &pose, 0.0, rolling, &polygons, imprint.layers.len());
    let row = |(k, w): (usize, &crate::rolling_resistance::WheelResistance)| Row {
        case,
        quantity: format!("coefficient of wheel {k}"),
        computed: w.coefficient(),
        reference: angle.sin(),
        tolerance: 1e-4,
        unit: "-",
        source: "closed form: −F·r_d/|F| on flat ground = sin 8°",
    };
    wheels.iter().enumerate().filter(|(_, w)| w.normal_force > 0.0).map(row).collect()
}

/// A run cut in the middle and taken up again ends with the same state, bit by bit.
pub fn restart() -> Vec<Row> {
    let case = "P2 test 25: restart";
    let machine = component_vehicle(30_000.0, false, 0.05);
    let settings = RunSettings {
        route: Route { points: vec![[2.0, 0.0], [3.0, 0.0]] },
        run_step: 0.12,
        intermediate_steps: 2,
        search: SearchSettings { position_tolerance: 1e-6, ..SearchSettings::default() },
    };
    let run = || -> Option<(RunState, RunState)> {
        let mut straight = RunState::start(&machine, flat_ground(0.08, 9.0), &settings).ok()?;
        straight.step(&machine, &settings).ok()?;
        let mut resumed = straight.clone();
        straight.step(&machine, &settings).ok()?;
        resumed.step(&machine, &settings).ok()?;
        Some((straight, resumed))
    };
    let computed = run().map_or(f64::NAN, |(a, b)| f64::from(u8::from(a != b)));
    vec![Row {
        case,
        quantity: "states that differ".into(),
        computed,
        reference: 0.0,
        tolerance: 0.0,
        unit: "-",
        source: "the uninterrupted run",
    }]
}
