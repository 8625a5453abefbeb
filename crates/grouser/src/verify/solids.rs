//! Cases of elastic solids.

use super::{Case, Row};
use grouser_fem::verification::{self, Row as SolidRow};

/// Every case of `grouser-fem`.
pub fn cases() -> impl Iterator<Item = Case> {
    let rows = || match verification::all() {
        Ok(rows) => rows.into_iter().map(Row::from).collect(),
        Err(error) => {
            let case = ("elastic solids", "none");
            vec![Row::absolute(case, format!("not computed: {error}"), "-", f64::NAN, (0.0, 0.0))]
        }
    };
    std::iter::once(Case { name: "elastic solids", rows: Box::new(rows) })
}

impl From<SolidRow> for Row {
    fn from(row: SolidRow) -> Self {
        let pass = row.is_pass();
        let SolidRow { case, quantity, computed, reference, tolerance, unit, source } = row;
        Self {
            case,
            quantity,
            computed,
            reference,
            tolerance,
            unit: unit.into(),
            source: source.into(),
            pass,
        }
    }
}
