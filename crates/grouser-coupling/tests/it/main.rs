//! Spheres on triangle surfaces against planes, closed forms and the surfaces' own facets.

mod deforming_surfaces;
mod elastic_block;
mod moving_surfaces;
mod valleys;

use grouser_contact::*;
use grouser_coupling::*;
use grouser_geometry::generate::{cone, cuboid, icosphere, plane};
use grouser_geometry::{Orientation, RigidMotion, TriangleSurface, Vec3, Wrench};

type Law = HertzMindlin;

const GLASS: Material = Material { young_pa: 1e7, poisson: 0.3, density_kg_m3: 2500.0 };
const RADIUS: f64 = 0.01;

fn table() -> PairTable {
    PairTable::new(&[GLASS], Tail::CutCorrected, |_, _| Interaction { restitution: 0.5, friction: 0.5 })
        .unwrap()
}

fn bead(centre: Vec3) -> Sphere {
    Sphere {
        position: Vector::new(centre.x, centre.y, centre.z),
        radius: RADIUS,
        mass: 0.0105,
        ..Default::default()
    }
}

fn step(table: &PairTable) -> Step<'_, Law, f64> {
    Step { law: &const { HertzMindlin::new(Tail::CutCorrected) }, table, time_step: 1e-5, fastest: 1.0 }
}

/// Load of one bead at rest, wrench on the surface, number of contacts.
fn press(surface: &TriangleSurface, centre: Vec3) -> (Load, Wrench, usize) {
    let (table, mut loads) = (table(), [Load::default()]);
    let mut contacts = SurfaceContacts::new(surface.clone(), 0);
    let motion = RigidMotion::default();
    let wrench = contacts.forces(&motion, (&[bead(centre)], &[7]), &mut loads, &step(&table));
    (loads[0], wrench, contacts.n_contacts())
}

/// Hertz's force at an overlap.
fn hertz(overlap: f64) -> f64 {
    table().pair(0, 0).normal_modulus * RADIUS.sqrt() * overlap.powf(1.5)
}

#[test]
fn a_plane_gives_the_same_force_however_finely_it_is_cut() {
    let whole = press(&plane(0.1, 0.1, 1, 1).unwrap(), Vec3::new(0.0013, 0.0007, RADIUS - 1e-4));
    for n in [2, 3, 7, 10, 31, 70] {
        let surface = plane(0.1, 0.1, n, n).unwrap();
        // Also exactly above a vertex and above an edge.
        let vertex = surface.vertices[surface.vertices.len() / 2];
        for place in [Vec3::new(0.0013, 0.0007, 0.0), vertex, vertex + Vec3::new(0.0003, 0.0, 0.0)] {
            let (load, wrench, n_contacts) = press(&surface, place + Vec3::z() * (RADIUS - 1e-4));
            assert_eq!(n_contacts, 1, "{n} × {n} pieces at {place}");
            assert!((load.force.z - whole.0.force.z).abs() < 1e-9 * whole.0.force.z);
            assert!((wrench.force.z + load.force.z).abs() < 1e-12 * load.force.z);
        }
    }
}

#[test]
fn edges_that_do_not_match_count_once() {
    // A T-joint: one long edge on the left against two short ones on the right, and no common vertices.
    let v = |x: f64, y: f64| Vec3::new(x, y, 0.0);
    let vertices = vec![
        v(-1.0, -1.0),
        v(0.0, -1.0),
        v(0.0, 1.0),
        v(0.0, -1.0),
        v(1.0, 0.0),
        v(0.0, 0.0),
        v(0.0, 0.0),
        v(1.0, 0.0),
        v(0.0, 1.0),
    ];
    let surface = TriangleSurface { vertices, triangles: vec![[0, 1, 2], [3, 4, 5], [6, 7, 8]] };
    for x in [-1e-3, -1e-5, 0.0, 1e-5, 1e-3] {
        for y in [-1e-3, 0.0, 1e-3] {
            let (load, _, n_contacts) = press(&surface, Vec3::new(x, y, RADIUS - 1e-4));
            assert_eq!(n_contacts, 1, "at {x}, {y}");
            assert!((load.force.z - hertz(1e-4)).abs() < 1e-9 * load.force.z);
        }
    }
}

