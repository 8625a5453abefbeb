//! Tilting grains: spheres that resist rolling as angular grains do, P1 Eqs. (7)–(15); read as `docs/theory/tilting.md` says.
//!
//! ```text
//!        E_k (short side a)          the grain rests on corner C; n points from the contact into the grain
//!   .------|------.                  l_N = sgn θ · d cos(γ + |θ|)   lever at right angles to n
//!   |      o----- | E_j (long side b)  l_T =        d sin(γ + |θ|)   lever along n
//!   C-------------'                  θ = angle between the contact plane and side b, γ = arctan A, A = a/b
//! ```
//! The three rectangles are the sections of one box (or cylinder, or ball) of half sides h. Its corner below the centre is
//! at −ℓ, ℓ = Σ h_i sgn(n·E_i) E_i, in units of the distance from the centre to the contact point; in each rotation plane ℓ has
//! the components l_N and l_T. The torque is ℓ's, and the tangential spring feels the velocity of that corner: the torque of a
//! normal force is then the slope of F_N ℓ·n, and what the tangential force spends is what the motion loses.
//!
//! The torque is that of a normal force F̄ ≤ F_N which follows F_N within some impact times: a law whose torques follow the elastic
//! vibration of the overlap, while no force follows the turning, has an unsymmetric stiffness, and beds flutter.

use crate::{
    ArmNormalisation, Body, Contact, ContactVelocity, Couples, PairProperties, ParameterError, PlaneShape,
    Quaternion, Real, Response, RotationLaw, TiltingSettings, Vector, hertz_stiffness,
};
use serde::{Deserialize, Serialize};

/// The tilting law for grains of one shape; `IS_ROUND` where some figure of it is a circle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tilting<const IS_ROUND: bool = false> {
    /// Half sides h over the distance from the centre to the contact point [-] of the axes that end in a face, else 0.
    flat: [f64; 3],
    /// The same of the axes that lie in a circle, which is one figure of a cylinder or a ball; read where `IS_ROUND`.
    round: [f64; 3],
    /// Width w of the passage between corners [-], never zero.
    width: f64,
    /// 1/(π × impact times of the build-up) [-]; [`AT_ONCE`] without.
    following: f64,
    /// Dashpot on the lift over that of the normal force [-].
    lift_damping: f64,
    /// The largest dashpot on the lift times the step over the reduced mass [-].
    largest_damping: f64,
    inertia_ratios: [f64; 3],
}

/// Width of a jump: any component of a normal that is not zero lies beyond it.
const JUMP: f64 = 1e-30;
/// A rate against which every other vanishes.
const AT_ONCE: f64 = 1e30;
/// Share of the turning that the dashpot on one lift may stop within a step [-]: a grain has several contacts.
const STOPPED_IN_A_STEP: f64 = 0.25;
/// Half sides of one axis in its two planes may differ by rounding of what a user types [-].
const SAME_SIDE: f64 = 1e-6;

impl<const IS_ROUND: bool> Default for Tilting<IS_ROUND> {
    /// A ball: no more than a place to read a checkpoint into.
    fn default() -> Self {
        Self {
            flat: [0.0; 3],
            round: [1.0; 3],
            width: 1.0,
            following: 1.0,
            lift_damping: 1.0,
            largest_damping: 0.0,
            inertia_ratios: [0.4; 3],
        }
    }
}

impl<const IS_ROUND: bool> Tilting<IS_ROUND> {
    /// The law for grains of one shape.
    ///
    /// # Errors
    /// When a constant is outside its range, the figures are not the sections of one body, or one is a circle without `IS_ROUND`.
    pub fn new(settings: &TiltingSettings) -> Result<Self, ParameterError> {
        settings.validate()?;
        let shape = &settings.shape;
        let expected = "a law made for circles (`Tilting<true>`): this shape has one";
        ParameterError::check("roundness", 1.0, IS_ROUND || !shape.is_round(), expected)?;
        let (mut half, circles) = one_body(&shape.planes())?;
        if settings.arms == ArmNormalisation::Inscribed {
            let longest = longest_arm(&half, &circles);
            half = half.map(|side| side / longest);
        }
        let lies_in_circle = |i: usize| (0..3).any(|j| j != i && circles[i][j] > 0.0);
        let sides_where =
            |wanted: bool| std::array::from_fn(|i| if lies_in_circle(i) == wanted { half[i] } else { 0.0 });
        Ok(Self {
            flat: sides_where(false),
            round: sides_where(true),
            width: settings.smoothing_rad.max(JUMP),
            following: (1.0 / (std::f64::consts::PI * settings.build_up)).min(AT_ONCE),
            lift_damping: settings.lift_damping,
            largest_damping: STOPPED_IN_A_STEP / (settings.mobility() - 1.0),
            inertia_ratios: settings.inertia_ratios(),
        })
    }

