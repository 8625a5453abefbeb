//! Pressure–sinkage relationships: how hard the ground presses back at a given sinkage.
//!
//! Every law lies in its own file. All are turned into a [`PressureArray`] before use (P2 Eq. (1)); the conversion is
//! where parameters without meaning are refused.

mod array;
mod bekker;
mod linear;
mod meirion_griffith_spenko;
pub(crate) mod noise;
mod polynomial;
mod reece;
mod spatial;
mod table;
mod wong;

use serde::{Deserialize, Serialize};
use thiserror::Error;

pub(crate) use array::interpolate;
pub use array::{PressureArray, PressureField};
pub use bekker::Bekker;
pub use linear::Linear;
pub use meirion_griffith_spenko::MeirionGriffithSpenko;
pub use noise::Noisy;
pub use polynomial::Polynomial;
pub use reece::Reece;
pub use spatial::{LocatedLaw, SpatialLaws, read_located_laws, weights};
pub use table::Table;
pub use wong::Wong;

/// A pressure–sinkage relationship p(z).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum PressureLaw {
    /// Measured points.
    Table(Table),
    /// p = k z.
    Linear(Linear),
    /// p = Σ cᵢ zⁱ.
    Polynomial(Polynomial),
    /// Bekker 1969.
    Bekker(Bekker),
    /// Reece 1965.
    Reece(Reece),
    /// Wong 2008, organic ground.
    Wong(Wong),
    /// Meirion-Griffith & Spenko 2013.
    MeirionGriffithSpenko(MeirionGriffithSpenko),
    /// Another relationship with random deviations.
    Noisy(Noisy),
}

impl PressureLaw {
    /// Pressure \[Pa\] at `sinkage` ≥ 0 \[m\].
    pub fn pressure(&self, sinkage: f64) -> f64 {
        match self {
            Self::Table(law) => law.pressure(sinkage),
            Self::Linear(law) => law.pressure(sinkage),
            Self::Polynomial(law) => law.pressure(sinkage),
            Self::Bekker(law) => law.pressure(sinkage),
            Self::Reece(law) => law.pressure(sinkage),
            Self::Wong(law) => law.pressure(sinkage),
            Self::MeirionGriffithSpenko(law) => law.pressure(sinkage),
            Self::Noisy(law) => law.pressure(sinkage),
        }
    }

    /// Refuses parameters without meaning.
    pub fn check(&self) -> Result<(), PressureError> {
        match self {
            Self::Table(law) => law.check(),
            Self::Linear(law) => law.check(),
            Self::Polynomial(law) => law.check(),
            Self::Bekker(law) => law.check(),
            Self::Reece(law) => law.check(),
            Self::Wong(law) => law.check(),
            Self::MeirionGriffithSpenko(law) => law.check(),
            Self::Noisy(law) => law.check(),
        }
    }

    /// Largest sinkage \[m\] for which the relationship is known; infinite for formulas.
    pub fn max_sinkage(&self) -> f64 {
        match self {
            Self::Table(law) => law.max_sinkage(),
            Self::Noisy(law) => law.law.max_sinkage(),
            _ => f64::INFINITY,
        }
    }
}

/// Why a pressure–sinkage relationship cannot be used.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PressureError {
    /// A parameter without meaning.
    #[error(
        "{law}: {parameter} is {value}, expected {expected}; usual cause: a wrong unit (this crate takes Pa and m)"
    )]
    Parameter {
        /// The relationship.
        law: &'static str,
        /// Its parameter.
        parameter: &'static str,
        /// The value given.
        value: f64,
        /// What was expected.
        expected: &'static str,
    },
    /// Table points out of order.
    #[error(
        "pressure table, point {point}: sinkage {sinkage} m does not exceed the one before; expected rising sinkages from 0 on; \
         remedy: sort the points and average repeated ones"
    )]
    TableOrder {
        /// Point, counted from 1.
        point: usize,
        /// Its sinkage \[m\].
        sinkage: f64,
    },
    /// No points.
    #[error(
        "pressure table: no point below zero sinkage was given; expected at least one (sinkage, pressure) pair"
    )]
    EmptyTable,
    /// Pressure at zero sinkage.
    #[error(
        "the pressure at zero sinkage is {pressure} Pa, expected 0 (P2 Eq. (1)); usual cause: a constant term in a polynomial or a \
         table that starts with an offset"
    )]
    NotZeroAtSurface {
        /// The pressure \[Pa\].
        pressure: f64,
    },
    /// A pressure that pulls or is not a number.
    #[error("the pressure at {sinkage} m sinkage is {pressure} Pa, expected a finite value of zero or more")]
    BadPressure {
        /// Sinkage \[m\].
        sinkage: f64,
        /// Pressure \[Pa\].
        pressure: f64,
    },
    /// A bad sinkage resolution or depth.
    #[error(
        "a resolution of {resolution} m down to {max_sinkage} m makes no pressure array; expected 0 < resolution < maximum sinkage \
         and at most 100,000 values"
    )]
    Resolution {
        /// Resolution \[m\].
        resolution: f64,
        /// Maximum sinkage \[m\].
        max_sinkage: f64,
    },
    /// Two relationships at one place.
    #[error(
        "relationships {first} and {second} both lie at ({x}, {y}) m: every weight of P2 Eq. (2) is zero there (0/0 in Eq. (3)); \
         remedy: average the two beforehand or move one"
    )]
    Coincident {
        /// First relationship, counted from 1.
        first: usize,
        /// Second relationship, counted from 1.
        second: usize,
        /// Position \[m\].
        x: f64,
        /// Position \[m\].
        y: f64,
    },
    /// No relationship at all.
    #[error("no pressure–sinkage relationship was given")]
    None,
    /// A line of a data file.
    #[error("line {line}: expected `name x y sinkage pressure` [m, m, m, Pa], found `{found}`")]
    Line {
        /// Line, counted from 1.
        line: usize,
        /// What stands there.
        found: String,
    },
    /// A relationship of a data file that is itself refused.
    #[error("relationship `{name}` (line {line}): {reason}")]
    Located {
        /// Its name.
        name: String,
        /// Line where it starts.
        line: usize,
        /// Why it is refused.
        reason: Box<PressureError>,
    },
}

/// Checks that a parameter is finite and above zero.
pub(crate) fn positive(law: &'static str, parameter: &'static str, value: f64) -> Result<(), PressureError> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(PressureError::Parameter { law, parameter, value, expected: "a finite value above zero" })
    }
}
