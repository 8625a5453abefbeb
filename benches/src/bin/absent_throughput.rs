//! What a scene does not use costs nothing: `cargo xtask bench absent` fails where it does.
//!
//! A bed at rest without rotation law, tool, probes and active zone is timed against loops of just that: a plain loop over its contacts
//! and its floor written for this one law, the same bed with a rotation law that does nothing, and steps made phase by phase. Runs alternate; the
//! fastest of each counts.

use benches::beds::{BedOf, LAW, Law, SAND};
use benches::figures::Figures;
use clap::Parser;
use grouser_contact::*;
use grouser_dem::*;
use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;

/// Fails when something absent costs time.
#[derive(Parser)]
struct Arguments {
    /// How much slower than the loop of just that a scene may be, for noise [-]
    #[arg(long, default_value_t = 0.08)]
    margin: f64,
    /// Steps of each of seven repeats, of which the fastest counts
    #[arg(long, default_value_t = 200)]
    steps: u64,
    /// Threads: one
    #[arg(long, default_value_t = 1)]
    threads: usize,
    /// Write the figures as JSON
    #[arg(long)]
    json: Option<PathBuf>,
}

/// Contacts of a bed at rest, looped over as one would write it by hand: no lists to renew, no law to choose, no blocks.
struct ByHand {
    spheres: Vec<Sphere>,
    accelerations: Vec<[Vector<f64>; 2]>,
    loads: Vec<Load>,
    pairs: Vec<([u32; 2], Vector<f64>)>,
    springs: Vec<Vector<f64>>,
    /// Grains of the lowest layer, and their springs at the floor.
    lowest: Vec<u32>,
    floor_springs: Vec<Vector<f64>>,
    pair: PairProperties,
    dt: f64,
}

impl ByHand {
    fn of(bed: &Bed<Law>, dt: f64) -> Self {
        let spheres = bed.grains().spheres.clone();
        let size = bed.settings().domain.size();
        let pairs: Vec<_> = bed
            .contacts()
            .map(|[i, j]| {
                let mut shift = (spheres[i as usize].position - spheres[j as usize].position).to_array();
                for axis in 0..3 {
                    let is_periodic = bed.settings().domain.is_periodic[axis];
                    shift[axis] =
                        if is_periodic { size[axis] * (shift[axis] / size[axis]).round() } else { 0.0 };
                }
                ([i, j], Vector::from(shift))
            })
            .collect();
        let lowest: Vec<u32> =
            (0..spheres.len() as u32).filter(|&i| spheres[i as usize].position.z < 0.006).collect();
        Self {
            floor_springs: vec![Vector::ZERO; lowest.len()],
            lowest,
            accelerations: vec![[Vector::ZERO; 2]; spheres.len()],
            loads: vec![Load::default(); spheres.len()],
            springs: vec![Vector::ZERO; pairs.len()],
            pairs,
            spheres,
            pair: *bed.pair_table().pair(0, 0),
            dt,
        }
    }

