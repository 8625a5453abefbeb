//! Cantilever under its own weight.

use grouser_geometry::{Vec3, box_mesh};

use super::{Row, VerificationError};
use crate::{Formulation, Material, Settings, Solid, StaticOptions};

/// Deflection of the tip for the three formulations with ten-node elements.
pub(super) fn rows() -> Result<Vec<Row>, VerificationError> {
    let mut rows = Vec::new();
    for formulation in [Formulation::BodyAttached, Formulation::Corotational, Formulation::FiniteStrain] {
        let mesh = box_mesh(Vec3::new(1.0, 0.1, 0.1), [16, 2, 2]).to_quadratic();
        let settings = Settings { formulation, ..Default::default() };
        // nu = 0: the clamped root does not hinder lateral strain, as in beam theory.
        let mut solid = Solid::new(mesh, vec![Material::hooke(1000.0, 1e9, 0.0)], settings)?;
        solid.fix("x_min")?;
        solid.loads.gravity = Vec3::new(0.0, 0.0, -9.81);
        solid.solve_statics(&StaticOptions { tolerance: 1e-8, ..Default::default() })?;
        let tip = solid.mesh().nodes_of("x_max")?;
        let computed =
            tip.iter().map(|&n| -solid.state.displacement[n as usize].z).sum::<f64>() / tip.len() as f64;
        // q L^4 / (8 E I) + q L^2 / (2 kappa A G), kappa = 5/6, G = E/2
        let (q, area, inertia, e) = (1000.0 * 0.01 * 9.81, 0.01, 0.1f64.powi(4) / 12.0, 1e9);
        let reference = q / (8.0 * e * inertia) + q / (2.0 * 5.0 / 6.0 * area * e / 2.0);
        rows.push(Row {
            case: format!("cantilever under its own weight, {formulation:?}"),
            quantity: "deflection of the tip".to_owned(),
            computed,
            reference,
            tolerance: 0.01 * reference,
            unit: "m",
            source: "Timoshenko beam, κ = 5/6",
        });
    }
    Ok(rows)
}
