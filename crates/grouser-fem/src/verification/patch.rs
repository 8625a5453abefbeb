//! Patch test: a uniform uniaxial stretch prescribed on the boundary.

use grouser_geometry::Vec3;

use super::{ELEMENTS, Row, VerificationError, irregular_cube};
use crate::{Material, Settings, Solid, StaticOptions};

/// Stress in the worst element of each kind.
pub(super) fn rows() -> Result<Vec<Row>, VerificationError> {
    let mut rows = Vec::new();
    for (name, volumetric, is_quadratic) in ELEMENTS {
        let mesh = irregular_cube(3, is_quadratic);
        let settings = Settings { volumetric, ..Default::default() };
        let mut solid = Solid::new(mesh.clone(), vec![Material::hooke(1000.0, 1e9, 0.3)], settings)?;
        for facet in mesh.boundary()? {
            for n in mesh.facet_nodes(facet) {
                let u = 1e-3 * mesh.nodes[n as usize].component_mul(&Vec3::new(1.0, -0.3, -0.3));
                (0..3).for_each(|c| solid.prescribe(n, c, u[c], 0.0));
            }
        }
        solid.solve_statics(&StaticOptions::default())?;
        let worst = solid
            .element_fields()
            .iter()
            .map(|f| f.stress[(0, 0)])
            .max_by(|a, b| (a - 1e6).abs().total_cmp(&(b - 1e6).abs()));
        rows.push(Row {
            case: format!("patch test, {name}"),
            quantity: "stress along x in the worst element".to_owned(),
            computed: worst.unwrap_or(f64::NAN),
            reference: 1e6,
            tolerance: 1e-4,
            unit: "Pa",
            source: "E ε, E = 1 GPa, ε = 1e-3",
        });
    }
    Ok(rows)
}
