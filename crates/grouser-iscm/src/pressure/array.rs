//! Relationships as arrays over the sinkage: what the force integration reads (P2 Eq. (1)).

use serde::{Deserialize, Serialize};

use super::{PressureError, PressureLaw};

/// One relationship at equal distances of sinkage, from 0 to the maximum sinkage.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PressureArray {
    resolution: f64,
    pressures: Vec<f64>,
}

impl PressureArray {
    /// Converts a relationship with a `resolution` \[m\] down to `max_sinkage` \[m\] or the end of its data.
    pub fn new(law: &PressureLaw, resolution: f64, max_sinkage: f64) -> Result<Self, PressureError> {
        law.check()?;
        let max_sinkage = max_sinkage.min(law.max_sinkage());
        let intervals = (max_sinkage / resolution - 1e-9).floor();
        if !(resolution > 0.0 && max_sinkage.is_finite() && (1.0..1e5).contains(&intervals)) {
            return Err(PressureError::Resolution { resolution, max_sinkage });
        }
        let mut pressures = Vec::with_capacity(intervals as usize + 2);
        for k in 0..=intervals as usize + 1 {
            let sinkage = (k as f64 * resolution).min(max_sinkage);
            // Beyond the end of the data the array keeps its grid: the last line of the law goes on.
            let sinkage = if law.max_sinkage().is_finite() { sinkage } else { k as f64 * resolution };
            let pressure = law.pressure(sinkage);
            if k == 0 && pressure != 0.0 {
                return Err(PressureError::NotZeroAtSurface { pressure });
            }
            if !(pressure.is_finite() && pressure >= 0.0) {
                return Err(PressureError::BadPressure { sinkage, pressure });
            }
            pressures.push(pressure);
        }
        if law.max_sinkage().is_finite() && (intervals + 1.0) * resolution > max_sinkage + 1e-12 {
            pressures.pop();
        }
        Ok(Self { resolution, pressures })
    }

    /// Distance of the values in sinkage \[m\].
    pub fn resolution(&self) -> f64 {
        self.resolution
    }

    /// Pressures \[Pa\] at sinkage 0, resolution, 2 resolution, …
    pub fn pressures(&self) -> &[f64] {
        &self.pressures
    }

    /// Sinkage of the last value \[m\].
    pub fn max_sinkage(&self) -> f64 {
        self.resolution * (self.pressures.len() - 1) as f64
    }

    /// Pressure \[Pa\] at `sinkage` \[m\]: linear between the values.
    pub fn pressure(&self, sinkage: f64) -> f64 {
        interpolate(&self.pressures, sinkage / self.resolution).0
    }
}

/// Relationships of all nodes of a terrain: one for all, or one per node.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PressureField {
    resolution: f64,
    n_levels: usize,
    pressures: Vec<f64>,
    is_per_node: bool,
}

impl PressureField {
    /// The same relationship at every node.
    pub fn uniform(array: PressureArray) -> Self {
        Self {
            resolution: array.resolution,
            n_levels: array.pressures.len(),
            pressures: array.pressures,
            is_per_node: false,
        }
    }

    /// One relationship per node: `pressures` holds `n_levels` values \[Pa\] for each node in turn.
    pub(super) fn per_node(resolution: f64, n_levels: usize, pressures: Vec<f64>) -> Self {
        Self { resolution, n_levels, pressures, is_per_node: true }
    }

    /// Pressures of one node \[Pa\] at sinkage 0, resolution, 2 resolution, …
    #[inline(always)]
    pub fn of_node(&self, node: usize) -> &[f64] {
        if self.is_per_node {
            &self.pressures[node * self.n_levels..(node + 1) * self.n_levels]
        } else {
            &self.pressures
        }
    }

    /// Whether every node has a relationship of its own.
    #[inline(always)]
    pub fn is_per_node(&self) -> bool {
        self.is_per_node
    }

    /// Distance of the values in sinkage \[m\].
    pub fn resolution(&self) -> f64 {
        self.resolution
    }

    /// Sinkage of the last value \[m\].
    pub fn max_sinkage(&self) -> f64 {
        self.resolution * (self.n_levels - 1) as f64
    }

    /// Number of nodes for which the field is made; none for a uniform one.
    pub fn n_nodes(&self) -> Option<usize> {
        self.is_per_node.then(|| self.pressures.len() / self.n_levels)
    }
}

/// Value and slope per interval at `t` intervals; beyond the last value its last line goes on, below zero nothing.
#[inline(always)]
pub(crate) fn interpolate(pressures: &[f64], t: f64) -> (f64, f64) {
    if t <= 0.0 {
        return (0.0, pressures[1] - pressures[0]);
    }
    let k = (t as usize).min(pressures.len() - 2);
    let slope = pressures[k + 1] - pressures[k];
    (pressures[k] + (t - k as f64) * slope, slope)
}

#[cfg(test)]
mod tests {
    use super::super::{Linear, Polynomial, Table};
    use super::*;

    #[test]
    fn a_linear_law_survives_conversion_exactly() {
        let law = PressureLaw::Linear(Linear { stiffness: 1.5e6 });
        let array = PressureArray::new(&law, 0.005, 0.5).unwrap();
        for z in [0.0, 0.001, 0.113_246_089, 0.5] {
            assert!((array.pressure(z) - 1.5e6 * z).abs() < 1e-6);
        }
        assert!(array.max_sinkage() >= 0.5);
    }

    #[test]
    fn the_conversion_error_of_a_curved_law_falls_with_the_square_of_the_resolution() {
        let law = PressureLaw::Polynomial(Polynomial { coefficients: vec![0.0, 1e6] });
        let error = |resolution| {
            let array = PressureArray::new(&law, resolution, 0.4).unwrap();
            (0..400)
                .map(|k| (array.pressure(k as f64 * 1e-3) - 1e6 * (k as f64 * 1e-3).powi(2)).abs())
                .fold(0.0, f64::max)
        };
        let order = (error(0.02) / error(0.01)).log2();
        assert!((order - 2.0).abs() < 0.05, "observed order {order}");
    }

    #[test]
    fn data_end_where_the_table_ends() {
        let law = PressureLaw::Table(Table { points: vec![[0.1, 1e4], [0.2, 3e4]] });
        let array = PressureArray::new(&law, 0.05, 1.0).unwrap();
        assert!((array.max_sinkage() - 0.2).abs() < 1e-12);
        let expected = [0.0, 5e3, 1e4, 2e4, 3e4];
        assert_eq!(array.pressures().len(), 5);
        assert!(array.pressures().iter().zip(expected).all(|(p, e)| (p - e).abs() < 1e-6));
    }

    #[test]
    fn tension_and_offsets_are_refused() {
        let law = |points: &[[f64; 2]]| PressureLaw::Table(Table { points: points.to_vec() });
        assert!(matches!(
            PressureArray::new(&law(&[[0.0, 5.0], [0.1, 6.0]]), 0.01, 0.1),
            Err(PressureError::NotZeroAtSurface { .. })
        ));
        let falling = PressureLaw::Polynomial(Polynomial { coefficients: vec![1e6, -1e7] });
        assert!(matches!(PressureArray::new(&falling, 0.01, 0.5), Err(PressureError::BadPressure { .. })));
    }
}
