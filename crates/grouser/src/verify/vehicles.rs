//! Cases of the pressure–sinkage model of vehicles.

use super::{Case, Row};
use grouser_iscm::verification::{CASES, Row as VehicleRow};

/// Every case of `grouser-iscm`.
pub fn cases() -> impl Iterator<Item = Case> {
    CASES.iter().map(|&(name, rows)| Case {
        name,
        rows: Box::new(move || rows().into_iter().map(Row::from).collect()),
    })
}

impl From<VehicleRow> for Row {
    fn from(row: VehicleRow) -> Self {
        let pass = row.is_passed();
        let VehicleRow { case, quantity, computed, reference, tolerance, unit, source } = row;
        Self {
            case: case.into(),
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
