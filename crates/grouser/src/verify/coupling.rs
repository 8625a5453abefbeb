//! Cases of grains on surfaces that deform.

use super::Row;
use grouser_contact::{F64, HertzMindlin, Interaction, Load, Material, PairTable, Sphere, Tail, Vector};
use grouser_coupling::{DeformingContacts, Margin, Mirror, Step};
use grouser_geometry::generate::{cone, plane};
use grouser_geometry::{Orientation, TriangleSurface, Vec3};
use std::sync::LazyLock;

pub(super) type Contacts = DeformingContacts<Vector<f64>>;

pub(super) const LAW: HertzMindlin = HertzMindlin::new(Tail::CutCorrected);
/// Radius of the bead [m].
pub(super) const RADIUS: f64 = 0.01;
/// A bead and a surface of the same stuff.
const GLASS: Material = Material { young_pa: 1e7, poisson: 0.3, density_kg_m3: 2500.0 };

/// Their constants; the correction of the tail is found once.
pub(super) static TABLE: LazyLock<PairTable> = LazyLock::new(|| {
    let interaction = |_, _| Interaction { restitution: 0.5, friction: 0.5 };
    PairTable::new(&[GLASS], Tail::CutCorrected, interaction).expect("these constants are in range")
});

pub(super) fn bead(centre: Vec3) -> Sphere<F64> {
    let position = Vector::new(centre.x, centre.y, centre.z);
    Sphere { position, radius: RADIUS, mass: 0.0105, ..Default::default() }
}

/// Hertz's force of the bead on a rigid surface of its own stuff at an overlap [N].
pub(super) fn hertz(overlap: f64) -> f64 {
    TABLE.pair(0, 0).normal_modulus * RADIUS.sqrt() * overlap.powf(1.5)
}

/// Contacts of a surface whose nodes are its vertices.
fn contacts(surface: &TriangleSurface) -> Contacts {
    let mirror = Mirror::new(&surface.triangles, 1).expect("triangles have three nodes");
    DeformingContacts::new(mirror, |n| surface.vertices[n as usize], 0, Margin::DEFAULT)
}

fn load(contacts: &mut Contacts, sphere: Sphere<F64>) -> Load<f64> {
    let mut loads = [Load::default()];
    let step = Step { law: &LAW, table: &*TABLE, time_step: 1e-5, fastest: 3.0 };
    contacts.forces((&[sphere], &[0]), &mut loads, &step, |_| ());
    loads[0]
}

/// A plane cut into 2 to 10,082 triangles, and a cone of 50 and 500 sides.
pub fn cut_surfaces() -> Vec<Row> {
    let case = ("cut surfaces", "Hertz's force at the same overlap");
    let mut rows = Vec::new();
    let place = Vec3::new(0.0013, 0.0007, RADIUS - 1e-4);
    for n in [1, 7, 71] {
        let surface = plane(0.1, 0.1, n, n).expect("a plane");
        let force = load(&mut contacts(&surface), bead(place)).force.z;
        let what = format!("force on a plane of {} triangles", 2 * n * n);
        rows.push(Row::relative(case, what, "N", force, (hertz(1e-4), 1e-9)));
    }
    let of_cone = [(50, 0.06), (500, 2e-3)].map(|(n_sides, tolerance)| {
        let surface = cone(0.05, 0.05, n_sides).expect("a cone");
        let normal = Vec3::new(1.0, 0.0, -1.0).normalize();
        let turned = Orientation::from_axis_angle(&Vec3::z_axis(), 0.3);
        let place = turned * (Vec3::new(0.025, 0.0, 0.025) + normal * (RADIUS - 1e-3));
        let force = load(&mut contacts(&surface), bead(place)).force.norm();
        let what = format!("force on a cone of {n_sides} sides");
        Row::relative(case, what, "N", force, (hertz(1e-3), tolerance))
    });
    let [coarse, fine] = of_cone.each_ref().map(|row| (row.computed - row.reference).abs());
    rows.extend(of_cone);
    let order = (coarse / fine).log10();
    rows.push(Row::absolute(case, "order of the cone's error in its sides", "-", order, (2.0, 0.6)));
    rows
}

/// A bead that rolls over the triangles of a plane that travels: largest difference from the uncut one.
pub fn rolling_over_triangles() -> Vec<Row> {
    let case = ("rolling over triangles", "the same plane of two triangles");
    let surfaces = [(13, 17), (1, 1)].map(|(n, m)| plane(0.1, 0.1, n, m).expect("a plane"));
    let mut both = surfaces.each_ref().map(contacts);
    let [mut of_force, mut of_torque] = [0.0_f64; 2];
    let speed = Vec3::new(0.3, 0.1, 0.0);
    for k in 0..1000 {
        let t = 4e-5 * f64::from(k);
        let mut sphere = bead(Vec3::new(t - 0.02, 0.7 * t - 0.014, RADIUS - 1e-4));
        sphere.velocity = Vector::new(1.0, 0.7, 0.0);
        sphere.spin = Vector::new(-60.0, 99.0, 10.0);
        let mut loads = [Load::default(); 2];
        for ((contacts, surface), load_on) in both.iter_mut().zip(&surfaces).zip(&mut loads) {
            contacts.follow(|n| surface.vertices[n as usize] + speed * t, |_| speed);
            *load_on = load(contacts, sphere);
        }
        let [cut, whole] = loads;
        of_force = of_force.max((cut.force - whole.force).norm() / whole.force.norm());
        of_torque = of_torque.max((cut.torque - whole.torque).norm() / whole.torque.norm());
    }
    [("force", of_force), ("torque", of_torque)]
        .map(|(name, jump)| {
            Row::absolute(case, format!("largest jump of the {name}, over it"), "-", jump, (0.0, 1e-9))
        })
        .into()
}
