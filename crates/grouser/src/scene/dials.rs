//! The dials between speed and accuracy.

use grouser_contact::{ArmNormalisation, GrainInertia, GrainShape, TiltingSettings};
pub use grouser_dem::Integrator;
use serde::{Deserialize, Serialize};

/// Choices that change cost and accuracy but not what the scene is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Dials {
    /// Time step over the smallest critical step of every criterion [-].
    pub time_step_fraction: f64,
    /// What happens while the dashpot would pull two parting grains together.
    pub restitution_tail: RestitutionTail,
    /// Normal and tangential force between grains.
    pub forces: Forces,
    /// How grains rotate.
    pub rotation: Rotation,
    /// Scalars that grains are computed with.
    pub precision: Precision,
    /// How grains go on from step to step.
    pub integrator: Integrator,
    /// Damping of every grain's absolute velocity [N·s/m]; 0 is off.
    pub background_damping_n_s_m: f64,
    /// Overlap over the smaller radius at which the run is given up [-]. At 0.5 Hertz's force on a sphere in a half-space is 5 % too
    /// large.
    pub largest_overlap: f64,
    /// Grains at rest and out of reach of the tool are held in place; left out, every grain is computed at every step.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub active_zone: Option<ActiveZone>,
}

/// Which grains are computed. `docs/theory/active_zone.md` says what it saves and what error it makes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ActiveZone {
    /// Distance from the tool's bounding box within which every grain is computed [m]; four to six times the tool's half width
    /// is a safe choice.
    pub reach_m: f64,
    /// Speed below which a grain counts as at rest, over the tool's speed [-].
    #[serde(default = "rest")]
    pub rest: f64,
    /// Change of the force on a sleeping block of grains, over that force when it fell asleep and the block's weight, beyond which
    /// it wakes [-]; `inf` is never.
    #[serde(default = "one")]
    pub wake: f64,
}

fn rest() -> f64 {
    0.01
}

impl Default for Dials {
    fn default() -> Self {
        Dials {
            time_step_fraction: 0.2,
            restitution_tail: RestitutionTail::default(),
            forces: Forces::default(),
            rotation: Rotation::default(),
            precision: Precision::default(),
            integrator: Integrator::default(),
            background_damping_n_s_m: 0.0,
            largest_overlap: grouser_dem::LARGEST_OVERLAP,
            active_zone: None,
        }
    }
}

/// End of a damped normal contact.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum RestitutionTail {
    /// The contact lasts until the overlap is zero; the force may pull shortly. Restitution is met exactly.
    Keep,
    /// The force never pulls; damping is corrected so that the restitution asked for is the one obtained.
    #[default]
    CutCorrected,
}

/// Normal and tangential force between grains.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub enum Forces {
    /// Hertz–Mindlin with the restitution of the materials.
    #[default]
    HertzMindlin,
    /// Hertz with a constant dashpot, a linear tangential spring, stick and slip angles (Lichtenheldt 2013); the friction of the
    /// materials is that of slipping, their restitution is not used.
    Dlr(Dlr),
}

/// Constants of [`Forces::Dlr`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Dlr {
    /// Tangential stiffness c_t [N/m].
    pub tangential_stiffness_n_m: f64,
    /// Normal damping k_n [N·s/m].
    pub normal_damping_n_s_m: f64,
    /// Friction at which a sticking contact begins to slip over that of slipping, tan φ_h / tan φ_g [-].
    #[serde(default = "one")]
    pub stick_over_slip: f64,
}

fn one() -> f64 {
    1.0
}

/// How grains rotate.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub enum Rotation {
    /// As spheres do.
    #[default]
    Free,
    /// Not at all: an upper bound of strength.
    Fixed,
    /// As spheres do, against a rolling resistance.
    Rolling(Rolling),
    /// As angular grains do.
    Tilting(Tilting),
}

/// Rolling resistance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Rolling {
    /// A torque of constant size against the rolling.
    Constant {
        /// Coefficient of rolling friction [-].
        friction: f64,
    },
    /// A spring and a dashpot up to a limit: holds slopes at rest.
    ElasticPlastic {
        /// Coefficient of rolling friction [-].
        friction: f64,
        /// Share of critical damping [-].
        #[serde(default = "damping_ratio")]
        damping_ratio: f64,
    },
}

fn damping_ratio() -> f64 {
    0.3
}

/// Angular grains, `docs/theory/tilting.md`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tilting {
    /// Shape by name or by the figures in its three planes.
    pub shape: GrainShape,
    /// How long the arms are.
    #[serde(default)]
    pub arms: ArmNormalisation,
    /// Moments of inertia.
    #[serde(default)]
    pub inertia: GrainInertia,
    /// Width of the passage between two corners [rad].
    #[serde(default = "smoothing")]
    pub smoothing_rad: f64,
    /// Impact times over which the torque of a normal force builds up [-]; 0 is the law as printed at every instant.
    #[serde(default = "build_up")]
    pub build_up: f64,
    /// Dashpot on the lift over that of the normal force [-]; 0 is the law as printed.
    #[serde(default = "lift_damping")]
    pub lift_damping: f64,
    /// Whether the three figures are sections of one body.
    #[serde(default)]
    pub figures: Figures,
}

fn smoothing() -> f64 {
    TiltingSettings::of(GrainShape::Cube).smoothing_rad
}

fn build_up() -> f64 {
    TiltingSettings::of(GrainShape::Cube).build_up
}

fn lift_damping() -> f64 {
    TiltingSettings::of(GrainShape::Cube).lift_damping
}

impl Tilting {
    /// The same for the contact law.
    pub fn settings(&self) -> TiltingSettings {
        let Self { shape, arms, inertia, smoothing_rad, build_up, lift_damping, .. } = *self;
        TiltingSettings { shape, arms, inertia, smoothing_rad, build_up, lift_damping }
    }
}

/// What the three figures of an angular grain are.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Figures {
    /// Sections of one body: beds come to rest.
    #[default]
    OneBody,
    /// Each for itself, as the law is printed: takes any figures, and drives beds of elongated grains.
    EachForItself,
}

/// Scalars that grains are computed with.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Precision {
    /// Double precision throughout.
    #[default]
    F64,
    /// Positions and their differences in double precision, contacts and motion in single precision.
    Mixed,
    /// Single precision throughout: overlaps are differences of rounded positions.
    F32,
}
