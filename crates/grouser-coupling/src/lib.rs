//! Grains against triangle surfaces, rigid or deforming, over borrowed slices: this crate knows neither the bed nor the solid.
//!
//! ```text
//!        .-----.
//!       (   o   )  n     n: from the surface to the centre      one contact for each minimum of the distance, less
//!        '--|--'   ^     δ = r − |centre − point|               one for each saddle between them: a cut wall and a
//!   --------+------|--   contact point: on the surface          ridge push once, a sharp valley twice, a shallow
//!   surface            the surface receives the opposite force  one 1 + 1 − 1 times
//! ```
//!
//! A bead sinks 10 µm into a table; its force is Hertz's, and the table feels it:
//! ```
//! use grouser_contact::*;
//! use grouser_coupling::{Step, SurfaceContacts};
//! use grouser_geometry::{RigidMotion, Vec3, generate::plane};
//! let glass = Material { young_pa: 1e7, poisson: 0.3, density_kg_m3: 2500.0 };
//! let table = PairTable::new(&[glass], Tail::CutCorrected, |_, _| Interaction { restitution: 0.5, friction: 0.5 })?;
//! let position = Vector::new(0.011, 0.013, 0.01 - 1e-5);
//! let bead = Sphere::<F64> { position, radius: 0.01, mass: 0.0105, ..Default::default() };
//! let mut loads = [Load::default()];
//! let mut contacts = SurfaceContacts::new(plane(1.0, 1.0, 50, 50)?, 0);
//! let step = Step { law: &HertzMindlin::new(Tail::CutCorrected), table: &table, time_step: 1e-5, fastest: 0.0 };
//! let on_table = contacts.forces(&RigidMotion::default(), (&[bead], &[0]), &mut loads, &step);
//! let hertz = table.pair(0, 0).normal_modulus * 0.01_f64.sqrt() * 1e-5_f64.powf(1.5);
//! assert!((loads[0].force.z - hertz).abs() < 1e-9 * hertz);
//! assert!((on_table.force + Vec3::z() * hertz).norm() < 1e-9 * hertz && contacts.n_contacts() == 1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod candidates;
mod closest_point;
mod contact_pass;
mod coupled_step;
mod deforming_contacts;
mod facet;
mod mirror;
mod spread;
mod surface_contacts;
mod touches;

pub use candidates::Margin;
pub use closest_point::{Feature, closest_point, natural_coordinates};
pub use contact_pass::{Deepest, Seen, Step};
pub use coupled_step::{MovedGrains, SteppedSolid, coupled_step};
pub use deforming_contacts::DeformingContacts;
pub use mirror::{Mirror, MirrorError};
pub use spread::Spread;
pub use surface_contacts::SurfaceContacts;
pub use touches::{Touch, touches};
