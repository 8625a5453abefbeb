//! Waves in a bar: a suddenly applied end force, and the first natural frequency.

use grouser_geometry::{Vec3, box_mesh};

use super::{Row, VerificationError};
use crate::{Material, Settings, Solid};

/// Peak displacement of the end and when it comes; first natural frequency.
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
    let case = "fixed-free bar, first natural frequency";
    let frequency = Row {
        case: case.to_owned(),
        quantity: "frequency, 20 cells along the bar".to_owned(),
        computed: first_frequency(2)?,
        reference: 250.0,
        tolerance: 0.25,
        unit: "Hz",
        source: "Graff, Wave Motion in Elastic Solids: c / (4 L)",
    };
    Ok(vec![
        frequency,
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

/// Frequency [Hz] of a bar of 1 m and c = 1000 m/s with 10 `n` cells along and `n` across it, from the end's passages through rest.
fn first_frequency(n: usize) -> Result<f64, VerificationError> {
    let mesh = box_mesh(Vec3::new(1.0, 0.1, 0.1), [10 * n, n, n]);
    let mut bar = Solid::new(mesh, vec![Material::hooke(1000.0, 1e9, 0.0)], Settings::default())?;
    bar.fix("x_min")?;
    for n in 0..bar.mesh().nodes.len() {
        let x = bar.mesh().nodes[n].x;
        bar.state.displacement[n].x = 1e-5 * (std::f64::consts::FRAC_PI_2 * x).sin();
    }
    let tip = bar.mesh().nodes_of("x_max")?;
    let mean = |bar: &Solid| tip.iter().map(|&n| bar.state.displacement[n as usize].x).sum::<f64>();
    // Small, so that the error is that of the mesh.
    let dt = 0.1 * bar.stable_time_step().dt;
    let (mut last, mut passages) = (mean(&bar), Vec::new());
    while passages.len() < 41 {
        bar.step(dt)?;
        let now = mean(&bar);
        if now * last < 0.0 {
            passages.push(bar.state.time - dt * now / (now - last));
        }
        last = now;
    }
    Ok(0.5 * (passages.len() - 1) as f64 / (passages[passages.len() - 1] - passages[0]))
}
