//! Room for a tool among grains: it must not meet its own image beyond a period, nor be so thin that grains pass through it.

use super::Check;
use crate::scene::{Grains, Side};

/// Thickness over the smallest radius below which a grain that is pressed deep can slip to the other side.
const THINNEST: f64 = 0.3;

/// Checks a plate's `thickness` [m], named by `path`, against the smallest grain.
pub fn validate_thickness(check: &mut Check, bed: &Grains, path: &str, thickness: f64) {
    let smallest = bed.layers.iter().map(|layer| layer.sizes.range().0).fold(f64::INFINITY, f64::min);
    let least = THINNEST * smallest;
    if thickness > 0.0 && thickness < least {
        check.push(
            path,
            format!("`{path}` is {thickness} m: grains may pass through a plate that thin"),
            &format!("at least {least:.2e} m, {THINNEST} of the smallest grain's radius"),
            "millimetres and metres mixed, or the sheet's true thickness beside grains that are scaled up",
            "make the plate thicker: its force comes from the face that grains touch".to_owned(),
        );
    }
}

/// Checks a tool of `width` [m] along the axis `axis` (0 or 1), all its places while it moves, against its image beyond
/// the period. `path` names what makes it so wide.
pub fn validate_image(check: &mut Check, bed: &Grains, path: &str, axis: usize, width: f64) {
    let side = [bed.container.x, bed.container.y][axis];
    let period = bed.container.size_m[axis];
    let largest = bed.layers.iter().map(|layer| layer.sizes.range().1).fold(0.0, f64::max);
    // A grain between the tool and its image would be met by only one of them.
    let most = period - 2.0 * largest;
    if side == Side::Periodic && width.is_finite() && width > most {
        let name = ["x", "y"][axis];
        check.push(
            path,
            format!("the tool is {width:.4} m wide along {name} and meets its own image beyond the period of {period} m"),
            &format!("at most {most:.4} m: the period less a diameter of the largest grain"),
            "a container for a smaller tool",
            format!("widen `soil.container.size_m[{axis}]`, or close the box there: `{name}: Walled`"),
        );
    }
}
