//! Geometry of terramechanics: what lies under every other crate.
//!
//! SI units and radians everywhere; right-handed frames; `z` points up in every generator. Triangles run anticlockwise
//! seen from outside, so that their normals point outwards.
//!
//! ```text
//!      c            n = (b − a) × (c − a) / |…|  points towards you
//!     ╱ ╲
//!    ╱   ╲          fold angle of an edge: 0 flat, > 0 ridge, < 0 valley
//!   a─────b
//! ```
//!
//! A wheel is made, checked and weighed:
//!
//! ```
//! use grouser_geometry::generate::{GrouseredWheel, grousered_wheel};
//! use grouser_geometry::mesh_doctor::{Closedness, examine};
//!
//! let wheel = grousered_wheel(&GrouseredWheel {
//!     radius: 0.125,
//!     width: 0.1,
//!     n_grousers: 12,
//!     grouser_height: 0.01,
//!     grouser_thickness: 0.003,
//!     n_rim_segments: 8,
//! })?;
//! assert!(examine(&wheel, Closedness::Required).is_empty());
//! let mass = 2700.0 * wheel.solid_properties().volume; // aluminium
//! assert!((mass - 13.34).abs() < 0.01);
//! # Ok::<(), grouser_geometry::generate::ShapeError>(())
//! ```

pub mod abaqus;
pub mod bmp;
mod bounding_box;
pub mod esri_ascii;
pub mod generate;
pub mod gmsh;
pub mod grey_image;
mod height_grid;
mod height_shape;
pub mod lathe;
mod lug_pattern;
pub mod mesh_doctor;
mod mesh_file;
pub mod obj;
mod polygon;
mod quality;
mod rigid_motion;
pub mod stl;
mod structured_mesh;
mod surface;
mod surface_topology;
mod tetrahedral_mesh;
pub mod tetrahedron_shape;
mod tire_tread;
mod wrench;
pub mod xyz_text;

pub use bounding_box::BoundingBox;
pub use height_grid::{GridError, HeightGrid};
pub use height_shape::HeightShape;
pub use lug_pattern::LugPattern;
pub use mesh_file::MeshFileError;
pub use nalgebra;
pub use quality::QualityReport;
pub use rigid_motion::RigidMotion;
pub use structured_mesh::{Lattice, box_mesh, cylinder, hollow_cylinder};
pub use surface::{SolidProperties, TriangleSurface};
pub use surface_topology::{Edge, EdgeUse, SurfaceTopology};
pub use tetrahedral_mesh::{ElementOrder, Facet, MeshError, TetrahedralMesh};
pub use tire_tread::{TireError, TireSize, TireTread};
pub use wrench::Wrench;

/// Vector or point in space [m, or the unit of the quantity].
pub type Vec3 = nalgebra::Vector3<f64>;
/// Unit quaternion: orientation of a body frame in the world frame.
pub type Orientation = nalgebra::UnitQuaternion<f64>;
/// Rigid motion from a body frame to the world frame.
pub type Pose = nalgebra::Isometry3<f64>;
