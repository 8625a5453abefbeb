//! Geometry of terramechanics: what lies under every other crate.
//!
//! SI units and radians everywhere; right-handed frames; `z` points up in every generator.

mod bounding_box;
mod surface;

pub use bounding_box::BoundingBox;
pub use nalgebra;
pub use surface::{SolidProperties, TriangleSurface};

/// Vector or point in space [m, or the unit of the quantity].
pub type Vec3 = nalgebra::Vector3<f64>;
/// Unit quaternion: orientation of a body frame in the world frame.
pub type Orientation = nalgebra::UnitQuaternion<f64>;
/// Rigid motion from a body frame to the world frame.
pub type Pose = nalgebra::Isometry3<f64>;
