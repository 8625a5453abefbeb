//! Deforming surfaces against rigid ones, against their own cuts, and in balance.

use grouser_contact::*;
use grouser_coupling::{DeformingContacts, Margin, Mirror, SurfaceContacts};
use grouser_geometry::generate::{cone, plane};
use grouser_geometry::{Orientation, RigidMotion, TriangleSurface, Vec3};

use super::{RADIUS, bead, hertz, step, table};

type Contacts = DeformingContacts<Vector<f64>>;

fn of(v: Vector<f64>) -> Vec3 {
    Vec3::new(v.x, v.y, v.z)
}

/// Contacts of a surface whose nodes are its vertices.
fn contacts(surface: &TriangleSurface, margin: Margin) -> Contacts {
    let mirror = Mirror::new(&surface.triangles, 1).unwrap();
    DeformingContacts::new(mirror, |n| surface.vertices[n as usize], 0, margin)
}

fn load(contacts: &mut Contacts, sphere: Sphere) -> Load {
    let (table, mut loads) = (table(), [Load::default()]);
    let step = grouser_coupling::Step { fastest: 1e4, ..step(&table) };
    contacts.forces((&[sphere], &[0]), &mut loads, &step, |_| ());
    loads[0]
}

#[test]
fn a_plane_cut_into_one_to_ten_thousand_triangles_gives_the_same_force() {
    let place = Vec3::new(0.0013, 0.0007, RADIUS - 1e-4);
    for n in [1, 2, 3, 7, 22, 71] {
        let surface = plane(0.1, 0.1, n, n).unwrap();
        let force = load(&mut contacts(&surface, Margin::DEFAULT), bead(place)).force;
        assert!((force.z - hertz(1e-4)).abs() < 1e-9 * force.z, "{} triangles", 2 * n * n);
    }
}

#[test]
fn the_force_of_a_facetted_cone_converges() {
    let error = |n_sides: usize| {
        let surface = cone(0.05, 0.05, n_sides).unwrap();
        let normal = Vec3::new(1.0, 0.0, -1.0).normalize();
        let turned = Orientation::from_axis_angle(&Vec3::z_axis(), 0.3);
        let place = turned * (Vec3::new(0.025, 0.0, 0.025) + normal * (RADIUS - 1e-3));
        let force = load(&mut contacts(&surface, Margin::DEFAULT), bead(place)).force.norm();
        (force - hertz(1e-3)).abs() / hertz(1e-3)
    };
    let [coarse, middle, fine] = [10, 50, 500].map(error);
    assert!(middle < 0.3 * coarse && fine < 0.02 * coarse && fine < 2e-3, "{coarse} {middle} {fine}");
}

/// Where the nodes of a plane are at time `t`: it bulges, turns and travels.
fn bulging(at_rest: &Vec3, t: f64) -> Vec3 {
    let bulge = 0.004 * (60.0 * at_rest.x).sin() * (50.0 * at_rest.y).cos() * (30.0 * t).sin();
    let turn = Orientation::from_scaled_axis(Vec3::new(0.1, 0.2, 0.3) * t);
    turn * (at_rest + Vec3::z() * bulge) + Vec3::new(0.1, 0.0, 0.05) * t
}

fn velocity(at_rest: &Vec3, t: f64) -> Vec3 {
    (bulging(at_rest, t + 1e-6) - bulging(at_rest, t - 1e-6)) / 2e-6
}

#[test]
fn action_equals_reaction_in_force_moment_and_power_for_faces_of_three_and_six_nodes() {
    let surface = plane(0.2, 0.2, 8, 8).unwrap();
    let mut nodes = surface.vertices.clone();
    let mut middles = std::collections::BTreeMap::new();
    let mut six_nodes = Vec::new();
    for &[a, b, c] in &surface.triangles {
        let mut middle = |i: u32, j: u32| {
            *middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
                nodes.push((surface.vertices[i as usize] + surface.vertices[j as usize]) / 2.0);
                nodes.len() as u32 - 1
            })
        };
        six_nodes.push(vec![a, b, c, middle(a, b), middle(b, c), middle(c, a)]);
    }
    let three_nodes: Vec<Vec<u32>> = surface.triangles.iter().map(|t| t.to_vec()).collect();
    let table = table();
    for (faces, divisions) in [(three_nodes, 1), (six_nodes.clone(), 2), (six_nodes, 3)] {
        let mirror = Mirror::new(&faces, divisions).unwrap();
        let t = 0.03;
        let (place, speed) =
            (|n: u32| bulging(&nodes[n as usize], t), |n: u32| velocity(&nodes[n as usize], t));
        let mut contacts: Contacts = DeformingContacts::new(mirror, place, 0, Margin::DEFAULT);
        contacts.follow(place, speed);
        let spheres: Vec<Sphere> = (0..300)
            .map(|k| {
                let n = f64::from(k) * 0.7548776662466927;
                let at_rest =
                    Vec3::new(0.18 * n.fract() - 0.09, 0.09 * (9.0 * n).sin(), 0.8 * RADIUS + 1e-3 * n.cos());
                let mut sphere = bead(bulging(&at_rest, t));
                sphere.velocity = Vector::new(n.sin(), n.cos(), (2.0 * n).sin());
                sphere.spin = Vector::new(9.0 * n.cos(), 5.0 * n.sin(), 2.0);
                sphere
            })
            .collect();
        let ids: Vec<u32> = (0..300).collect();
        let mut loads = vec![Load::default(); 300];
        let (mut seen, mut power) = (Vec3::zeros(), [0.0; 2]);
        contacts.forces((&spheres, &ids), &mut loads, &step(&table), |contact| seen += contact.force);
        assert!(contacts.n_contacts() > 200);
        let (mut force, mut moment, mut scale) = (Vec3::zeros(), Vec3::zeros(), 0.0);
        for (sphere, load) in spheres.iter().zip(&loads) {
            force += of(load.force);
            moment += of(sphere.position).cross(&of(load.force)) + of(load.torque);
            scale += load.force.norm();
        }
        assert!((force + seen).norm() < 1e-12 * scale);
        for (vertex, force) in contacts.vertex_forces().iter().enumerate() {
            let mirrored = Mirror::new(&faces, divisions).unwrap().at_vertex(vertex, speed);
            power[0] += force.dot(&mirrored);
        }
        contacts.spread(|n, on_node| {
            force += on_node;
            moment += place(n).cross(&on_node);
            power[1] += on_node.dot(&speed(n));
        });
        assert!(force.norm() < 1e-12 * scale && moment.norm() < 1e-12 * scale, "{force} {moment} {scale}");
        assert!((power[0] - power[1]).abs() < 1e-10 * power[0].abs());
    }
}

