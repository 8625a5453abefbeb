//! A constant outside the range that its law is defined on.

use thiserror::Error;

/// A physical constant that no material can have.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{name} is {value}; expected {expected}")]
pub struct ParameterError {
    /// Which constant.
    pub name: &'static str,
    /// The value that was given.
    pub value: f64,
    /// The range that is accepted.
    pub expected: &'static str,
}

impl ParameterError {
    /// `Ok` when `holds`, otherwise the error about `name`.
    ///
    /// # Errors
    /// When `holds` is false.
    pub fn check(name: &'static str, value: f64, holds: bool, expected: &'static str) -> Result<(), Self> {
        if holds { Ok(()) } else { Err(Self { name, value, expected }) }
    }
}
