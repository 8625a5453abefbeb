//! Where the energy of a bed is and where it went.

use grouser_contact::ContactLedger;
use serde::{Deserialize, Serialize};

/// Energy of a whole bed at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BedEnergy {
    /// Translational kinetic energy [J].
    pub kinetic: f64,
    /// Rotational kinetic energy [J].
    pub rotational: f64,
    /// Gravitational energy relative to the origin [J].
    pub gravitational: f64,
    /// Contacts among grains and with planes.
    pub contacts: ContactLedger,
    /// Lost to background damping since the bed was made [J].
    pub background_damping: f64,
    /// Kinetic energy of grains when they fell asleep, lost since the active zone began [J].
    pub fallen_asleep: f64,
}

impl BedEnergy {
    /// Kinetic, gravitational and elastic energy [J].
    pub fn stored(&self) -> f64 {
        self.kinetic + self.rotational + self.gravitational + self.contacts.elastic()
    }
}