#[test]
fn a_bead_that_rolls_over_the_triangles_of_a_moving_surface_feels_no_jump() {
    let surface = plane(0.1, 0.1, 13, 17).unwrap();
    let mut cut = contacts(&surface, Margin::DEFAULT);
    let mut rigid = SurfaceContacts::new(plane(0.1, 0.1, 1, 1).unwrap(), 0);
    let table = table();
    let (dt, n_steps) = (1e-5, 4000);
    for k in 0..n_steps {
        let t = dt * f64::from(k);
        let motion = RigidMotion {
            position: Vec3::new(0.3 * t, 0.1 * t, 0.0),
            orientation: Orientation::from_scaled_axis(Vec3::z() * (2.0 * t)),
            velocity: Vec3::new(0.3, 0.1, 0.0),
            spin: Vec3::z() * 2.0,
        };
        let place = |n: u32| motion.point(&surface.vertices[n as usize]);
        cut.follow(place, |n| motion.velocity_at(&place(n)));
        let mut sphere =
            bead(Vec3::new(1e-5 * f64::from(k) - 0.02, 0.7e-5 * f64::from(k) - 0.014, RADIUS - 1e-4));
        sphere.velocity = Vector::new(1.0, 0.7, 0.0);
        sphere.spin = Vector::new(-60.0, 99.0, 10.0);
        let (mut of_cut, mut of_rigid) = ([Load::default()], [Load::default()]);
        cut.forces((&[sphere], &[0]), &mut of_cut, &step(&table), |_| ());
        rigid.forces(&motion, (&[sphere], &[0]), &mut of_rigid, &step(&table));
        let (a, b) = (of_cut[0], of_rigid[0]);
        assert!((a.force - b.force).norm() < 1e-9 * b.force.norm(), "step {k}: {a:?} {b:?}");
        assert!((a.torque - b.torque).norm() < 1e-9 * b.torque.norm(), "step {k}");
    }
}

/// Many beads on a bulging plane: sum of all forces of 300 steps.
fn bulge_under_beads(mut contacts: Contacts, surface: &TriangleSurface, n_restarts: usize) -> (Vec3, u64) {
    let table = table();
    let ids: Vec<u32> = (0..100).rev().collect();
    let mut sum = Vec3::zeros();
    for k in 0..300 {
        let t = 1e-4 * k as f64;
        contacts.follow(
            |n| bulging(&surface.vertices[n as usize], t),
            |n| velocity(&surface.vertices[n as usize], t),
        );
        let spheres: Vec<Sphere> = (0..100)
            .map(|b| {
                let n = f64::from(b) * 0.7548776662466927;
                bead(Vec3::new(0.18 * n.fract() - 0.09 + 0.3 * t, 0.09 * (9.0 * n).sin(), 0.9 * RADIUS))
            })
            .collect();
        let mut loads = vec![Load::default(); 100];
        let step = grouser_coupling::Step { time_step: 1e-4, fastest: 0.4, ..step(&table) };
        contacts.forces((&spheres, &ids), &mut loads, &step, |_| ());
        contacts.spread(|_, force| sum += force);
        if n_restarts > 0 && k % (300 / n_restarts) == 17 {
            contacts = postcard::from_bytes(&postcard::to_allocvec(&contacts).unwrap()).unwrap();
        }
    }
    (sum, contacts.n_refits())
}

#[test]
fn refitting_seldom_or_starting_again_changes_no_byte() {
    let surface = plane(0.2, 0.2, 20, 20).unwrap();
    let (every, n_every) = bulge_under_beads(contacts(&surface, Margin(0.0)), &surface, 0);
    let (seldom, n_seldom) = bulge_under_beads(contacts(&surface, Margin(0.5)), &surface, 0);
    let (again, _) = bulge_under_beads(contacts(&surface, Margin(0.5)), &surface, 5);
    assert!(n_every == 300 && n_seldom < 50, "{n_every} {n_seldom}");
    assert_eq!(every, seldom);
    assert_eq!(every, again);
}
