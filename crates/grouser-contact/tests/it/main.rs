//! Laws against closed forms and published numbers.

mod dlr;
mod plane_tilting;
mod rolling;
mod tilting;

use grouser_contact::*;

/// A reproducible unit quaternion (i, j, k, real part) for each number.
fn some_quaternion(n: u32) -> Quaternion<f64> {
    let n = f64::from(n);
    let raw = [(1.1 * n + 0.3).sin(), (2.3 * n + 1.0).sin(), (3.7 * n + 2.0).sin(), (5.1 * n + 0.7).cos()];
    let norm = raw.iter().map(|c| c * c).sum::<f64>().sqrt();
    Quaternion(raw.map(|c| c / norm))
}

/// Turn by `angle` about the unit vector `axis`.
fn turn(axis: Vector<f64>, angle: f64) -> Quaternion<f64> {
    let (sin, cos) = (0.5 * angle).sin_cos();
    Quaternion([axis.x * sin, axis.y * sin, axis.z * sin, cos])
}

/// First `b`, then `a`.
fn product(a: &Quaternion<f64>, b: &Quaternion<f64>) -> Quaternion<f64> {
    let ([ax, ay, az, aw], [bx, by, bz, bw]) = (a.0, b.0);
    Quaternion([
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    ])
}

/// `v` in the world frame of a body turned by `frame`.
fn turned(frame: &Quaternion<f64>, v: Vector<f64>) -> Vector<f64> {
    let [a, b, c] = frame.axes();
    a * v.x + b * v.y + c * v.z
}

/// Two equal grains of 10 mm radius and 10 g in contact along x.
fn touching(overlap: f64, velocity: Vector<f64>, time_step: f64) -> Contact<f64> {
    let normal = Vector::new(1.0, 0.0, 0.0);
    Contact {
        overlap,
        normal,
        velocity: ContactVelocity::of(velocity, normal),
        normal_spin: 0.0,
        effective_radius: 5e-3,
        effective_mass: 5e-3,
        time_step,
    }
}

fn sand_pair(friction: f64) -> PairProperties {
    let sand = Material { young_pa: 1e7, poisson: 0.3, density_kg_m3: 2600.0 };
    PairProperties::new(&sand, &sand, &Interaction { restitution: 1.0, friction }, Tail::Keep).unwrap()
}
