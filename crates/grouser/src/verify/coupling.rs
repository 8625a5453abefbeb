//! Cases of grains on surfaces that deform, and on elastic solids.

use super::Row;
use grouser_contact::{F64, HertzMindlin, Interaction, Load, Material, PairTable, Sphere, Tail, Vector};
use grouser_coupling::{DeformingContacts, Margin, Mirror, Step};
use grouser_fem::{DynamicsError, Formulation, Material as Elastic, Settings, Solid};
use grouser_geometry::generate::{cone, plane};
use grouser_geometry::{Orientation, TriangleSurface, Vec3, box_mesh};
use std::sync::LazyLock;

type Contacts = DeformingContacts<Vector<f64>>;

const LAW: HertzMindlin<false, false> = HertzMindlin;
/// Radius of the bead [m].
const RADIUS: f64 = 0.01;
/// A bead and a surface of the same stuff.
const GLASS: Material = Material { young_pa: 1e7, poisson: 0.3, density_kg_m3: 2500.0 };

/// Their constants; the correction of the tail is found once.
static TABLE: LazyLock<PairTable> = LazyLock::new(|| {
    let interaction = |_, _| Interaction { restitution: 0.5, friction: 0.5 };
    PairTable::new(&[GLASS], Tail::CutCorrected, interaction).expect("these constants are in range")
});

fn bead(centre: Vec3) -> Sphere<F64> {
    let position = Vector::new(centre.x, centre.y, centre.z);
    Sphere { position, radius: RADIUS, mass: 0.0105, ..Default::default() }
}

/// Hertz's force of the bead on a rigid surface of its own stuff at an overlap [N].
fn hertz(overlap: f64) -> f64 {
    TABLE.pair(0, 0).normal_modulus * RADIUS.sqrt() * overlap.powf(1.5)
}

