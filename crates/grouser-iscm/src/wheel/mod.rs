//! A single driven wheel on flat ground at steady state, in two fidelities with the same inputs and outputs.
//!
//! [`closed_form`] integrates Bekker's or Wong and Reece's stresses over the rim; [`grid`] draws the wheel on a terrain grid and
//! integrates as a vehicle does. Theory: `docs/theory/iscm_shear.md`.
//!
//! ```text
//!        ω ↻   v →              θ from the lowest point, positive forwards; entry θ_f, exit −θ_r
//!      ╭─────╮                  s = (ωR − v)/(ωR)
//!  ────╯  ↓W ╰╮────  ground     sinkage: undisturbed ground minus lowest point
//!  ━━━━━╰─┴──θ_f                drawbar pull: what the wheel can pull behind it, positive forwards
//!   rut                         torque: of the drive on the wheel, positive forwards
//! ```
//!
//! ```
//! use grouser_iscm::pressure::{Linear, PressureLaw};
//! use grouser_iscm::shear::JanosiHanamoto;
//! use grouser_iscm::wheel::{PressurePeak, SingleWheel, WheelSoil, closed_form};
//!
//! let wheel = SingleWheel { radius: 0.5, width: 0.5, lugs: None, load: 9810.0 };
//! let soil = WheelSoil {
//!     pressure: PressureLaw::Linear(Linear { stiffness: 1.5e6 }),
//!     shear: JanosiHanamoto { cohesion: 0.0, friction_angle: 0.0, shear_deformation_modulus: 0.01 },
//!     peak: PressurePeak::Bottom,
//!     rebound: None,
//! };
//! // Plastic ground carries the front half only: w K (half a circular segment) = 9810 N.
//! let point = closed_form::operating_point(&wheel, &soil, 0.2, 0.0)?;
//! assert!((point.sinkage - 0.073_854).abs() < 1e-6, "{}", point.sinkage);
//! // Without shear the wheel is dragged: w ∫ p dz = w K z²/2.
//! assert!((point.drawbar_pull + 0.5 * 1.5e6 * point.sinkage.powi(2) / 2.0).abs() < 1e-6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod closed_form;
pub mod grid;
mod search;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::pressure::{PressureError, PressureLaw};
use crate::shear::JanosiHanamoto;

pub use search::slip_for_drawbar_pull;

/// Lugs (grousers) as a thicker wheel: shear and pressure act on the circle of radius R + share · height.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lugs {
    /// Height of the lugs above the rim \[m\].
    pub height: f64,
    /// Share of the height up to which ground sticks between the lugs (0…1) \[-\]; 1 for closely set lugs.
    pub share: f64,
}

/// A rigid wheel and its load.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SingleWheel {
    /// Radius R of the rim, to which the slip refers \[m\].
    pub radius: f64,
    /// Width b \[m\].
    pub width: f64,
    /// Lugs.
    pub lugs: Option<Lugs>,
    /// Vertical load W \[N\].
    pub load: f64,
}

/// Where the normal stress on the rim is largest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum PressurePeak {
    /// At the lowest point: the pressure follows the sinkage (Bekker, P2).
    #[default]
    Bottom,
    /// At θ_m = (c₁ + c₂ |s|) θ_f; behind it the stress falls as it rose (J. Y. Wong & A. R. Reece, *J. Terramechanics* 4 (1967) 81).
    WongReece {
        /// c₁ \[-\].
        c_1: f64,
        /// c₂ \[-\].
        c_2: f64,
    },
}

/// Ground under a single wheel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WheelSoil {
    /// Pressure–sinkage relationship.
    pub pressure: PressureLaw,
    /// Shear.
    pub shear: JanosiHanamoto,
    /// Where the pressure is largest.
    pub peak: PressurePeak,
    /// Stiffness k_u of the line along which unloaded ground springs back \[Pa/m\]; none for plastic ground.
    pub rebound: Option<f64>,
}

/// Steady state of a wheel. Works are per metre of rim: power over ωR.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OperatingPoint {
    /// Slip s = (ωR − v)/(ωR) \[-\].
    pub slip: f64,
    /// Slip angle β \[rad\].
    pub slip_angle: f64,
    /// Sinkage \[m\]: undisturbed ground minus lowest point of the wheel (with lugs: of the circle on which the ground acts).
    pub sinkage: f64,
    /// Depth of the rut left behind \[m\]; less than the sinkage where the ground springs back.
    pub rut_depth: f64,
    /// Vertical force of the ground \[N\].
    pub vertical_force: f64,
    /// Net forward force \[N\]: thrust minus compaction resistance.
    pub drawbar_pull: f64,
    /// Forward part of the shear \[N\].
    pub thrust: f64,
    /// Backward part of the pressure \[N\].
    pub compaction_resistance: f64,
    /// Force to the left \[N\].
    pub lateral_force: f64,
    /// Torque of the drive \[N·m\].
    pub torque: f64,
    /// Work of the axle \[J/m\]: torque over R.
    pub axle_work: f64,
    /// Work of drawbar pull and lateral force \[J/m\].
    pub drawbar_work: f64,
    /// Work lost in compaction \[J/m\].
    pub compaction_loss: f64,
    /// Work lost in shearing \[J/m\].
    pub shear_loss: f64,
    /// Evaluations of the ground's forces.
    pub n_evaluations: usize,
}

