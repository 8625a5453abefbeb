//! Every case of the verification module within its tolerance.

use grouser_iscm::verification::CASES;

#[test]
fn every_published_case_is_within_its_tolerance() {
    let rows: Vec<_> = CASES
        .iter()
        .flat_map(|(name, case)| {
            let rows = case();
            assert!(!rows.is_empty(), "{name} computed nothing");
            rows
        })
        .collect();
    for row in &rows {
        println!(
            "{} {} {}: {} against {} ± {} {}",
            if row.is_passed() { "ok" } else { "FAILED" },
            row.case,
            row.quantity,
            row.computed,
            row.reference,
            row.tolerance,
            row.unit
        );
    }
    assert!(rows.iter().all(|row| row.is_passed()));
}
