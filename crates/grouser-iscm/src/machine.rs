//! A machine: bodies, joints and the running gear that carries them.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::gear::{Fit, Foot, GearError};
use crate::mechanism::{Configuration, Joint, Mechanism};
use crate::route::Route;

/// A vehicle ready to stand on ground.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// Bodies and joints.
    pub mechanism: Mechanism,
    /// Running gear.
    pub feet: Vec<Foot>,
}

/// Why a machine cannot be used.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum MachineError {
    /// Nothing to stand on.
    #[error("the machine has no running gear; expected at least one wheel")]
    NoGear,
    /// Gear on a body that is not there.
    #[error("running gear {foot} stands on body {body}, the machine has {n_bodies}; bodies count from 0")]
    NoSuchBody {
        /// Running gear, counted from 0.
        foot: usize,
        /// The body.
        body: usize,
        /// Bodies of the machine.
        n_bodies: usize,
    },
    /// Gear without meaning.
    #[error("running gear {foot}: {reason}")]
    Gear {
        /// Running gear, counted from 0.
        foot: usize,
        /// What is wrong.
        reason: GearError,
    },
}

impl Machine {
    /// Checks and takes the parts.
    pub fn new(mechanism: Mechanism, feet: Vec<Foot>) -> Result<Self, MachineError> {
        if feet.iter().all(|f| f.wheels.is_empty()) {
            return Err(MachineError::NoGear);
        }
        for (foot, gear) in feet.iter().enumerate() {
            let n_bodies = mechanism.bodies().len();
            if gear.body >= n_bodies {
                return Err(MachineError::NoSuchBody { foot, body: gear.body, n_bodies });
            }
            gear.check().map_err(|reason| MachineError::Gear { foot, reason })?;
        }
        Ok(Self { mechanism, feet })
    }

    /// The machine `distance` \[m\] along a route with its origin at `height` \[m\], steered, all free joints at zero.
    pub fn on_route(&self, route: &Route, distance: f64, height: f64) -> Configuration {
        let (position, heading) = route.at(distance);
        let mut at = self.mechanism.at(position, heading, height);
        self.steer(route, distance, &mut at);
        at
    }

    /// Turns every steered joint so that its body's heading is that of the route at the body's distance behind the first one.
    pub(crate) fn steer(&self, route: &Route, distance: f64, at: &mut Configuration) {
        for (n, body) in self.mechanism.bodies().iter().enumerate().skip(1) {
            if let Joint::Held { axis } = body.joint
                && axis.z.abs() > 0.5
            {
                let (_, heading) = route.at(distance + body.attachment.x);
                let turn = heading - at.heading;
                at.joints[n] = axis.z.signum() * turn.sin().atan2(turn.cos());
            }
        }
    }

    /// Which of the machine's slack belts are those of a foot, counted as in `Configuration::tracks`.
    pub fn slack_belts(&self, foot: usize) -> std::ops::Range<usize> {
        let n_slack = |foot: &Foot| foot.belts.iter().filter(|belt| belt.fit == Fit::Slack).count();
        let before = self.feet[..foot].iter().map(n_slack).sum();
        before..before + n_slack(&self.feet[foot])
    }
}
