//! A bead that hits a free elastic block: momentum, angular momentum and energy of both together, with sub-steps on either side.

use grouser_contact::*;
use grouser_coupling::{DeformingContacts, Margin, Mirror, Step};
use grouser_fem::{Formulation, Material as Elastic, Settings, Solid};
use grouser_geometry::{Vec3, box_mesh};

use super::{RADIUS, bead, table};

fn of(v: Vector<f64>) -> Vec3 {
    Vec3::new(v.x, v.y, v.z)
}

/// Steps of the bead and of the solid in one coupled step.
#[derive(Clone, Copy)]
struct SubSteps {
    bead: u32,
    solid: u32,
}

struct Impact {
    solid: Solid,
    contacts: DeformingContacts<Vector<f64>>,
    bead: Sphere,
    load: Load,
    table: PairTable,
}

impl Impact {
    fn new(is_quadratic: bool) -> Self {
        let mut mesh = box_mesh(Vec3::new(0.1, 0.1, 0.05), [8, 8, 4]);
        if is_quadratic {
            mesh = mesh.to_quadratic();
        }
        let settings = Settings { formulation: Formulation::FiniteStrain, ..Settings::default() };
        let solid = Solid::new(mesh, vec![Elastic::hooke(1000.0, 1e7, 0.3)], settings).unwrap();
        let facets = solid.mesh().facets("z_max").unwrap();
        let faces: Vec<Vec<u32>> = facets.iter().map(|&f| solid.mesh().facet_nodes(f)).collect();
        let mirror = Mirror::new(&faces, 2).unwrap();
        let mut bead = bead(Vec3::new(0.047, 0.061, 0.05 + 1.01 * RADIUS));
        bead.velocity = Vector::new(0.7, -0.3, -1.0);
        bead.spin = Vector::new(5.0, -8.0, 3.0);
        Self {
            contacts: DeformingContacts::new(mirror, |n| solid.position(n), 0, Margin::DEFAULT)
                .with_nodal_masses(|n| solid.nodal_mass()[n as usize]),
            solid,
            bead,
            load: Load::default(),
            table: table(),
        }
    }

    fn kick_bead(&mut self, dt: f64) {
        self.bead.velocity += self.load.force * (dt / self.bead.mass);
        self.bead.spin += self.load.torque * (dt / self.bead.inertia());
    }

    /// One coupled step: the bead in `sub.bead` steps while the surface moves linearly, the solid in `sub.solid` steps.
    fn step(&mut self, dt: f64, sub: SubSteps) {
        let start: Vec<Vec3> =
            (0..self.solid.mesh().nodes.len()).map(|n| self.solid.position(n as u32)).collect();
        let h = dt / f64::from(sub.solid);
        self.solid.state.applied.fill(Vec3::zeros());
        for _ in 1..sub.solid {
            self.solid.step(h).unwrap();
        }
        self.solid.advance_positions(h).unwrap();
        let bead_dt = dt / f64::from(sub.bead);
        let mut applied = vec![Vec3::zeros(); start.len()];
        for k in 1..=sub.bead {
            self.kick_bead(bead_dt / 2.0);
            self.bead.position += self.bead.velocity * bead_dt;
            let (share, solid) = (f64::from(k) / f64::from(sub.bead), &self.solid);
            let place = |n: u32| start[n as usize] * (1.0 - share) + solid.position(n) * share;
            self.contacts.follow(place, |n| (solid.position(n) - start[n as usize]) / dt);
            let mut loads = [Load::default()];
            let step = Step {
                law: &HertzMindlin::<false, false>,
                table: &self.table,
                time_step: bead_dt,
                fastest: 3.0,
            };
            self.contacts.forces((&[self.bead], &[0]), &mut loads, &step, |_| ());
            // The impulse of the whole step at its end.
            let weight = f64::from(sub.solid) / f64::from(sub.bead);
            self.contacts.spread(|n, force| applied[n as usize] += force * weight);
            self.load = loads[0];
            self.kick_bead(bead_dt / 2.0);
        }
        self.solid.state.applied = applied;
        self.solid.advance_velocities(h).unwrap();
    }

    /// Momentum and angular momentum about the origin.
    fn momenta(&self) -> [Vec3; 2] {
        let solid = self.solid.momentum(&Vec3::zeros());
        let momentum = of(self.bead.velocity) * self.bead.mass;
        let spin = of(self.bead.spin) * self.bead.inertia();
        [solid.force + momentum, solid.moment + of(self.bead.position).cross(&momentum) + spin]
    }

    fn energy(&self) -> f64 {
        let bead = &self.bead;
        let ledger = self.contacts.ledger();
        bead.mass * bead.velocity.norm_squared() / 2.0
            + bead.inertia() * bead.spin.norm_squared() / 2.0
            + self.solid.kinetic_energy()
            + self.solid.strain_energy()
            + ledger.elastic()
            + ledger.dissipated()
    }
}

/// Residual of the energy over an oblique impact in coupled steps of `share` of the solid's stable step; momenta are checked at
/// each step.
fn energy_residual(is_quadratic: bool, solid: u32, share: f64) -> f64 {
    let mut impact = Impact::new(is_quadratic);
    let dt = share * impact.solid.stable_time_step().dt;
    let (momenta, energy) = (impact.momenta(), impact.energy());
    let (mut n_touched, mut n_free) = (0, 0);
    while n_free < 20 {
        impact.step(dt, SubSteps { bead: 1, solid });
        let touches = impact.contacts.n_contacts() > 0;
        n_touched += u32::from(touches);
        n_free += u32::from(n_touched > 0 && !touches);
        for (now, before) in impact.momenta().into_iter().zip(&momenta) {
            assert!((now - before).norm() < 1e-12 * before.norm(), "{now} {before}");
        }
        assert!(n_touched < 10_000);
    }
    assert!(n_touched > 100 && impact.bead.velocity.z > 0.0, "{n_touched}");
    (impact.energy() - energy).abs() / energy
}

#[test]
fn momentum_is_exact_at_each_step_and_energy_within_one_per_cent_of_an_oblique_impact() {
    for (is_quadratic, solid) in [(false, 4), (true, 1), (true, 6)] {
        let residual = energy_residual(is_quadratic, solid, 0.3);
        assert!(residual < 0.01, "{is_quadratic} {solid} {residual}");
    }
    let (coarse, fine) = (energy_residual(false, 1, 0.4), energy_residual(false, 1, 0.1));
    assert!(coarse < 0.01 && fine < 0.35 * coarse, "{coarse} {fine}");
}

#[test]
fn a_bead_stepped_faster_than_the_solid_exchanges_the_same_impulse_with_it() {
    let after = |sub: SubSteps| {
        let mut impact = Impact::new(false);
        let dt = 0.4 * impact.solid.stable_time_step().dt;
        let before = impact.momenta()[0];
        let n_steps = (4e-3 / dt) as u32;
        (0..n_steps).for_each(|_| impact.step(dt, sub));
        assert_eq!(impact.contacts.n_contacts(), 0);
        assert!((impact.momenta()[0] - before).norm() < 1e-12 * before.norm());
        of(impact.bead.velocity)
    };
    let (single, fine) = (after(SubSteps { bead: 1, solid: 1 }), after(SubSteps { bead: 4, solid: 1 }));
    assert!((single - fine).norm() < 0.01 * single.norm(), "{single} {fine}");
}
