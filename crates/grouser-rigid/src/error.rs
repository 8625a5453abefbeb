//! What is wrong with the description of a body.

use thiserror::Error;

/// A body, motion or connector that cannot be built.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RigidError {
    /// A number that is NaN or infinite.
    #[error(
        "{what} is {value}, expected a finite number; usual cause: a division by zero where it was computed; remedy: \
         correct the value"
    )]
    NotFinite {
        /// Which number.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A number that must not be negative.
    #[error("{what} is {value}, expected zero or more; remedy: give its magnitude")]
    Negative {
        /// Which number.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A velocity table without a row.
    #[error("a velocity table has no row; remedy: give at least one pair (time, velocity)")]
    EmptyTable,
    /// A velocity table that does not advance.
    #[error(
        "row {row} of a velocity table is at {time} s, not later than the row before ({before} s); usual cause: rows out \
         of order; remedy: sort them by time; for a jump place two rows a small time apart"
    )]
    TimeNotRising {
        /// Row, counted from 0.
        row: usize,
        /// Its time [s].
        time: f64,
        /// Time of the row before [s].
        before: f64,
    },
    /// A body that is free to move but has no mass.
    #[error(
        "the body is free to move along {degree:?} but its mass is {mass} kg; usual cause: a surface that is not closed \
         or a density left out; remedy: give a positive mass, or prescribe the motion"
    )]
    NoMass {
        /// The free degree of freedom.
        degree: crate::Degree,
        /// The mass [kg].
        mass: f64,
    },
    /// A body that is free to rotate but whose inertia is not positive definite.
    #[error(
        "the body is free to rotate about {degree:?} but its inertia has the principal values {principal:?} kg·m², \
         expected all above zero; usual cause: a surface that is not closed or faces inwards; remedy: give a \
         positive-definite tensor about the centre of mass, or fix the rotation"
    )]
    NoInertia {
        /// The free degree of freedom.
        degree: crate::Degree,
        /// Principal moments of inertia [kg·m²].
        principal: [f64; 3],
    },
}
