//! Springs, dashpots and stops between a body and the ground.

use serde::{Deserialize, Serialize};

use crate::{Degree, RigidError};

/// Something between a body and the ground that acts along one degree of freedom.
///
/// Displacements are counted from the body's place at construction; for rotations they are the spin integrated over time,
/// which is an angle only while the body turns about that axis alone. Units are N, m, s, or N·m, rad, s.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Connector {
    /// Linear spring with a linear dashpot beside it: F = −stiffness (u − rest) − damping v.
    Spring {
        /// Where it acts.
        degree: Degree,
        /// Stiffness k [N/m or N·m/rad].
        stiffness: f64,
        /// Damping constant c [N·s/m or N·m·s/rad]; with stiffness 0 a pure dashpot.
        damping: f64,
        /// Displacement without force [m or rad].
        rest: f64,
    },
    /// Keeps the displacement below `limit`: pushes back beyond it, never pulls.
    UpperStop {
        /// Where it acts.
        degree: Degree,
        /// Displacement at which it is touched [m or rad].
        limit: f64,
        /// Stiffness k [N/m or N·m/rad].
        stiffness: f64,
        /// Damping constant c [N·s/m or N·m·s/rad].
        damping: f64,
    },
    /// Keeps the displacement above `limit`.
    LowerStop {
        /// Where it acts.
        degree: Degree,
        /// Displacement at which it is touched [m or rad].
        limit: f64,
        /// Stiffness k [N/m or N·m/rad].
        stiffness: f64,
        /// Damping constant c [N·s/m or N·m·s/rad].
        damping: f64,
    },
}

/// What a connector does at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ConnectorAction {
    /// Force on the body along the degree of freedom [N or N·m].
    pub force: f64,
    /// Energy stored [J].
    pub stored: f64,
    /// Power lost [W], never negative.
    pub dissipated: f64,
}

impl Connector {
    /// Refuses negative or infinite constants.
    ///
    /// # Errors
    /// Names the first one.
    pub fn validate(&self) -> Result<(), RigidError> {
        let (offset, stiffness, damping) = match *self {
            Self::Spring { stiffness, damping, rest, .. } => (rest, stiffness, damping),
            Self::UpperStop { limit, stiffness, damping, .. }
            | Self::LowerStop { limit, stiffness, damping, .. } => (limit, stiffness, damping),
        };
        let constants = [
            ("rest or limit of a connector", offset),
            ("stiffness of a connector", stiffness),
            ("damping of a connector", damping),
        ];
        for (k, &(what, value)) in constants.iter().enumerate() {
            if !value.is_finite() {
                return Err(RigidError::NotFinite { what, value });
            }
            if k > 0 && value < 0.0 {
                return Err(RigidError::Negative { what, value });
            }
        }
        Ok(())
    }

    /// The degree of freedom on which it acts.
    pub fn degree(&self) -> Degree {
        match *self {
            Self::Spring { degree, .. } | Self::UpperStop { degree, .. } | Self::LowerStop { degree, .. } => {
                degree
            }
        }
    }

    /// Action at `displacement` [m or rad] and `velocity` [m/s or rad/s].
    pub fn action(&self, displacement: f64, velocity: f64) -> ConnectorAction {
        match *self {
            Self::Spring { stiffness, damping, rest, .. } => {
                let stretch = displacement - rest;
                ConnectorAction {
                    force: -stiffness * stretch - damping * velocity,
                    stored: stiffness * stretch * stretch / 2.0,
                    dissipated: damping * velocity * velocity,
                }
            }
            Self::UpperStop { limit, stiffness, damping, .. } => {
                let action = push_back(displacement - limit, velocity, stiffness, damping);
                ConnectorAction { force: -action.force, ..action }
            }
            Self::LowerStop { limit, stiffness, damping, .. } => {
                push_back(limit - displacement, -velocity, stiffness, damping)
            }
        }
    }
}

/// Push of a stop that is pressed in by `depth`, growing at `rate`; it never pulls.
fn push_back(depth: f64, rate: f64, stiffness: f64, damping: f64) -> ConnectorAction {
    if depth <= 0.0 {
        return ConnectorAction::default();
    }
    let force = (stiffness * depth + damping * rate).max(0.0);
    ConnectorAction {
        force,
        stored: stiffness * depth * depth / 2.0,
        dissipated: (force - stiffness * depth) * rate,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stop_pushes_back_never_pulls_and_never_gives_energy() {
        let stop = Connector::UpperStop { degree: Degree::Z, limit: 0.1, stiffness: 1e3, damping: 50.0 };
        assert_eq!(stop.action(0.09, 3.0), ConnectorAction::default());
        assert!((stop.action(0.12, 0.0).force + 20.0).abs() < 1e-12);
        assert!((stop.action(0.12, 0.1).force + 25.0).abs() < 1e-12);
        assert_eq!(stop.action(0.12, -1.0).force, 0.0);
        assert!([-2.0, -0.3, 0.3].iter().all(|&v| stop.action(0.12, v).dissipated > 0.0));
        let floor = Connector::LowerStop { degree: Degree::Z, limit: -0.1, stiffness: 1e3, damping: 50.0 };
        assert!((floor.action(-0.12, -0.1).force - 25.0).abs() < 1e-12);
    }

    #[test]
    fn negative_constants_are_refused() {
        let spring = Connector::Spring { degree: Degree::X, stiffness: -1.0, damping: 0.0, rest: 0.0 };
        assert!(spring.validate().unwrap_err().to_string().starts_with("stiffness of a connector is -1"));
    }
}
