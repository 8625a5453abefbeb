//! An elastic tire, and how it rolls.

use serde::{Deserialize, Serialize};

/// A tire tread on a rim that does not deform.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tire {
    /// Size code such as `165/65R13`: width in mm, aspect ratio in %, diameter of the rim in inches.
    pub size: String,
    /// Distance between the flanges of the rim [m]; the section of a tire is wider and bulges.
    pub rim_width_m: f64,
    /// Thickness of the wall [m].
    pub wall_thickness_m: f64,
    /// Depth of the grooves between the lugs [m].
    pub groove_depth_m: f64,
    /// Tread pattern.
    pub tread: Tread,
    /// Tetrahedra to aim at.
    pub n_elements: usize,
    /// Inflation pressure on the inner surface [Pa].
    pub inflation_pa: f64,
    /// Name of the rubber.
    pub material: String,
    /// Damping of the rubber proportional to its stiffness, β [s]; a loss factor of β ω at angular frequency ω.
    #[serde(default)]
    pub damping_s: f64,
    /// How the rubber is computed.
    pub model: TireModel,
    /// Which tetrahedra.
    #[serde(default)]
    pub elements: TireElements,
    /// Sub-steps of the rubber in a step of the grains.
    #[serde(default)]
    pub sub_steps: SubSteps,
    /// Share of the mean grain radius that grains and tread may approach each other before the hierarchy of boxes is
    /// refitted and asked; 0 is every step.
    #[serde(default = "quarter")]
    pub refit_margin: f64,
    /// Radius over which the force of a grain is spread on the tread [m], so that meshes finer than contacts give Hertz's force; 0 puts
    /// it on one triangle, as meshes need whose triangles are several times as large as a contact.
    #[serde(default)]
    pub contact_spread_m: f64,
}

/// Pattern of a tread.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Tread {
    /// A closed crown of the same outer radius.
    Smooth,
    /// Lugs on the left and on the right half, shifted by half a pitch.
    Alternating {
        /// Lugs on each half around the tire.
        lugs: usize,
        /// Length of a lug around the tire over the pitch, above 0 and below 1: a road tire's is near 0.7, a field tire's near 0.3.
        #[serde(default = "half")]
        land: f64,
    },
}

/// How much of the rubber is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum TireModel {
    /// Nothing: the tread is rigid.
    Rigid,
    /// Small strains in the frame of the rim.
    BodyAttached,
    /// Small strains in a frame that turns with each element.
    Corotational,
    /// Any strain.
    FiniteStrain,
}

impl TireModel {
    /// In words.
    pub fn label(self) -> &'static str {
        match self {
            Self::Rigid => "rigid",
            Self::BodyAttached => "body-attached",
            Self::Corotational => "corotational",
            Self::FiniteStrain => "finite strain",
        }
    }
}

/// Kinds of tetrahedra.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum TireElements {
    /// Four nodes, as in the paper.
    #[default]
    Linear,
    /// Four nodes with averaged nodal pressure: does not lock as ν → 0.5.
    AveragedPressure,
}

/// Sub-steps of a solid.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum SubSteps {
    /// As few as 0.8 of the stable step allows.
    #[default]
    Auto,
    /// This many.
    Fixed(u32),
}

/// Down into the bed until the ground carries the load, then along x with a given slip.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Roll {
    /// Distance of the tire's lowest point from the highest grain below it, at the start [m].
    pub gap_m: f64,
    /// Speed of sinking [m/s].
    pub sinking_speed_m_s: f64,
    /// Vertical force at which the travel begins [N].
    pub load_n: f64,
    /// Speed of travel [m/s].
    pub speed_m_s: f64,
    /// Slip (ω R − v)/(ω R) [-], R being the outer radius of the size code.
    pub slip: f64,
    /// Distance travelled [m].
    pub travel_m: f64,
    /// Time in which speed and spin are reached [s].
    pub ramp_s: f64,
    /// Place of the axle along x at the start [m].
    pub start_m: f64,
    /// What the axle does up and down while it travels.
    #[serde(default)]
    pub vertical: Vertical,
}

impl Roll {
    /// Time of one run [s], with a sinkage of 60 mm, tire and ground together, for what is not known before.
    pub fn duration(&self) -> f64 {
        (self.gap_m + 0.06) / self.sinking_speed_m_s + self.travel_m / self.speed_m_s + self.ramp_s / 2.0
    }
}

/// What an axle does up and down while it travels.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Vertical {
    /// The load rides on it and it moves freely.
    #[default]
    Loaded,
    /// It stays where it was when the load was reached.
    Held,
}

fn quarter() -> f64 {
    0.25
}
fn half() -> f64 {
    0.5
}
