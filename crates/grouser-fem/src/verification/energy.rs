//! Energy over a million steps at 0.95 of the stable step, and a step above the true limit.

use grouser_geometry::Vec3;

use super::{Row, VerificationError, irregular_cube};
use crate::{Formulation, Material, Settings, Solid};

const STEPS: u64 = 1_000_000;

/// Drift of the energy and detection of a step 2 % above the limit.
pub(super) fn rows() -> Result<Vec<Row>, VerificationError> {
    let mut rows = Vec::new();
    let build = |formulation| -> Result<Solid, VerificationError> {
        let settings = Settings { formulation, ..Default::default() };
        let mut solid =
            Solid::new(irregular_cube(1, false), vec![Material::hooke(1000.0, 1e9, 0.3)], settings)?;
        for (i, v) in solid.state.velocity.iter_mut().enumerate() {
            *v = Vec3::new((i as f64).sin(), (2.0 * i as f64).cos(), 0.3) * 1e-3;
        }
        Ok(solid)
    };
    for formulation in [Formulation::BodyAttached, Formulation::Corotational] {
        let mut solid = build(formulation)?;
        let dt = 0.95 * solid.stable_time_step().dt;
        // Largest energy of the first and of the last tenth, at every tenth step.
        let mut largest = [0.0f64; 2];
        for step in 0..STEPS {
            solid.step(dt)?;
            let tenth = 10 * step / STEPS;
            if step % 10 == 0 && (tenth == 0 || tenth == 9) {
                let energy = solid.kinetic_energy() + solid.strain_energy();
                largest[usize::from(tenth == 9)] = largest[usize::from(tenth == 9)].max(energy);
            }
        }
        rows.push(Row {
            case: format!("a million steps at 0.95 of the stable step, {formulation:?}"),
            quantity: "largest energy of the last tenth over that of the first".to_owned(),
            computed: largest[1] / largest[0],
            reference: 1.0,
            tolerance: 0.01,
            unit: "–",
            source: "central differences keep a bounded energy",
        });
    }
    let limit = true_limit(&mut build(Formulation::BodyAttached)?)?;
    for (factor, is_refused) in [(0.99, false), (1.01, true)] {
        let mut solid = build(Formulation::BodyAttached)?;
        let failure = (0..20_000).find_map(|_| solid.step(factor * limit).err());
        rows.push(Row {
            case: format!("{factor} of the true stable step"),
            quantity: "runs refused as unstable".to_owned(),
            computed: f64::from(failure.is_some()),
            reference: f64::from(is_refused),
            tolerance: 0.0,
            unit: "–",
            source: "2/ω of the largest frequency, by power iteration",
        });
    }
    Ok(rows)
}

/// 2/ω [s] with ω² the largest eigenvalue of M⁻¹K, by power iteration on accelerations.
fn true_limit(solid: &mut Solid) -> Result<f64, VerificationError> {
    let norm = |v: &[Vec3]| v.iter().map(Vec3::norm_squared).sum::<f64>().sqrt();
    let n = solid.mesh().nodes.len();
    let start = |i: usize| Vec3::new((7.0 * i as f64).sin(), (3.0 * i as f64).cos(), (i as f64).sin());
    let mut u: Vec<Vec3> = (0..n).map(|i| start(i) * 1e-6).collect();
    let mut square = 0.0;
    for _ in 0..5000 {
        solid.state.displacement.clone_from(&u);
        solid.state.velocity.fill(Vec3::zeros());
        solid.step(0.0)?;
        square = norm(&solid.state.acceleration) / norm(&u);
        let scale = -1e-6 / norm(&solid.state.acceleration);
        u = solid.state.acceleration.iter().map(|a| a * scale).collect();
    }
    Ok(2.0 / square.sqrt())
}
