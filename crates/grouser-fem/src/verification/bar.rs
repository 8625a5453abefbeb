//! Bar under a suddenly applied end force.

use grouser_geometry::{Vec3, box_mesh};

use super::{Row, VerificationError};
use crate::{Material, Settings, Solid};

/// Peak displacement of the end and when it comes.
pub(super) fn rows() -> Result<Vec<Row>, VerificationError> {
    let mesh = box_mesh(Vec3::new(1.0, 0.1, 0.1), [40, 2, 2]);
    let mut bar = Solid::new(mesh, vec![Material::hooke(1000.0, 1e9, 0.0)], Settings::default())?;
    bar.fix("x_min")?;
    bar.add_pressure("x_max", -1e4)?;
    let tip = bar.mesh().nodes_of("x_max")?;
    let dt = 0.9 * bar.stable_time_step().dt;
    let (mut peak, mut time) = (0.0, 0.0);
    while bar.state.time < 2.5e-3 {
        bar.step(dt)?;
        let u = tip.iter().map(|&n| bar.state.displacement[n as usize].x).sum::<f64>() / tip.len() as f64;
        if u > peak {
            (peak, time) = (u, bar.state.time);
        }
    }
    let row = |quantity: &str, computed, reference: f64, unit, source| Row {
        case: "bar under a sudden end force".to_owned(),
        quantity: quantity.to_owned(),
        computed,
        reference,
        tolerance: 0.02 * reference,
        unit,
        source,
    };
    Ok(vec![
        row(
            "peak displacement of the end",
            peak,
            2e-5,
            "m",
            "Graff, Wave Motion in Elastic Solids: 2 F L / (E A)",
        ),
        row("time of the peak", time, 2e-3, "s", "Graff, Wave Motion in Elastic Solids: 2 L / c"),
    ])
}
