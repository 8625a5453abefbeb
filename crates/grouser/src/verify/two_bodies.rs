//! Bodies on a plane against rigid-body mechanics.

use super::Row;
use super::bodies::wall;
use grouser_contact::{HertzMindlin, Interaction, Material, PairTable, Sphere, Tail};
use grouser_dem::{Bed, BedSettings, sphere};
use grouser_geometry::Vec3;

type Law = HertzMindlin;

const STEEL: Material = Material { young_pa: 2e9, poisson: 0.3, density_kg_m3: 7800.0 };
const RADIUS: f64 = 0.01;
const GRAVITY: f64 = 9.81;
/// A tenth of the Rayleigh time of the body.
const STEP: f64 = 6e-6;

/// Bodies on a plane under a given gravity.
fn bed(bodies: Vec<Sphere>, gravity: Vec3, restitution: f64, friction: f64) -> Bed<Law> {
    let between = Interaction { restitution, friction };
    let table = PairTable::new(&[STEEL], Tail::CutCorrected, |_, _| between).expect("sound");
    Bed::new(bodies, BedSettings { gravity, ..wall(0) }, table, Law::default()).expect("sound")
}

fn ball(height: f64) -> Sphere {
    sphere(Vec3::new(0.0, 0.0, height), RADIUS, STEEL.density_kg_m3, 0)
}

/// A ball that rests on the plane with the overlap that carries `load` times its weight under `gravity`.
fn resting(gravity: f64) -> Sphere {
    let modulus = PairTable::<f64>::new(&[STEEL], Tail::CutCorrected, |_, _| Interaction {
        restitution: 1.0,
        friction: 0.0,
    })
    .expect("sound")
    .pair(0, 0)
    .normal_modulus;
    let mass = ball(RADIUS).mass;
    ball(RADIUS - (mass * gravity / (modulus * RADIUS.sqrt())).powf(2.0 / 3.0))
}

fn go(bed: &mut Bed<Law>, time: f64) {
    let n_steps = (time / STEP).round() as u64;
    bed.run(n_steps, STEP, |_| Ok::<(), grouser_dem::Failure>(())).expect("well behaved");
}

/// A ball launched along a plane without spin slides, and rolls from then on.
pub fn slip_to_roll() -> Vec<Row> {
    let case = ("slip-to-roll", "v = 5/7 v₀ after 2 v₀/(7 μ g); way 12 v₀²/(49 μ g)");
    let (speed, friction) = (0.5, 0.3);
    let mut body = resting(GRAVITY);
    body.velocity.x = speed;
    let mut bed = bed(vec![body], Vec3::new(0.0, 0.0, -GRAVITY), 0.5, friction);
    let time = 2.0 * speed / (7.0 * friction * GRAVITY);
    go(&mut bed, 0.5 * time);
    let half_way = bed.grains().spheres[0];
    go(&mut bed, 0.5 * time);
    let x = bed.grains().spheres[0].position.x;
    go(&mut bed, 0.5 * time);
    let end = bed.grains().spheres[0];
    let sliding = speed - friction * GRAVITY * 0.5 * time;
    vec![
        Row::relative(case, "velocity half way, still sliding", "m/s", half_way.velocity.x, (sliding, 1e-3)),
        Row::relative(
            case,
            "way until it rolls",
            "m",
            x,
            (12.0 * speed * speed / (49.0 * friction * GRAVITY), 1e-3),
        ),
        Row::relative(case, "velocity when rolling", "m/s", end.velocity.x, (5.0 / 7.0 * speed, 1e-3)),
        Row::relative(case, "spin when rolling", "rad/s", end.spin.y, (5.0 / 7.0 * speed / RADIUS, 1e-3)),
    ]
}

