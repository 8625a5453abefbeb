//! Forces of single polygons and blended relationships.

use super::Row;
use crate::polygon::{SubTriangles, polygon_force};
use crate::pressure::{Polynomial, PressureArray, PressureLaw, SpatialLaws, read_located_laws};
use grouser_geometry::HeightGrid;

/// ∫ over the triangle part where `inside` of Σ c_m z^m by the exact formula for monomials over sub-triangles of corners.
fn exact_over(corners: [f64; 3], area: f64, coefficients: &[f64]) -> f64 {
    // ∫ z^m dA = 2 A m!/(m+2)! h_m(z₁, z₂, z₃), h_m the complete homogeneous symmetric polynomial.
    let complete = |m: usize| -> f64 {
        let mut sum = 0.0;
        for a in 0..=m {
            for b in 0..=m - a {
                sum += corners[0].powi(a as i32)
                    * corners[1].powi(b as i32)
                    * corners[2].powi((m - a - b) as i32);
            }
        }
        sum
    };
    coefficients
        .iter()
        .enumerate()
        .map(|(k, c)| c * 2.0 * area * complete(k + 1) / ((k + 2) as f64 * (k + 3) as f64))
        .sum()
}

fn degree_eight() -> Vec<f64> {
    vec![4e5, 3e6, -2e7, 9e7, 4e8, -6e8, 2e9, 5e9]
}

fn rows(
    case: &'static str,
    is_loaded: [bool; 3],
    exact: impl Fn([f64; 3], f64) -> f64,
    order: f64,
) -> Vec<Row> {
    let law = PressureLaw::Polynomial(Polynomial { coefficients: degree_eight() });
    let array = PressureArray::new(&law, 1e-4, 0.3).expect("the polynomial is positive");
    let polygons = [[0.02, 0.05, 0.11], [0.18, 0.20, 0.15], [0.0, 0.03, 0.01], [0.1, 0.1, 0.1]];
    let area = 8e-4;
    let error = |resolution: usize| {
        let sub = SubTriangles::new(resolution);
        let relative = |z: &[f64; 3]| {
            let reference = exact(*z, area);
            (polygon_force(&sub, &array, *z, is_loaded, area) / reference - 1.0).abs()
        };
        polygons.iter().map(relative).fold(0.0, f64::max)
    };
    let observed = (error(8) / error(16)).log2();
    let source = "integral of the polynomial in closed form";
    vec![
        Row {
            case,
            quantity: "largest relative error, resolution 16".into(),
            computed: error(16),
            reference: 0.0,
            tolerance: 4e-3,
            unit: "-",
            source,
        },
        Row {
            case,
            quantity: "observed order, 8 to 16".into(),
            computed: observed,
            reference: order,
            tolerance: 0.15,
            unit: "-",
            source: "midpoint rule",
        },
    ]
}

/// All corners loaded.
pub fn polygon_force_full() -> Vec<Row> {
    rows("P2 test 1: polygon force", [true; 3], |z, area| exact_over(z, area, &degree_eight()), 2.0)
}

/// One corner, and two corners loaded: a quarter and three quarters of the polygon.
pub fn polygon_force_partial() -> Vec<Row> {
    let case = "P2 test 2: polygon force, partial load";
    let quarter = |z: [f64; 3], area: f64| {
        exact_over([z[0], (z[0] + z[1]) / 2.0, (z[0] + z[2]) / 2.0], area / 4.0, &degree_eight())
    };
    let mut all = rows(case, [true, false, false], quarter, 2.0);
    let rest = |z: [f64; 3], area: f64| exact_over(z, area, &degree_eight()) - quarter(z, area);
    all.extend(rows(case, [false, true, true], rest, 2.0));
    all
}

/// The three relationships of P2 Fig. 2 read from text, blended on a grid with two widths, read back at its nodes.
pub fn relationships_from_a_file() -> Vec<Row> {
    let case = "P2 test 24: relationships from a data file";
    let text = "# name x y sinkage pressure [m, m, m, Pa]\nhard 1 1 0.1 1e6\nhard 1 1 0.4 4e6\nsoft, 1, 2, 0.1, 1e5\n\
                soft, 1, 2, 0.4, 4e5\nfirm 1 3 0.1 8.5e5\nfirm 1 3 0.4 3.4e6\n";
    // (c, x, y, averaged slope [MPa/m]) by P2 Eqs. (2), (3) in another program.
    let references = [
        (0.5, 1.0, 1.0, 10.0),
        (0.5, 1.0, 2.0, 1.0),
        (0.5, 1.0, 1.5, 5.997_799_621),
        (0.5, 1.25, 1.5, 6.070_200_764),
        (0.5, 1.25, 2.0, 2.737_941_590),
        (0.5, 1.75, 1.0, 6.905_461_778),
        (0.5, 2.0, 4.0, 6.512_278_456),
        (1.5, 1.0, 1.5, 5.692_777_171),
        (1.5, 1.25, 2.0, 1.956_660_035),
        (1.5, 1.75, 2.0, 4.669_484_350),
        (1.5, 0.5, 0.5, 8.246_918_773),
        (1.5, 2.0, 4.0, 6.740_802_178),
        // Beyond 5 c of all three every weight is 1.
        (0.1, 2.0, 4.0, 6.5),
    ];
    let row = |&(c, x, y, reference): &(f64, f64, f64, f64)| {
        let slope = || -> Option<f64> {
            let laws = read_located_laws(text.as_bytes()).ok()?;
            let grid = HeightGrid::covering([0.0, 0.0], [2.0, 4.0], 0.25, |_, _| 0.0).ok()?;
            let field = SpatialLaws { laws, standard_deviation: c }.field(&grid, 0.005, 0.4).ok()?;
            let node = (y / 0.25) as usize * grid.n_x() + (x / 0.25) as usize;
            let pressures = field.of_node(node);
            Some(pressures[60] / (60.0 * field.resolution()) / 1e6)
        };
        let quantity = format!("slope at ({x}, {y}) m, c = {c} m");
        let source = "P2 Eqs. (2), (3), independent evaluation";
        Row::new(case, quantity, slope().unwrap_or(f64::NAN), reference, 1e-8, "MPa/m", source)
    };
    references.iter().map(row).collect()
}
