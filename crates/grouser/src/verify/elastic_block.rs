//! Cases of a bead on an elastic block, in the coupled step of `docs/theory/coupling.md`.

use super::Row;
use super::coupling::{Contacts, LAW, RADIUS, TABLE, bead, hertz};
use grouser_contact::{F64, Load, Sphere, Vector};
use grouser_coupling::{
    DeformingContacts, Margin, Mirror, MovedGrains, Spread, Step, SteppedSolid, coupled_step,
};
use grouser_fem::{
    DynamicsError, Formulation, Material as Elastic, Settings, Solid, SolidError, VolumetricTreatment,
};
use grouser_geometry::{Vec3, box_mesh};

fn of(v: Vector<f64>) -> Vec3 {
    Vec3::new(v.x, v.y, v.z)
}

/// Young's modulus [Pa] and Poisson's ratio of the block.
const YOUNG: f64 = 1e7;
const POISSON: f64 = 0.3;
/// Side of its cells [m].
const CELL: f64 = 0.0125;

/// An elastic solid that stands in the world.
struct Standing(Solid);

impl SteppedSolid for Standing {
    type Error = DynamicsError;

    fn advance_positions(&mut self, h: f64) -> Result<(), DynamicsError> {
        self.0.advance_positions(h)
    }
    fn advance_velocities(&mut self, h: f64) -> Result<(), DynamicsError> {
        self.0.advance_velocities(h)
    }
    fn place(&self, node: u32) -> Vec3 {
        self.0.position(node)
    }
    fn clear_forces(&mut self) {
        self.0.state.applied.fill(Vec3::zeros());
    }
    fn add_force(&mut self, node: u32, force: Vec3) {
        self.0.state.applied[node as usize] += force;
    }
}

impl Standing {
    /// A block of 0.1 × 0.1 × 0.05 m in 8 × 8 × 4 cells.
    fn block(is_quadratic: bool, settings: Settings) -> Result<Self, SolidError> {
        let mesh = box_mesh(Vec3::new(0.1, 0.1, 0.05), [8, 8, 4]);
        let mesh = if is_quadratic { mesh.to_quadratic() } else { mesh };
        Solid::new(mesh, vec![Elastic::hooke(1000.0, YOUNG, POISSON)], settings).map(Self)
    }

    /// Contacts of its top.
    fn contacts(&self) -> Contacts {
        let mesh = self.0.mesh();
        let top = mesh.facets("z_max").expect("a box has a top");
        let faces: Vec<Vec<u32>> = top.iter().map(|&f| mesh.facet_nodes(f)).collect();
        let mirror = Mirror::new(&faces, 2).expect("faces of tetrahedra");
        DeformingContacts::new(mirror, |n| self.place(n), 0, Margin::DEFAULT)
    }
}

/// A bead that hits a free elastic block obliquely.
struct Impact {
    solid: Standing,
    contacts: Contacts,
    bead: Sphere<F64>,
    load: Load<f64>,
}

impl Impact {
    /// Forces are spread over `spread` [m] where that is above 0.
    fn new(is_quadratic: bool, spread: f64) -> Self {
        let settings = Settings { formulation: Formulation::FiniteStrain, ..Settings::default() };
        let solid = Standing::block(is_quadratic, settings).expect("a block");
        let mut bead = bead(Vec3::new(0.047, 0.061, 0.05 + 1.01 * RADIUS));
        bead.velocity = Vector::new(0.7, -0.3, -1.0);
        bead.spin = Vector::new(5.0, -8.0, 3.0);
        let mut contacts = solid.contacts();
        if spread > 0.0 {
            let spread = Spread { radius: spread, plane_modulus: YOUNG / (1.0 - POISSON * POISSON) };
            contacts = contacts.with_spread(spread, |n| solid.place(n));
        }
        let contacts = contacts.with_nodal_masses(|n| solid.0.nodal_mass()[n as usize]);
        Self { contacts, solid, bead, load: Load::default() }
    }

    fn kick_bead(&mut self, dt: f64) {
        self.bead.velocity += self.load.force * (dt / self.bead.mass);
        self.bead.spin += self.load.torque * (dt / self.bead.inertia());
    }

    /// One coupled step, the solid in `n` sub-steps.
    fn step(&mut self, dt: f64, n: u32) -> Result<(), DynamicsError> {
        self.kick_bead(dt / 2.0);
        self.bead.position += self.bead.velocity * dt;
        let mut loads = [Load::default()];
        let moved = MovedGrains { spheres: &[self.bead], ids: &[0], orientations: None, loads: &mut loads };
        let step = Step { law: &LAW, table: &*TABLE, time_step: dt, fastest: 3.0 };
        coupled_step(&mut self.solid, &mut self.contacts, moved, &step, n, |_| ())?;
        self.load = loads[0];
        self.kick_bead(dt / 2.0);
        Ok(())
    }