/// A ball released on an incline rolls where friction suffices, and slides where it does not.
pub fn incline() -> Vec<Row> {
    let case = ("incline", "a = 5/7 g sin α; sliding: a = g (sin α − μ cos α), dω/dt = 5 μ g cos α/(2 r)");
    let friction: f64 = 0.2;
    let mut rows = Vec::new();
    for angle_deg in [10.0_f64, 30.0, 50.0] {
        let (sin, cos) = angle_deg.to_radians().sin_cos();
        let body = resting(GRAVITY * cos);
        let mut bed = bed(vec![body], Vec3::new(GRAVITY * sin, 0.0, -GRAVITY * cos), 0.5, friction);
        let time = 0.2;
        go(&mut bed, time);
        let body = bed.grains().spheres[0];
        let rolls = angle_deg.to_radians().tan() < 3.5 * friction;
        let (acceleration, turning) = if rolls {
            (5.0 / 7.0 * GRAVITY * sin, 5.0 / 7.0 * GRAVITY * sin / RADIUS)
        } else {
            (GRAVITY * (sin - friction * cos), 2.5 * friction * GRAVITY * cos / RADIUS)
        };
        let how = if rolls { "rolling" } else { "sliding" };
        let name = |what: &str| format!("{what} at {angle_deg}°, {how}");
        rows.push(Row::relative(
            case,
            name("acceleration"),
            "m/s²",
            body.velocity.x / time,
            (acceleration, 2e-3),
        ));
        rows.push(Row::relative(case, name("turning"), "rad/s²", body.spin.y / time, (turning, 2e-3)));
    }
    rows
}

/// A ball falls and bounces; each time e² of the height is left.
pub fn bounces() -> Vec<Row> {
    let case = ("bounces", "height hₖ = h₀ e²ᵏ, contact times neglected");
    let (height, restitution) = (0.2, 0.8);
    let mut bed = bed(vec![ball(RADIUS + height)], Vec3::new(0.0, 0.0, -GRAVITY), restitution, 0.0);
    let mut rows = Vec::new();
    let mut speed_before = 0.0;
    while rows.len() < 5 {
        go(&mut bed, STEP);
        let body = bed.grains().spheres[0];
        if speed_before > 0.0 && body.velocity.z <= 0.0 {
            let bounce = rows.len() as i32 + 1;
            let expected = height * restitution.powi(2 * bounce);
            let name = format!("height after bounce {bounce}");
            rows.push(Row::relative(case, name, "m", body.position.z - RADIUS, (expected, 5e-3)));
        }
        speed_before = body.velocity.z;
    }
    rows
}

/// Five balls on top of each other come to rest; every contact carries the weight above it.
pub fn stack() -> Vec<Row> {
    let case = ("stack", "Hertz: overlap of contact k = (weight above/k)^(2/3); the floor carries all");
    let n = 5;
    let bodies: Vec<Sphere> = (0..n).map(|k| ball(RADIUS * (2 * k + 1) as f64)).collect();
    let weight = bodies[0].mass * GRAVITY;
    let mut bed = bed(bodies, Vec3::new(0.0, 0.0, -GRAVITY), 0.3, 0.5);
    go(&mut bed, 0.6);
    let modulus = bed.pair_table().pair(0, 0).normal_modulus;
    let overlap =
        |load: f64, effective_radius: f64| (load / (modulus * effective_radius.sqrt())).powf(2.0 / 3.0);
    let mut height = RADIUS * (2 * n - 1) as f64 - overlap(n as f64 * weight, RADIUS);
    for above in 1..n {
        height -= overlap(above as f64 * weight, RADIUS / 2.0);
    }
    let heights = bed.grains().spheres.iter().map(|sphere| sphere.position.z);
    let top = heights.fold(0.0, f64::max);
    let fall = RADIUS * (2 * n - 1) as f64;
    let fastest = bed.grains().spheres.iter().map(|s| s.velocity.norm()).fold(0.0, f64::max);
    vec![
        Row::relative(case, "force on the floor", "N", -bed.plane_force(0).z, (n as f64 * weight, 1e-4)),
        Row::relative(case, "compression of the stack", "m", fall - top, (fall - height, 1e-3)),
        Row::absolute(case, "fastest ball", "m/s", fastest, (0.0, 1e-6)),
    ]
}