    fn step(&mut self) {
        let (dt, half) = (self.dt, 0.5 * self.dt);
        for ((sphere, load), [linear, angular]) in
            self.spheres.iter_mut().zip(&mut self.loads).zip(&self.accelerations)
        {
            sphere.position += (sphere.velocity + *linear * half) * dt;
            sphere.velocity += *linear * dt;
            sphere.spin += *angular * dt;
            *load = Load::default();
        }
        for (&([i, j], shift), spring) in self.pairs.iter().zip(&mut self.springs) {
            let (a, b) = (self.spheres[i as usize], self.spheres[j as usize]);
            let difference = a.position - b.position - shift;
            let (distance, reach) = (difference.norm(), a.radius + b.radius);
            if distance >= reach {
                *spring = Vector::ZERO;
                continue;
            }
            let overlap = reach - distance;
            let arms = [a.radius - 0.5 * overlap, b.radius - 0.5 * overlap];
            let normal = difference * (1.0 / distance);
            let contact = Contact {
                overlap,
                normal,
                velocity: ContactVelocity::of(
                    a.velocity - b.velocity - (a.spin * arms[0] + b.spin * arms[1]).cross(normal),
                    normal,
                ),
                normal_spin: 0.5 * (a.spin + b.spin).dot(normal),
                effective_radius: a.radius * b.radius / reach,
                effective_mass: a.mass * b.mass / (a.mass + b.mass),
                time_step: dt,
            };
            let (force, couple) = answer(&contact, &self.pair, spring);
            self.loads[i as usize].add(force, couple * -arms[0]);
            self.loads[j as usize].add(-force, couple * -arms[1]);
        }
        for (&i, spring) in self.lowest.iter().zip(&mut self.floor_springs) {
            let grain = self.spheres[i as usize];
            let overlap = grain.radius - grain.position.z;
            if overlap <= 0.0 {
                *spring = Vector::ZERO;
                continue;
            }
            let (normal, arm) = (Vector::new(0.0, 0.0, 1.0), grain.radius - overlap);
            let contact = Contact {
                overlap,
                normal,
                velocity: ContactVelocity::of(grain.velocity - (grain.spin * arm).cross(normal), normal),
                normal_spin: 0.5 * grain.spin.dot(normal),
                effective_radius: grain.radius,
                effective_mass: grain.mass,
                time_step: dt,
            };
            let (force, couple) = answer(&contact, &self.pair, spring);
            self.loads[i as usize].add(force, couple * -arm);
        }
        let gravity = Vector::new(0.0, 0.0, -9.81);
        for ((sphere, load), [linear, angular]) in
            self.spheres.iter_mut().zip(&self.loads).zip(&mut self.accelerations)
        {
            let after = [load.force * (1.0 / sphere.mass) + gravity, load.torque * (1.0 / sphere.inertia())];
            sphere.velocity += (after[0] - *linear) * half;
            sphere.spin += (after[1] - *angular) * half;
            [*linear, *angular] = after;
        }
    }
}

/// Force on the first grain, and its couple over the arm.
#[inline(always)]
fn answer(
    contact: &Contact<f64>,
    pair: &PairProperties,
    spring: &mut Vector<f64>,
) -> (Vector<f64>, Vector<f64>) {
    let (response, remembered) = LAW.respond(contact, pair, *spring);
    *spring = remembered;
    let tangential = response.tangential_force;
    (contact.normal * response.normal_force + tangential, contact.normal.cross(tangential))
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global()?;
    let radii = RadiusDistribution::Uniform { from_m: 0.0038, to_m: 0.0042 };
    let bed_of = BedOf { radii, n_grains: 5_000, width: [0.1, 0.1] };
    let dt = bed_of.time_step();
    let mut bed = bed_of.settled()?;
    let between = Interaction { restitution: 0.5, friction: 0.5 };
    let table = PairTable::new(&[SAND], Tail::Keep, |_, _| between)?;
    let nothing = Rotating { forces: LAW, rotation: Free };
    let mut free = Bed::new(bed.grains().spheres.clone(), bed.settings().clone(), table, nothing)?;
    let mut phases = bed.clone();
    let mut by_hand = ByHand::of(&bed, dt);
    let n_steps = arguments.steps;
    let mut fastest = [f64::INFINITY; 4];
    for repeat in 0..8 {
        let mut times = [0.0; 4];
        let begun = Instant::now();
        bed.run(n_steps, dt, |_| Ok::<(), Failure>(()))?;
        times[0] = begun.elapsed().as_secs_f64();
        let begun = Instant::now();
        (0..n_steps).for_each(|_| by_hand.step());
        times[1] = begun.elapsed().as_secs_f64();
        let begun = Instant::now();
        free.run(n_steps, dt, |_| Ok::<(), Failure>(()))?;
        times[2] = begun.elapsed().as_secs_f64();
        let begun = Instant::now();
        for _ in 0..n_steps {
            phases.predict(dt)?;
            phases.contact_forces(dt);
            phases.correct(dt);
        }
        times[3] = begun.elapsed().as_secs_f64();
        if repeat > 0 {
            (0..4).for_each(|k| fastest[k] = fastest[k].min(times[k]));
        }
    }
    std::hint::black_box(&by_hand.spheres);
    let mut figures = Figures::new("absent", arguments.threads);
    let loops =
        ["a plain loop over its contacts", "a rotation law that does nothing", "steps phase by phase"];
    let mut is_ok = true;
    for (case, other) in loops.into_iter().zip(&fastest[1..]) {
        let ratio = fastest[0] / other;
        figures.push(case, "time of the scene over time of the loop", ratio, "-");
        is_ok &= ratio <= 1.0 + arguments.margin;
    }
    figures.write(arguments.json.as_deref())?;
    if is_ok {
        Ok(())
    } else {
        Err(format!("something absent costs more than {:.0} %", 100.0 * arguments.margin).into())
    }
}