    /// Half sides of the body over the distance from the centre to the contact point [-].
    pub fn half_sides(&self) -> [f64; 3] {
        std::array::from_fn(|i| self.flat[i] + self.round[i])
    }

    /// Vector from the touching corner to the centre [m] of a grain turned by `frame`, in the world frame. `normal` points from
    /// the contact into the grain, `arm` [m] is the distance from the centre to the contact point.
    ///
    /// ℓ·n is the height of the centre over the corner; h_i sgn n_i becomes h_i n_i/w within the width of the passage.
    #[inline(always)]
    pub fn lever<T: Real>(&self, frame: &Quaternion<T>, normal: Vector<T>, arm: T) -> Vector<T> {
        // Written out: closures over arrays are not inlined into the vectorised pass.
        let [e1, e2, e3] = frame.axes();
        let (n1, n2, n3) = (e1.dot(normal), e2.dot(normal), e3.dot(normal));
        let flat = |i: usize, n: T| {
            let most = T::from_f64(self.flat[i]);
            (n * T::from_f64(self.flat[i] / self.width)).max(-most).min(most)
        };
        let (mut along1, mut along2, mut along3) = (flat(0, n1), flat(1, n2), flat(2, n3));
        if IS_ROUND {
            // Squares of the normal's part in the circle: 1 for its axes, else 0.
            let in_circle = |i: usize| T::from_f64(if self.round[i] > 0.0 { 1.0 } else { 0.0 });
            let squared = n1 * n1 * in_circle(0) + n2 * n2 * in_circle(1) + n3 * n3 * in_circle(2);
            let inverse = T::ONE / squared.sqrt().max(T::from_f64(self.width));
            let round = |i: usize, n: T| n * (T::from_f64(self.round[i]) * inverse);
            along1 += round(0, n1);
            along2 += round(1, n2);
            along3 += round(2, n3);
        }
        (e1 * along1 + e2 * along2 + e3 * along3) * arm
    }

    /// Torque [N·m] of `force` [N] on a grain turned by `frame`, in the world frame; arguments as for [`Tilting::lever`].
    #[inline(always)]
    pub fn torque<T: Real>(
        &self,
        frame: &Quaternion<T>,
        normal: Vector<T>,
        force: Vector<T>,
        arm: T,
    ) -> Vector<T> {
        force.cross(self.lever(frame, normal, arm))
    }

    /// The part F̄ [N] of the normal force that turns the bodies, `before` a step ago: dF̄/dt = (F_N − F̄)/τ with τ some times
    /// π √(m*/k), k being the secant stiffness; F̄ ≤ F_N, and F̄ = 0 at first touch. Beside it the dashpot on the lift [N·s/m].
    ///
    /// Everything times m*: the root √(m* k) is the one that the dashpot of the normal force takes, and one division remains.
    #[inline(always)]
    fn built_up<T: Real>(
        &self,
        contact: &Contact<T>,
        pair: &PairProperties<T>,
        normal_force: T,
        before: T,
    ) -> (T, T) {
        let contact_radius = (contact.effective_radius * contact.overlap).sqrt();
        let stiffness = hertz_stiffness(pair.normal_modulus, contact_radius);
        let mass = contact.effective_mass;
        let impedance = (mass * stiffness).sqrt();
        // m* Δt/τ
        let step = impedance * (contact.time_step * T::from_f64(self.following));
        let most = mass * (T::from_f64(self.largest_damping) / contact.time_step);
        let dashpot = (pair.damping * impedance * T::from_f64(self.lift_damping)).min(most);
        (((before * mass + normal_force * step) / (mass + step)).min(normal_force), dashpot)
    }

    /// Levers of both bodies. From the second one the normal is opposite, and so is its lever: both are given for `normal`.
    #[inline(always)]
    fn levers<T: Real>(&self, normal: Vector<T>, bodies: &[Body<T, Quaternion<T>>; 2]) -> [Vector<T>; 2] {
        [
            self.lever(&bodies[0].frame, normal, bodies[0].arm),
            self.lever(&bodies[1].frame, normal, bodies[1].arm),
        ]
    }
}

