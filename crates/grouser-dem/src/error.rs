//! Why a bed cannot be made.

use crate::BedSettings;
use crate::slab::MOST_GRAINS;
use grouser_contact::{Precision, Real, Sphere};
use thiserror::Error;

/// A bed that makes no sense.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum BedError {
    /// No grains.
    #[error("the bed has no grains; expected at least one (is the fill depth smaller than a grain?)")]
    Empty,
    /// More grains than a pair can number.
    #[error("the bed has {n} grains; expected fewer than 134 217 728")]
    TooMany {
        /// Number of grains.
        n: usize,
    },
    /// A grain without size or mass, or with a number that is not finite.
    #[error(
        "grain {grain} has radius {radius} m and mass {mass} kg; expected finite numbers above zero everywhere"
    )]
    Grain {
        /// Its place in the list.
        grain: usize,
        /// Radius [m].
        radius: f64,
        /// Mass [kg].
        mass: f64,
    },
    /// A material number without a row in the table.
    #[error("material number {material} has no row; the table has {n_materials} materials")]
    Material {
        /// The number.
        material: u32,
        /// Rows of the table.
        n_materials: usize,
    },
    /// The box has no extent.
    #[error("the box is {size} m along axis {axis}; expected a finite length above zero")]
    Box {
        /// 0, 1 or 2 for x, y or z.
        axis: usize,
        /// Length [m].
        size: f64,
    },
    /// A period so short that a grain could touch another one from both sides.
    #[error(
        "the period along axis {axis} is {period} m; expected at least {least} m, five times the largest grain: \
         widen the box or take smaller grains"
    )]
    Period {
        /// 0, 1 or 2 for x, y or z.
        axis: usize,
        /// Length [m].
        period: f64,
        /// Least length [m].
        least: f64,
    },
}

impl BedError {
    pub(crate) fn check<P: Precision>(
        spheres: &[Sphere<P>],
        settings: &BedSettings,
        n_materials: usize,
    ) -> Result<(), Self> {
        if spheres.is_empty() {
            return Err(Self::Empty);
        }
        if spheres.len() >= MOST_GRAINS {
            return Err(Self::TooMany { n: spheres.len() });
        }
        let mut largest = 0.0_f64;
        for (grain, sphere) in spheres.iter().enumerate() {
            let (radius, mass) = (sphere.radius.to_f64(), sphere.mass.to_f64());
            let is_sound = radius > 0.0 && mass > 0.0 && radius.is_finite() && mass.is_finite();
            if !is_sound || !sphere.is_finite() {
                return Err(Self::Grain { grain, radius, mass });
            }
            largest = largest.max(radius);
        }
        let materials = spheres.iter().map(|s| s.material).chain(settings.planes.iter().map(|p| p.material));
        if let Some(material) = materials.into_iter().find(|&material| material as usize >= n_materials) {
            return Err(Self::Material { material, n_materials });
        }
        let size = settings.domain.size();
        for axis in 0..3 {
            if !(size[axis] > 0.0 && size[axis].is_finite()) {
                return Err(Self::Box { axis, size: size[axis] });
            }
            let least = 10.0 * largest;
            if settings.domain.is_periodic[axis] && size[axis] < least {
                return Err(Self::Period { axis, period: size[axis], least });
            }
        }
        Ok(())
    }
}
