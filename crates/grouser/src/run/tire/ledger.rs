//! Where the work of a tire's axle went.

use crate::output::summary::{Energy, EnergyEntry};
use crate::run::ToolLedger;
use grouser_contact::ContactLedger;
use grouser_dem::BedEnergy;
use grouser_fem::Solid;
use serde::{Deserialize, Serialize};

/// Energy of a tire's way through a bed [J].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TireLedger {
    /// The bed and the contacts; its input is the work of axle, inflation and the tread's weight.
    pub bed: ToolLedger,
    /// Kinetic and strain energy gained by the tread; in the frame of the rim where it is body-attached.
    pub tread: f64,
    /// Lost by damping of the rubber.
    pub rubber_damping: f64,
}

impl TireLedger {
    /// The ledger between two looks at the bed. `on_tire` is the work of the grains on the tire [J].
    ///
    /// What the axle puts in is the work of the supports, and that of pressures, weight and inertia without that of the grains. For a
    /// body-attached tread the motion of the frame does the supports' work: W = W_external − ∫ Σ f·v dt with v in the world.
    pub fn between(
        before: &BedEnergy,
        after: &BedEnergy,
        contacts: &ContactLedger,
        solid: Option<&Solid>,
        on_tire: f64,
    ) -> Self {
        let (mut input, mut tread, mut rubber_damping) = (-on_tire, 0.0, 0.0);
        if let Some(solid) = solid {
            let ledger = &solid.state.ledger;
            input += ledger.support_work + ledger.external_work;
            tread = solid.kinetic_energy() + solid.strain_energy() - ledger.initial;
            rubber_damping = ledger.mass_damping + ledger.stiffness_damping;
        }
        Self { bed: ToolLedger::between(before, after, contacts, input), tread, rubber_damping }
    }

    /// Energy gained [J].
    pub fn stored(&self) -> f64 {
        self.bed.stored() + self.tread
    }

    /// Energy lost [J].
    pub fn dissipated(&self) -> f64 {
        self.bed.dissipated() + self.rubber_damping
    }

    /// What the ledger misses [J].
    pub fn residual(&self) -> f64 {
        self.bed.input - self.stored() - self.dissipated()
    }

    /// As the summary shows it.
    pub fn energy(&self) -> Energy {
        let mut entries = ToolLedger::energy(&[self.bed]).entries;
        let entry = |name: &str, value: f64| EnergyEntry { name: name.into(), value_J: value };
        entries.push(entry("kinetic and strain energy gained by the tread", self.tread));
        entries.push(entry("lost in the rubber", self.rubber_damping));
        Energy::new(self.bed.input, self.stored(), self.dissipated(), entries)
    }
}
