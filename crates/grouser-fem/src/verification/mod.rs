//! Computed values beside closed forms, as rows that a program can list.

mod bar;
mod beam;
mod patch;
mod tube;

use serde::Serialize;

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

/// Why a case could not be computed.
pub type VerificationError = Box<dyn std::error::Error + Send + Sync>;

/// Rows of all cases, some seconds of work.
///
/// # Errors
/// The error of the first case that cannot be computed.
pub fn all() -> Result<Vec<Row>, VerificationError> {
    Ok([patch::rows()?, tube::rows()?, beam::rows()?, bar::rows()?].concat())
}

#[cfg(test)]
mod tests {
    #[test]
    fn every_row_lies_within_its_tolerance() {
        for row in super::all().unwrap() {
            assert!(row.is_pass(), "{row:?}");
        }
    }
}
