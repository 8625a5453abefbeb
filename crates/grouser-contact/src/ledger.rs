//! Where the energy of many contacts is and where it went.

use crate::{ContactEnergy, Real};
use serde::{Deserialize, Serialize};
use std::ops::AddAssign;

/// Energy of contacts: stored now, and spent since the ledger began.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactLedger {
    /// Stored by normal overlaps at this instant [J].
    pub normal_elastic: f64,
    /// Stored by tangential springs at this instant [J].
    pub tangential_elastic: f64,
    /// Lost in normal dashpots [J].
    pub normal_damping: f64,
    /// Spent by tangential motion on contacts: what is not stored of it was lost [J].
    pub tangential: f64,
    /// The part of `tangential` spent while contacts slid [J].
    pub sliding: f64,
    /// Taken from the motion by rotation laws beyond what spheres' torques exchange with tangential springs [J]; rolling
    /// springs hold a part of it, and tilting grains give back what they took.
    pub turning: f64,
    /// Stored by tangential springs when the ledger began [J].
    pub tangential_elastic_at_start: f64,
}

impl ContactLedger {
    /// Adds one contact over one step of `time_step` [s].
    #[inline]
    pub fn add<T: Real>(&mut self, energy: &ContactEnergy<T>, time_step: f64) {
        self.normal_elastic += energy.normal_elastic.to_f64();
        self.tangential_elastic += energy.tangential_elastic.to_f64();
        self.normal_damping += energy.normal_damping.to_f64() * time_step;
        self.tangential += energy.tangential.to_f64() * time_step;
        self.sliding += energy.sliding.to_f64() * time_step;
    }

    /// Adds `weight` times what `other` holds.
    pub fn add_weighted(&mut self, other: &Self, weight: f64) {
        self.normal_elastic += weight * other.normal_elastic;
        self.tangential_elastic += weight * other.tangential_elastic;
        self.normal_damping += weight * other.normal_damping;
        self.tangential += weight * other.tangential;
        self.sliding += weight * other.sliding;
        self.turning += weight * other.turning;
    }

    /// Adds the spending of one pass to this running ledger; stored energies are those of the latest pass.
    pub fn record(&mut self, pass: &Self) {
        self.normal_elastic = pass.normal_elastic;
        self.tangential_elastic = pass.tangential_elastic;
        self.normal_damping += pass.normal_damping;
        self.tangential += pass.tangential;
        self.sliding += pass.sliding;
        self.turning += pass.turning;
    }

    /// A ledger that begins now, with nothing spent.
    pub fn restarted(&self) -> Self {
        Self {
            normal_elastic: self.normal_elastic,
            tangential_elastic: self.tangential_elastic,
            tangential_elastic_at_start: self.tangential_elastic,
            ..Self::default()
        }
    }

    /// Stored energy [J].
    pub fn elastic(&self) -> f64 {
        self.normal_elastic + self.tangential_elastic
    }

    /// Energy lost in dashpots and friction, and spent on turning [J].
    pub fn dissipated(&self) -> f64 {
        self.normal_damping + self.tangential + self.turning + self.tangential_elastic_at_start
            - self.tangential_elastic
    }
}

impl AddAssign for ContactLedger {
    fn add_assign(&mut self, other: Self) {
        self.add_weighted(&other, 1.0);
    }
}
