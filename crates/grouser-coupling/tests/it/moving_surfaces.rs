//! Surfaces in motion: lists against brute force, memory against closed forms, energy against work.

use grouser_contact::*;
use grouser_coupling::{Step, SurfaceContacts, closest_point, touches};
use grouser_geometry::generate::{GrouseredWheel, cone, cuboid, cylinder, grousered_wheel, icosphere, plane};
use grouser_geometry::{RigidMotion, TriangleSurface, Vec3};
use grouser_rigid::{BodySpec, Degree, Freedom, RigidBody, VelocityProfile};

use super::{RADIUS, bead, hertz, step, table};

fn of(v: Vector<f64>) -> Vec3 {
    Vec3::new(v.x, v.y, v.z)
}

fn to(v: Vec3) -> Vector<f64> {
    Vector::new(v.x, v.y, v.z)
}

#[test]
fn listed_triangles_give_the_contacts_of_brute_force_while_wheel_and_grains_move() {
    let wheel = GrouseredWheel {
        radius: 0.05,
        width: 0.04,
        n_grousers: 9,
        grouser_height: 0.008,
        grouser_thickness: 0.004,
        n_rim_segments: 4,
    };
    let surface = grousered_wheel(&wheel).unwrap();
    let every_triangle: Vec<u32> = (0..surface.triangles.len() as u32).collect();
    let mut spec = BodySpec::driven(Vec3::new(0.0, 0.0, 0.06))
        .with(Degree::X, Freedom::Prescribed(VelocityProfile::constant(0.5)))
        .with(Degree::AboutY, Freedom::Prescribed(VelocityProfile::constant(15.0)));
    spec.motion.velocity = Vec3::zeros();
    let mut body = RigidBody::new(spec).unwrap();
    let (table, dt) = (table(), 1e-4);
    let mut spheres: Vec<Sphere> = (0..300)
        .map(|k| {
            let n = f64::from(k) * 0.7548776662466927;
            let mut sphere =
                bead(Vec3::new(0.2 * n.fract() - 0.05, 0.03 * (9.0 * n).sin(), 0.012 * (5.0 * n).cos()));
            sphere.velocity = Vector::new((3.0 * n).sin(), (4.0 * n).sin(), n.cos());
            sphere
        })
        .collect();
    let ids: Vec<u32> = (0..300).rev().collect();
    let mut contacts = SurfaceContacts::new(surface.clone(), 0);
    let fastest = spheres.iter().map(|s| s.velocity.norm()).fold(0.0, f64::max);
    let mut n_seen = 0;
    for _ in 0..400 {
        body.predict(dt);
        for sphere in &mut spheres {
            sphere.position += sphere.velocity * dt;
        }
        let mut loads = vec![Load::default(); 300];
        let step = Step { time_step: dt, fastest, ..step(&table) };
        contacts.forces(body.motion(), (&spheres, &ids), &mut loads, &step);
        let expected: usize = (spheres.iter())
            .map(|s| {
                touches(&surface, &every_triangle, &body.motion().point_in_body(&of(s.position)), RADIUS)
                    .iter()
                    .filter(|touch| touch.is_minimum)
                    .count()
            })
            .sum();
        assert_eq!(contacts.n_contacts(), expected);
        n_seen += expected;
    }
    assert!(n_seen > 10_000, "{n_seen}");
}

/// Two faces that fold upwards by `angle` on both sides of the y axis together.
fn valley(angle: f64) -> TriangleSurface {
    let v = Vec3::new;
    TriangleSurface {
        vertices: vec![
            v(-1.0, 0.0, 0.0),
            v(0.0, -1.0, 0.0),
            v(0.0, 1.0, 0.0),
            v(angle.cos(), 0.0, angle.sin()),
        ],
        triangles: vec![[0, 1, 2], [1, 3, 2]],
    }
}

