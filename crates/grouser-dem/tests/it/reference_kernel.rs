//! The sorted, blocked, listed engine against the plainest loop over all pairs.

use crate::*;

/// All pairs, one after the other, with the law called directly and the springs in a full matrix.
struct Plain {
    spheres: Vec<Sphere>,
    springs: Vec<Vec<Vector<f64>>>,
    accelerations: Vec<[Vector<f64>; 2]>,
    domain: Domain,
    pair: PairProperties,
}

impl Plain {
    fn step(&mut self, dt: f64) {
        let n = self.spheres.len();
        for (sphere, [linear, angular]) in self.spheres.iter_mut().zip(&self.accelerations) {
            sphere.position += (sphere.velocity + *linear * (0.5 * dt)) * dt;
            sphere.velocity += *linear * dt;
            sphere.spin += *angular * dt;
        }
        let mut loads = vec![Load::<f64>::default(); n];
        let size = self.domain.size();
        for i in 0..n {
            for j in i + 1..n {
                let (a, b) = (self.spheres[i], self.spheres[j]);
                let mut d = (a.position - b.position).to_array();
                for axis in 0..3 {
                    if self.domain.is_periodic[axis] {
                        d[axis] -= size[axis] * (d[axis] / size[axis]).round();
                    }
                }
                let d = Vector::from(d);
                let overlap = a.radius + b.radius - d.norm();
                if overlap <= 0.0 {
                    self.springs[i][j] = Vector::ZERO;
                    continue;
                }
                let normal = d * (1.0 / d.norm());
                let arms = [a.radius - overlap / 2.0, b.radius - overlap / 2.0];
                let contact = Contact {
                    overlap,
                    normal,
                    velocity: ContactVelocity::of(
                        a.velocity - b.velocity - (a.spin * arms[0] + b.spin * arms[1]).cross(normal),
                        normal,
                    ),
                    normal_spin: 0.5 * (a.spin + b.spin).dot(normal),
                    effective_radius: a.radius * b.radius / (a.radius + b.radius),
                    effective_mass: a.mass * b.mass / (a.mass + b.mass),
                    time_step: dt,
                };
                let law = HertzMindlin::new(Tail::CutCorrected);
                let (response, spring) = law.respond(&contact, &self.pair, self.springs[i][j]);
                self.springs[i][j] = spring;
                let force = normal * response.normal_force + response.tangential_force;
                let couple = normal.cross(response.tangential_force);
                loads[i].add(force, couple * -arms[0]);
                loads[j].add(-force, couple * -arms[1]);
            }
        }
        for ((sphere, load), [linear, angular]) in
            self.spheres.iter_mut().zip(&loads).zip(&mut self.accelerations)
        {
            let after = [load.force * (1.0 / sphere.mass), load.torque * (1.0 / sphere.inertia())];
            sphere.velocity += (after[0] - *linear) * (0.5 * dt);
            sphere.spin += (after[1] - *angular) * (0.5 * dt);
            (*linear, *angular) = (after[0], after[1]);
        }
    }
}

/// Largest distance between grains of the two engines after some steps.
fn largest_difference(n_grains: usize, is_periodic: [bool; 3], n_steps: u64) -> f64 {
    let (mut spheres, mut settings) = falling_column::<F64>(n_grains, 11);
    settings.planes.clear();
    settings.gravity = Vec3::zeros();
    let top = spheres.iter().fold(0.05_f64, |top, s| top.max(s.position.z + s.radius));
    settings.domain = Domain { lower: Vec3::zeros(), upper: Vec3::new(0.06, 0.06, top), is_periodic };
    for sphere in &mut spheres {
        // Everything falls towards the middle of the box.
        sphere.velocity =
            Vector::new(0.03 - sphere.position.x, 0.03 - sphere.position.y, 0.5 * top - sphere.position.z)
                * 60.0;
    }
    let pair = *table(0.5, 0.5, Tail::CutCorrected).pair(0, 0);
    let mut plain = Plain {
        springs: vec![vec![Vector::ZERO; n_grains]; n_grains],
        accelerations: vec![Default::default(); n_grains],
        domain: settings.domain,
        spheres: spheres.clone(),
        pair,
    };
    let law = HertzMindlin::new(Tail::CutCorrected);
    let mut bed = Bed::new(spheres, settings, table(0.5, 0.5, Tail::CutCorrected), law).unwrap();
    let mut most_contacts = 0;
    for _ in 0..n_steps {
        plain.step(2e-5);
        bed.step(2e-5).unwrap();
        most_contacts = most_contacts.max(bed.n_contacts());
    }
    assert!(
        n_grains < 8 || most_contacts > n_grains / 4,
        "{n_grains} grains had {most_contacts} contacts at most"
    );
    let size = settings_size(&plain.domain);
    bed.grains().spheres.iter().zip(&bed.grains().ids).fold(0.0, |worst: f64, (sphere, &id)| {
        let mut d = (sphere.position - plain.spheres[id as usize].position).to_array();
        for axis in 0..3 {
            if is_periodic[axis] {
                d[axis] -= size[axis] * (d[axis] / size[axis]).round();
            }
        }
        worst.max(Vector::from(d).norm())
    })
}

fn settings_size(domain: &Domain) -> [f64; 3] {
    let size = domain.size();
    [size.x, size.y, size.z]
}

#[test]
fn the_engine_moves_grains_as_the_plain_loop_does_for_any_number_of_them() {
    // Rounding differs (order of sums); over so few collisions it stays far below a picometre.
    for n_grains in [1, 2, 3, 7, 16, 33, 64, 150] {
        let open = largest_difference(n_grains, [false; 3], 900);
        assert!(open < 1e-11, "{n_grains} grains, open: {open} m");
        let periodic = largest_difference(n_grains, [true, true, false], 900);
        assert!(periodic < 1e-11, "{n_grains} grains, periodic: {periodic} m");
    }
}
