//! Velocity prescribed as a function of time, with its exact integral and derivative.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use crate::RigidError;

/// Prescribed velocity of one degree of freedom: m, m/s for translations; rad, rad/s for rotations. Zero before `start`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum VelocityProfile {
    /// Constant `velocity` from `start` on.
    Constant {
        /// Begin of the motion [s].
        start: f64,
        /// Velocity [m/s or rad/s].
        velocity: f64,
    },
    /// Velocity interpolated linearly between points, held before the first and after the last.
    Table {
        /// Begin of the motion [s]; times of the points count from here.
        start: f64,
        /// Pairs of time [s], strictly rising, and velocity [m/s or rad/s].
        points: Vec<[f64; 2]>,
    },
    /// Displacement amplitude · (sin(2π frequency τ + phase) − sin phase), τ being the time since `start`.
    Sine {
        /// Begin of the motion [s].
        start: f64,
        /// Amplitude of the displacement [m or rad].
        amplitude: f64,
        /// Frequency [Hz].
        frequency: f64,
        /// Phase at the start [rad].
        phase: f64,
    },
}

impl VelocityProfile {
    /// Constant velocity from time zero on.
    pub fn constant(velocity: f64) -> Self {
        Self::Constant { start: 0.0, velocity }
    }

    /// Refuses values that are not finite and tables that do not advance in time.
    ///
    /// # Errors
    /// Names the first value that is out of order.
    pub fn validate(&self) -> Result<(), RigidError> {
        let finite = |what, value: f64| {
            if value.is_finite() { Ok(()) } else { Err(RigidError::NotFinite { what, value }) }
        };
        match self {
            Self::Constant { start, velocity } => {
                finite("start of a motion", *start)?;
                finite("prescribed velocity", *velocity)
            }
            Self::Table { start, points } => {
                finite("start of a motion", *start)?;
                if points.is_empty() {
                    return Err(RigidError::EmptyTable);
                }
                for (row, &[time, velocity]) in points.iter().enumerate() {
                    finite("time in a velocity table", time)?;
                    finite("velocity in a velocity table", velocity)?;
                    if row > 0 && time <= points[row - 1][0] {
                        return Err(RigidError::TimeNotRising { row, time, before: points[row - 1][0] });
                    }
                }
                Ok(())
            }
            Self::Sine { start, amplitude, frequency, phase } => {
                finite("start of a motion", *start)?;
                finite("amplitude of a sine", *amplitude)?;
                finite("frequency of a sine", *frequency)?;
                finite("phase of a sine", *phase)
            }
        }
    }

    /// Velocity at `time` [m/s or rad/s].
    pub fn velocity(&self, time: f64) -> f64 {
        let since = time - self.start();
        if since < 0.0 {
            return 0.0;
        }
        match self {
            Self::Constant { velocity, .. } => *velocity,
            Self::Table { points, .. } => interpolated(points, since),
            Self::Sine { amplitude, frequency, phase, .. } => {
                amplitude * TAU * frequency * (TAU * frequency * since + phase).cos()
            }
        }
    }

    /// Displacement since the start [m or rad]: the exact integral of the velocity.
    pub fn displacement(&self, time: f64) -> f64 {
        let since = time - self.start();
        if since <= 0.0 {
            return 0.0;
        }
        match self {
            Self::Constant { velocity, .. } => velocity * since,
            Self::Table { points, .. } => {
                let primitive = |t: f64| integral_from_first_point(points, t);
                primitive(since) - primitive(0.0)
            }
            Self::Sine { amplitude, frequency, phase, .. } => {
                amplitude * ((TAU * frequency * since + phase).sin() - phase.sin())
            }
        }
    }

    /// Acceleration at `time` [m/s² or rad/s²]; at a kink the value to its right. The jump at `start` is not in it.
    pub fn acceleration(&self, time: f64) -> f64 {
        let since = time - self.start();
        if since < 0.0 {
            return 0.0;
        }
        match self {
            Self::Constant { .. } => 0.0,
            Self::Table { points, .. } => points
                .windows(2)
                .find(|p| (p[0][0]..p[1][0]).contains(&since))
                .map_or(0.0, |p| (p[1][1] - p[0][1]) / (p[1][0] - p[0][0])),
            Self::Sine { amplitude, frequency, phase, .. } => {
                -amplitude * (TAU * frequency).powi(2) * (TAU * frequency * since + phase).sin()
            }
        }
    }

