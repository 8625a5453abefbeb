//! How tools move.

use super::{Collapse, Roll, Route, Slips};
use serde::{Deserialize, Serialize};

/// Kinds of motion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Motion {
    /// Straight down at constant speed.
    Press(Press),
    /// Rolling at given slips, each at steady state.
    Slips(Slips),
    /// Along a route over soft ground.
    Route(Route),
    /// Down until the ground carries a load, then rolling with a given slip.
    Roll(Roll),
    /// No tool: a part of the bed is taken away, and the rest slides into a slope.
    Collapse(Collapse),
}

impl Motion {
    /// Largest speed of a tool [m/s]; zero where time does not count.
    pub fn speed(&self) -> f64 {
        match self {
            Motion::Press(press) => press.speed_m_s,
            Motion::Slips(_) | Motion::Collapse(_) => 0.0,
            Motion::Route(route) => route.shown_speed_m_s,
            // The top of a tire that slips moves faster than twice the speed.
            Motion::Roll(roll) => {
                roll.sinking_speed_m_s.max(roll.speed_m_s * (1.0 + 1.0 / (1.0 - roll.slip)))
            }
        }
    }

    /// Time that it takes [s]; zero where time does not count.
    pub fn duration(&self) -> f64 {
        match self {
            Motion::Press(press) => (press.gap_m + press.depth_m) / press.speed_m_s,
            Motion::Route(route) => route.length() / route.shown_speed_m_s,
            Motion::Slips(_) => 0.0,
            Motion::Roll(roll) => roll.duration(),
            Motion::Collapse(collapse) => collapse.longest_s,
        }
    }
}

/// From above the bed's surface into it, straight down.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Press {
    /// Speed downwards [m/s].
    pub speed_m_s: f64,
    /// Distance of the tool's lowest point from the highest grain below it, at the start [m].
    pub gap_m: f64,
    /// Sinkage at the end, measured from the bed's mean surface [m].
    pub depth_m: f64,
}
