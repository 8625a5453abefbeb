//! Shapes of angular grains for the tilting law: P1 Table 1, by name and by parameters.

use crate::ParameterError;
use serde::{Deserialize, Serialize};

/// The figure that stands for the grain in one rotation plane.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum PlaneShape {
    /// A rectangle: short over long side A = a/b, in [0.05, 1], and a factor s on both arms, in [0.1, 1]. The long side lies
    /// along the body axis of the lower number.
    Rectangle {
        /// A [-].
        aspect_ratio: f64,
        /// s [-].
        scale: f64,
    },
    /// A circle: free rotation, with a factor s on the arm.
    Circle {
        /// s [-].
        scale: f64,
    },
}

/// A grain: one figure in each of the planes normal to the body axes 1, 2, 3.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum GrainShape {
    /// A = 1 in every plane.
    Cube,
    /// Sides 1 : √A : A, one parameter for angular grains: no two sides alike, A₂ = A, A₁ = A₃ = √A, s₁ = √A.
    Angular {
        /// A [-].
        aspect_ratio: f64,
    },
    /// Long along body axis 1: A₁ = 1, A₂ = A₃ = A, s₁ = A.
    Bar {
        /// A [-].
        aspect_ratio: f64,
    },
    /// Thin along body axis 3: A₁ = A₂ = A, A₃ = 1.
    Plate {
        /// A [-].
        aspect_ratio: f64,
    },
    /// Thin along body axis 3 and round about it: A₁ = A₂ = A, a circle in plane 3 (P1 leaves A₃ and s₃ open).
    Disc {
        /// A [-].
        aspect_ratio: f64,
    },
    /// Any three figures. [`crate::Tilting`] takes them only where they are the sections of one body; three times the same
    /// rectangle is none unless A = 1.
    Planes([PlaneShape; 3]),
}

impl GrainShape {
    /// The figures in planes 1, 2, 3.
    pub fn planes(&self) -> [PlaneShape; 3] {
        let scaled = |aspect_ratio, scale| PlaneShape::Rectangle { aspect_ratio, scale };
        let rectangle = |aspect_ratio| scaled(aspect_ratio, 1.0);
        match *self {
            Self::Cube => [rectangle(1.0); 3],
            Self::Angular { aspect_ratio: a } => {
                let root = a.sqrt();
                [scaled(root, root), rectangle(a), rectangle(root)]
            }
            Self::Bar { aspect_ratio: a } => [scaled(1.0, a), rectangle(a), rectangle(a)],
            Self::Plate { aspect_ratio: a } => [rectangle(a), rectangle(a), rectangle(1.0)],
            Self::Disc { aspect_ratio: a } => [rectangle(a), rectangle(a), PlaneShape::Circle { scale: 1.0 }],
            Self::Planes(planes) => planes,
        }
    }

    /// Some figure is a circle.
    pub fn is_round(&self) -> bool {
        self.planes().iter().any(|plane| matches!(plane, PlaneShape::Circle { .. }))
    }

    /// Refuses constants outside the range that the laws have been tested on.
    fn validate(&self) -> Result<(), ParameterError> {
        let in_range = |aspect_ratio: f64| {
            let holds = (0.05..=1.0).contains(&aspect_ratio);
            let expected = "in [0.05, 1]: A is the short side over the long one, and below 0.05 a grain lies flat up to 87°, \
                            which the law cannot tell from fixed rotation";
            ParameterError::check("aspect ratio", aspect_ratio, holds, expected)
        };
        match *self {
            Self::Cube => Ok(()),
            Self::Angular { aspect_ratio }
            | Self::Bar { aspect_ratio }
            | Self::Plate { aspect_ratio }
            | Self::Disc { aspect_ratio } => in_range(aspect_ratio),
            Self::Planes(planes) => planes.into_iter().try_for_each(|plane| {
                let scale = match plane {
                    PlaneShape::Rectangle { aspect_ratio, scale } => {
                        in_range(aspect_ratio)?;
                        scale
                    }
                    PlaneShape::Circle { scale } => scale,
                };
                let expected =
                    "in [0.1, 1]: above 1 arms leave the sphere, below 0.1 friction no longer turns the grain";
                ParameterError::check("arm scale", scale, (0.1..=1.0).contains(&scale), expected)
            }),
        }
    }
}

