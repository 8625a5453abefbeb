//! Cost per grain of beds whose sizes differ, over that of a bed of nearly equal grains: `cargo xtask bench sizes`.
//!
//! 10,000 grains at rest; graded beds spread their mass evenly over the logarithm of size, and their mean grain has the volume of a
//! sphere of 3.5 mm. Beds are kept in the build folder, so that only the first run settles them.

use benches::beds::{BedOf, cost};
use benches::figures::Figures;
use clap::Parser;
use grouser_dem::{Failure, RadiusDistribution};
use std::error::Error;
use std::path::PathBuf;

/// Cost per grain against the ratio of sizes.
#[derive(Parser)]
struct Arguments {
    /// Grains of each bed
    #[arg(long, default_value_t = 10_000)]
    grains: usize,
    /// Ratios of the largest to the smallest radius
    #[arg(long, value_delimiter = ',', default_value = "3,10")]
    ratios: Vec<f64>,
    /// Steps of each of five repeats, of which the fastest counts
    #[arg(long, default_value_t = 300)]
    steps: u64,
    /// Threads
    #[arg(long, default_value_t = 1)]
    threads: usize,
    /// Write the figures as JSON
    #[arg(long)]
    json: Option<PathBuf>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    rayon::ThreadPoolBuilder::new().num_threads(arguments.threads).build_global()?;
    let equal = RadiusDistribution::Uniform { from_m: 0.0038, to_m: 0.0042 };
    let graded = |&ratio: &f64| {
        let unit = RadiusDistribution::Graded { from_m: 1.0, to_m: ratio };
        let from_m = 3.5e-3 * (4.0 / 3.0 * std::f64::consts::PI / unit.mean_volume()).cbrt();
        (format!("graded {ratio}:1"), RadiusDistribution::Graded { from_m, to_m: from_m * ratio })
    };
    let mut figures = Figures::new("sizes", arguments.threads);
    let mut of_equal = 0.0;
    for (case, radii) in
        [("equal ± 5 %".to_owned(), equal)].into_iter().chain(arguments.ratios.iter().map(graded))
    {
        let bed_of = BedOf { radii, n_grains: arguments.grains, width: [0.2, 0.2] };
        let mut bed = bed_of.settled()?;
        bed.run(200, bed_of.time_step(), |_| Ok::<(), Failure>(()))?;
        let time = cost(&mut bed, bed_of.time_step(), arguments.steps, 5)?;
        if of_equal == 0.0 {
            of_equal = time;
        }
        let n_grains = bed.grains().len() as f64;
        figures.push(&case, "grain-steps per second", 1.0 / time, "1/s");
        figures.push(&case, "cost per grain over that of equal grains", time / of_equal, "-");
        figures.push(
            &case,
            "contacts per grain, both sides counted",
            2.0 * bed.n_contacts() as f64 / n_grains,
            "-",
        );
        figures.push(&case, "listed pairs per grain", bed.n_listed() as f64 / n_grains, "-");
        // A rebuild of unmoved lists, without what settling has to do with it.
        let begun = std::time::Instant::now();
        for _ in 0..5 {
            bed.renew_lists()?;
        }
        let rebuild = begun.elapsed().as_secs_f64() / 5.0 / n_grains;
        figures.push(&case, "making the lists, per grain", 1e9 * rebuild, "ns");
    }
    figures.write(arguments.json.as_deref())
}