    fn start(&self) -> f64 {
        match self {
            Self::Constant { start, .. } | Self::Table { start, .. } | Self::Sine { start, .. } => *start,
        }
    }
}

fn interpolated(points: &[[f64; 2]], time: f64) -> f64 {
    let after = points.partition_point(|p| p[0] <= time);
    match (after.checked_sub(1).map(|k| points[k]), points.get(after)) {
        (Some([t0, v0]), Some(&[t1, v1])) => v0 + (v1 - v0) * (time - t0) / (t1 - t0),
        (Some([_, v]), None) | (None, Some(&[_, v])) => v,
        (None, None) => 0.0,
    }
}

/// ∫ v dt from the first point's time to `time`, negative before it.
fn integral_from_first_point(points: &[[f64; 2]], time: f64) -> f64 {
    let Some(&[first, velocity]) = points.first() else { return 0.0 };
    if time <= first {
        return velocity * (time - first);
    }
    let mut sum = 0.0;
    for (k, &[t0, v0]) in points.iter().enumerate() {
        let end = points.get(k + 1).map_or(time, |p| p[0].min(time));
        sum += (v0 + interpolated(points, end)) / 2.0 * (end - t0);
        if end >= time {
            break;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    use super::*;

    fn profiles() -> Vec<VelocityProfile> {
        vec![
            VelocityProfile::Constant { start: 0.5, velocity: -0.3 },
            VelocityProfile::Table { start: 0.2, points: vec![[0.1, 1.0], [0.4, -2.0], [1.0, 0.5]] },
            VelocityProfile::Sine { start: 0.3, amplitude: 0.02, frequency: 3.0, phase: 0.7 },
        ]
    }

    #[test]
    fn table_ramps_and_holds_its_ends() {
        let ramp = VelocityProfile::Table { start: 1.0, points: vec![[0.0, 0.0], [2.0, 4.0]] };
        assert_eq!([0.5, 1.0, 2.0, 3.0, 9.0].map(|t| ramp.velocity(t)), [0.0, 0.0, 2.0, 4.0, 4.0]);
        assert_eq!([0.5, 1.0, 2.0, 3.0, 4.0].map(|t| ramp.displacement(t)), [0.0, 0.0, 1.0, 4.0, 8.0]);
        assert_eq!([0.5, 1.5, 3.5].map(|t| ramp.acceleration(t)), [0.0, 2.0, 0.0]);
    }

    #[test]
    fn tables_out_of_order_are_refused_with_the_row() {
        let message = VelocityProfile::Table { start: 0.0, points: vec![[0.0, 1.0], [0.0, 2.0]] };
        assert!(
            message.validate().unwrap_err().to_string().starts_with("row 1 of a velocity table is at 0 s")
        );
        assert!(VelocityProfile::constant(f64::NAN).validate().is_err());
        assert!(VelocityProfile::Table { start: 0.0, points: vec![] }.validate().is_err());
    }

    proptest! {
        #[test]
        fn displacement_is_the_integral_and_acceleration_the_derivative_of_velocity(time in 0.0..2.0f64) {
            let h = 1e-6;
            for profile in profiles() {
                let kinks = [0.2, 0.3, 0.5, 0.6, 1.2];
                prop_assume!(kinks.iter().all(|k| (time - k).abs() > 2.0 * h));
                let slope = |f: &dyn Fn(f64) -> f64| (f(time + h) - f(time - h)) / (2.0 * h);
                assert_relative_eq!(slope(&|t| profile.displacement(t)), profile.velocity(time), epsilon = 1e-7);
                assert_relative_eq!(slope(&|t| profile.velocity(t)), profile.acceleration(time), epsilon = 1e-6);
            }
        }
    }
}
