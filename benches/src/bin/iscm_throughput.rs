//! Time of one operating point of a driven wheel, by fidelity and fineness of the grid.

use std::time::Instant;

use grouser_iscm::pressure::{Bekker, PressureLaw};
use grouser_iscm::shear::JanosiHanamoto;
use grouser_iscm::wheel::{PressurePeak, SingleWheel, WheelSoil, closed_form, grid};

fn main() {
    let wheel = SingleWheel { radius: 0.0625, width: 0.06, lugs: None, load: 24.6 };
    let soil = WheelSoil {
        pressure: PressureLaw::Bekker(Bekker {
            cohesive_modulus: -169e3,
            frictional_modulus: 9219e3,
            exponent: 1.328,
            plate_width: 0.04,
        }),
        shear: JanosiHanamoto {
            cohesion: 0.0,
            friction_angle: 29_f64.to_radians(),
            shear_deformation_modulus: 0.013,
        },
        peak: PressurePeak::WongReece { c_1: 0.18, c_2: 0.32 },
        rebound: None,
    };
    let slips = [0.0, 0.2, 0.5, 0.9];
    let Ok(exact) = closed_form::operating_point(&wheel, &soil, 0.2, 0.0) else {
        eprintln!("error: the wheel has no operating point in closed form");
        return;
    };
    let measure = |name: &str, n_repeats: usize, at: &dyn Fn(f64) -> Option<f64>| {
        let begun = Instant::now();
        let mut sum = 0.0;
        for _ in 0..n_repeats {
            sum += slips.iter().filter_map(|&slip| at(slip)).sum::<f64>();
        }
        let each = begun.elapsed().as_secs_f64() / (n_repeats * slips.len()) as f64;
        let error = at(0.2).map_or(f64::NAN, |sinkage| sinkage / exact.sinkage - 1.0);
        println!(
            "{name:<24} {:>9.3} ms a point   sinkage {error:+.1e} of the closed form   ({sum:.3})",
            1e3 * each
        );
    };
    measure("closed form", 2000, &|slip| {
        Some(closed_form::operating_point(&wheel, &soil, slip, 0.0).ok()?.sinkage)
    });
    for cells in [16.0, 32.0, 64.0] {
        let spacing = wheel.radius / cells;
        let settings =
            grid::GridSettings { spacing, sinkage_resolution: spacing / 16.0, integration_resolution: 4 };
        let name = format!("grid, {cells} cells a radius");
        measure(&name, 20, &|slip| {
            Some(grid::operating_point(&wheel, &soil, slip, 0.0, &settings).ok()?.sinkage)
        });
    }
}