    /// Momentum and angular momentum about the origin.
    fn momenta(&self) -> [Vec3; 2] {
        let solid = self.solid.0.momentum(&Vec3::zeros());
        let momentum = of(self.bead.velocity) * self.bead.mass;
        let spin = of(self.bead.spin) * self.bead.inertia();
        [solid.force + momentum, solid.moment + of(self.bead.position).cross(&momentum) + spin]
    }

    fn energy(&self) -> f64 {
        let (bead, ledger) = (&self.bead, self.contacts.ledger());
        bead.mass * bead.velocity.norm_squared() / 2.0
            + bead.inertia() * bead.spin.norm_squared() / 2.0
            + self.solid.0.kinetic_energy()
            + self.solid.0.strain_energy()
            + ledger.elastic()
            + ledger.dissipated()
    }
}

/// Largest change of a momentum at any step, over it; change of the energy, over it.
fn balance(is_quadratic: bool, n: u32, share: f64, spread: f64) -> Result<[f64; 2], DynamicsError> {
    let mut impact = Impact::new(is_quadratic, spread);
    let dt = share * impact.solid.0.stable_time_step().dt;
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
    for (is_quadratic, n, share, spread) in
        [(false, 1, 0.4, 0.0), (false, 4, 0.3, 0.0), (true, 4, 0.3, 0.0), (false, 4, 0.3, 3.0 * CELL)]
    {
        let spread_over = if spread > 0.0 { ", forces spread over three cells" } else { "" };
        let label =
            format!("{} nodes, {n} sub-steps{spread_over}", if is_quadratic { "ten" } else { "four" });
        let [drift, residual] = balance(is_quadratic, n, share, spread).unwrap_or([f64::NAN; 2]);
        let what = format!("{label}: momenta, largest change at a step");
        rows.push(Row::absolute(case, what, "-", drift, (0.0, 1e-12)));
        rows.push(Row::absolute(case, format!("{label}: energy residual"), "-", residual, (0.0, 0.01)));
    }
    let [coarse, fine] = [0.4, 0.1]
        .map(|share| balance(false, 1, share, 0.0).map_or(f64::NAN, |[_, residual]| residual.abs()));
    let order = (coarse / fine).ln() / 4.0_f64.ln();
    rows.push(Row::absolute(case, "order of the energy residual in the step", "-", order, (1.0, 0.3)));
    rows
}

/// Force [N] of the bead held where Hertz's contact, grain and block together, would have the radius `share` of a cell, once the
/// block has come to rest; Hertz's force there. None of the block's sides is held but its bottom.
fn pressed(settings: Settings, is_quadratic: bool, share: f64) -> Result<[f64; 2], DynamicsError> {
    let mut block = Standing::block(is_quadratic, settings).expect("a block");
    block.0.fix("z_min").expect("a box has a bottom");
    let mut contacts = block.contacts().with_nodal_masses(|n| block.0.nodal_mass()[n as usize]);
    let dt = 0.7 * block.0.stable_time_step().dt;
    let indentation = (share * CELL).powi(2) / RADIUS;
    let held = bead(Vec3::new(0.047, 0.061, 0.05 + RADIUS - indentation));
    let step = Step { law: &LAW, table: &*TABLE, time_step: dt, fastest: 0.0 };
    let mut force = 0.0;
    for _ in 0..(8e-3 / dt) as u32 {
        let mut loads = [Load::default()];
        let moved = MovedGrains { spheres: &[held], ids: &[0], orientations: None, loads: &mut loads };
        coupled_step(&mut block, &mut contacts, moved, &step, 1, |_| ())?;
        force = loads[0].force.z;
    }
    Ok([force, hertz(indentation)])
}

/// The law holds the compliance of grain and block near the contact; what the mesh adds to it falls as the contact radius a
/// over the size h of the elements.
pub fn bead_pressed() -> Vec<Row> {
    let case = ("bead pressed into an elastic block", "Hertz, as a/h goes to 0 (Johnson, Contact Mechanics)");
    let mut rows = Vec::new();
    for (name, volumetric, is_quadratic) in [
        ("four nodes, averaged pressure", VolumetricTreatment::NodalAverage, false),
        ("ten nodes", VolumetricTreatment::PerElement, true),
    ] {
        let settings = Settings { volumetric, mass_damping: 3e3, ..Settings::default() };
        let missing = |share: f64| {
            pressed(settings, is_quadratic, share).map_or(f64::NAN, |[force, hertz]| 1.0 - force / hertz)
        };
        let [coarse, fine] = [0.08, 0.02].map(missing);
        let order = (coarse / fine).ln() / 4.0_f64.ln();
        rows.push(Row::absolute(
            case,
            format!("{name}: order of the missing force in a/h"),
            "-",
            order,
            (1.0, 0.1),
        ));
        rows.push(Row::absolute(
            case,
            format!("{name}: force missing at a/h = 0.02"),
            "-",
            fine,
            (0.0, 0.03),
        ));
    }
    rows
}
