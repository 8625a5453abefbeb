//! Cases with an analytical or published answer. One case is one function; a new one is a row of [`cases`].

mod angular;
mod angular_rest;
mod bodies;
mod chung_ooi;
mod coupling;
mod elastic_block;
mod precision;
mod solids;
mod spread_contact;
mod two_bodies;
mod vehicles;

use serde::Serialize;

/// A number, what it should be, and how far it may be off.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Name of the case.
    pub case: String,
    /// What is compared.
    pub quantity: String,
    /// What grouser finds.
    pub computed: f64,
    /// What it should be.
    pub reference: f64,
    /// Largest allowed difference, in the unit of the quantity.
    pub tolerance: f64,
    /// Unit.
    pub unit: String,
    /// Where the reference is from.
    pub source: String,
    /// The difference is within the tolerance.
    pub pass: bool,
}

impl Row {
    /// A comparison with an absolute tolerance.
    pub fn absolute(
        (case, source): (&str, &str),
        quantity: impl Into<String>,
        unit: &str,
        computed: f64,
        (reference, tolerance): (f64, f64),
    ) -> Self {
        Self {
            case: case.into(),
            quantity: quantity.into(),
            computed,
            reference,
            tolerance,
            unit: unit.into(),
            source: source.into(),
            pass: (computed - reference).abs() <= tolerance,
        }
    }

    /// A comparison with a tolerance relative to the reference.
    pub fn relative(
        case: (&str, &str),
        quantity: impl Into<String>,
        unit: &str,
        computed: f64,
        (reference, tolerance): (f64, f64),
    ) -> Self {
        Self::absolute(case, quantity, unit, computed, (reference, tolerance * reference.abs()))
    }

    /// The row as a line of text.
    pub fn line(&self) -> String {
        let number = |value: f64| {
            if value == 0.0 || (1e-3..1e6).contains(&value.abs()) {
                format!("{value:.6}")
            } else {
                format!("{value:.6e}")
            }
        };
        let mark = if self.pass { "pass" } else { "FAIL" };
        format!(
            "  {mark}  {:<52} {:>16} {:>16} ± {:<10.1e} {:<6} {}",
            self.quantity,
            number(self.computed),
            number(self.reference),
            self.tolerance,
            self.unit,
            self.source
        )
    }
}

/// A named case.
pub struct Case {
    /// Name.
    pub name: &'static str,
    /// Computes its rows.
    pub rows: Box<dyn Fn() -> Vec<Row>>,
}

/// Every case.
pub fn cases() -> Vec<Case> {
    let grains = GRAINS.iter().map(|&(name, rows)| Case { name, rows: Box::new(rows) });
    grains.chain(solids::cases()).chain(vehicles::cases()).collect()
}

/// What a case computes.
type Rows = fn() -> Vec<Row>;

/// Cases of grains.
const GRAINS: &[(&str, Rows)] = &[
    ("chung-ooi-1 two elastic spheres", chung_ooi::test_1),
    ("chung-ooi-2 elastic sphere on a wall", chung_ooi::test_2),
    ("chung-ooi-3 restitution", chung_ooi::test_3),
    ("chung-ooi-4 oblique impacts", chung_ooi::test_4),
    ("oblique impacts in default steps", chung_ooi::default_step),
    ("chung-ooi-7 spinning spheres", chung_ooi::test_7),
    ("slip-to-roll", two_bodies::slip_to_roll),
    ("rolling on an incline", two_bodies::incline),
    ("free fall with bounces", two_bodies::bounces),
    ("a stack at rest", two_bodies::stack),
    ("tilting arms", angular::arms_and_sign_change),
    ("toppling", angular::toppling),
    ("tilting limits", angular::limits),
    ("tilting energy", angular::energy),
    ("angular grains at rest", angular_rest::rest_and_extremes),
    ("cut surfaces", coupling::cut_surfaces),
    ("rolling over triangles", coupling::rolling_over_triangles),
    ("bead on an elastic block", elastic_block::bead_on_block),
    ("bead pressed into an elastic block", elastic_block::bead_pressed),
    ("bead pressed into ever finer cells", spread_contact::bead_pressed_into_fine_cells),
    ("mixed precision", precision::mixed),
    ("single precision", precision::single),
];
