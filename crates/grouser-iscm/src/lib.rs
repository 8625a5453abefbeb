//! Integration soil contact model (ISCM): wheeled and tracked vehicles on soft ground.
//!
//! The ground is a grid of heights with pressure–sinkage relationships; wheels and track shoes are drawn onto the grid, the pressure is
//! integrated over the polygons they press, and the machine is moved until forces and moments vanish. Source: Kulju & Ala-Ilomäki,
//! *Soil & Tillage Research* 246 (2025), called P2; theory and readings in `docs/theory/iscm.md`.
//!
//! ```text
//!    z ↑  ↗ x forward     SI units and radians; z up, y left
//!      │╱                 sinkage: vertical, positive downwards, from the undisturbed ground
//!  y ←─o                  forces: of the ground on the machine
//! ```
//!
//! How deep does a wheel loaded with 1,000 kg sink?
//!
//! ```
//! use grouser_geometry::{HeightGrid, Vec3};
//! use grouser_iscm::equilibrium::{SearchSettings, equilibrium, start_position};
//! use grouser_iscm::{gear::*, machine::Machine, mechanism::*, pressure::*, terrain::Terrain};
//!
//! let grid = HeightGrid::covering([-1.0, -1.0], [2.0, 2.0], 0.02, |_, _| 0.0)?;
//! let soil = PressureLaw::Linear(Linear { stiffness: 1.5e6 }); // Pa/m
//! let terrain = Terrain::new(grid, PressureField::uniform(PressureArray::new(&soil, 0.005, 0.4)?))?;
//! let body = Body {
//!     name: "wheel".into(), parent: None, attachment: Vec3::zeros(), joint: Joint::Held { axis: Vec3::y() },
//!     mass: 1000.0, centre_of_mass: Vec3::new(0.0, 0.0, -0.1),
//! };
//! let foot = Foot { body: 0, wheels: vec![Wheel::cylinder(Vec3::zeros(), 0.5, 0.5)], belts: vec![] };
//! let machine = Machine::new(Mechanism::new(vec![body])?, vec![foot])?;
//! let search = SearchSettings::default();
//! let start = start_position(&machine, &terrain, &machine.mechanism.at([0.0, 0.0], 0.0, 0.6), 0.0, &search)?;
//! let rest = equilibrium(&machine, &terrain, &start, 0.0, &search)?;
//! let sinkage = 0.5 - rest.configuration.height;
//! assert!((sinkage - 0.046_259).abs() < 1e-4, "{sinkage}"); // w K (circular segment) = 9810 N
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod batch;
pub mod contact;
pub mod equilibrium;
mod footing;
pub mod gear;
pub mod imprint;
mod levels;
pub mod machine;
pub mod mechanism;
pub mod polygon;
pub mod pressure;
mod response;
pub mod rolling_resistance;
pub mod route;
pub mod run;
pub mod rut;
pub mod shear;
pub mod terrain;
pub mod track;
pub mod vehicle;
pub mod verification;
pub mod wheel;
