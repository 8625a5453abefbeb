//! Shapes to try things on: walls, plates, penetrometers, wheels.
//!
//! All are in metres, with normals pointing outwards. Plates, boxes, cylinders and cones stand on the plane z = 0 with
//! their axis on z; spheres and wheels have their centre at the origin; a wheel's axle is y and it rolls along x.
//! Round shapes are inscribed: vertices lie on the true surface, so facets lie inside it.

mod cuboid;
mod cylinder;
mod grousered_wheel;
mod icosphere;
mod plane;

use thiserror::Error;

pub use cuboid::cuboid;
pub use cylinder::{cone, cylinder, disc_plate};
pub use grousered_wheel::{GrouseredWheel, grousered_wheel};
pub use icosphere::icosphere;
pub use plane::plane;

/// Why a shape cannot be made.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ShapeError {
    /// A length that must be a positive number is not.
    #[error(
        "{shape}: {length} is {value} m, expected a finite length above zero; usual cause: a forgotten key or a wrong \
         unit; remedy: give it in metres"
    )]
    NotPositive {
        /// The shape.
        shape: &'static str,
        /// Name of the length.
        length: &'static str,
        /// Its value \[m\].
        value: f64,
    },
    /// Too few or too many pieces.
    #[error("{shape}: {count} is {value}, expected {least} to {most}; remedy: choose a number in that range")]
    Count {
        /// The shape.
        shape: &'static str,
        /// Name of the count.
        count: &'static str,
        /// Its value.
        value: usize,
        /// Least value.
        least: usize,
        /// Largest value.
        most: usize,
    },
    /// Grousers wider than the rim has room for.
    #[error(
        "grousered wheel: {n_grousers} grousers of {thickness} m need {needed:.6} m of the circumference of {available:.6} m; \
         usual cause: a diameter given as a radius or a thickness in millimetres; remedy: fewer or thinner grousers"
    )]
    GrousersTouch {
        /// Number of grousers.
        n_grousers: usize,
        /// Thickness of one \[m\].
        thickness: f64,
        /// Length of rim that they cover \[m\].
        needed: f64,
        /// Circumference of the rim \[m\].
        available: f64,
    },
}

/// Checks that every named length is finite and above zero.
fn positive(shape: &'static str, lengths: &[(&'static str, f64)]) -> Result<(), ShapeError> {
    match lengths.iter().find(|(_, value)| !(value.is_finite() && *value > 0.0)) {
        Some(&(length, value)) => Err(ShapeError::NotPositive { shape, length, value }),
        None => Ok(()),
    }
}

/// Checks that a count lies between `least` and `most`.
fn counted(
    shape: &'static str,
    count: &'static str,
    value: usize,
    least: usize,
    most: usize,
) -> Result<(), ShapeError> {
    if (least..=most).contains(&value) {
        Ok(())
    } else {
        Err(ShapeError::Count { shape, count, value, least, most })
    }
}
