//! From curves to soil parameters.

mod plate_fit;

pub use plate_fit::{Estimated, PlateFit, PlatePoint, fit_plates};
