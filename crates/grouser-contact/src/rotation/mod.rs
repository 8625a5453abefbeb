//! How grains turn: one law, one file.

mod law;
mod planes;
mod quaternion;
mod rolling;
mod rotating;
mod shape;
mod tilting;

pub use law::{Body, Couples, Frame, Free, RotationLaw};
pub use planes::PlaneTilting;
pub use quaternion::Quaternion;
pub use rolling::{ConstantRolling, ElasticPlasticRolling};
pub use rotating::Rotating;
pub use shape::{ArmNormalisation, GrainInertia, GrainShape, PlaneShape, TiltingSettings};
pub use tilting::Tilting;
