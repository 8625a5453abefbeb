//! How much of the stable time step the contacts of a loaded bed leave (`docs/theory/grains.md`, "Stability under load").

use crate::block::FrameOf;
use crate::{Bed, cell_grid};
use grouser_contact::{
    Body, Contact, ContactLaw, ContactVelocity, Frame, PairProperties, Precision, Real, RotationLaw, Sphere,
    Vector,
};
use serde::{Deserialize, Serialize};

/// Where a bed is nearest to its stable step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Stability {
    /// Bound of (Δt² λ_K + 4 Δt λ_C)/4 [-]; below 1 the vibrations of all contacts are stable, [`Stability::LIMIT`] was never too
    /// much where it was tried.
    pub share: f64,
    /// Permanent number of the grain that the bound belongs to.
    pub grain: u32,
}

impl Stability {
    /// Share from which beds were seen to shake and to gain energy [-]: 2.8 at the earliest (`tests/it/stability.rs`).
    pub const LIMIT: f64 = 2.6;
}

impl<L: ContactLaw<P::Real>, P: Precision> Bed<L, P> {
    /// Bound of how much of the stable step `time_step` [s] takes, with the contacts as they are now.
    ///
    /// Every contact's mass is a share of its grains' in proportion to its stiffness (B. M. Irons, 1970, for elements):
    /// λ ≤ max over contacts of Σκ_i/m_i + Σκ_j/m_j. Stiffness and damping are asked of the law itself. Contacts with tools
    /// are not seen, and angular grains count as spheres.
    pub fn stability(&self, time_step: f64) -> Stability {
        let spheres = &self.grains().spheres;
        let period = self.settings().domain.period::<P::Coordinate>();
        let mut sums = vec![0.0; spheres.len()];
        let pairs: Vec<[usize; 2]> = self.contacts().map(|pair| pair.map(|place| place as usize)).collect();
        for &[i, j] in &pairs {
            let (a, b) = (&spheres[i], &spheres[j]);
            let distance = period.nearest(a.position - b.position).0.norm();
            let overlap = (a.radius + b.radius - distance).to_f64();
            let pair = self.pair_table().pair(a.material, b.material);
            let between = [a, b].map(Ball::of);
            let stiffness = vibration::<P, L>(self.law(), pair, between, overlap, time_step);
            sums[i] += stiffness;
            sums[j] += stiffness;
        }
        for plane in &self.settings().planes {
            for (sphere, sum) in spheres.iter().zip(&mut sums) {
                let overlap = sphere.radius.to_f64() - plane.height(cell_grid::to_f64(sphere));
                let pair = self.pair_table().pair(sphere.material, plane.material);
                let between = [Ball::of(sphere), Ball::WALL];
                *sum += vibration::<P, L>(self.law(), pair, between, overlap, time_step);
            }
        }
        let over_mass = |place: usize| sums[place] / spheres[place].mass.to_f64();
        let alone = (0..spheres.len()).map(|i| (over_mass(i), i));
        let together = pairs.iter().map(|&[i, j]| (over_mass(i) + over_mass(j), i));
        let (bound, place) =
            alone.chain(together).fold((0.0, 0), |most, next| if next.0 > most.0 { next } else { most });
        Stability { share: bound / 4.0, grain: self.grains().ids[place] }
    }
}

/// What matters of a body: radius [m] and mass [kg].
#[derive(Clone, Copy)]
struct Ball {
    radius: f64,
    mass: f64,
}

impl Ball {
    /// A plane is a ball of any size and weight.
    const WALL: Self = Self { radius: 1e30, mass: 1e30 };

    fn of<P: Precision>(sphere: &Sphere<P>) -> Self {
        Self { radius: sphere.radius.to_f64(), mass: sphere.mass.to_f64() }
    }
}

