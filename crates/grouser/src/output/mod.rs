//! What a run leaves in its folder. Every file is written beside its place and then renamed: a reader never sees half
//! of one, and a run that dies leaves the previous version.

mod atomic;
pub mod chart;
pub mod checkpoint;
pub mod heat_map;
mod pvd;
pub mod raster;
pub mod summary;
mod table;
mod vtp;
pub mod vtu;

pub use atomic::write_atomic;
pub use pvd::Series;
pub use table::{Column, Table};
pub use vtp::{PointField, PolyData};
