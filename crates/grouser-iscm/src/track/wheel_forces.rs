//! Forces of a slack track on its wheels (P2 §2.3.4.2).

use grouser_geometry::{Pose, Vec3};

use super::DrawnTrack;
use crate::gear::{Belt, Wheel};

/// Distance from the wheel up to which a joint counts as lying on it \[m\].
const ON_WHEEL: f64 = 1e-3;

/// Adds to the `forces` (force, position) of each wheel what the shoes of a slack track with `on_shoe` \[N\] hand over to it.
///
/// Shoes on a wheel act on it, unless they hang below its axle; the sections between act at their ends, in proportion to the vertical
/// parts of the directions in which they pull.
pub(crate) fn forces_on_wheels(
    belt: &Belt,
    wheels: &[Wheel],
    track: &DrawnTrack,
    pose: &Pose,
    on_shoe: &[Vec3],
    forces: &mut [Vec<(Vec3, Vec3)>],
) {
    let (circles, y, n) = (belt.circles(wheels), belt.lateral(wheels), belt.n_shoes);
    let world = |[x, z]: [f64; 2]| (pose * nalgebra::Point3::new(x, y, z)).coords;
    let joint = |k: usize| track.joints[k % n];
    let wheel_of = |k: usize| {
        let is_on = |c: &[f64; 3], j: [f64; 2]| (j[0] - c[0]).hypot(j[1] - c[1]) < c[2] + ON_WHEEL;
        let wheel = circles.iter().position(|c| is_on(c, joint(k)) && is_on(c, joint(k + 1)))?;
        let height =
            world(joint(k)).z + world(joint(k + 1)).z - 2.0 * world([circles[wheel][0], circles[wheel][1]]).z;
        (height > 0.0 || on_shoe[k].z >= 0.0).then_some(wheel)
    };
    let lies_on: Vec<Option<usize>> = (0..n).map(wheel_of).collect();
    for k in 0..n {
        if let Some(wheel) = lies_on[k] {
            let middle = (world(joint(k)) + world(joint(k + 1))) / 2.0;
            forces[belt.wheels[wheel]].push((on_shoe[k], middle));
        }
    }
    // Sections between shoes that lie on wheels.
    for start in (0..n).filter(|&k| lies_on[k].is_some() && lies_on[(k + 1) % n].is_none()) {
        let mut end = start + 1;
        while lies_on[end % n].is_none() {
            end += 1;
        }
        let total: Vec3 = (start + 1..end).map(|k| on_shoe[k % n]).sum();
        let direction = |from: usize, to: usize| (world(joint(to)) - world(joint(from))).normalize().z.abs();
        let (first, last) = (direction(start + 1, start + 2), direction(end, end - 1));
        let share = if first + last > 1e-9 { first / (first + last) } else { 0.5 };
        for (k, held, share) in [(start, start + 1, share), (end % n, end, 1.0 - share)] {
            if let Some(wheel) = lies_on[k] {
                forces[belt.wheels[wheel]].push((total * share, world(joint(held))));
            }
        }
    }
}
