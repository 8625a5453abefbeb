//! Terramechanics from one scenario file: what happens between a machine and soft ground.
//!
//! This crate is the only one that knows files, RON, terminals and the number of threads. A scene is read
//! ([`scene::read`]), its cost is estimated ([`run::estimate`]), and it is run into a folder ([`run::run`]).
//!
//! ```
//! use grouser::{run, scene};
//! let text = r#"(
//!     title: "A thimble of sand",
//!     materials: {
//!         "sand": (young_pa: 1e7, poisson: 0.3, density_kg_m3: 2600, restitution: 0.3, friction: 0.5),
//!     },
//!     soil: Grains(
//!         container: (size_m: (0.06, 0.06, 0.08), material: "sand"),
//!         layers: [(material: "sand", sizes: Monodisperse(radius_m: 0.004), depth_m: 0.02)],
//!     ),
//! )"#;
//! let scene = scene::read("thimble.ron", text, false, &[]).map_err(|messages| messages[0].to_string())?;
//! let step = run::time_step(&scene, scene.soil.grains().expect("grains"))?;
//! assert!(step.criteria.iter().all(|criterion| step.step_s <= criterion.step_s()));
//! assert_eq!(step.binding().name, "Hertz collision"); // of a grain that falls from the top of the loose packing
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod calibration;
pub mod cli;
pub mod diagnostic;
pub mod output;
pub mod run;
pub mod scene;
pub mod verify;
