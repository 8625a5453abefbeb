//! Measured points, straight lines between them.

use serde::{Deserialize, Serialize};

use super::PressureError;

/// Points (sinkage \[m\], pressure \[Pa\]) in rising order of sinkage; (0, 0) is understood.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// The points.
    pub points: Vec<[f64; 2]>,
}

impl Table {
    /// Pressure \[Pa\] at `sinkage` \[m\]; beyond the last point its last line goes on.
    pub fn pressure(&self, sinkage: f64) -> f64 {
        let points = &self.points;
        let last = points.len() - 1;
        let k = points.iter().position(|p| sinkage <= p[0]).unwrap_or(last);
        let before = if k == 0 { [0.0, 0.0] } else { points[k - 1] };
        let after = points[k];
        let run = after[0] - before[0];
        if run == 0.0 {
            return after[1];
        }
        before[1] + (after[1] - before[1]) * (sinkage - before[0]) / run
    }

    /// Sinkage of the last point \[m\].
    pub fn max_sinkage(&self) -> f64 {
        self.points.last().map_or(0.0, |p| p[0])
    }

    pub(super) fn check(&self) -> Result<(), PressureError> {
        if self.max_sinkage() <= 0.0 {
            return Err(PressureError::EmptyTable);
        }
        let mut before = f64::NEG_INFINITY;
        for (n, &[sinkage, pressure]) in self.points.iter().enumerate() {
            if !sinkage.is_finite() || sinkage < 0.0 || sinkage <= before {
                return Err(PressureError::TableOrder { point: n + 1, sinkage });
            }
            if !pressure.is_finite() || pressure < 0.0 {
                return Err(PressureError::BadPressure { sinkage, pressure });
            }
            before = sinkage;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_passes_through_its_points_and_the_origin() {
        let table = Table { points: vec![[0.1, 10e3], [0.2, 40e3]] };
        for (z, p) in [(0.0, 0.0), (0.05, 5e3), (0.1, 10e3), (0.15, 25e3), (0.2, 40e3), (0.3, 70e3)] {
            assert!((table.pressure(z) - p).abs() < 1e-9, "{z}");
        }
    }

    #[test]
    fn unsorted_and_empty_tables_are_refused() {
        let table = |points: &[[f64; 2]]| Table { points: points.to_vec() }.check();
        assert_eq!(
            table(&[[0.1, 1.0], [0.1, 2.0]]),
            Err(PressureError::TableOrder { point: 2, sinkage: 0.1 })
        );
        assert_eq!(table(&[]), Err(PressureError::EmptyTable));
        assert!(table(&[[0.1, -1.0]]).is_err());
    }
}