fn of(v: Vector<f64>) -> Vec3 {
    Vec3::new(v.x, v.y, v.z)
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

/// A bead that hits a free elastic block obliquely.
struct Impact {
    solid: Solid,
    contacts: Contacts,
    bead: Sphere<F64>,
    load: Load<f64>,
}

impl Impact {
    fn new(is_quadratic: bool) -> Self {
        let mut mesh = box_mesh(Vec3::new(0.1, 0.1, 0.05), [8, 8, 4]);
        if is_quadratic {
            mesh = mesh.to_quadratic();
        }
        let settings = Settings { formulation: Formulation::FiniteStrain, ..Settings::default() };
        let solid = Solid::new(mesh, vec![Elastic::hooke(1000.0, 1e7, 0.3)], settings).expect("a block");
        let facets = solid.mesh().facets("z_max").expect("a box has a top");
        let faces: Vec<Vec<u32>> = facets.iter().map(|&f| solid.mesh().facet_nodes(f)).collect();
        let mirror = Mirror::new(&faces, 2).expect("faces of tetrahedra");
        let mut bead = bead(Vec3::new(0.047, 0.061, 0.05 + 1.01 * RADIUS));
        bead.velocity = Vector::new(0.7, -0.3, -1.0);
        bead.spin = Vector::new(5.0, -8.0, 3.0);
        Self {
            contacts: DeformingContacts::new(mirror, |n| solid.position(n), 0, Margin::DEFAULT)
                .with_nodal_masses(|n| solid.nodal_mass()[n as usize]),
            solid,
            bead,
            load: Load::default(),
        }
    }

    fn kick_bead(&mut self, dt: f64) {
        self.bead.velocity += self.load.force * (dt / self.bead.mass);
        self.bead.spin += self.load.torque * (dt / self.bead.inertia());
    }

    /// One coupled step, the solid in `n` sub-steps.
    fn step(&mut self, dt: f64, n: u32) -> Result<(), DynamicsError> {
        let h = dt / f64::from(n);
        let impulsive = std::mem::take(&mut self.solid.state.applied);
        self.solid.state.applied = vec![Vec3::zeros(); impulsive.len()];
        for _ in 1..n {
            self.solid.step(h)?;
        }
        self.solid.advance_positions(h)?;
        self.kick_bead(dt / 2.0);
        self.bead.position += self.bead.velocity * dt;
        let solid = &self.solid;
        let kick = |k: usize| if n > 1 { impulsive[k] / solid.nodal_mass()[k] } else { Vec3::zeros() };
        let ahead = |node: u32| {
            let k = node as usize;
            solid.state.velocity[k] + (solid.state.acceleration[k] + kick(k)) * (0.5 * h)
        };
        self.contacts.follow(|node| solid.position(node), ahead);
        let mut loads = [Load::default()];
        let step = Step { law: &LAW, table: &*TABLE, time_step: dt, fastest: 3.0 };
        self.contacts.forces((&[self.bead], &[0]), &mut loads, &step, |_| ());
        self.load = loads[0];
        self.kick_bead(dt / 2.0);
        let mut applied = std::mem::take(&mut self.solid.state.applied);
        self.contacts.spread(|node, force| applied[node as usize] += force * f64::from(n));
        self.solid.state.applied = applied;
        self.solid.advance_velocities(h)
    }

    /// Momentum and angular momentum about the origin.
    fn momenta(&self) -> [Vec3; 2] {
        let solid = self.solid.momentum(&Vec3::zeros());
        let momentum = of(self.bead.velocity) * self.bead.mass;
        let spin = of(self.bead.spin) * self.bead.inertia();
        [solid.force + momentum, solid.moment + of(self.bead.position).cross(&momentum) + spin]
    }

    fn energy(&self) -> f64 {
        let (bead, ledger) = (&self.bead, self.contacts.ledger());
        bead.mass * bead.velocity.norm_squared() / 2.0
            + bead.inertia() * bead.spin.norm_squared() / 2.0
            + self.solid.kinetic_energy()
            + self.solid.strain_energy()
            + ledger.elastic()
            + ledger.dissipated()
    }
}

/// Largest change of a momentum at any step, over it; change of the energy, over it.
fn balance(is_quadratic: bool, n: u32, share: f64) -> Result<[f64; 2], DynamicsError> {
    let mut impact = Impact::new(is_quadratic);
    let dt = share * impact.solid.stable_time_step().dt;
    let (momenta, energy) = (impact.momenta(), impact.energy());
    let (mut n_touched, mut n_free, mut drift) = (0, 0, 0.0_f64);
    while n_free < 5 && n_touched < 100_000 {
        impact.step(dt, n)?;
        let touches = impact.contacts.n_contacts() > 0;
        n_touched += u32::from(touches);
        n_free += u32::from(n_touched > 0 && !touches);
        for (now, before) in impact.momenta().into_iter().zip(&momenta) {
            drift = drift.max((now - before).norm() / before.norm());
        }
    }
    Ok([drift, (impact.energy() - energy) / energy])
}

/// Momentum, angular momentum and energy of bead and block together.
pub fn bead_on_block() -> Vec<Row> {
    let case = ("bead on an elastic block", "conservation");
    let mut rows = Vec::new();
    for (is_quadratic, n, share) in [(false, 1, 0.4), (false, 4, 0.3), (true, 4, 0.3)] {
        let label = format!("{} nodes, {n} sub-steps", if is_quadratic { "ten" } else { "four" });
        let [drift, residual] = balance(is_quadratic, n, share).unwrap_or([f64::NAN; 2]);
        let what = format!("{label}: momenta, largest change at a step");
        rows.push(Row::absolute(case, what, "-", drift, (0.0, 1e-12)));
        rows.push(Row::absolute(case, format!("{label}: energy residual"), "-", residual, (0.0, 0.01)));
    }
    let [coarse, fine] =
        [0.4, 0.1].map(|share| balance(false, 1, share).map_or(f64::NAN, |[_, residual]| residual.abs()));
    let order = (coarse / fine).ln() / 4.0_f64.ln();
    rows.push(Row::absolute(case, "order of the energy residual in the step", "-", order, (1.0, 0.3)));
    rows
}
