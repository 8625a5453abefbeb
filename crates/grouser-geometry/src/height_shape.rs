//! Shapes of ground that add up: slopes, steps, waves.

use serde::{Deserialize, Serialize};

/// A shape of ground: a height \[m\] at every position; shapes of one ground add up.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum HeightShape {
    /// A level at this height \[m\].
    Level(f64),
    /// A plane that rises by `angle` \[rad\] in the direction `heading` \[rad, anticlockwise from x\], zero at the origin.
    Slope {
        /// Angle of rise \[rad\].
        angle: f64,
        /// Direction of rise \[rad\], anticlockwise from x.
        heading: f64,
    },
    /// A step of `height` \[m\] beyond the line at `distance` \[m\] from the origin along `heading` \[rad\].
    Step {
        /// Distance of the edge from the origin \[m\].
        distance: f64,
        /// Height of the step \[m\].
        height: f64,
        /// Direction in which the ground steps up \[rad\], anticlockwise from x.
        heading: f64,
    },
    /// `amplitude` sin(2π s / `wavelength` + `phase`), s along `heading`.
    Sine {
        /// Amplitude \[m\]: half the relief.
        amplitude: f64,
        /// Wavelength \[m\].
        wavelength: f64,
        /// Direction of the wave \[rad\], anticlockwise from x.
        heading: f64,
        /// Phase \[rad\].
        phase: f64,
    },
}

impl HeightShape {
    /// Height at (`x`, `y`) \[m\].
    pub fn height(&self, x: f64, y: f64) -> f64 {
        let along = |heading: f64| x * heading.cos() + y * heading.sin();
        match *self {
            Self::Level(height) => height,
            Self::Slope { angle, heading } => angle.tan() * along(heading),
            Self::Step { distance, height, heading } => {
                if along(heading) >= distance {
                    height
                } else {
                    0.0
                }
            }
            Self::Sine { amplitude, wavelength, heading, phase } => {
                amplitude * (std::f64::consts::TAU * along(heading) / wavelength + phase).sin()
            }
        }
    }

    /// Height of the sum of `shapes` at (`x`, `y`) \[m\].
    pub fn sum(shapes: &[Self], x: f64, y: f64) -> f64 {
        shapes.iter().map(|shape| shape.height(x, y)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_add_up() {
        let shapes = [
            HeightShape::Level(1.0),
            HeightShape::Slope { angle: 0.25_f64.atan(), heading: std::f64::consts::FRAC_PI_2 },
            HeightShape::Step { distance: 2.0, height: 0.15, heading: 0.0 },
            HeightShape::Sine { amplitude: 0.1, wavelength: 4.0, heading: 0.0, phase: 0.0 },
        ];
        assert!((HeightShape::sum(&shapes, 1.0, 2.0) - (1.0 + 0.5 + 0.1)).abs() < 1e-12);
        assert!((HeightShape::sum(&shapes, 3.0, 0.0) - (1.0 + 0.15 - 0.1)).abs() < 1e-12);
    }
}
