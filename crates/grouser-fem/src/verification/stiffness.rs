//! Zero modes of the stiffness, and stress as the derivative of the stored energy.

use grouser_geometry::nalgebra::DMatrix;

use super::{ELEMENTS, Row, VerificationError, irregular_cube};
use crate::law::Law;
use crate::tensor::Tensor;
use crate::{Elasticity, Formulation, Material, Settings, Solid};

/// Number of zero and of negative modes for each element and formulation, and the worst derivative of each law.
pub(super) fn rows() -> Result<Vec<Row>, VerificationError> {
    let mut rows = Vec::new();
    for (name, volumetric, is_quadratic) in ELEMENTS {
        for formulation in [Formulation::BodyAttached, Formulation::Corotational, Formulation::FiniteStrain] {
            let settings = Settings { formulation, volumetric, ..Default::default() };
            let material = Material::hooke(1000.0, 1e9, 0.45);
            let k = Solid::new(irregular_cube(1, is_quadratic), vec![material], settings)?.stiffness();
            let mut dense = DMatrix::zeros(3 * k.n_rows(), 3 * k.n_rows());
            for i in 0..k.n_rows() {
                for (j, block) in k.row(i) {
                    dense.fixed_view_mut::<3, 3>(3 * i, 3 * j).copy_from(block);
                }
            }
            let eigenvalues = dense.symmetric_eigenvalues();
            let zero = 1e-12 * eigenvalues.max();
            let row = |quantity: &str, computed: usize, reference: f64| Row {
                case: format!("stiffness at ν = 0.45, {name}, {formulation:?}"),
                quantity: quantity.to_owned(),
                computed: computed as f64,
                reference,
                tolerance: 0.0,
                unit: "–",
                source: "rigid motions (P0 Eq. 34 with λ and μ in place)",
            };
            rows.push(row(
                "modes without stiffness",
                eigenvalues.iter().filter(|l| l.abs() <= zero).count(),
                6.0,
            ));
            rows.push(row(
                "modes of negative stiffness",
                eigenvalues.iter().filter(|l| **l < -zero).count(),
                0.0,
            ));
        }
    }
    let hooke = Elasticity::Hooke { young_modulus: 20e6, poisson_ratio: 0.45 };
    let mooney_rivlin = Elasticity::MooneyRivlin { c10: 0.6e6, c01: 0.2e6, bulk_modulus: 80e6 };
    let yeoh = Elasticity::Yeoh { c10: 0.8e6, c20: -0.05e6, c30: 0.02e6, bulk_modulus: 80e6 };
    for law in [
        hooke.law(Formulation::BodyAttached),
        hooke.law(Formulation::Corotational),
        hooke.law(Formulation::FiniteStrain),
        mooney_rivlin.law(Formulation::FiniteStrain),
        yeoh.law(Formulation::FiniteStrain),
    ] {
        rows.push(Row {
            case: format!("stress by the stored energy, {}", name_of(&law)),
            quantity: "largest |P − Δψ/ΔF| over |P|".to_owned(),
            computed: worst_derivative(&law),
            reference: 0.0,
            tolerance: 1e-7,
            unit: "–",
            source: "central differences of ψ",
        });
    }
    Ok(rows)
}

fn name_of(law: &Law) -> &'static str {
    match law {
        Law::SmallStrain(_) => "small strain",
        Law::Corotational(_) => "corotational",
        Law::NeoHookean(_) => "neo-Hookean",
        Law::MooneyRivlin(_) => "Mooney–Rivlin",
        Law::Yeoh(_) => "Yeoh",
    }
}

fn worst_derivative(law: &Law) -> f64 {
    let mut worst = 0.0f64;
    for k in 0..20 {
        let h = Tensor::from_fn(|i, j| 0.25 * (f64::from(k) * 1.7 + 3.0 * i as f64 + 5.0 * j as f64).sin());
        let stress = law.stress(&h);
        let size = stress.dot(&stress).sqrt();
        let step = 1e-5;
        for i in 0..3 {
            for j in 0..3 {
                let energy = |d: f64| {
                    let mut moved = h;
                    moved.0[i][j] += d;
                    law.energy(&moved)
                };
                let difference = (energy(step) - energy(-step)) / (2.0 * step);
                worst = worst.max((stress.0[i][j] - difference).abs() / size);
            }
        }
    }
    worst
}
