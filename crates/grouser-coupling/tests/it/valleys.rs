//! Deep overlaps in hollows: elastic contacts have one energy, whatever the folds.

use grouser_coupling::{Feature, Touch, touches};
use grouser_geometry::generate::plane;
use grouser_geometry::{TriangleSurface, Vec3};

use super::RADIUS;

/// Hertz's energy of weighted touches in units of the energy of one contact that is a radius deep.
fn energy(touches: &[Touch]) -> f64 {
    touches.iter().map(|touch| touch.weight * (1.0 - touch.distance / RADIUS).powf(2.5)).sum()
}

/// Its force on the sphere, times the radius.
fn force(touches: &[Touch], centre: &Vec3) -> Vec3 {
    let one = |touch: &Touch| {
        (centre - touch.point).normalize() * (touch.weight * 2.5 * (1.0 - touch.distance / RADIUS).powf(1.5))
    };
    touches.iter().map(one).sum()
}

/// A plane whose vertices are moved up and down by up to `height`, cut into squares of `side`.
fn rough(side: f64, height: f64) -> TriangleSurface {
    let mut surface = plane(20.0 * side, 20.0 * side, 20, 20).unwrap();
    for (n, vertex) in surface.vertices.iter_mut().enumerate() {
        vertex.z += height * (n as f64 * 78.233).sin();
    }
    surface
}

/// Largest miss of energy and work over a straight path cut into `n` steps, over the largest energy on the way; how many saddles
/// and maxima were met.
fn miss(surface: &TriangleSurface, from: Vec3, to: Vec3, n: usize) -> (f64, usize) {
    let every: Vec<u32> = (0..surface.triangles.len() as u32).collect();
    let at = |k: usize| from + (to - from) * (k as f64 / n as f64);
    let found = |centre: &Vec3| touches(surface, &every, centre, RADIUS);
    let first = found(&from);
    let (mut before, mut work, start) = (force(&first, &from), 0.0, energy(&first));
    let (mut worst, mut most, mut n_counted_twice) = (0.0_f64, start, 0);
    for k in 1..=n {
        let centre = at(k);
        let now = found(&centre);
        let push = force(&now, &centre);
        work += (push + before).dot(&(to - from)) / (2.0 * n as f64 * RADIUS);
        before = push;
        most = most.max(energy(&now));
        worst = worst.max((energy(&now) - start + work).abs());
        n_counted_twice += now.iter().filter(|touch| !touch.is_minimum).count();
    }
    (worst / most, n_counted_twice)
}

#[test]
fn the_energy_of_deep_contacts_on_dented_surfaces_is_the_work_of_their_force() {
    let mut n_counted_twice = 0;
    for (side, height) in [(0.3, 0.1), (0.7, 0.2), (1.5, 0.5)] {
        let surface = rough(side * RADIUS, height * RADIUS);
        for n in 0..6 {
            let angle = f64::from(n);
            let from = Vec3::new(0.3 * angle.sin(), 0.3 * angle.cos(), 0.55) * RADIUS;
            let to = Vec3::new((2.0 * angle).cos(), (3.0 * angle).sin(), 0.8) * RADIUS;
            let (coarse, _) = miss(&surface, from, to, 500);
            let (fine, n_met) = miss(&surface, from, to, 2000);
            n_counted_twice += n_met;
            assert!(fine < 2e-3 && fine < 0.6 * coarse + 1e-5, "{side} {n}: {coarse:e} {fine:e}");
        }
    }
    assert!(n_counted_twice > 10_000, "{n_counted_twice}");
}

#[test]
fn a_second_face_begins_at_zero_in_every_valley() {
    for degrees in [1.0_f64, 10.0, 28.0, 30.0, 32.0, 45.0, 60.0] {
        let fold = degrees.to_radians();
        let v = Vec3::new;
        let surface = TriangleSurface {
            vertices: vec![
                v(-1.0, 0.0, 0.0),
                v(0.0, -1.0, 0.0),
                v(0.0, 1.0, 0.0),
                v(fold.cos(), 0.0, fold.sin()),
            ],
            triangles: vec![[0, 1, 2], [1, 3, 2]],
        };
        let (from, to) = (v(-1.5, 0.1, 0.7) * RADIUS, v(1.0, 0.0, 0.9) * RADIUS);
        let (miss, n_saddles) = miss(&surface, from, to, 4000);
        assert!(miss < 1e-3, "{degrees}: {miss:e}");
        assert!(degrees > 45.0 || n_saddles > 20, "{degrees}: {n_saddles}");
    }
}

#[test]
fn a_wall_on_a_floor_that_it_shares_no_edge_with_has_a_valley() {
    // The floor is one large triangle; the wall's lower edge lies in it.
    let v = Vec3::new;
    let surface = TriangleSurface {
        vertices: vec![
            v(-9.0, -9.0, 0.0),
            v(9.0, -9.0, 0.0),
            v(0.0, 9.0, 0.0),
            v(0.0, -1.0, 0.0),
            v(0.0, 1.0, 0.0),
            v(2.0, 0.0, 1.0),
        ],
        triangles: vec![[0, 1, 2], [3, 5, 4]],
    };
    let centre = v(-0.17, 0.01, 0.7) * RADIUS;
    let found = touches(&surface, &[0, 1], &centre, RADIUS);
    let weights: Vec<f64> = found.iter().map(|touch| touch.weight).collect();
    assert_eq!(weights, [1.0, 1.0, -1.0]);
    assert!(found[2].feature == Feature::Edge && found[2].point.x.abs() < 1e-15);
}
