//! Cost per grain of beds of 5,000 to 180,000 grains, all copies of one bed side by side: `cargo xtask bench growth`.

use benches::beds::{BedOf, cost};
use benches::figures::Figures;
use clap::Parser;
use grouser_dem::RadiusDistribution;
use std::error::Error;
use std::path::PathBuf;

/// Cost per grain against the number of grains.
#[derive(Parser)]
struct Arguments {
    /// Copies of the bed of 5,000 grains along x and along y
    #[arg(long, value_delimiter = ',', default_value = "1,2,3,4,6")]
    tiles: Vec<usize>,
    /// Steps of each of three repeats, of which the fastest counts, for 5,000 grains; fewer for more
    #[arg(long, default_value_t = 2000)]
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
    let radii = RadiusDistribution::Uniform { from_m: 0.0038, to_m: 0.0042 };
    let bed_of = BedOf { radii, n_grains: 5_000, width: [0.1, 0.1] };
    let mut figures = Figures::new("growth", arguments.threads);
    let mut of_first = 0.0;
    for &tiles in &arguments.tiles {
        let mut bed = bed_of.tiled([tiles; 2])?;
        let n_grains = bed.grains().len();
        let n_steps = (arguments.steps / (tiles * tiles) as u64).max(50);
        let time = cost(&mut bed, bed_of.time_step(), n_steps, 3)?;
        if of_first == 0.0 {
            of_first = time;
        }
        let case = format!("{n_grains} grains");
        figures.push(&case, "grain-steps per second", 1.0 / time, "1/s");
        figures.push(&case, "cost per grain-step", 1e9 * time, "ns");
        figures.push(&case, "cost per grain over that of the first bed", time / of_first, "-");
        figures.push(&case, "memory per grain", bed.bytes() as f64 / n_grains as f64, "B");
    }
    figures.write(arguments.json.as_deref())
}
