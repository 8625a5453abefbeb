//! Cylinders on an inclined plane of linear soil in closed form: the reference for standing machines, apart from any grid.

/// Ground z = `slope` · x with p = `stiffness` · z \[Pa\].
pub struct Plane {
    /// Rise per run.
    pub slope: f64,
    /// Pressure per sinkage \[Pa/m\].
    pub stiffness: f64,
}

/// A cylinder across the slope.
pub struct WheelAt {
    /// Centre along the slope's run \[m\].
    pub x: f64,
    /// Height of the centre \[m\].
    pub z: f64,
    /// Radius \[m\].
    pub radius: f64,
    /// Width \[m\].
    pub width: f64,
}

impl Plane {
    /// Force (x, z) of the ground on a wheel \[N\]: p times (−h′, 1) integrated over the chord, h the wheel's underside.
    pub fn force(&self, wheel: &WheelAt) -> [f64; 2] {
        let (t, r) = (self.slope, wheel.radius);
        // Sinkage at u = x − x_c: t u + c + √(r² − u²), zero at the ends of the chord.
        let c = wheel.x * t - wheel.z;
        let discriminant = c * c * t * t - (1.0 + t * t) * (c * c - r * r);
        if discriminant <= 0.0 || (c + r * (1.0 + t * t).sqrt()) <= 0.0 {
            return [0.0; 2];
        }
        // Roots of (t u + c)² = r² − u².
        let root = discriminant.sqrt();
        let ends = [(-c * t - root) / (1.0 + t * t), (-c * t + root) / (1.0 + t * t)];
        let primitive = |u: f64| {
            let s = (r * r - u * u).max(0.0).sqrt();
            let arc = r * r * (u / r).clamp(-1.0, 1.0).asin();
            let vertical = 0.5 * t * u * u + c * u + 0.5 * (u * s + arc);
            let lengthwise = t * 0.5 * (arc - u * s) - c * s + 0.5 * u * u;
            [-lengthwise, vertical]
        };
        let (a, b) = (primitive(ends[0]), primitive(ends[1]));
        let scale = wheel.width * self.stiffness;
        [scale * (b[0] - a[0]), scale * (b[1] - a[1])]
    }

    /// Sinkage \[m\] at which a wheel of `radius` and `width` on level ground carries `load` \[N\].
    pub fn sinkage(&self, radius: f64, width: f64, load: f64) -> f64 {
        let carried = |z: f64| self.force(&WheelAt { x: 0.0, z: radius - z, radius, width })[1];
        bisect(|z| carried(z) - load, 0.0, radius)
    }
}

/// Zero of a rising function between `low` and `high`.
pub fn bisect(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if f(middle) > 0.0 { high = middle } else { low = middle }
    }
    0.5 * (low + high)
}

/// Zero of n functions of n unknowns by Newton's method with difference quotients.
pub fn newton<const N: usize>(f: impl Fn([f64; N]) -> [f64; N], start: [f64; N]) -> [f64; N] {
    let mut at = nalgebra::DVector::from_column_slice(&start);
    let value =
        |x: &nalgebra::DVector<f64>| nalgebra::DVector::from_column_slice(&f(std::array::from_fn(|k| x[k])));
    for _ in 0..60 {
        let here = value(&at);
        let step = 1e-7;
        let mut jacobian = nalgebra::DMatrix::zeros(N, N);
        for k in 0..N {
            let mut moved = at.clone();
            moved[k] += step;
            jacobian.set_column(k, &((value(&moved) - &here) / step));
        }
        let Some(correction) = jacobian.lu().solve(&here) else { return [f64::NAN; N] };
        let largest = correction.amax();
        at -= correction * (0.05 / largest).min(1.0);
        if largest < 1e-13 {
            break;
        }
    }
    std::array::from_fn(|k| at[k])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_closed_form_is_the_integral() {
        let plane = Plane { slope: 0.3, stiffness: 1.5e6 };
        let wheel = WheelAt { x: 0.2, z: 0.5, radius: 0.5, width: 0.4 };
        let n = 2_000_000;
        let mut sum = [0.0; 2];
        for k in 0..n {
            let u = -0.5 + (k as f64 + 0.5) / n as f64;
            let s = (0.25 - u * u).sqrt();
            let z = 0.3 * (wheel.x + u) - (wheel.z - s);
            if z > 0.0 {
                let p = 1.5e6 * z * 0.4 / n as f64;
                sum = [sum[0] - p * u / s, sum[1] + p];
            }
        }
        let exact = plane.force(&wheel);
        assert!((0..2).all(|k| (exact[k] - sum[k]).abs() < 1e-5 * sum[1]), "{exact:?} {sum:?}");
    }
}
