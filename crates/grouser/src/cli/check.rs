//! `grouser check`: what a scene is and what it will cost.

use super::{FAILED, Scene};
use crate::run::{Estimate, estimate};
use crate::scene::resolved;

pub(super) fn check(scene: &Scene) -> u8 {
    let scenario = match scene.read() {
        Ok(scenario) => scenario,
        Err(status) => return status,
    };
    print!("{}", resolved(&scenario));
    match estimate(&scenario) {
        Ok(estimate) => {
            println!("\n{}", described(&estimate));
            0
        }
        Err(error) => {
            eprintln!("error: {error}");
            FAILED
        }
    }
}

/// The estimate in a few lines.
pub(super) fn described(estimate: &Estimate) -> String {
    let step = &estimate.time_step;
    let binding = step.binding();
    format!(
        "time step   {:.3e} s, bound by the {} criterion ({} of {:.3e} s): {}\n\
         grains      {}\n\
         steps       about {} to settle the bed (none when it is in the cache), {} of the tools\n\
         memory      about {:.0} MB\n\
         pace        {:.1} million grain-steps a second on {} threads, measured just now\n\
         run time    about {:.0} s",
        step.step_s,
        binding.name,
        binding.fraction,
        binding.time_s,
        binding.place,
        estimate.n_grains,
        estimate.settling_steps,
        estimate.tool_steps,
        estimate.bytes as f64 / 1e6,
        estimate.rate / 1e6,
        rayon::current_num_threads(),
        estimate.wall().as_secs_f64()
    )
}