/// How long the arms are; P1 does not print it. d is the half diagonal of a rectangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum ArmNormalisation {
    /// The longest d is r: no arm in a rotation plane is longer than r. Three rectangles for themselves have d = r each.
    #[default]
    Inscribed,
    /// d = r/cos γ: half the long side is r.
    LongSide,
}

/// Moment of inertia about a body axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum GrainInertia {
    /// The inscribed rectangle, m r²/3 for every A.
    #[default]
    Inscribed,
    /// P1 Eq. (15), a thin rod of length r/A: m (r/A)²/12. At A = 1 it is 4.8 times below a solid sphere.
    ThinRod,
}

/// All choices of the tilting law.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TiltingSettings {
    /// The grain.
    pub shape: GrainShape,
    /// Length of the arms.
    pub arms: ArmNormalisation,
    /// Moments of inertia; a circle has that of the solid sphere.
    pub inertia: GrainInertia,
    /// Angle within which the normal arm passes from one corner to the other [rad], in [0, 0.2]; 0 is the jump itself.
    pub smoothing_rad: f64,
    /// Impact times π √(m*/k) over which the torque of a normal force builds up [-], in [0, 100]; 0 is P1's law at every instant.
    /// Read by [`crate::Tilting`].
    pub build_up: f64,
    /// Dashpot on the lift over that of the normal force [-], in [0, 4]; 0 is P1's law. It calms beds under a plate and slows a
    /// grain that topples under its own weight. Read by [`crate::Tilting`].
    pub lift_damping: f64,
}

/// 0.29°: a grain on an incline topples where the closed form says, within half a degree.
const DEFAULT_SMOOTHING: f64 = 5e-3;
/// Five times the least at which beds rest under a friction angle of 55° (`docs/theory/tilting.md`).
const DEFAULT_BUILD_UP: f64 = 10.0;

impl TiltingSettings {
    /// Inscribed arms and inertia, a passage between corners within 0.005 rad (0.29°), torques built up over ten impact times, no dashpot on
    /// the lift.
    pub fn of(shape: GrainShape) -> Self {
        Self {
            shape,
            arms: ArmNormalisation::Inscribed,
            inertia: GrainInertia::Inscribed,
            smoothing_rad: DEFAULT_SMOOTHING,
            build_up: DEFAULT_BUILD_UP,
            lift_damping: 0.0,
        }
    }

    /// Refuses constants outside the range that the law has been tested on.
    ///
    /// # Errors
    /// Names the constant, its range and the reason.
    pub fn validate(&self) -> Result<(), ParameterError> {
        self.shape.validate()?;
        let width = self.smoothing_rad;
        let expected = "in [0, 0.2] rad: wider, the grain would rest on an edge";
        ParameterError::check("smoothing width", width, (0.0..=0.2).contains(&width), expected)?;
        let expected =
            "in [0, 100] impact times: longer, grains that move with a tool would not feel their corners";
        ParameterError::check("build-up", self.build_up, (0.0..=100.0).contains(&self.build_up), expected)?;
        let damping = self.lift_damping;
        let expected =
            "in [0, 4] times the dashpot of the normal force: more, an explicit step could not follow it";
        ParameterError::check("damping of the lift", damping, (0.0..=4.0).contains(&damping), expected)
    }

    /// How much faster than one of equal mass that does not turn the point of a grain where it is touched gives way, at most [-]:
    /// 1 + |ℓ|²/(J/m) with the smallest principal moment J; 7/2 for a sphere.
    pub fn mobility(&self) -> f64 {
        // The diagonal of a box whose sections have a half diagonal of 1 at most, or half sides of 1 at most.
        let longest_squared = match self.arms {
            ArmNormalisation::Inscribed => 1.5,
            ArmNormalisation::LongSide => 3.0,
        };
        1.0 + longest_squared / self.inertia_ratios().into_iter().fold(f64::INFINITY, f64::min)
    }

    /// Principal moments of inertia over m r² [-]: about axis i that of the figure in plane i, without its scale.
    pub(crate) fn inertia_ratios(&self) -> [f64; 3] {
        self.shape.planes().map(|plane| match (plane, self.inertia) {
            (PlaneShape::Circle { .. }, _) => 0.4,
            (PlaneShape::Rectangle { .. }, GrainInertia::Inscribed) => 1.0 / 3.0,
            (PlaneShape::Rectangle { aspect_ratio, .. }, GrainInertia::ThinRod) => {
                1.0 / (12.0 * aspect_ratio * aspect_ratio)
            }
        })
    }
}
