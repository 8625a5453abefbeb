//! Three rectangles for themselves: the tilting law as P1 prints it, Eqs. (11)–(14), read as `docs/theory/tilting.md` says.
//!
//! It takes any three figures, and drives beds of elongated grains: use [`crate::Tilting`] unless the printed law is what you want.
//! Both arms are components of the constant vector from corner to centre, ½b sgn(n_j) E_j + ½a sgn(n_k) E_k: no angle is
//! ever computed.

use crate::{
    ArmNormalisation, Body, Contact, Couples, PairProperties, ParameterError, PlaneShape, Quaternion, Real,
    Response, RotationLaw, TiltingSettings, Vector,
};
use serde::{Deserialize, Serialize};

/// Three rectangles for themselves, for grains of one shape. Lengths are in units of the distance from the centre to the contact point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlaneTilting {
    /// Half the long side of the rectangle in planes 1, 2, 3, times the scale [-]; zero for a circle.
    long: [f64; 3],
    /// Half the short side [-].
    short: [f64; 3],
    /// Radius of the circle [-]; zero for a rectangle.
    round: [f64; 3],
    /// One over the width of the passage between corners [-].
    steepness: f64,
    inertia_ratios: [f64; 3],
}

/// Plane i has the side b along the lower and the side a along the higher of the two other axes; the sign is that
/// of E_j × E_k against E_i.
const PLANES: [(usize, usize, f64); 3] = [(1, 2, 1.0), (0, 2, -1.0), (0, 1, 1.0)];
/// Steepness of a jump: any number that is not zero lies beyond it.
const JUMP: f64 = 1e30;

impl PlaneTilting {
    /// The law for grains of one shape.
    ///
    /// # Errors
    /// When a constant is outside its range.
    pub fn new(settings: &TiltingSettings) -> Result<Self, ParameterError> {
        settings.validate()?;
        let mut law = Self {
            long: [0.0; 3],
            short: [0.0; 3],
            round: [0.0; 3],
            steepness: (1.0 / settings.smoothing_rad).min(JUMP),
            inertia_ratios: settings.inertia_ratios(),
        };
        for (i, plane) in settings.shape.planes().into_iter().enumerate() {
            match plane {
                PlaneShape::Circle { scale } => law.round[i] = scale,
                PlaneShape::Rectangle { aspect_ratio, scale } => {
                    // d cos γ and d sin γ with tan γ = A.
                    let cos = 1.0 / (1.0 + aspect_ratio * aspect_ratio).sqrt();
                    let long = match settings.arms {
                        ArmNormalisation::Inscribed => cos,
                        ArmNormalisation::LongSide => 1.0,
                    };
                    (law.long[i], law.short[i]) = (scale * long, scale * long * aspect_ratio);
                }
            }
        }
        Ok(law)
    }

    /// Torque [N·m] of `force` [N] on a grain turned by `frame`, in the world frame.
    ///
    /// `normal` points from the contact into the grain, `normal_force` [N] is the force along it, `arm` [m] the distance from the
    /// centre to the contact point.
    #[inline(always)]
    pub fn torque<T: Real>(
        &self,
        frame: &Quaternion<T>,
        normal: Vector<T>,
        normal_force: T,
        force: Vector<T>,
        arm: T,
    ) -> Vector<T> {
        // Written out: closures over arrays are not inlined into the vectorised pass.
        let axes = frame.axes();
        let n = [axes[0].dot(normal), axes[1].dot(normal), axes[2].dot(normal)];
        let f = [axes[0].dot(force), axes[1].dot(force), axes[2].dot(force)];
        let squares = [n[0] * n[0], n[1] * n[1], n[2] * n[2]];
        let steepness = T::from_f64(self.steepness);
        let sign = |n: T| (n * steepness).max(-T::ONE).min(T::ONE);
        let signs = [sign(n[0]), sign(n[1]), sign(n[2])];
        let mut torque = [T::ZERO; 3];
        let mut torsion = T::ZERO;
        for (i, (j, k, sign)) in PLANES.into_iter().enumerate() {
            let (long, short) = (T::from_f64(sign * self.long[i]), T::from_f64(sign * self.short[i]));
            let round = T::from_f64(sign * self.round[i]);
            // Arms are scaled by the length of the projected normal, so that n_j² + n_k² ≤ 1 stands in for a unit vector.
            let length = (squares[j] + squares[k]).sqrt();
            let lever_j = length * signs[j] * long + n[j] * round;
            let lever_k = length * signs[k] * short + n[k] * round;
            torque[i] = f[j] * lever_k - f[k] * lever_j;
            torsion += n[i] * (n[j] * lever_k - n[k] * lever_j);
        }
        // A force along the normal has no moment about its own line; the sum over planes would leave one.
        let torsion = torsion * normal_force;
        let part = |i: usize| axes[i] * ((torque[i] - n[i] * torsion) * arm);
        part(0) + part(1) + part(2)
    }
}

impl<T: Real> RotationLaw<T> for PlaneTilting {
    type Memory = ();
    type Frame = Quaternion<T>;

    #[inline(always)]
    fn couples(
        &self,
        contact: &Contact<T>,
        _: &PairProperties<T>,
        response: &Response<T>,
        bodies: &[Body<T, Quaternion<T>>; 2],
        (): (),
    ) -> (Couples<T>, ()) {
        let (normal, normal_force) = (contact.normal, response.normal_force);
        let force = normal * normal_force + response.tangential_force;
        // From the second body normal and force are both opposite, which leaves the torque as it is.
        let torque =
            |body: &Body<T, Quaternion<T>>| self.torque(&body.frame, normal, normal_force, force, body.arm);
        let torques = [torque(&bodies[0]), torque(&bodies[1])];
        let of_spheres = Couples::of_spheres(contact, response, bodies).torques;
        let spent = |b: usize| (of_spheres[b] - torques[b]).dot(bodies[b].spin);
        (Couples { torques, spent: spent(0) + spent(1) }, ())
    }

    #[inline(always)]
    fn inertia_ratios(&self) -> [f64; 3] {
        self.inertia_ratios
    }
}
