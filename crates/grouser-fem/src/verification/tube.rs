//! Long thick-walled cylinder under inner pressure, also close to incompressible.

use std::f64::consts::FRAC_PI_2;

use grouser_geometry::{Vec3, hollow_cylinder};

use super::{Row, VerificationError};
use crate::{Material, Settings, Solid, StaticOptions, VolumetricTreatment};

/// Displacement of the inner face for two kinds of element at ν = 0.3 and 0.499.
pub(super) fn rows() -> Result<Vec<Row>, VerificationError> {
    let mut rows = Vec::new();
    for nu in [0.3, 0.499] {
        for (name, volumetric, is_quadratic) in [
            ("four nodes, averaged pressure", VolumetricTreatment::NodalAverage, false),
            ("ten nodes", VolumetricTreatment::PerElement, true),
        ] {
            // u(a) = (1 + nu) p a^2 / (E (b^2 - a^2)) ((1 - 2 nu) a + b^2 / a)
            let (a, b, p, e) = (0.1, 0.2, 1e6, 1e9);
            let reference =
                (1.0 + nu) * p * a * a / (e * (b * b - a * a)) * ((1.0 - 2.0 * nu) * a + b * b / a);
            let mesh = hollow_cylinder(a, b, 0.01, FRAC_PI_2, [10, 20, 1]);
            let mesh = if is_quadratic { mesh.to_quadratic() } else { mesh };
            let settings = Settings { volumetric, ..Default::default() };
            let mut solid = Solid::new(mesh, vec![Material::hooke(1000.0, e, nu)], settings)?;
            for (side, held) in [
                ("z_min", [false, false, true]),
                ("z_max", [false, false, true]),
                ("angle_min", [false, true, false]),
                ("angle_max", [true, false, false]),
            ] {
                solid.fix_components(side, held)?;
            }
            solid.inflate("inner", p)?;
            solid.solve_statics(&StaticOptions::default())?;
            let nodes = solid.mesh().nodes_of("inner")?;
            let radial = |&n: &u32| {
                let x = solid.mesh().nodes[n as usize];
                solid.state.displacement[n as usize].dot(&Vec3::new(x.x, x.y, 0.0).normalize())
            };
            rows.push(Row {
                case: format!("thick-walled cylinder, ν = {nu}, {name}"),
                quantity: "radial displacement of the inner face".to_owned(),
                computed: nodes.iter().map(radial).sum::<f64>() / nodes.len() as f64,
                reference,
                tolerance: 0.015 * reference,
                unit: "m",
                source: "Timoshenko & Goodier, Theory of Elasticity (Lamé), plane strain",
            });
        }
    }
    Ok(rows)
}