/// Half sides of the body whose sections by the planes through two of its axes are `planes`, and which axes lie in one circle;
/// half the long side of an unscaled rectangle is 1.
fn one_body(planes: &[PlaneShape; 3]) -> Result<([f64; 3], [[f64; 3]; 3]), ParameterError> {
    let mut circles = [[0.0; 3]; 3];
    let mut seen: [Vec<f64>; 3] = Default::default();
    for (i, plane) in planes.iter().enumerate() {
        let [j, k] = [[1, 2], [0, 2], [0, 1]][i];
        let (long, short) = match *plane {
            PlaneShape::Rectangle { aspect_ratio, scale } => (scale, scale * aspect_ratio),
            PlaneShape::Circle { scale } => {
                (circles[j][k], circles[k][j]) = (1.0, 1.0);
                (scale, scale)
            }
        };
        seen[j].push(long);
        seen[k].push(short);
        circles[i][i] = 1.0;
    }
    for sides in &seen {
        let mismatch = (sides[0] / sides[1] - 1.0).abs();
        let expected = "the same half side of an axis from both planes that contain it (bar: A1 = 1, s1 = A, A2 = A3 = A): else the \
                        way from plane to plane around an axis yields work, and grains drive themselves; three rectangles \
                        for themselves are the law `PlaneTilting`";
        ParameterError::check("mismatch of the figures", mismatch, mismatch <= SAME_SIDE, expected)?;
    }
    let n_circles = planes.iter().filter(|plane| matches!(plane, PlaneShape::Circle { .. })).count();
    let expected = "no circle, one (a cylinder) or three (a ball)";
    ParameterError::check("number of circles", n_circles as f64, n_circles != 2, expected)?;
    Ok((seen.map(|sides| sides[0]), circles))
}

/// The longest half diagonal of a section; a circle's radius.
fn longest_arm(half: &[f64; 3], circles: &[[f64; 3]; 3]) -> f64 {
    let arm = |[j, k]: [usize; 2]| if circles[j][k] > 0.0 { half[j] } else { half[j].hypot(half[k]) };
    [[1, 2], [0, 2], [0, 1]].map(arm).into_iter().fold(0.0, f64::max)
}

impl<T: Real, const IS_ROUND: bool> RotationLaw<T> for Tilting<IS_ROUND> {
    /// The part F̄ of the normal force that turns the bodies [N].
    type Memory = T;
    type Frame = Quaternion<T>;

    /// Tangentially the corners' velocity, so that the tangential force spends what its torques take; along the normal that of the
    /// spheres, whose overlap it changes.
    #[inline(always)]
    fn velocity_at_contact(
        &self,
        normal: Vector<T>,
        centres: Vector<T>,
        bodies: &[Body<T, Quaternion<T>>; 2],
    ) -> Vector<T> {
        let velocity = self.velocity_in_parts(normal, centres, bodies);
        normal * velocity.normal + velocity.tangential
    }

    /// Neither part waits for the other, and the normal one not for the levers: most of a contact's law can begin at once.
    #[inline(always)]
    fn velocity_in_parts(
        &self,
        normal: Vector<T>,
        centres: Vector<T>,
        bodies: &[Body<T, Quaternion<T>>; 2],
    ) -> ContactVelocity<T> {
        let [first, second] = self.levers(normal, bodies);
        let turned = bodies[0].spin.cross(first) + bodies[1].spin.cross(second);
        let along = centres.dot(normal);
        ContactVelocity {
            normal: along,
            tangential: centres - turned - normal * (along - turned.dot(normal)),
        }
    }

    #[inline(always)]
    fn couples(
        &self,
        contact: &Contact<T>,
        pair: &PairProperties<T>,
        response: &Response<T>,
        bodies: &[Body<T, Quaternion<T>>; 2],
        built_up: T,
    ) -> (Couples<T>, T) {
        let (built_up, dashpot) = self.built_up(contact, pair, response.normal_force, built_up);
        let levers = self.levers(contact.normal, bodies);
        let turned = bodies[0].spin.cross(levers[0]) + bodies[1].spin.cross(levers[1]);
        // Rate at which the centres are lifted over the corners; the dashpot never pulls.
        let lift = turned.dot(contact.normal);
        let pushed = (built_up + dashpot * lift).max(T::ZERO);
        let force = contact.normal * pushed + response.tangential_force;
        let torques = [force.cross(levers[0]), force.cross(levers[1])];
        (Couples { torques, spent: pushed * lift }, built_up)
    }

    #[inline(always)]
    fn inertia_ratios(&self) -> [f64; 3] {
        self.inertia_ratios
    }
}
