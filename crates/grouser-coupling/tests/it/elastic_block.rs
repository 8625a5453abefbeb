//! A bead on an elastic block that makes sub-steps, or that the bead makes sub-steps of.
//! What an impact conserves stands among the cases of `grouser verify`.

use grouser_contact::*;
use grouser_coupling::{DeformingContacts, Margin, Mirror, MovedGrains, Step, SteppedSolid, coupled_step};
use grouser_fem::{DynamicsError, Formulation, Material as Elastic, Settings, Solid};
use grouser_geometry::{Vec3, box_mesh};

use super::{RADIUS, bead, table};

fn of(v: Vector<f64>) -> Vec3 {
    Vec3::new(v.x, v.y, v.z)
}

const LAW: HertzMindlin = HertzMindlin::new(Tail::CutCorrected);

/// A block of rubber that stands in the world.
struct Block(Solid);

impl SteppedSolid for Block {
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

impl Block {
    fn new(damping: f64) -> Self {
        let mesh = box_mesh(Vec3::new(0.1, 0.1, 0.05), [8, 8, 4]);
        let settings =
            Settings { formulation: Formulation::FiniteStrain, mass_damping: damping, ..Settings::default() };
        Self(Solid::new(mesh, vec![Elastic::hooke(1000.0, 1e7, 0.3)], settings).unwrap())
    }

    fn contacts(&self) -> DeformingContacts<Vector<f64>> {
        let mesh = self.0.mesh();
        let faces: Vec<Vec<u32>> =
            mesh.facets("z_max").unwrap().iter().map(|&f| mesh.facet_nodes(f)).collect();
        let mirror = Mirror::new(&faces, 2).unwrap();
        DeformingContacts::new(mirror, |n| self.place(n), 0, Margin::DEFAULT)
            .with_nodal_masses(|n| self.0.nodal_mass()[n as usize])
    }
}

/// A bead that hits a free block.
struct Impact {
    block: Block,
    contacts: DeformingContacts<Vector<f64>>,
    bead: Sphere,
    load: Load,
    table: PairTable,
}

impl Impact {
    fn new() -> Self {
        let block = Block::new(0.0);
        let mut bead = bead(Vec3::new(0.047, 0.061, 0.05 + 1.01 * RADIUS));
        bead.velocity = Vector::new(0.7, -0.3, -1.0);
        bead.spin = Vector::new(5.0, -8.0, 3.0);
        Self { contacts: block.contacts(), block, bead, load: Load::default(), table: table() }
    }

    fn kick_bead(&mut self, dt: f64) {
        self.bead.velocity += self.load.force * (dt / self.bead.mass);
        self.bead.spin += self.load.torque * (dt / self.bead.inertia());
    }

    /// One coupled step.
    fn step(&mut self, dt: f64) {
        self.kick_bead(dt / 2.0);
        self.bead.position += self.bead.velocity * dt;
        let mut loads = [Load::default()];
        let moved = MovedGrains { spheres: &[self.bead], ids: &[0], orientations: None, loads: &mut loads };
        let step = Step { law: &LAW, table: &self.table, time_step: dt, fastest: 3.0 };
        coupled_step(&mut self.block, &mut self.contacts, moved, &step, 1, |_| ()).unwrap();
        self.load = loads[0];
        self.kick_bead(dt / 2.0);
    }

    /// One step of the solid, in which the bead makes `n` while the surface moves linearly.
    fn step_of_solid(&mut self, dt: f64, n: u32) {
        let solid = &mut self.block.0;
        let start: Vec<Vec3> = (0..solid.mesh().nodes.len()).map(|n| solid.position(n as u32)).collect();
        solid.advance_positions(dt).unwrap();
        let bead_dt = dt / f64::from(n);
        let mut applied = vec![Vec3::zeros(); start.len()];
        for k in 1..=n {
            self.kick_bead(bead_dt / 2.0);
            self.bead.position += self.bead.velocity * bead_dt;
            let (share, solid) = (f64::from(k) / f64::from(n), &self.block.0);
            let place = |n: u32| start[n as usize] * (1.0 - share) + solid.position(n) * share;
            self.contacts.follow_in(bead_dt, place);
            let mut loads = [Load::default()];
            let step = Step { law: &LAW, table: &self.table, time_step: bead_dt, fastest: 3.0 };
            self.contacts.forces((&[self.bead], &[0]), &mut loads, &step, |_| ());
            self.contacts.spread(|node, force| applied[node as usize] += force / f64::from(n));
            self.load = loads[0];
            self.kick_bead(bead_dt / 2.0);
        }
        self.block.0.state.applied = applied;
        self.block.0.advance_velocities(dt).unwrap();
    }

    fn momentum(&self) -> Vec3 {
        self.block.0.momentum(&Vec3::zeros()).force + of(self.bead.velocity) * self.bead.mass
    }
}

#[test]
fn a_bead_stepped_faster_than_the_solid_exchanges_the_same_impulse_with_it() {
    let after = |step: fn(&mut Impact, f64)| {
        let mut impact = Impact::new();
        let dt = 0.4 * impact.block.0.stable_time_step().dt;
        let before = impact.momentum();
        let n_steps = (4e-3 / dt) as u32;
        (0..n_steps).for_each(|_| step(&mut impact, dt));
        assert_eq!(impact.contacts.n_contacts(), 0);
        assert!((impact.momentum() - before).norm() < 1e-12 * before.norm());
        of(impact.bead.velocity)
    };
    let single = after(|impact, dt| impact.step(dt));
    let fine = after(|impact, dt| impact.step_of_solid(dt, 4));
    assert!((single - fine).norm() < 0.01 * single.norm(), "{single} {fine}");
}

#[test]
fn a_pressed_block_at_rest_loses_nothing_though_its_nodes_are_kicked_at_each_step() {
    // The impulse of a step moves a node at once by F Δt/m, the block takes it back before the next: no dashpot may see that.
    let mut block = Block::new(3e3);
    block.0.fix("z_min").unwrap();
    let mut contacts = block.contacts();
    let dt = 2.0 * block.0.stable_time_step().dt;
    let (table, bead) = (table(), bead(Vec3::new(0.047, 0.061, 0.05 + 0.8 * RADIUS)));
    let step = Step { law: &LAW, table: &table, time_step: dt, fastest: 0.0 };
    let mut force = 0.0;
    let mut run = |n_steps: u32| {
        for _ in 0..n_steps {
            let mut loads = [Load::default()];
            let moved = MovedGrains { spheres: &[bead], ids: &[0], orientations: None, loads: &mut loads };
            coupled_step(&mut block, &mut contacts, moved, &step, 4, |_| ()).unwrap();
            force = loads[0].force.z;
        }
        (force, contacts.ledger().dissipated())
    };
    let (force, before) = run(400);
    let (later, after) = run(100);
    assert!((later - force).abs() < 1e-6 * force, "{force} {later}");
    // What a dashpot that sees the kicks takes for a speed, F Δt/m, would spend in this time.
    let kick = force * dt / 0.0105;
    let spent = 0.01 * force * kick * 100.0 * dt;
    assert!((after - before).abs() < 1e-3 * spent, "{before} {after} {spent}");
}
