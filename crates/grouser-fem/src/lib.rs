//! Elastic solids by finite elements: tetrahedra of four or ten nodes, explicit dynamics and statics.
//!
//! # Example
//! A cantilever of rubber sags under its own weight:
//! ```
//! use grouser_fem::{Formulation, Material, Settings, Solid, StaticOptions};
//! use grouser_geometry::{Vec3, box_mesh};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let mesh = box_mesh(Vec3::new(0.5, 0.05, 0.05), [20, 2, 2]).to_quadratic();
//! let rubber = Material::hooke(1100.0, 20e6, 0.45);
//! let settings = Settings { formulation: Formulation::Corotational, ..Default::default() };
//! let mut solid = Solid::new(mesh, vec![rubber], settings)?;
//! solid.fix("x_min")?;
//! solid.loads.gravity = Vec3::new(0.0, 0.0, -9.81);
//! solid.solve_statics(&StaticOptions::default())?;
//! let sag = solid.state.displacement.iter().map(|u| -u.z).fold(0.0, f64::max);
//! // q L^4 / (8 E I) = 0.0202 m by beam theory (without shear)
//! assert!((sag / 0.0202 - 1.0).abs() < 0.04);
//! // Then it swings when gravity goes.
//! solid.loads.gravity = Vec3::zeros();
//! let dt = 0.9 * solid.stable_time_step().dt;
//! for _ in 0..50 {
//!     solid.step(dt)?;
//! }
//! # Ok(())
//! # }
//! ```
//!
//! # Conventions
//! SI units. Displacements u lead from the undeformed position X to x = X + u; F = I + ∂u/∂X. Stress is positive in tension, a
//! pressure on a surface acts against its outward normal. [`Formulation::BodyAttached`] solids live in a frame
//! ([`State::frame`]) that moves with the body; the others in the world frame.
//!
//! ```text
//!     z                     mesh ── Material per region ── Settings
//!     |__ x                   │
//!    /                      Solid: fix · add_pressure · loads ──► solve_statics() ──► step(dt) …
//!   y
//! ```
//!
//! Results are the same bits for any number of threads.

// Comparisons are turned around on purpose: a NaN must fall on the side of failure.
#![allow(clippy::neg_cmp_op_on_partial_ord)]

mod block_kernel;
mod dynamics;
mod element_blocks;
mod element_state;
mod elements;
mod fields;
mod internal_force;
pub mod law;
mod loads;
mod mass;
mod material;
mod motion;
mod nodal_average;
mod node_pass;
pub mod number;
mod polar;
mod solid;
mod stable_step;
pub mod statics;
mod stiffness_rows;
pub mod tensor;
pub mod verification;

pub use dynamics::{DynamicsError, Ledger};
pub use fields::ElementFields;
pub use loads::{Loads, Pressure, Spin};
pub use mass::MassKind;
pub use material::{Elasticity, Formulation, Material, MaterialError};
pub use solid::{Settings, Solid, SolidError, State, Support, VolumetricTreatment};
pub use stable_step::StableStep;
pub use statics::{LinearSolver, StaticError, StaticOptions, StaticSummary};
