//! Random deviations from a smooth relationship, as P2 §2.5 adds to its linear one.

use serde::{Deserialize, Serialize};

use super::{PressureError, PressureLaw};

/// A relationship multiplied by 1 + a ξ(z), ξ piecewise linear between uniform random values in \[−1, 1\].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Noisy {
    /// The smooth relationship.
    pub law: Box<PressureLaw>,
    /// Largest relative deviation a \[-\].
    pub amplitude: f64,
    /// Distance of the random values in sinkage \[m\].
    pub interval: f64,
    /// Seed of the random values.
    pub seed: u64,
}

impl Noisy {
    /// Pressure \[Pa\] at `sinkage` \[m\].
    pub fn pressure(&self, sinkage: f64) -> f64 {
        let t = sinkage.max(0.0) / self.interval;
        let k = t.floor();
        let (a, b) = (uniform(self.seed, k as u64), uniform(self.seed, k as u64 + 1));
        self.law.pressure(sinkage) * (1.0 + self.amplitude * (a + (b - a) * (t - k)))
    }

    pub(super) fn check(&self) -> Result<(), PressureError> {
        self.law.check()?;
        super::positive("noisy", "interval", self.interval)?;
        if (0.0..1.0).contains(&self.amplitude) {
            return Ok(());
        }
        Err(PressureError::Parameter {
            law: "noisy",
            parameter: "amplitude",
            value: self.amplitude,
            expected: "a relative deviation from 0 to below 1",
        })
    }
}

/// The `k`-th of a stream of uniform random numbers in \[−1, 1\] (SplitMix64: Steele, Lea & Flood 2014).
pub(crate) fn uniform(seed: u64, k: u64) -> f64 {
    let mut z = seed.wrapping_add(k.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15));
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

#[cfg(test)]
mod tests {
    use super::super::Linear;
    use super::*;

    #[test]
    fn deviations_stay_within_the_amplitude_and_average_out() {
        let law = Box::new(PressureLaw::Linear(Linear { stiffness: 1e6 }));
        let noisy = Noisy { law, amplitude: 0.2, interval: 0.001, seed: 7 };
        let deviations: Vec<f64> =
            (1..2000).map(|k| noisy.pressure(k as f64 * 5e-4) / (k as f64 * 500.0) - 1.0).collect();
        assert!(deviations.iter().all(|d| d.abs() <= 0.2));
        assert!((deviations.iter().sum::<f64>() / deviations.len() as f64).abs() < 0.01);
        assert!(deviations.iter().any(|d| d.abs() > 0.15));
    }
}
