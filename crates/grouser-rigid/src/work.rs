//! Work done on a body.

use serde::{Deserialize, Serialize};

/// Work since time zero [J], by the trapezoidal rule over the steps.
///
/// Balance: change of kinetic energy + change of stored energy = applied + gravity + drive − connectors_dissipated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Work {
    /// By the loads given to the body: negative where a tool works on the ground [J].
    pub applied: f64,
    /// By gravity [J].
    pub gravity: f64,
    /// By the drives of prescribed degrees of freedom [J].
    pub drive: f64,
    /// Lost in dashpots and stops [J].
    pub connectors_dissipated: f64,
}