#[test]
fn a_sharp_valley_gives_two_contacts_and_a_ridge_one() {
    let v = Vec3::new;
    let fold = |height: f64| TriangleSurface {
        vertices: vec![v(-1.0, 0.0, height), v(0.0, -1.0, 0.0), v(0.0, 1.0, 0.0), v(1.0, 0.0, height)],
        triangles: vec![[0, 1, 2], [1, 3, 2]],
    };
    // Faces at 45°: the bead in the valley touches both when its centre is √2 r above the bottom.
    let (load, _, n_contacts) = press(&fold(1.0), v(0.0, 0.0, 2.0_f64.sqrt() * (RADIUS - 1e-4)));
    assert_eq!(n_contacts, 2);
    assert!((load.force.z - 2.0_f64.sqrt() * hertz(1e-4)).abs() < 1e-9 * load.force.z);
    let (load, _, n_contacts) = press(&fold(-1.0), v(0.0, 0.0, RADIUS - 1e-4));
    assert_eq!(n_contacts, 1);
    assert!((load.force.z - hertz(1e-4)).abs() < 1e-9 * load.force.z);
}

#[test]
fn the_corner_of_a_box_pushes_along_its_diagonal() {
    let corner = Vec3::new(0.05, 0.05, 0.1);
    let direction = Vec3::new(1.0, 2.0, 2.0) / 3.0;
    let (load, _, n_contacts) =
        press(&cuboid(Vec3::repeat(0.1)).unwrap(), corner + direction * (RADIUS - 1e-4));
    assert_eq!(n_contacts, 1);
    let force = Vec3::new(load.force.x, load.force.y, load.force.z);
    assert!((force - direction * hertz(1e-4)).norm() < 1e-9 * force.norm());
}

#[test]
fn a_bead_in_a_facetted_bowl_is_pushed_as_by_one_contact() {
    let bowl = icosphere(1.25 * RADIUS, 3).unwrap();
    let (load, ..) = press(&bowl, Vec3::new(0.00001, 0.00002, -0.26 * RADIUS));
    let smooth = hertz(0.01 * RADIUS);
    // The facets lie up to 0.5 % of the bowl's radius inside it, half of the overlap.
    assert!(load.force.z > smooth && load.force.z < 1.5_f64.powf(1.5) * smooth, "{} {smooth}", load.force.z);
}

#[test]
fn the_force_of_a_facetted_cone_converges() {
    let at = |n_sides: usize| {
        let surface = cone(0.05, 0.05, n_sides).unwrap();
        // Beside the cone's flank at mid height, 45° down.
        let flank = Vec3::new(0.025, 0.0, 0.025);
        let turned = Orientation::from_axis_angle(&Vec3::z_axis(), 0.3);
        let normal = Vec3::new(1.0, 0.0, -1.0).normalize();
        let (load, ..) = press(&surface, turned * (flank + normal * (RADIUS - 1e-3)));
        load.force.norm()
    };
    let [coarse, middle, fine] = [10, 50, 500].map(|n| (at(n) - hertz(1e-3)).abs() / hertz(1e-3));
    assert!(middle < 0.3 * coarse && fine < 0.02 * coarse && fine < 2e-3, "{coarse} {middle} {fine}");
}

#[test]
fn a_bead_that_rolls_over_facets_feels_no_jump() {
    let (table, surface) = (table(), plane(0.1, 0.1, 13, 17).unwrap());
    let mut cut = SurfaceContacts::new(surface, 0);
    let mut whole = SurfaceContacts::new(plane(0.1, 0.1, 1, 1).unwrap(), 0);
    let motion = RigidMotion::default();
    for n in 0..4000 {
        let mut sphere =
            bead(Vec3::new(1e-5 * f64::from(n) - 0.02, 0.7e-5 * f64::from(n) - 0.014, RADIUS - 1e-4));
        sphere.velocity = Vector::new(1.0, 0.7, 0.0);
        sphere.spin = Vector::new(-60.0, 99.0, 10.0);
        let mut load = || {
            [&mut cut, &mut whole].map(|contacts| {
                let mut loads = [Load::default()];
                contacts.forces(&motion, (&[sphere], &[0]), &mut loads, &step(&table));
                loads[0]
            })
        };
        let [of_cut, of_whole] = load();
        assert!((of_cut.force - of_whole.force).norm() < 1e-9 * of_whole.force.norm(), "step {n}");
        assert!((of_cut.torque - of_whole.torque).norm() < 1e-9 * of_whole.torque.norm(), "step {n}");
    }
}

