//! Driven wheels and belts: closed form, grid and energy against each other and against another program.

use grouser_geometry::{Pose, Vec3};

use super::{Row, flat_ground};
use crate::equilibrium::SearchSettings;
use crate::gear::{Belt, Fit, Foot, Shoe, ShoeShape, Wheel};
use crate::pressure::{Bekker, PressureLaw};
use crate::shear::{JanosiHanamoto, Motion, foot_traction};
use crate::terrain::{Terrain, Unloading};
use crate::wheel::{OperatingPoint, PressurePeak, SingleWheel, WheelSoil, closed_form, grid};

const INDEPENDENT: &str = "tanh–sinh quadrature and bisection in another program";

/// LETE sand of J. Y. Wong (2008), Table 2.3, under a wheel of R = 0.5 m, b = 0.3 m, 4 kN.
fn sand(peak: PressurePeak, rebound: Option<f64>) -> (SingleWheel, WheelSoil) {
    let pressure = PressureLaw::Bekker(Bekker {
        cohesive_modulus: 102e3,
        frictional_modulus: 5301e3,
        exponent: 0.79,
        plate_width: 0.3,
    });
    let shear = JanosiHanamoto {
        cohesion: 1.3e3,
        friction_angle: 31.1_f64.to_radians(),
        shear_deformation_modulus: 0.012,
    };
    let wheel = SingleWheel { radius: 0.5, width: 0.3, lugs: None, load: 4000.0 };
    (wheel, WheelSoil { pressure, shear, peak, rebound })
}

const WONG_REECE: PressurePeak = PressurePeak::WongReece { c_1: 0.18, c_2: 0.32 };

/// Sinkage, drawbar pull, torque and lateral force of the closed form against independent quadrature.
pub fn rigid_wheel_integrals() -> Vec<Row> {
    let case = "rigid wheel with shear: closed form";
    // Slip, slip angle, peak; z [m], drawbar pull [N], torque [N·m], lateral force [N].
    let references = [
        (0.1, 0.0, WONG_REECE, [0.012_926_531_870_4, 659.756_779_037, 525.878_165_753, 0.0]),
        (0.6, 0.0, WONG_REECE, [0.013_897_255_538_5, 1_672.620_611_34, 1_053.538_531_19, 0.0]),
        (-0.15, 0.0, PressurePeak::Bottom, [0.012_249_735_027_6, -1_631.208_037_24, -639.062_430_649, 0.0]),
        (
            0.3,
            0.15,
            PressurePeak::Bottom,
            [0.011_740_268_143_9, 1_417.130_427_31, 877.718_502_124, -602.473_910_013],
        ),
    ];
    let mut rows = Vec::new();
    for (slip, slip_angle, peak, reference) in references {
        let (wheel, soil) = sand(peak, None);
        let point = closed_form::operating_point(&wheel, &soil, slip, slip_angle);
        let computed =
            point.map_or([f64::NAN; 4], |p| [p.sinkage, p.drawbar_pull, p.torque, p.lateral_force]);
        let names = ["sinkage", "drawbar pull", "torque", "lateral force"];
        for (k, unit) in ["m", "N", "N·m", "N"].into_iter().enumerate() {
            rows.push(Row {
                case,
                quantity: format!("{} at slip {slip}, slip angle {slip_angle}", names[k]),
                computed: computed[k],
                reference: reference[k],
                tolerance: 1e-8 * reference[k].abs().max(1e-2),
                unit,
                source: INDEPENDENT,
            });
        }
    }
    rows
}

/// The grid against the closed form, and its observed order.
pub fn wheel_on_the_grid() -> Vec<Row> {
    let case = "rigid wheel with shear: grid";
    let mut rows = Vec::new();
    for (peak, rebound, name) in [
        (PressurePeak::Bottom, None, "plastic"),
        (PressurePeak::Bottom, Some(4e8), "elastic"),
        (WONG_REECE, None, "peak"),
    ] {
        let (wheel, soil) = sand(peak, rebound);
        let on_grid = |n: f64| {
            let spacing = wheel.radius / n;
            let settings =
                grid::GridSettings { spacing, sinkage_resolution: spacing / 16.0, integration_resolution: 4 };
            grid::operating_point(&wheel, &soil, 0.3, 0.1, &settings)
        };
        let (Ok(exact), Ok(coarse), Ok(fine)) =
            (closed_form::operating_point(&wheel, &soil, 0.3, 0.1), on_grid(20.0), on_grid(80.0))
        else {
            rows.push(Row::missing(case, name));
            continue;
        };
        let values = |p: &OperatingPoint| [p.sinkage, p.drawbar_pull, p.torque, p.lateral_force];
        for (k, quantity) in ["sinkage", "drawbar pull", "torque", "lateral force"].into_iter().enumerate() {
            let (a, b, e) = (values(&coarse)[k], values(&fine)[k], values(&exact)[k]);
            rows.push(Row {
                case,
                quantity: format!("{name}: {quantity} at R/80"),
                computed: b / e,
                reference: 1.0,
                // Second order as the plastic ground, from a larger error.
                tolerance: if rebound.is_some() { 5e-3 } else { 2e-3 },
                unit: "-",
                source: "closed form",
            });
            // The kink at the shifted peak falls anywhere within a polygon: no steady order there.
            if k == 0 && peak == PressurePeak::Bottom {
                rows.push(Row {
                    case,
                    quantity: format!("{name}: observed order of the sinkage, R/20 to R/80"),
                    computed: ((a - e) / (b - e)).abs().log2() / 2.0,
                    reference: 2.0,
                    tolerance: 0.4,
                    unit: "-",
                    source: "linear interpolation of a curved underside",
                });
            }
        }
    }
    rows
}

