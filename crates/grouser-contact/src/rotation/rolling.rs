//! Rolling resistance of spheres: J. Ai, J.-F. Chen, J. M. Rotter, J. Y. Ooi, Powder Technology 206 (2011) 269–282.
//!
//! Both laws act on the rolling rate, the part of ω_i − ω_j at right angles to the normal, and on the two bodies with
//! opposite torques up to μ_r R* F_n. They add to the torque of the tangential force.

use crate::{
    Body, Contact, Couples, PairProperties, ParameterError, Real, Response, RotationLaw, Vector,
    hertz_stiffness, mindlin,
};
use serde::{Deserialize, Serialize};

/// Constant directional torque (type A of Ai et al.): μ_r R* F_n against the rolling.
///
/// A torque that jumps with the direction would make resting grains tremble: it is bounded by a quarter of what
/// stops the pair within one step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConstantRolling {
    /// Coefficient of rolling friction μ_r ≥ 0 [-].
    pub friction: f64,
}

/// Elastic-plastic spring and dashpot (type C of Ai et al.; "epsd" in other codes): holds slopes at rest.
///
/// k_r = 2.25 k_n (μ_r R*)², C_r = 2 η_r √(I_r k_r), the sum cut at μ_r R* F_n. k_n is the secant stiffness of Hertz's law.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ElasticPlasticRolling {
    /// Coefficient of rolling friction μ_r ≥ 0 [-].
    pub friction: f64,
    /// Share η_r of critical damping, in [0, 1] [-].
    pub damping_ratio: f64,
}

impl ConstantRolling {
    /// Refuses a negative coefficient.
    ///
    /// # Errors
    /// Names the constant outside its range.
    pub fn new(friction: f64) -> Result<Self, ParameterError> {
        check_friction(friction)?;
        Ok(Self { friction })
    }
}

impl ElasticPlasticRolling {
    /// Refuses a negative coefficient and damping outside [0, 1].
    ///
    /// # Errors
    /// Names the constant outside its range.
    pub fn new(friction: f64, damping_ratio: f64) -> Result<Self, ParameterError> {
        check_friction(friction)?;
        let holds = (0.0..=1.0).contains(&damping_ratio);
        ParameterError::check("rolling damping ratio", damping_ratio, holds, "in [0, 1]")?;
        Ok(Self { friction, damping_ratio })
    }
}

fn check_friction(friction: f64) -> Result<(), ParameterError> {
    let holds = friction >= 0.0 && friction.is_finite();
    ParameterError::check("rolling friction", friction, holds, "zero or a positive number")
}

/// ω_i − ω_j without its part about the normal [rad/s].
#[inline(always)]
fn rolling_rate<T: Real>(normal: Vector<T>, bodies: &[Body<T, ()>; 2]) -> Vector<T> {
    let relative = bodies[0].spin - bodies[1].spin;
    relative - normal * relative.dot(normal)
}

/// The sphere's torques and `torque` on the first body, its opposite on the second.
#[inline(always)]
fn with_rolling<T: Real>(
    contact: &Contact<T>,
    response: &Response<T>,
    bodies: &[Body<T, ()>; 2],
    torque: Vector<T>,
    rate: Vector<T>,
) -> Couples<T> {
    let [first, second] = Couples::of_spheres(contact, response, bodies).torques;
    Couples { torques: [first + torque, second - torque], spent: -torque.dot(rate) }
}

impl<T: Real> RotationLaw<T> for ConstantRolling {
    type Memory = ();
    type Frame = ();

    #[inline(always)]
    fn couples(
        &self,
        contact: &Contact<T>,
        _: &PairProperties<T>,
        response: &Response<T>,
        bodies: &[Body<T, ()>; 2],
        (): (),
    ) -> (Couples<T>, ()) {
        let rate = rolling_rate(contact.normal, bodies);
        let limit =
            T::from_f64(self.friction) * contact.effective_radius * response.normal_force.max(T::ZERO);
        // J_r = 2/5 / (1/(m r²)_i + 1/(m r²)_j)
        let both = bodies[0].inverse_moment + bodies[1].inverse_moment;
        let stopping = T::from_f64(0.1) / (both * contact.time_step);
        let per_rate = (limit / (rate.norm() + T::from_f64(1e-30))).min(stopping);
        (with_rolling(contact, response, bodies, rate * -per_rate, rate), ())
    }
}

impl<T: Real> RotationLaw<T> for ElasticPlasticRolling {
    /// Rolling angle stored in the spring [rad].
    type Memory = Vector<T>;
    type Frame = ();

    #[inline(always)]
    fn couples(
        &self,
        contact: &Contact<T>,
        pair: &PairProperties<T>,
        response: &Response<T>,
        bodies: &[Body<T, ()>; 2],
        angle: Vector<T>,
    ) -> (Couples<T>, Vector<T>) {
        let &Contact { overlap, normal, velocity, effective_radius, time_step, .. } = contact;
        let rate = rolling_rate(normal, bodies);
        // μ_r R*
        let length = T::from_f64(self.friction) * effective_radius;
        let normal_stiffness = hertz_stiffness(pair.normal_modulus, (effective_radius * overlap).sqrt());
        // A floor keeps 1/k_r finite without rolling friction.
        let floor = T::from_f64(1e-30);
        let stiffness = T::from_f64(2.25) * normal_stiffness * length * length + floor;
        // I_r is taken about the contact: 7/5 m r² each.
        let both = bodies[0].inverse_moment + bodies[1].inverse_moment;
        let inertia = T::from_f64(1.4) / both;
        let dashpot = T::from_f64(2.0 * self.damping_ratio) * (inertia * stiffness).sqrt();
        // Turned with the pair; under growing load the torque is kept, under falling load the angle (as in Mindlin's spring).
        let turned = angle - normal * normal.dot(angle);
        let turned = turned + normal.cross(turned) * (contact.normal_spin * time_step);
        let overlap_before = (overlap + velocity.normal * time_step).max(T::ZERO).min(overlap);
        let kept_share = (overlap_before + overlap_before) / (overlap_before + overlap);
        let stretched = turned * kept_share + rate * time_step;
        let limit = length * response.normal_force.max(T::ZERO);
        let rolling = mindlin(stretched, rate, stiffness, T::ONE / stiffness, dashpot, limit);
        (with_rolling(contact, response, bodies, rolling.force, rate), rolling.spring)
    }
}