#[test]
fn contact_that_is_new_does_not_inherit_the_stretch_of_its_neighbour() {
    let angle = 40f64.to_radians(); // sharper than the smooth angle, yet the two normals are alike
    let surface = valley(angle);
    let table = table();
    let mut contacts = SurfaceContacts::new(surface, 0);
    let mut load = |centre: Vec3, velocity: Vec3| {
        let mut sphere = bead(centre);
        sphere.velocity = to(velocity);
        let mut loads = [Load::default()];
        let step = Step { fastest: 1e4, ..step(&table) }; // the bead is put from place to place
        contacts.forces(&RigidMotion::default(), (&[sphere], &[0]), &mut loads, &step);
        (of(loads[0].force), contacts.n_contacts())
    };
    // Pressed on the level face and drawn along the valley: the spring stretches along y.
    let depth = 1e-4;
    for _ in 0..10 {
        load(Vec3::new(-0.02, 0.0, RADIUS - depth), Vec3::new(0.0, 0.1, 0.0));
    }
    let (alone, _) = load(Vec3::new(-0.02, 0.0, RADIUS - depth), Vec3::zeros());
    // Put where it touches both faces to the same depth, at rest: the second contact begins with no stretch.
    let x = -(RADIUS - depth) * (angle / 2.0).tan();
    let (both, n_contacts) = load(Vec3::new(x, 0.0, RADIUS - depth), Vec3::zeros());
    assert_eq!(n_contacts, 2);
    assert!(alone.y < 0.0 && (both.y - alone.y).abs() < 1e-9 * alone.y.abs(), "{alone} {both}");
    let normal_sum = hertz(depth) * (1.0 + angle.cos());
    assert!((both.z - normal_sum).abs() < 1e-9 * normal_sum);
}

#[test]
fn grain_whose_centre_passed_through_in_one_step_is_named() {
    let table = table();
    let mut contacts = SurfaceContacts::new(plane(1.0, 1.0, 3, 3).unwrap(), 0);
    let mut depth = |z: f64, speed: f64| {
        let mut sphere = bead(Vec3::new(0.01, 0.02, z));
        sphere.velocity = Vector::new(0.0, 0.0, speed);
        let mut loads = [Load::default()];
        let step = Step { time_step: 1e-4, fastest: speed.abs(), ..step(&table) };
        contacts.forces(&RigidMotion::default(), (&[sphere], &[42]), &mut loads, &step);
        assert!(loads[0].force.is_finite());
        contacts.deepest().map(|d| (d.grain, d.depth))
    };
    let (grain, shallow) = depth(0.9 * RADIUS, -50.0).unwrap();
    assert!(grain == 42 && (shallow - 0.1).abs() < 1e-12);
    let (grain, passed) = depth(-0.4 * RADIUS, -130.0).unwrap();
    assert!(grain == 42 && passed > 1.0);
    // Exactly on the surface there is still a direction.
    assert!((depth(0.0, 0.0).unwrap().1 - 1.0).abs() < 1e-12);
    assert_eq!(depth(2.0 * RADIUS, -1.0), None);
}

/// A bead on an oscillating plate, cut into triangles: what the plate's drive gives is what bead and contact have or lost.
#[test]
fn work_of_an_oscillating_plate_is_the_energy_of_the_bead_and_of_the_contact() {
    let residual = |n_steps: usize| {
        let dt = 0.2 / n_steps as f64;
        let table = table();
        let drive = |amplitude: f64, phase: f64| {
            Freedom::Prescribed(VelocityProfile::Sine { start: 0.0, amplitude, frequency: 15.0, phase })
        };
        let spec = BodySpec::driven(Vec3::zeros())
            .with(Degree::Z, drive(2e-3, 1.0))
            .with(Degree::X, drive(4e-3, 0.0))
            .with(Degree::AboutX, drive(0.05, 0.5));
        let mut plate = RigidBody::new(spec).unwrap();
        let mut contacts = SurfaceContacts::new(plane(0.4, 0.4, 40, 40).unwrap(), 0);
        let mut sphere = bead(Vec3::new(0.003, 0.011, 1.3 * RADIUS));
        let gravity = Vec3::new(0.0, 0.0, -9.81);
        let inertia = sphere.inertia();
        let energy = |s: &Sphere| {
            s.mass * (s.velocity.norm_squared() / 2.0 + 9.81 * s.position.z)
                + inertia * s.spin.norm_squared() / 2.0
        };
        let start = energy(&sphere);
        let (mut acceleration, mut turn) = (gravity, Vec3::zeros());
        let mut n_touched = 0;
        for _ in 0..n_steps {
            plate.predict(dt);
            sphere.position += sphere.velocity * dt + to(acceleration * (dt * dt / 2.0));
            sphere.velocity += to(acceleration * dt);
            sphere.spin += to(turn * dt);
            let mut loads = [Load::default()];
            let step = Step { time_step: dt, fastest: sphere.velocity.norm(), ..step(&table) };
            let wrench = contacts.forces(plate.motion(), (&[sphere], &[0]), &mut loads, &step);
            let (a, t) = (gravity + of(loads[0].force) / sphere.mass, of(loads[0].torque) / inertia);
            sphere.velocity += to((a - acceleration) * (dt / 2.0));
            sphere.spin += to((t - turn) * (dt / 2.0));
            (acceleration, turn) = (a, t);
            plate.correct(&wrench, dt);
            n_touched += contacts.n_contacts();
        }
        assert!(n_touched > n_steps / 20 && n_touched < n_steps, "{n_touched}");
        let given = plate.work().drive;
        let ledger = contacts.ledger();
        assert!(ledger.dissipated() > 0.0 && (given + plate.work().applied).abs() < 1e-9);
        (given - (energy(&sphere) - start) - ledger.elastic() - ledger.dissipated()) / start
    };
    let (coarse, fine) = (residual(40_000).abs(), residual(160_000).abs());
    assert!(fine < 1e-3 && fine < 0.5 * coarse, "{coarse:e} {fine:e}");
}

