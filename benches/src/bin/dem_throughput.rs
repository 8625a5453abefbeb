//! Grain-steps per second of a bed.
use grouser_contact::*;
use grouser_dem::*;
use grouser_geometry::Vec3;
use std::time::Instant;

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let text = std::fs::read_to_string(&args[1]).unwrap();
    let steps: usize = args[2].parse().unwrap();
    let threads: usize = args.get(3).map_or(1, |t| t.parse().unwrap());
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().unwrap();
    let mut spheres = Vec::new();
    for line in text.lines().skip(2) {
        let v: Vec<f64> = line.split_whitespace().map(|x| x.parse().unwrap()).collect();
        let r = v[1];
        spheres.push(Sphere::<F64> {
            position: Vector::new(v[2], v[3], v[4]),
            radius: r,
            velocity: Vector::ZERO,
            mass: 2600.0 * 4.0 / 3.0 * std::f64::consts::PI * r * r * r,
            spin: Vector::ZERO,
            material: 0,
        });
    }
    let n = spheres.len();
    let material = Material { young_pa: 1e7, poisson: 0.3, density_kg_m3: 2600.0 };
    let table =
        PairTable::new(&[material], Tail::Keep, |_, _| Interaction { restitution: 0.5, friction: 0.5 })
            .unwrap();
    let settings = BedSettings {
        domain: Domain {
            lower: Vec3::new(0.0, 0.0, -0.01),
            upper: Vec3::new(0.2, 0.2, 0.5),
            is_periodic: [true, true, false],
        },
        planes: vec![Plane { point: Vec3::zeros(), normal: Vec3::z(), material: 0 }],
        gravity: Vec3::new(0.0, 0.0, -9.81),
        rotation: Rotation::Free,
        has_ledger: args.get(4).is_some(),
    };
    let mut bed = Bed::new(spheres, settings, table, HertzMindlin::<true, false>).unwrap();
    let dt = 4e-5;
    for _ in 0..200 {
        bed.step(dt).unwrap();
    }
    let mut best = 0.0_f64;
    for _ in 0..5 {
        let t = Instant::now();
        bed.run(steps as u64 / 5, dt, |_| Ok::<(), Failure>(())).unwrap();
        best = best.max(n as f64 * (steps / 5) as f64 / t.elapsed().as_secs_f64());
    }
    let e = bed.energy();
    println!(
        "{:.2} M grain-steps/s; contacts/grain {:.3}, listed/grain {:.2}, rebuilds {}, skin {:.3e}, ke {:.3e}, bytes/grain {}, floor {:?} weight {:.4}, {:?}",
        best / 1e6,
        2.0 * bed.n_contacts() as f64 / n as f64,
        bed.n_listed() as f64 / n as f64,
        bed.n_rebuilds(),
        bed.skin(),
        e.kinetic + e.rotational,
        bed.bytes() / n,
        bed.plane_force(0),
        bed.grains().spheres.iter().map(|s| s.mass).sum::<f64>() * 9.81,
        bed.deepest_overlap()
    );
}
