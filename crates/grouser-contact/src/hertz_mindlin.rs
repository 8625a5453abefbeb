//! Hertz–Mindlin with Tsuji damping and Coulomb friction: P0 Eqs. (16)–(27).

use crate::{
    Contact, ContactEnergy, ContactLaw, ContactVelocity, Free, Loading, PairProperties, Real, Response, Tail,
    Vector, hertz_energy, hertz_stiffness, mindlin,
};
use serde::{Deserialize, Serialize};

/// The law of P0. `TOTAL_DISPLACEMENT`: [`Loading::TotalDisplacement`] instead of [`Loading::Passive`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HertzMindlin<const TOTAL_DISPLACEMENT: bool = false> {
    /// What becomes of the dashpot's attraction.
    pub tail: Tail,
}

impl HertzMindlin {
    /// The law with a spring that yields no energy on any closed path of loading.
    pub const fn new(tail: Tail) -> Self {
        Self { tail }
    }
}

impl<const TOTAL_DISPLACEMENT: bool> HertzMindlin<TOTAL_DISPLACEMENT> {
    /// The loading rule that this type stands for.
    pub const LOADING: Loading =
        if TOTAL_DISPLACEMENT { Loading::TotalDisplacement } else { Loading::Passive };

    /// The smallest normal force [N].
    #[inline(always)]
    fn least_force<T: Real>(&self) -> T {
        match self.tail {
            Tail::Keep => T::from_f64(f64::NEG_INFINITY),
            Tail::CutCorrected => T::ZERO,
        }
    }
}

impl<T: Real, const TOTAL_DISPLACEMENT: bool> ContactLaw<T> for HertzMindlin<TOTAL_DISPLACEMENT> {
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
        let &Contact { overlap, normal, effective_radius, effective_mass, time_step, .. } = contact;
        let ContactVelocity { normal: normal_velocity, tangential: tangential_velocity } = contact.velocity;
        // Normal: F_n = k δ − c v_n, the rate being the signed v·n (negative on approach).
        let contact_radius = (effective_radius * overlap).sqrt();
        let stiffness = hertz_stiffness(pair.normal_modulus, contact_radius);
        let dashpot = pair.damping * (effective_mass * stiffness).sqrt();
        let pushed = stiffness * overlap - dashpot * normal_velocity;
        let normal_force = pushed.max(self.least_force());
        let limit = pair.friction * normal_force.max(T::ZERO);

        // Tangential: the spring is turned with the pair, stretched by the sliding, cut at Coulomb's limit.
        let turned = spring - normal * normal.dot(spring);
        let turned = turned + normal.cross(turned) * (contact.normal_spin * time_step);
        let tangential_stiffness = pair.tangential_modulus * contact_radius;
        let tangential_dashpot = pair.tangential_damping_ratio * dashpot;
        // While the load grows the *force* is kept, so the stretch shrinks by √(δ₀/δ), δ₀ being the overlap a step ago;
        // while it falls the stretch is kept and the force falls with the contact radius. The root is taken as
        // 2 δ₀/(δ₀ + δ): equal to first order in the step, and never larger, so that no step size yields energy.
        // A contact that began within the step (δ₀ < 0) slid for the share δ/(δ − δ₀) of it.
        let overlap_a_step_ago = (overlap + normal_velocity * time_step).min(overlap);
        let is_new = overlap_a_step_ago < T::ZERO;
        let half = T::from_f64(0.5);
        let (both_overlaps, share_above) = if is_new {
            (overlap - overlap_a_step_ago, overlap)
        } else {
            (overlap_a_step_ago + overlap, overlap_a_step_ago + overlap_a_step_ago)
        };
        // One division serves the share and 1/k_t.
        let inverse = T::ONE / (both_overlaps * tangential_stiffness);
        let softness = both_overlaps * inverse;
        let share = share_above * (tangential_stiffness * inverse);
        let (kept_share, slid_share) = if is_new { (T::ZERO, share) } else { (share, half) };
        let kept = if TOTAL_DISPLACEMENT { turned } else { turned * kept_share };
        // The memory runs half a step ahead: half of each step's sliding is added with the velocity at its beginning,
        // half with that at its end.
        let stretched = kept + tangential_velocity * (time_step * slid_share);
        let tangential = mindlin(
            stretched,
            tangential_velocity,
            tangential_stiffness,
            softness,
            tangential_dashpot,
            limit,
        );

        let ahead = tangential.spring + tangential_velocity * (half * time_step);
        let spent = -tangential.force.dot(tangential_velocity);
        let energy = ContactEnergy {
            normal_elastic: hertz_energy(stiffness, overlap),
            tangential_elastic: half * tangential_stiffness * tangential.spring.norm_squared(),
            normal_damping: (stiffness * overlap - normal_force) * normal_velocity,
            tangential: spent,
            sliding: if tangential.is_sliding { spent } else { T::ZERO },
        };
        (Response { normal_force, tangential_force: tangential.force, energy }, ahead)
    }
}