#[test]
fn contacts_written_and_read_back_continue_byte_for_byte() {
    let table = table();
    let mut sphere = bead(Vec3::new(0.003, 0.011, 0.99 * RADIUS));
    sphere.velocity = Vector::new(0.3, 0.2, -0.1);
    let go = |contacts: &mut SurfaceContacts<Vector<f64>>, sphere: &mut Sphere| {
        for _ in 0..2000 {
            sphere.position += sphere.velocity * 1e-5;
            let mut loads = [Load::default()];
            let step = Step { fastest: sphere.velocity.norm(), ..step(&table) };
            contacts.forces(&RigidMotion::default(), (&[*sphere], &[3]), &mut loads, &step);
            sphere.velocity += loads[0].force * (1e-5 / sphere.mass);
            sphere.spin += loads[0].torque * (1e-5 / sphere.inertia());
        }
    };
    let mut straight = SurfaceContacts::new(plane(0.4, 0.4, 40, 40).unwrap(), 0);
    go(&mut straight, &mut sphere);
    let checkpoint = postcard::to_allocvec(&straight).unwrap();
    let (mut resumed, mut other): (SurfaceContacts<Vector<f64>>, _) =
        (postcard::from_bytes(&checkpoint).unwrap(), sphere);
    go(&mut straight, &mut sphere);
    go(&mut resumed, &mut other);
    assert_eq!(sphere, other);
    assert_eq!(postcard::to_allocvec(&straight).unwrap(), postcard::to_allocvec(&resumed).unwrap());
}

#[test]
fn convex_bodies_are_touched_once_at_their_closest_point_from_every_side() {
    let shapes = [
        cuboid(Vec3::new(0.03, 0.05, 0.02)).unwrap(),
        cylinder(0.02, 0.03, 17).unwrap(),
        cone(0.03, 0.04, 9).unwrap(),
        icosphere(0.02, 2).unwrap(),
    ];
    for (shape, surface) in shapes.iter().enumerate() {
        let every_triangle: Vec<u32> = (0..surface.triangles.len() as u32).collect();
        let mut n_touches = 0;
        for k in 0..1500 {
            let n = f64::from(k) * 0.7548776662466927;
            let direction = Vec3::new((9.7 * n).sin(), (5.3 * n).cos(), (3.1 * n).sin()).normalize();
            let [a, b, c] = surface.corners(k as usize % surface.triangles.len());
            let (u, v) = ((n * 1.3247).fract(), (n * 7.1317).fract() * 1.2);
            let place = a + (b - a) * u + (c - a) * (v * (1.0 - u)) + direction * (0.9 * RADIUS);
            let distance = (0..surface.triangles.len())
                .map(|t| (closest_point(&place, &surface.corners(t)).0 - place).norm())
                .fold(f64::INFINITY, f64::min);
            let is_outside = (0..surface.triangles.len())
                .any(|t| surface.normal(t).dot(&(place - surface.corners(t)[0])) > 0.0);
            if !is_outside || !(0.8 * RADIUS..RADIUS).contains(&distance) {
                continue;
            }
            let found = touches(surface, &every_triangle, &place, RADIUS);
            assert_eq!(found.len(), 1, "shape {shape} at {place}: {found:?}");
            assert!((found[0].distance - distance).abs() < 1e-12 * RADIUS);
            n_touches += 1;
        }
        assert!(n_touches > 100, "shape {shape}: {n_touches}");
    }
}