impl OperatingPoint {
    /// Work that the axle gives and nothing takes, over the axle's \[-\]; zero up to quadrature.
    pub fn energy_residual(&self) -> f64 {
        let given = self.axle_work.abs().max(self.drawbar_work.abs()).max(1e-300);
        (self.axle_work - self.drawbar_work - self.compaction_loss - self.shear_loss) / given
    }

    /// Drawbar power over axle power \[-\].
    pub fn tractive_efficiency(&self) -> f64 {
        self.drawbar_pull * (1.0 - self.slip) / self.axle_work
    }
}

/// Why a wheel has no operating point.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum WheelError {
    /// A value without meaning.
    #[error("wheel: {quantity} is {value}, expected {expected}")]
    Value {
        /// The quantity.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// What was expected.
        expected: &'static str,
    },
    /// A soil that is refused.
    #[error(transparent)]
    Soil(#[from] PressureError),
    /// The ground does not carry the load.
    #[error(
        "the ground carries {carried:.4} N at a sinkage of {sinkage:.4} m, the load is {load} N; usual cause: soft ground, a narrow wheel, or \
         data that end too early; remedy: less load, a wider wheel, deeper data"
    )]
    NotCarried {
        /// Largest force \[N\].
        carried: f64,
        /// Sinkage there \[m\].
        sinkage: f64,
        /// Load \[N\].
        load: f64,
    },
    /// No slip gives the pull.
    #[error(
        "no slip between {least_slip} and {most_slip} gives a drawbar pull of {pull} N; the wheel pulls {least:.4} to {most:.4} N there; \
         remedy: less pull, more load, stronger ground"
    )]
    NoSlip {
        /// Wanted pull \[N\].
        pull: f64,
        /// Least slip.
        least_slip: f64,
        /// Largest slip.
        most_slip: f64,
        /// Pull at the least slip \[N\].
        least: f64,
        /// Largest pull \[N\].
        most: f64,
    },
}

impl SingleWheel {
    /// Radius of the circle on which the ground acts \[m\].
    pub fn acting_radius(&self) -> f64 {
        self.radius + self.lugs.map_or(0.0, |lugs| lugs.share * lugs.height)
    }

    /// Slip of that circle: its speed is ωR times the ratio of the radii.
    fn acting_slip(&self, slip: f64) -> f64 {
        1.0 - (1.0 - slip) * self.radius / self.acting_radius()
    }

    fn check(&self, soil: &WheelSoil, slip: f64, slip_angle: f64) -> Result<(), WheelError> {
        let positive = |quantity, value: f64| {
            if value.is_finite() && value > 0.0 {
                return Ok(());
            }
            Err(WheelError::Value { quantity, value, expected: "a finite value above zero" })
        };
        positive("radius", self.radius)?;
        positive("width", self.width)?;
        positive("load", self.load)?;
        let within = |quantity, value: f64, low: f64, high: f64, expected| {
            if value >= low && value <= high {
                return Ok(());
            }
            Err(WheelError::Value { quantity, value, expected })
        };
        if let Some(lugs) = self.lugs {
            within("lug height", lugs.height, 0.0, self.radius, "0 to the radius of the rim")?;
            within("lug share", lugs.share, 0.0, 1.0, "0 to 1")?;
        }
        within("slip", slip, -1e3, 1.0, "a slip (ωR − v)/(ωR) of at most 1; a locked wheel has none")?;
        within("slip angle", slip_angle.abs(), 0.0, 1.5, "at most 1.5 rad to either side")?;
        soil.pressure.check()?;
        soil.shear.check()?;
        if let Some(stiffness) = soil.rebound {
            positive("rebound stiffness", stiffness)?;
        }
        if let PressurePeak::WongReece { c_1, c_2 } = soil.peak {
            let largest = c_1 + c_2 * slip.abs();
            within(
                "c₁ + c₂ |s|",
                largest,
                0.0,
                0.999,
                "0 to below 1: the peak lies between bottom and entry",
            )?;
            within("c₂", c_2, 0.0, 1.0, "0 to 1")?;
            if let Some(value) = soil.rebound {
                return Err(WheelError::Value {
                    quantity: "rebound stiffness",
                    value,
                    expected: "none with the stress peak of Wong and Reece, which has its own rear half",
                });
            }
        }
        Ok(())
    }
}
