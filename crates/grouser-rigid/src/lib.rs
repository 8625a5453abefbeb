//! Rigid bodies whose six degrees of freedom are each held, driven or free: tools, wheels, mechanisms.
//!
//! ```text
//!      z, AboutZ          translations of the centre of mass along, and spin about, the axes of the world;
//!        ▲                orientation is a unit quaternion; inertia is given in the body frame
//!        │   ↺
//!        └────► y, AboutY     predict → evaluate the loads at the predicted state → correct
//!       ╱
//!      x, AboutX          (velocity Verlet, second order, positions and velocities at the same instant)
//! ```
//!
//! A plate of 2 kg on a spring, driven sideways:
//!
//! ```
//! use grouser_geometry::{Vec3, Wrench};
//! use grouser_rigid::{BodySpec, Connector, Degree, Freedom, RigidBody, VelocityProfile};
//!
//! let mut spec = BodySpec::driven(Vec3::zeros())
//!     .with(Degree::X, Freedom::Prescribed(VelocityProfile::constant(0.1)))
//!     .with(Degree::Z, Freedom::Free);
//! spec.mass = 2.0;
//! spec.gravity = Vec3::new(0.0, 0.0, -9.81);
//! spec.connectors = vec![Connector::Spring { degree: Degree::Z, stiffness: 200.0, damping: 10.0, rest: 0.0 }];
//! let mut plate = RigidBody::new(spec)?;
//! for _ in 0..5000 {
//!     plate.predict(1e-3);
//!     let loads = Wrench::default(); // contact forces at the predicted state would go here
//!     plate.correct(&loads, 1e-3);
//! }
//! let rest = Vec3::new(0.5, 0.0, -2.0 * 9.81 / 200.0);
//! assert!((plate.motion().position - rest).norm() < 1e-5);
//! # Ok::<(), grouser_rigid::RigidError>(())
//! ```

mod body;
mod connector;
mod error;
mod freedom;
mod velocity_profile;
mod work;

pub use body::{BodySpec, RigidBody};
pub use connector::{Connector, ConnectorAction};
pub use error::RigidError;
pub use freedom::{Degree, Freedom};
pub use velocity_profile::VelocityProfile;
pub use work::Work;
