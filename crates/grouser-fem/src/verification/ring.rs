//! A ring as thick as the wall of a tire, one element thick, pinched between two lines: bending and how elements lock in it.

use std::f64::consts::{FRAC_PI_2, PI};

use grouser_geometry::hollow_cylinder;

use super::{ELEMENTS, Row, VerificationError};
use crate::{Material, Settings, Solid, StaticOptions, VolumetricTreatment};

/// Inner and outer radius of wall and length along the axis [m].
const RADII: [f64; 2] = [0.241, 0.257];
const LENGTH: f64 = 0.01;
/// Rubber: Young's modulus [Pa], Poisson's ratio.
const YOUNG_MODULUS: f64 = 20e6;
const POISSON_RATIO: f64 = 0.45;
/// Cells in a quarter of the ring, as many as the treads of the scenes have.
const CELLS: usize = 20;

/// Compliance of each element over that of the ring: ten nodes bend, four do not.
pub(super) fn rows() -> Result<Vec<Row>, VerificationError> {
    let row = |(name, volumetric, is_quadratic): (&str, VolumetricTreatment, bool)| {
        let is_locking = !is_quadratic;
        let what = "deflection over that of a thin ring";
        Ok(Row {
            case: format!("ring one element thick, ν = {POISSON_RATIO}, {name}"),
            quantity: if is_locking { format!("locks: {what}, below 0.7") } else { what.to_owned() },
            computed: deflection(volumetric, is_quadratic)?,
            reference: if is_locking { 0.35 } else { 1.0 },
            tolerance: if is_locking { 0.35 } else { 0.06 },
            unit: "–",
            source: "thin ring, plane strain: P R³/(E' I) (π/4 − 2/π) (Timoshenko, Strength of Materials II)",
        })
    };
    ELEMENTS.into_iter().map(row).collect()
}

/// Deflection of a quarter whose end is pressed towards the axis, over the closed form.
fn deflection(volumetric: VolumetricTreatment, is_quadratic: bool) -> Result<f64, VerificationError> {
    let [inner, outer] = RADII;
    let mesh = hollow_cylinder(inner, outer, LENGTH, FRAC_PI_2, [1, CELLS, 1]);
    let mesh = if is_quadratic { mesh.to_quadratic() } else { mesh };
    let settings = Settings { volumetric, ..Default::default() };
    let material = Material::hooke(1000.0, YOUNG_MODULUS, POISSON_RATIO);
    let mut ring = Solid::new(mesh, vec![material], settings)?;
    ring.fix_components("z_min", [false, false, true])?;
    ring.fix_components("z_max", [false, false, true])?;
    ring.fix_components("angle_min", [false, true, false])?;
    ring.fix_components("angle_max", [true, false, false])?;
    let approach = 1e-3;
    let end = ring.mesh().nodes_of("angle_max")?;
    end.iter().for_each(|&node| ring.prescribe(node, 1, -approach, 0.0));
    ring.solve_statics(&StaticOptions::default())?;
    let held = |node: &u32| ring.supports().keys().position(|n| n == node).expect("it is held");
    // Half of the pinching force on each of two quarters.
    let force = -2.0 * end.iter().map(|node| ring.state.reaction[held(node)].y).sum::<f64>();
    let (radius, thickness) = ((inner + outer) / 2.0, outer - inner);
    let bending = YOUNG_MODULUS / (1.0 - POISSON_RATIO.powi(2)) * LENGTH * thickness.powi(3) / 12.0;
    let closed_form = force * radius.powi(3) / bending * (PI / 4.0 - 2.0 / PI);
    // Both lines approach the axis.
    Ok(2.0 * approach / closed_form)
}
