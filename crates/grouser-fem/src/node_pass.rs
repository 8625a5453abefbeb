//! What happens at a node once the elements have given their forces: loads, acceleration, second half of the velocity change.
//!
//! One pass over the nodes reads and writes each of their vectors once (`docs/theory/elastic_solids.md`, steps 5 to 7).

use grouser_geometry::Vec3;
use rayon::prelude::*;

use crate::elements::NodeForces;
use crate::loads::Spin;
use crate::mass::Mass;

/// Nodes that one task works on; the sums of powers are taken in this grain, whatever the number of threads.
const CHUNK: usize = 2048;

/// Power of the external forces and of damping proportional to mass at the end of a step [W].
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Power {
    pub external: f64,
    pub mass_damping: f64,
}

/// Everything that acts on the nodes beside each other.
#[derive(Clone, Copy)]
pub(crate) struct NodePass<'a> {
    pub internal: NodeForces<'a>,
    /// Forces of the caller [N].
    pub applied: &'a [Vec3],
    /// Forces of pressures and of a turning frame [N], where there are any.
    pub distributed: Option<&'a [Vec3]>,
    /// Mass that hangs on each node [kg].
    pub nodal_mass: &'a [f64],
    /// Gravity in the solid's frame [m/s²].
    pub gravity: Vec3,
    /// Turning of the solid's frame, where it turns.
    pub spin: Option<Spin>,
    /// Damping proportional to mass [1/s].
    pub alpha: f64,
    /// Which components do not accelerate.
    pub is_held: &'a [[bool; 3]],
    /// Whether to use threads.
    pub is_parallel: bool,
}

impl NodePass<'_> {
    /// Force of everything but elements, damping and Coriolis on node `n` [N].
    #[inline(always)]
    fn external(&self, n: usize) -> Vec3 {
        let force = self.applied[n] + self.gravity * self.nodal_mass[n];
        self.distributed.map_or(force, |distributed| force + distributed[n])
    }

    /// Force on node `n` that the supports of a node held in all components must balance [N].
    pub fn unbalanced(&self, n: usize, velocity: &Vec3) -> Vec3 {
        let mut force = self.internal.of(n) + self.external(n);
        if let Some(spin) = &self.spin {
            force -= spin.angular_velocity.cross(velocity) * (2.0 * self.nodal_mass[n]);
        }
        force - velocity * (self.alpha * self.nodal_mass[n])
    }

    /// a = M⁻¹ f and v += `half_step` a; returns the powers with the new velocities.
    pub fn run(
        &self,
        mass: &Mass,
        half_step: f64,
        velocity: &mut [Vec3],
        acceleration: &mut [Vec3],
    ) -> Power {
        match (mass, self.spin.is_some()) {
            (Mass::Consistent(_), _) => self.run_consistent(mass, half_step, velocity, acceleration),
            (Mass::Lumped(_), false) => self.run_lumped::<false>(half_step, velocity, acceleration),
            (Mass::Lumped(_), true) => self.run_lumped::<true>(half_step, velocity, acceleration),
        }
    }

    fn run_lumped<const TURNS: bool>(
        &self,
        half_step: f64,
        velocity: &mut [Vec3],
        acceleration: &mut [Vec3],
    ) -> Power {
        let chunk = |(c, (velocity, acceleration)): (usize, (&mut [Vec3], &mut [Vec3]))| {
            let mut power = Power::default();
            for (i, (v, a)) in velocity.iter_mut().zip(acceleration).enumerate() {
                let n = c * CHUNK + i;
                let external = self.external(n);
                let damping = *v * (-self.alpha * self.nodal_mass[n]);
                let free = (self.internal.of(n) + external + damping) / self.nodal_mass[n];
                self.kick::<TURNS>(n, free, half_step, v, a);
                power.external += external.dot(v);
                power.mass_damping -= damping.dot(v);
            }
            power
        };
        let powers: Vec<Power> = if self.is_parallel {
            velocity
                .par_chunks_mut(CHUNK)
                .zip(acceleration.par_chunks_mut(CHUNK))
                .enumerate()
                .map(chunk)
                .collect()
        } else {
            velocity.chunks_mut(CHUNK).zip(acceleration.chunks_mut(CHUNK)).enumerate().map(chunk).collect()
        };
        powers.iter().fold(Power::default(), |sum, p| Power {
            external: sum.external + p.external,
            mass_damping: sum.mass_damping + p.mass_damping,
        })
    }

    fn run_consistent(
        &self,
        mass: &Mass,
        half_step: f64,
        velocity: &mut [Vec3],
        acceleration: &mut [Vec3],
    ) -> Power {
        let n = velocity.len();
        let external: Vec<Vec3> = (0..n).map(|i| self.external(i)).collect();
        let mut damping = vec![Vec3::zeros(); n];
        if self.alpha > 0.0 {
            mass.multiply(velocity, &mut damping);
            damping.iter_mut().for_each(|d| *d *= -self.alpha);
        }
        let force: Vec<Vec3> = (0..n).map(|i| self.internal.of(i) + external[i] + damping[i]).collect();
        mass.solve(&force, self.is_held, acceleration);
        let mut power = Power::default();
        for i in 0..n {
            let free = acceleration[i];
            self.kick::<true>(i, free, half_step, &mut velocity[i], &mut acceleration[i]);
            power.external += external[i].dot(&velocity[i]);
            power.mass_damping -= damping[i].dot(&velocity[i]);
        }
        power
    }

    /// Velocity and acceleration of node `n` from its acceleration without Coriolis' share.
    #[inline(always)]
    fn kick<const TURNS: bool>(&self, n: usize, free: Vec3, half_step: f64, v: &mut Vec3, a: &mut Vec3) {
        let (before, is_held) = (*v, self.is_held[n]);
        *v += free * half_step;
        *a = free;
        if TURNS && let Some(spin) = &self.spin {
            // v + dt w x v = v(n+1/2) + dt/2 a: Coriolis' force at the mean velocity does no work.
            let w = spin.angular_velocity * (2.0 * half_step);
            *v = (*v - w.cross(v) + w * w.dot(v)) / (1.0 + w.norm_squared());
            *a -= 2.0 * spin.angular_velocity.cross(v);
        }
        if is_held != [false; 3] {
            for c in (0..3).filter(|&c| is_held[c]) {
                v[c] = before[c];
                a[c] = 0.0;
            }
        }
    }
}
