//! The translational law of P1: Hertz with a constant normal dashpot, a linear tangential spring, stick and slip angles.

use crate::{
    Contact, ContactEnergy, ContactLaw, ContactVelocity, Free, PairProperties, ParameterError, Real,
    Response, Vector, hertz_energy, hertz_stiffness,
};
use serde::{Deserialize, Serialize};

/// P1 Eqs. (3)–(6). The elastic part and the slip friction tan φ_g are those of the pair of materials; restitution is not used.
///
/// The force on the first body is F_N = 4/3 E* √R* δ^1.5 − k_n v_n, cut at zero, and the tangential spring c_t slides with
/// F_N tan φ_g once it has reached F_N tan φ_h. Background damping acts on grains, not on contacts: it belongs to the bed.
///
/// ```
/// use grouser_contact::*;
/// let angles = SlipAngles { stick_deg: 35.0, slip_deg: 30.0 };
/// let law = Dlr::new(1e4, 0.2, &angles)?;
/// assert!((angles.slip_friction()? - 0.57735).abs() < 1e-5);
/// assert!(SlipAngles { stick_deg: 20.0, slip_deg: 30.0 }.slip_friction().is_err());
/// # let _ = law;
/// # Ok::<(), ParameterError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Dlr {
    /// Tangential stiffness c_t [N/m].
    pub tangential_stiffness: f64,
    /// Normal damping k_n [N·s/m].
    pub normal_damping: f64,
    /// tan φ_h / tan φ_g ≥ 1 [-].
    pub stick_over_slip: f64,
}

/// Interparticle friction angles, both in [0°, 60°].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SlipAngles {
    /// Stick angle φ_h [°], not below the slip angle.
    pub stick_deg: f64,
    /// Slip angle φ_g [°].
    pub slip_deg: f64,
}

impl SlipAngles {
    /// Coefficient of sliding friction tan φ_g [-], for the table of materials.
    ///
    /// # Errors
    /// When an angle is outside its range.
    pub fn slip_friction(&self) -> Result<f64, ParameterError> {
        let (stick, slip) = (self.stick_deg, self.slip_deg);
        let expected = "in [0, 60] degrees: beyond, arms of angular grains are loaded mainly sideways and no soil is known";
        ParameterError::check("slip angle", slip, (0.0..=60.0).contains(&slip), expected)?;
        let expected =
            "between the slip angle and 60 degrees: a contact that slides before it sticks has no meaning";
        ParameterError::check("stick angle", stick, (slip..=60.0).contains(&stick), expected)?;
        Ok(slip.to_radians().tan())
    }
}

impl Dlr {
    /// Law of a tangential stiffness c_t [N/m] and a normal damping k_n [N·s/m].
    ///
    /// # Errors
    /// When a constant is outside its range.
    pub fn new(
        tangential_stiffness: f64,
        normal_damping: f64,
        angles: &SlipAngles,
    ) -> Result<Self, ParameterError> {
        let slip = angles.slip_friction()?;
        let holds = tangential_stiffness > 0.0 && tangential_stiffness.is_finite();
        ParameterError::check("tangential stiffness", tangential_stiffness, holds, "a positive number")?;
        let holds = normal_damping >= 0.0 && normal_damping.is_finite();
        ParameterError::check("normal damping", normal_damping, holds, "zero or a positive number")?;
        let stick_over_slip = if slip > 0.0 { angles.stick_deg.to_radians().tan() / slip } else { 1.0 };
        Ok(Self { tangential_stiffness, normal_damping, stick_over_slip })
    }
}

impl<T: Real> ContactLaw<T> for Dlr {
    type Memory = Vector<T>;
    type Rotation = Free;

    #[inline(always)]
    fn rotation(&self) -> Free {
        Free
    }

    #[inline(always)]
    fn respond(
        &self,
        contact: &Contact<T>,
        pair: &PairProperties<T>,
        spring: Vector<T>,
    ) -> (Response<T>, Vector<T>) {
        let &Contact { overlap, normal, effective_radius, time_step, .. } = contact;
        let ContactVelocity { normal: normal_velocity, tangential: tangential_velocity } = contact.velocity;
        // Eqs. (3)–(5)
        let stiffness = hertz_stiffness(pair.normal_modulus, (effective_radius * overlap).sqrt());
        let pushed = stiffness * overlap - T::from_f64(self.normal_damping) * normal_velocity;
        let normal_force = pushed.max(T::ZERO);

        // Eq. (6): the spring keeps the length of the stick limit while the contact slides at the slip limit.
        let turned = spring - normal * normal.dot(spring);
        let turned = turned + normal.cross(turned) * (contact.normal_spin * time_step);
        let stretched = turned + tangential_velocity * time_step;
        let tangential_stiffness = T::from_f64(self.tangential_stiffness);
        let slip_limit = pair.friction * normal_force;
        let stick_limit = slip_limit * T::from_f64(self.stick_over_slip);
        let trial = stretched * -tangential_stiffness;
        let trial_squared = trial.norm_squared();
        let is_sliding = trial_squared > stick_limit * stick_limit;
        let choose = |sliding: T, sticking: T| if is_sliding { sliding } else { sticking };
        let inverse = T::ONE / choose(trial_squared, T::ONE).sqrt();
        let tangential_force = trial * choose(slip_limit * inverse, T::ONE);
        let spring = stretched * choose(stick_limit * inverse, T::ONE);

        let spent = -tangential_force.dot(tangential_velocity);
        let energy = ContactEnergy {
            normal_elastic: hertz_energy(stiffness, overlap),
            tangential_elastic: T::from_f64(0.5) * tangential_stiffness * spring.norm_squared(),
            normal_damping: (stiffness * overlap - normal_force) * normal_velocity,
            tangential: spent,
            sliding: choose(spent, T::ZERO),
        };
        (Response { normal_force, tangential_force, energy }, spring)
    }
}