/// Work per metre of rim: axle = drawbar + compaction + shear, compaction against the work of the pressure along the sinkage.
pub fn energy() -> Vec<Row> {
    let case = "rigid wheel with shear: energy";
    let mut rows = Vec::new();
    for rebound in [None, Some(4e8)] {
        let (wheel, soil) = sand(PressurePeak::Bottom, rebound);
        let spacing = wheel.radius / 80.0;
        let settings =
            grid::GridSettings { spacing, sinkage_resolution: spacing / 16.0, integration_resolution: 4 };
        for (fidelity, point) in [
            ("closed form", closed_form::operating_point(&wheel, &soil, 0.4, 0.0)),
            ("grid", grid::operating_point(&wheel, &soil, 0.4, 0.0, &settings)),
        ] {
            let Ok(point) = point else {
                rows.push(Row::missing(case, fidelity));
                continue;
            };
            // b (∫ p dz − p²/2k_u) per metre of way, (1 − s) metres of way per metre of rim.
            let PressureLaw::Bekker(law) = &soil.pressure else { continue };
            let (z, p) = (point.sinkage, law.pressure(point.sinkage));
            let kept = law.modulus() * z.powf(law.exponent + 1.0) / (law.exponent + 1.0)
                - rebound.map_or(0.0, |k_u| p * p / (2.0 * k_u));
            let ground = if rebound.is_some() { "elastic" } else { "plastic" };
            rows.push(Row {
                case,
                quantity: format!("{fidelity}, {ground}: what the axle gives and nothing takes"),
                computed: point.axle_work - point.drawbar_work - 0.6 * wheel.width * kept - point.shear_loss,
                reference: 0.0,
                tolerance: if fidelity == "grid" { 1e-3 } else { 1e-8 } * point.axle_work,
                unit: "J/m",
                source: "balance with the work of the pressure along the sinkage",
            });
        }
    }
    rows
}

/// A driven track of two wheels on linear ground at a given sinkage, at 10 % slip.
pub fn driven_track() -> Vec<Row> {
    let case = "driven track with shear";
    let wheels = [-0.75, 0.75].map(|x| Wheel::cylinder(Vec3::new(x, 0.0, 0.0), 0.5, 0.5)).to_vec();
    let shape = ShoeShape::Band { width: 0.6, depth: 0.02, n_pieces: 12 };
    let belt = Belt {
        wheels: vec![0, 1],
        link_offset: 0.0,
        n_shoes: 60,
        pitch: 0.102_360,
        shoe: Shoe { mass: 10.0, shape },
        fit: Fit::Tight,
    };
    let foot = Foot { body: 0, wheels, belts: vec![belt] };
    let law = JanosiHanamoto {
        cohesion: 2e3,
        friction_angle: 28_f64.to_radians(),
        shear_deformation_modulus: 0.025,
    };
    let settings = SearchSettings::default();
    let forces = |spacing: f64, heading: f64| {
        let terrain: Terrain = flat_ground(spacing, 3.0)
            .with_unloading(Unloading::Plastic { contact_distance: 1e-9 })
            .expect("a distance above zero");
        let turn = grouser_geometry::Orientation::from_axis_angle(&Vec3::z_axis(), heading);
        let pose = Pose::from_parts(Vec3::new(0.0031, 0.0021, 0.47).into(), turn);
        let imprint = foot.imprint(&terrain, &pose, 0.0, settings.partial);
        let polygons = imprint.polygons(&terrain, &Pose::identity(), &settings.integration());
        let forward = turn * Vec3::x();
        let motion = Motion { forward, slip: 0.1, slip_angle: 0.0 };
        let traction = foot_traction(&imprint, &terrain, &polygons, &law, motion, 0.1);
        [traction.rim_force, traction.wrench.force.dot(&forward), traction.wrench.force.z]
    };
    let references = [41_796.875_42, 41_686.908_21, -365.732_779_7];
    let mut rows = Vec::new();
    for heading in [0.0, 0.5] {
        let fine = forces(0.01, heading);
        for (k, quantity) in ["force along the belt", "thrust", "lift"].into_iter().enumerate() {
            rows.push(Row {
                case,
                quantity: format!("{quantity}, heading {heading} rad"),
                computed: fine[k],
                reference: references[k],
                tolerance: 2e-3 * references[0],
                unit: "N",
                source: INDEPENDENT,
            });
        }
    }
    rows
}