#[test]
fn action_equals_reaction_in_force_and_moment_on_a_turning_box() {
    let table = table();
    let mut contacts = SurfaceContacts::new(cuboid(Vec3::new(0.05, 0.04, 0.03)).unwrap(), 0);
    let motion = RigidMotion {
        position: Vec3::new(0.3, -0.1, 0.2),
        orientation: Orientation::from_scaled_axis(Vec3::new(0.3, 0.2, -0.5)),
        velocity: Vec3::new(0.1, 0.2, -0.3),
        spin: Vec3::new(3.0, -2.0, 1.0),
    };
    let places = (0..400).map(|n| f64::from(n) * 0.7548776662466927);
    let spheres: Vec<Sphere> = places
        .map(|n| {
            let direction = Vec3::new((9.7 * n).sin(), (5.3 * n).cos(), (3.1 * n).sin()).normalize();
            let mut sphere = bead(motion.position + direction * (0.02 + 0.015 * n.fract()));
            sphere.velocity = Vector::new(n.sin(), n.cos(), (2.0 * n).sin());
            sphere.spin = Vector::new(9.0 * n.cos(), 5.0 * n.sin(), 2.0);
            sphere
        })
        .collect();
    let ids: Vec<u32> = (0..400).collect();
    let mut loads = vec![Load::default(); 400];
    let wrench = contacts.forces(&motion, (&spheres, &ids), &mut loads, &step(&table));
    assert!(contacts.n_contacts() > 100);
    let (mut force, mut moment, mut scale) = (Vec3::zeros(), Vec3::zeros(), 0.0);
    for (sphere, load) in spheres.iter().zip(&loads) {
        let of = |v: Vector<f64>| Vec3::new(v.x, v.y, v.z);
        force += of(load.force);
        moment += (of(sphere.position) - motion.position).cross(&of(load.force)) + of(load.torque);
        scale += load.force.norm();
    }
    assert!((force + wrench.force).norm() < 1e-13 * scale);
    assert!((moment + wrench.moment).norm() < 1e-13 * scale);
}

#[test]
fn the_order_in_which_grains_are_stored_does_not_matter() {
    let (table, surface) = (table(), plane(0.2, 0.2, 9, 9).unwrap());
    let place = |n: usize| {
        Vec3::new(0.019 * (n % 9) as f64 - 0.08, 0.019 * (n / 9) as f64 - 0.08, RADIUS - 1e-5 * n as f64)
    };
    let spheres: Vec<Sphere> = (0..81).map(|n| bead(place(n))).collect();
    let ids: Vec<u32> = (0..81).collect();
    let run = |order: &[usize]| {
        let mut contacts = SurfaceContacts::new(surface.clone(), 0);
        let (spheres, ids): (Vec<_>, Vec<_>) = order.iter().map(|&n| (spheres[n], ids[n])).unzip();
        let mut loads = vec![Load::default(); 81];
        contacts.forces(&RigidMotion::default(), (&spheres, &ids), &mut loads, &step(&table))
    };
    let forward: Vec<usize> = (0..81).collect();
    let mixed: Vec<usize> = (0..81).map(|n| n * 37 % 81).collect();
    assert_eq!(run(&forward), run(&mixed));
}

#[test]
fn an_angular_grain_feels_its_edge_on_a_surface_as_on_a_plane() {
    // A cube that stands on an edge of half its height beside the normal, turned by 20° about y; 10 µm deep.
    // The torque of a contact that has lasted: without build-up it is there at once.
    let settings = TiltingSettings { build_up: 0.0, ..TiltingSettings::of(GrainShape::Cube) };
    let law = Rotating {
        forces: HertzMindlin::new(Tail::CutCorrected),
        rotation: Tilting::<false>::new(&settings).unwrap(),
    };
    let table = table();
    let turned = Orientation::from_scaled_axis(Vec3::y() * 20_f64.to_radians());
    let radius = 0.01;
    let sphere = Sphere::<F64> {
        position: Vector::new(0.011, 0.013, radius - 1e-5),
        radius,
        mass: 0.01,
        ..Default::default()
    };
    let mut loads = [Load::default()];
    let mut contacts = SurfaceContacts::new(plane(1.0, 1.0, 10, 10).unwrap(), 0);
    let step = Step { law: &law, table: &table, time_step: 1e-6, fastest: 0.0 };
    let grains = (&[sphere][..], &[0][..], Some(&[turned][..]));
    contacts.forces_on_turned(&RigidMotion::default(), grains, &mut loads, &step, |_| ());
    let force = loads[0].force.z;
    // l_N = r cos(45° + 20°), against the tilt.
    let expected = -force * (radius - 1e-5) * 65_f64.to_radians().cos();
    assert!(force > 0.0 && (loads[0].torque.y - expected).abs() < 1e-9 * expected.abs());
    assert!(loads[0].torque.x.abs() < 1e-12 && loads[0].torque.z.abs() < 1e-12);
}
