//! Ground known from plate tests alone: what a bevameter gives, and the rules that carry it over to a wheel.

use grouser_iscm::shear::JanosiHanamoto;
use grouser_iscm::wheel::PressurePeak;
use serde::{Deserialize, Serialize};

/// Flat ground whose pressure–sinkage law is fitted to the scene's measured plates.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlateTested {
    /// Largest sinkage of the plates that the fit uses [m].
    pub fit_to_m: f64,
    /// Which length of the wheel's contact stands for the plate's radius b in p = (k_c/b + k_φ) zⁿ.
    #[serde(default)]
    pub contact_size: ContactSize,
    /// Cohesion [Pa].
    pub cohesion_pa: f64,
    /// Angle of friction [°].
    pub friction_angle_deg: f64,
    /// Shear deformation modulus K [m].
    pub shear_deformation_modulus_m: f64,
    /// Where the stress on the rim is largest.
    #[serde(default)]
    pub peak: PressurePeak,
}

/// Length of a wheel's contact that is put for the radius of a circular plate.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum ContactSize {
    /// The smaller of width and length, length from the lowest point to where the rim enters, at zero slip (Bekker).
    #[default]
    SmallerSide,
    /// The width of the wheel.
    Width,
    /// The radius of the circle of the same area.
    EqualArea,
}

impl ContactSize {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::SmallerSide, Self::Width, Self::EqualArea];

    /// In words.
    pub fn label(self) -> &'static str {
        match self {
            Self::SmallerSide => "smaller side of the contact",
            Self::Width => "width of the wheel",
            Self::EqualArea => "circle of equal area",
        }
    }

    /// The length b [m] for a contact of `width` and `length` [m].
    pub fn of(self, width: f64, length: f64) -> f64 {
        match self {
            Self::SmallerSide => width.min(length),
            Self::Width => width,
            Self::EqualArea => (width * length / std::f64::consts::PI).sqrt(),
        }
    }
}

impl PlateTested {
    /// Law of shear.
    pub fn shear(&self) -> JanosiHanamoto {
        JanosiHanamoto {
            cohesion: self.cohesion_pa,
            friction_angle: self.friction_angle_deg.to_radians(),
            shear_deformation_modulus: self.shear_deformation_modulus_m,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_contact_has_its_side_and_its_circle() {
        assert_eq!(ContactSize::SmallerSide.of(0.06, 0.04), 0.04);
        assert_eq!(ContactSize::Width.of(0.06, 0.04), 0.06);
        let radius = ContactSize::EqualArea.of(0.06, 0.04);
        assert!((std::f64::consts::PI * radius * radius - 0.06 * 0.04).abs() < 1e-15);
    }
}
