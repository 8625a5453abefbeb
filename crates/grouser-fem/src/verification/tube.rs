//! Long thick-walled cylinder under inner pressure, also close to incompressible: convergence and locking.

use std::f64::consts::FRAC_PI_2;

use grouser_geometry::{TetrahedralMesh, Vec3, hollow_cylinder};

use super::{ELEMENTS, Row, VerificationError, order, order_row};
use crate::{Material, Settings, Solid, StaticOptions, VolumetricTreatment};

const SOURCE: &str = "Timoshenko & Goodier, Theory of Elasticity (Lamé), plane strain";
const INNER: f64 = 0.1;
const OUTER: f64 = 0.2;

/// Displacement of the inner face at ν = 0.3 and up to 0.499, its order of convergence, and how far plain elements lock.
pub(super) fn rows() -> Result<Vec<Row>, VerificationError> {
    let mut rows = Vec::new();
    for (name, volumetric, is_quadratic) in ELEMENTS {
        let ratio = |n: usize, nu: f64| displacement(quarter(n, is_quadratic), volumetric, nu);
        let case = |nu: f64| format!("thick-walled cylinder, ν = {nu}, {name}");
        let (coarse, nominal) = if is_quadratic { (6, 3.0) } else { (8, 2.0) };
        let (first, second) = (ratio(coarse, 0.3)? - 1.0, ratio(2 * coarse, 0.3)? - 1.0);
        rows.push(order_row(case(0.3), order(first, second, 2.0), nominal));
        for nu in [0.3, 0.45, 0.49, 0.499] {
            let is_locking = nu > 0.4 && volumetric == VolumetricTreatment::PerElement && !is_quadratic;
            let computed = ratio(if is_quadratic { 4 } else { 10 }, nu)?;
            let quantity = "radial displacement of the inner face over the closed form";
            rows.push(if is_locking {
                // Loss of displacement: 2 % at ν = 0.45 and more above.
                Row {
                    case: case(nu),
                    quantity: "locks: share of the closed form's displacement, below 0.985".to_owned(),
                    computed,
                    reference: 0.4925,
                    tolerance: 0.4925,
                    unit: "–",
                    source: SOURCE,
                }
            } else {
                let quantity = quantity.to_owned();
                Row {
                    case: case(nu),
                    quantity,
                    computed,
                    reference: 1.0,
                    tolerance: 0.01,
                    unit: "–",
                    source: SOURCE,
                }
            });
        }
    }
    Ok(rows)
}

/// Quarter of the tube, ten-node elements with their sides on the circles.
fn quarter(n: usize, is_quadratic: bool) -> TetrahedralMesh {
    let mesh = hollow_cylinder(INNER, OUTER, 0.1 / n as f64, FRAC_PI_2, [n, 2 * n, 1]);
    if !is_quadratic {
        return mesh;
    }
    let n_corners = mesh.nodes.len();
    let mut curved = mesh.to_quadratic();
    // Middle of two corners in cylindrical coordinates.
    let polar = |x: &Vec3| (x.x.hypot(x.y), x.y.atan2(x.x));
    let mut middles = vec![Vec3::zeros(); curved.nodes.len()];
    for e in 0..curved.n_elements() {
        let nodes = curved.element(e).to_vec();
        for (m, [i, j]) in grouser_geometry::tetrahedron_shape::EDGES.into_iter().enumerate() {
            let (a, b) = (curved.nodes[nodes[i] as usize], curved.nodes[nodes[j] as usize]);
            let ((ra, pa), (rb, pb)) = (polar(&a), polar(&b));
            let (r, p) = ((ra + rb) / 2.0, (pa + pb) / 2.0);
            middles[nodes[4 + m] as usize] = Vec3::new(r * p.cos(), r * p.sin(), (a.z + b.z) / 2.0);
        }
    }
    curved.nodes[n_corners..].copy_from_slice(&middles[n_corners..]);
    curved
}

/// Mean radial displacement of the inner face over
/// u(a) = (1 + ν) p a² / (E (b² − a²)) ((1 − 2 ν) a + b²/a).
fn displacement(
    mesh: TetrahedralMesh,
    volumetric: VolumetricTreatment,
    nu: f64,
) -> Result<f64, VerificationError> {
    let (a, b, p, e) = (INNER, OUTER, 1e6, 1e9);
    let closed_form = (1.0 + nu) * p * a * a / (e * (b * b - a * a)) * ((1.0 - 2.0 * nu) * a + b * b / a);
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
    Ok(nodes.iter().map(radial).sum::<f64>() / nodes.len() as f64 / closed_form)
}
