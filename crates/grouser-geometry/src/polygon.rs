//! Cutting a flat polygon into triangles.

use crate::Vec3;

/// Triangles that cover the polygon with the given corners, each three positions in `corners`; `None` where the polygon
/// crosses itself or has no area.
///
/// Convex polygons become a fan from their first corner, others are cut ear by ear.
pub(crate) fn triangulate(corners: &[Vec3]) -> Option<Vec<[usize; 3]>> {
    let n = corners.len();
    let fan: Vec<[usize; 3]> = (1..n.saturating_sub(1)).map(|k| [0, k, k + 1]).collect();
    let area_vector = |[a, b, c]: [usize; 3]| (corners[b] - corners[a]).cross(&(corners[c] - corners[a]));
    let normal: Vec3 = fan.iter().map(|&t| area_vector(t)).sum();
    let turns_left = |t: [usize; 3]| area_vector(t).dot(&normal);
    if n == 3 || (n > 3 && fan.iter().all(|&t| turns_left(t) > 0.0)) {
        return Some(fan);
    }
    let mut left: Vec<usize> = (0..n).collect();
    let mut triangles = Vec::with_capacity(fan.len());
    while left.len() >= 3 {
        let m = left.len();
        let is_ear = |&i: &usize| {
            let [a, b, c] = [left[(i + m - 1) % m], left[i], left[(i + 1) % m]];
            let is_inside = |&p: &usize| {
                ![a, b, c].contains(&p)
                    && turns_left([a, b, p]) >= 0.0
                    && turns_left([b, c, p]) >= 0.0
                    && turns_left([c, a, p]) >= 0.0
            };
            turns_left([a, b, c]) > 0.0 && !left.iter().any(is_inside)
        };
        let ear = (0..m).find(is_ear)?;
        triangles.push([left[(ear + m - 1) % m], left[ear], left[(ear + 1) % m]]);
        left.remove(ear);
    }
    (triangles.len() + 2 == n).then_some(triangles)
}