/// Δt² κ + 4 Δt γ [kg] of one contact: the larger of its normal vibration and of its tangential one, in which spheres give way 7/2
/// times as fast as bodies that do not turn.
fn vibration<P: Precision, L: ContactLaw<P::Real>>(
    law: &L,
    pair: &PairProperties<P::Real>,
    balls: [Ball; 2],
    overlap: f64,
    time_step: f64,
) -> f64 {
    if overlap <= 0.0 {
        return 0.0;
    }
    // Slow enough for the overlap of a step ago to be that of now, and for no contact to slide.
    let probe = Probe::<L, P> { law, pair, balls, overlap, speed: 1e-3 * overlap / time_step };
    let [elastic, pushed] = [0.0, -probe.speed].map(|speed| probe.normal_force(speed));
    // The tangent of Hertz's law is 3/2 of its secant.
    let [stiffness, dashpot] = [1.5 * elastic / overlap, (pushed - elastic) / probe.speed];
    let along = time_step * (time_step * stiffness + 4.0 * dashpot);
    // Within no time springs do not stretch, and dashpots are left. Laws stretch them by half a step or by a whole one.
    let both = |resistance: &dyn Fn(f64) -> f64| resistance(time_step) + resistance(1e-9 * time_step);
    let aside = both(&|within| probe.sliding_resistance(within));
    let rolling = both(&|within| probe.rolling_resistance(within));
    along.max(2.0 * time_step * (3.5 * aside + 2.5 * rolling))
}

/// A contact at rest, to be moved at a `speed` [m/s] that is small.
struct Probe<'a, L, P: Precision> {
    law: &'a L,
    pair: &'a PairProperties<P::Real>,
    balls: [Ball; 2],
    overlap: f64,
    speed: f64,
}

impl<L: ContactLaw<P::Real>, P: Precision> Probe<'_, L, P> {
    fn contact(&self, [along, aside]: [f64; 2], time_step: f64) -> Contact<P::Real> {
        let [a, b] = self.balls;
        let real = P::Real::from_f64;
        let harmonic = |a: f64, b: f64| real(1.0 / (1.0 / a + 1.0 / b));
        Contact {
            overlap: real(self.overlap),
            normal: Vector::new(P::Real::ZERO, P::Real::ZERO, P::Real::ONE),
            velocity: ContactVelocity {
                normal: real(along),
                tangential: Vector::new(real(aside), P::Real::ZERO, P::Real::ZERO),
            },
            normal_spin: P::Real::ZERO,
            effective_radius: harmonic(a.radius, b.radius),
            effective_mass: harmonic(a.mass, b.mass),
            time_step: real(time_step),
        }
    }

    /// Normal force at a speed along the normal [N].
    fn normal_force(&self, speed: f64) -> f64 {
        let contact = self.contact([speed, 0.0], 1e-9);
        self.law.respond(&contact, self.pair, L::Memory::default()).0.normal_force.to_f64()
    }

    /// Tangential force over speed, after `within` [s] of it [kg/s].
    fn sliding_resistance(&self, within: f64) -> f64 {
        let contact = self.contact([0.0, self.speed], within);
        let (response, _) = self.law.respond(&contact, self.pair, L::Memory::default());
        response.tangential_force.norm().to_f64() / self.speed
    }

    /// What the rotation law adds where the smaller of two spheres rolls: its torque over speed and radius [kg/s].
    fn rolling_resistance(&self, within: f64) -> f64 {
        if <L::Rotation as RotationLaw<P::Real>>::IS_SPHERE || FrameOf::<P::Real, L>::IS_TRACKED {
            return 0.0;
        }
        let [a, b] = self.balls;
        let radius = a.radius.min(b.radius);
        let real = P::Real::from_f64;
        let spin = real(self.speed / radius);
        let body = |ball: Ball, spin: P::Real| Body {
            arm: real(ball.radius),
            spin: Vector::new(P::Real::ZERO, spin, P::Real::ZERO),
            inverse_moment: real(1.0 / (ball.mass * ball.radius * ball.radius)),
            frame: FrameOf::<P::Real, L>::default(),
        };
        let contact = self.contact([0.0; 2], within);
        let (response, memory) = self.law.respond(&contact, self.pair, L::Memory::default());
        let bodies = [body(a, spin), body(b, P::Real::ZERO)];
        let (couples, _) = self.law.couples(&contact, self.pair, &response, &bodies, memory);
        couples.torques[0].norm().to_f64() / (self.speed * radius)
    }
}
