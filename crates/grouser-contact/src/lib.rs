//! Contact laws of grains: from overlap and relative motion to force and couple. No storage, no search.
//!
//! ```text
//!        second body j            first body i
//!          .--------.    n     .--------.        δ   = r_i + r_j − |x_i − x_j|   overlap, positive while touching
//!         /          \ ---->  /          \       n   = (x_i − x_j)/|x_i − x_j|   from j to i
//!        |      j     |<-δ-> |     i      |      v   = velocity of i against j at the contact point
//!         \          /        \          /       F_n > 0 pushes i along +n; j receives the opposite force
//!          '--------'          '--------'        contact point: the middle of the overlap, one for both
//! ```
//!
//! SI units. R* = r₁r₂/(r₁+r₂), m* = m₁m₂/(m₁+m₂), 1/E* = (1−ν₁²)/E₁ + (1−ν₂²)/E₂, 1/G* = (2−ν₁)/G₁ + (2−ν₂)/G₂.
//! P0 is M. Michael, F. Vogel, B. Peters, "DEM–FEM coupling simulations of the interactions between a tire tread and
//! granular terrain", Comput. Methods Appl. Mech. Engrg. (2015); its misprints are listed in `docs/theory/grains.md`.
//! P1 is R. Lichtenheldt, B. Schäfer, "Planetary rover locomotion on soft granular soils – efficient adaption of the rolling
//! behaviour of nonspherical grains for discrete element simulations", PARTICLES 2013 (`docs/theory/tilting.md`).
//!
//! A glass sphere presses on another one:
//! ```
//! use grouser_contact::*;
//! let glass = Material { young_pa: 48e9, poisson: 0.2, density_kg_m3: 2800.0 };
//! let between = Interaction { restitution: 0.9, friction: 0.35 };
//! let pair = PairProperties::new(&glass, &glass, &between, Tail::CutCorrected)?;
//! let contact = Contact {
//!     overlap: 1e-6,
//!     normal: Vector::new(0.0, 0.0, 1.0),
//!     velocity: ContactVelocity { normal: 0.0, tangential: Vector::new(0.01, 0.0, 0.0) },
//!     normal_spin: 0.0,
//!     effective_radius: 5e-3,
//!     effective_mass: 5.86e-3,
//!     time_step: 1e-8,
//! };
//! let (response, spring) = HertzMindlin::new(Tail::CutCorrected).respond(&contact, &pair, Vector::ZERO);
//! assert!((response.normal_force - 2.3570226).abs() < 1e-7); // 4/3 E* √R* δ^1.5
//! assert!(response.tangential_force.x < 0.0 && spring.x == 1e-10);
//! # Ok::<(), ParameterError>(())
//! ```

mod dlr;
mod error;
mod hertz_mindlin;
mod law;
mod ledger;
mod material;
mod normal;
mod precision;
mod real;
mod rotation;
mod sphere;
mod tangential;
mod vector;

pub use dlr::{Dlr, SlipAngles};
pub use error::ParameterError;
pub use hertz_mindlin::HertzMindlin;
pub use law::{BLOCK, Blocked, Contact, ContactEnergy, ContactLaw, ContactVelocity, Lanes, Memory, Response};
pub use ledger::ContactLedger;
pub use material::{Interaction, Material, PairProperties, PairTable};
pub use normal::{Tail, damping_coefficient, hertz_energy, hertz_stiffness, restitution_with_cut_tail};
pub use precision::{F32, F64, Mixed, Precision};
pub use real::Real;
pub use rotation::{
    ArmNormalisation, Body, ConstantRolling, Couples, ElasticPlasticRolling, Frame, Free, GrainInertia,
    GrainShape, PlaneShape, PlaneTilting, Quaternion, Rotating, RotationLaw, Tilting, TiltingSettings,
};
pub use sphere::{Load, Sphere};
pub use tangential::{Loading, Tangential, mindlin};
pub use vector::Vector;
