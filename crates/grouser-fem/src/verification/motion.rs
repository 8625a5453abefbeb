//! Rigid motion: a quarter turn, a turned frame, free fall.

use std::f64::consts::FRAC_PI_2;

use grouser_geometry::nalgebra::{Isometry3, Rotation3, UnitQuaternion};
use grouser_geometry::{Vec3, box_mesh};

use super::{ELEMENTS, Row, VerificationError, irregular_cube};
use crate::{Formulation, Material, Settings, Solid, StaticOptions};

/// Strain of a quarter turn, displacement in a turned frame, and fall of a free body.
pub(super) fn rows() -> Result<Vec<Row>, VerificationError> {
    let mut rows = Vec::new();
    let material = Material::hooke(1000.0, 1e6, 0.45);
    for (name, volumetric, is_quadratic) in ELEMENTS {
        for formulation in [Formulation::Corotational, Formulation::FiniteStrain] {
            let settings = Settings { formulation, volumetric, ..Default::default() };
            let mut solid = Solid::new(irregular_cube(2, is_quadratic), vec![material], settings)?;
            let turn = Rotation3::from_axis_angle(&Vec3::z_axis(), FRAC_PI_2);
            for n in 0..solid.mesh().nodes.len() {
                let x = solid.mesh().nodes[n];
                solid.state.displacement[n] = turn * x - x;
            }
            rows.push(Row {
                case: format!("quarter turn, {name}, {formulation:?}"),
                quantity: "largest strain".to_owned(),
                computed: solid.element_fields().iter().map(|f| f.strain.norm()).fold(0.0, f64::max),
                reference: 0.0,
                tolerance: 1e-13,
                unit: "–",
                source: "a rotation strains nothing",
            });
        }
        let settings = Settings { volumetric, ..Default::default() };
        let mut solid = Solid::new(irregular_cube(2, is_quadratic), vec![material], settings)?;
        solid.loads.gravity = Vec3::new(0.0, 0.0, -9.81);
        let dt = 0.9 * solid.stable_time_step().dt;
        for _ in 0..200 {
            solid.step(dt)?;
        }
        let fall = -0.5 * 9.81 * solid.state.time.powi(2);
        let off = |u: &Vec3| (u - Vec3::z() * fall).norm() / fall.abs();
        rows.push(Row {
            case: format!("free fall, {name}"),
            quantity: "largest distance from −g t²/2, over it".to_owned(),
            computed: solid.state.displacement.iter().map(off).fold(0.0, f64::max),
            reference: 0.0,
            tolerance: 1e-12,
            unit: "–",
            source: "Galilei: z = −g t²/2",
        });
    }
    // A body-attached bar sags the same way in its own frame wherever the frame is turned to.
    let sag = |turn: UnitQuaternion<f64>| -> Result<Vec<Vec3>, VerificationError> {
        let mesh = box_mesh(Vec3::new(1.0, 0.1, 0.1), [8, 2, 2]);
        let mut bar = Solid::new(mesh, vec![material], Settings::default())?;
        bar.fix("x_min")?;
        bar.state.frame = Isometry3::from_parts(Vec3::new(5.0, 1.0, 2.0).into(), turn);
        bar.loads.gravity = turn * Vec3::new(0.0, 0.0, -9.81);
        bar.solve_statics(&StaticOptions::default())?;
        Ok(bar.state.displacement)
    };
    let quarter = UnitQuaternion::from_axis_angle(&Vec3::x_axis(), FRAC_PI_2);
    let (upright, turned) = (sag(UnitQuaternion::identity())?, sag(quarter)?);
    let largest = upright.iter().map(Vec3::norm).fold(0.0, f64::max);
    rows.push(Row {
        case: "bar in a frame turned by 90°, body-attached".to_owned(),
        quantity: "largest change of displacement over the largest displacement".to_owned(),
        computed: upright.iter().zip(&turned).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) / largest,
        reference: 0.0,
        tolerance: 1e-12,
        unit: "–",
        source: "frame invariance",
    });
    Ok(rows)
}
