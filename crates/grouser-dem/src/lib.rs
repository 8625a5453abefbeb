//! Discrete elements: beds of spherical grains, their neighbours, and the explicit step.
//!
//! ```text
//!   z ^   o o  o      gravity: any direction       planes: normal points into the grains
//!     |  o oo o o     box: periodic or open        loads:  force [N] and torque [N·m] about each centre
//!     | oo o oo oo    grains are kept sorted in space; `Grains::ids` names them for good
//!     +-----------> x
//! ```
//!
//! One step is [`Bed::predict`] (move, renew lists), [`Bed::contact_forces`], whatever tools add to the loads, and
//! [`Bed::correct`]; positions and velocities belong to the same instant whenever forces are evaluated. The same bed gives the
//! same bytes on any number of threads and on any instruction set.
//!
//! A glass bead falls 5 mm onto a floor and comes to rest there:
//! ```
//! use grouser_contact::*;
//! use grouser_dem::*;
//! use grouser_geometry::Vec3;
//! let glass = Material { young_pa: 1e7, poisson: 0.3, density_kg_m3: 2500.0 };
//! let table = PairTable::new(&[glass], Tail::CutCorrected, |_, _| Interaction { restitution: 0.3, friction: 0.5 })?;
//! let bead = sphere::<F64>(Vec3::new(0.0, 0.0, 0.015), 0.01, glass.density_kg_m3, 0);
//! let settings = BedSettings {
//!     domain: Domain { lower: Vec3::repeat(-0.1), upper: Vec3::repeat(0.1), is_periodic: [false; 3] },
//!     planes: vec![Plane { point: Vec3::zeros(), normal: Vec3::z(), material: 0 }],
//!     gravity: Vec3::new(0.0, 0.0, -9.81),
//!     rotation: Rotation::Free,
//!     has_ledger: true,
//! };
//! let weight = bead.mass * 9.81;
//! let mut bed = Bed::new(vec![bead], settings, table, HertzMindlin::new(Tail::CutCorrected))?;
//! for _ in 0..20_000 {
//!     bed.step(2e-5)?;
//! }
//! assert!((bed.plane_force(0).z + weight).abs() < 1e-3 * weight);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod active_zone;
mod bed;
mod bed_zone;
mod block;
mod border;
mod candidates;
mod carry_over;
mod cell_grid;
mod domain;
mod drifts;
mod energy;
mod error;
mod euler;
mod failure;
mod force_pass;
mod grains;
mod integrate;
mod large_grains;
mod leeway;
mod neighbours;
mod packing;
mod plane;
#[cfg(target_arch = "x86_64")]
mod quads;
mod settle;
mod shared_grains;
mod size_levels;
mod slab;
mod sleepers;
mod stability;
mod sweep;
mod time_step;
mod turning;
mod zone_blocks;

pub use active_zone::{ActiveZone, ZoneAccount};
pub use bed::{Bed, BedSettings, LARGEST_OVERLAP};
pub use domain::Domain;
pub use energy::BedEnergy;
pub use error::BedError;
pub use failure::Failure;
pub use force_pass::InstructionSet;
pub use grains::{Grains, Rotation, sphere};
pub use integrate::Integrator;
pub use packing::{Layer, PackingError, RadiusDistribution, random_packing};
pub use plane::Plane;
pub use settle::{SettleCriterion, Settled, Settling};
pub use stability::Stability;
pub use time_step::{Criterion, TimeStep, hertz_collision_time, rayleigh_time};
