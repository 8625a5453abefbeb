//! Computed values beside closed forms, as rows that a program can list.

mod bar;
mod beam;
mod energy;
mod indentation;
mod motion;
mod patch;
mod ring;
mod stiffness;
mod tube;

pub use indentation::boussinesq;

use grouser_geometry::{TetrahedralMesh, Vec3, box_mesh};
use serde::Serialize;

use crate::VolumetricTreatment;

/// One quantity of one case against its reference.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Name of the case.
    pub case: String,
    /// What was computed.
    pub quantity: String,
    /// Value of this crate.
    pub computed: f64,
    /// Value of the source.
    pub reference: f64,
    /// Largest accepted |computed − reference|.
    pub tolerance: f64,
    /// Unit of the three values.
    pub unit: &'static str,
    /// Where the reference comes from.
    pub source: &'static str,
}

impl Row {
    /// Whether the computed value lies within the tolerance; false for NaN.
    pub fn is_pass(&self) -> bool {
        (self.computed - self.reference).abs() <= self.tolerance
    }
}

/// The three kinds of element: name, treatment of the volume, whether ten nodes.
const ELEMENTS: [(&str, VolumetricTreatment, bool); 3] = [
    ("four nodes", VolumetricTreatment::PerElement, false),
    ("four nodes, averaged pressure", VolumetricTreatment::NodalAverage, false),
    ("ten nodes", VolumetricTreatment::PerElement, true),
];

/// Unit cube whose inner nodes are out of line, so that no two elements are alike.
fn irregular_cube(cells: usize, is_quadratic: bool) -> TetrahedralMesh {
    let mut mesh = box_mesh(Vec3::repeat(1.0), [cells; 3]);
    for (i, x) in mesh.nodes.iter_mut().enumerate() {
        if x.iter().all(|c| *c > 0.01 && *c < 0.99) {
            *x += 0.04 * Vec3::new((7.0 * i as f64).sin(), (5.0 * i as f64).cos(), (3.0 * i as f64).sin());
        }
    }
    if is_quadratic { mesh.to_quadratic() } else { mesh }
}

/// Observed order of convergence: of the error of a mesh to that of one `ratio` times as fine.
fn order(coarse: f64, fine: f64, ratio: f64) -> f64 {
    (coarse.abs() / fine.abs()).ln() / ratio.ln()
}

/// Row about an observed order: it may be above the nominal one, and 0.1 below (`computed` is cut at the nominal order).
fn order_row(case: String, observed: f64, nominal: f64) -> Row {
    Row {
        quantity: format!("order of convergence, at least {nominal} (observed {observed:.2})"),
        case,
        computed: observed.min(nominal),
        reference: nominal,
        tolerance: 0.1,
        unit: "–",
        source: "a priori estimate (Ciarlet 1978)",
    }
}

/// Why a case could not be computed.
pub type VerificationError = Box<dyn std::error::Error + Send + Sync>;

/// Rows of all cases, twenty seconds of work in an optimised build.
///
/// # Errors
/// The error of the first case that cannot be computed.
pub fn all() -> Result<Vec<Row>, VerificationError> {
    Ok([short()?, indentation::rows()?].concat())
}

/// All cases but the indentation.
fn short() -> Result<Vec<Row>, VerificationError> {
    Ok([
        patch::rows()?,
        stiffness::rows()?,
        motion::rows()?,
        tube::rows()?,
        ring::rows()?,
        beam::rows()?,
        bar::rows()?,
        energy::rows()?,
    ]
    .concat())
}

#[cfg(test)]
mod tests {
    #[test]
    fn every_row_lies_within_its_tolerance() {
        for row in super::short().unwrap() {
            assert!(row.is_pass(), "{row:?}");
        }
    }
}
