//! Where the work of a tool on a bed of grains went.

use crate::output::summary::{Energy, EnergyEntry};
use grouser_contact::ContactLedger;
use grouser_dem::BedEnergy;
use serde::{Deserialize, Serialize};

/// Energy of a tool's way through a bed [J].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ToolLedger {
    /// Work of the tool on the bed.
    pub input: f64,
    /// Kinetic energy gained.
    pub kinetic: f64,
    /// Elastic energy gained by contacts among grains and with the box.
    pub elastic: f64,
    /// Elastic energy of contacts with the tool.
    pub tool_elastic: f64,
    /// Gravitational energy gained.
    pub gravitational: f64,
    /// Lost in normal dashpots.
    pub normal_damping: f64,
    /// Lost by sliding.
    pub sliding: f64,
    /// Lost by tangential motion without sliding: dashpots, and springs that unloading slackens.
    pub sticking: f64,
    /// Spent on turning by rotation laws; tilting grains give back what they took.
    pub turning: f64,
    /// Lost to background damping.
    pub background: f64,
    /// Kinetic energy of grains when they fell asleep outside the active zone.
    pub fallen_asleep: f64,
}

impl ToolLedger {
    /// The ledger of a bed between two looks at its energy, and of the tool's own contacts between them.
    pub fn between(before: &BedEnergy, after: &BedEnergy, tool: &ContactLedger, work: f64) -> Self {
        let mut contacts = after.contacts;
        let elastic = contacts.elastic() - before.contacts.elastic();
        contacts += *tool;
        let lost = |pick: fn(&ContactLedger) -> f64| pick(&contacts) - pick(&before.contacts);
        let (normal_damping, sliding) = (lost(|l| l.normal_damping), lost(|l| l.sliding));
        let turning = lost(|l| l.turning);
        Self {
            input: work,
            kinetic: after.kinetic + after.rotational - before.kinetic - before.rotational,
            elastic,
            tool_elastic: tool.elastic(),
            gravitational: after.gravitational - before.gravitational,
            normal_damping,
            sliding,
            sticking: lost(ContactLedger::dissipated) - normal_damping - sliding - turning,
            turning,
            background: after.background_damping - before.background_damping,
            fallen_asleep: after.fallen_asleep - before.fallen_asleep,
        }
    }

    /// Energy gained [J].
    pub fn stored(&self) -> f64 {
        self.kinetic + self.elastic + self.tool_elastic + self.gravitational
    }

    /// Energy lost [J].
    pub fn dissipated(&self) -> f64 {
        let by_contacts = self.normal_damping + self.sliding + self.sticking + self.turning;
        by_contacts + self.background + self.fallen_asleep
    }

    /// What the ledger misses, over the larger of work and loss [-].
    pub fn residual_fraction(&self) -> f64 {
        (self.input - self.stored() - self.dissipated()) / self.input.abs().max(self.dissipated())
    }

    /// Several ledgers together, as the summary shows them.
    pub fn energy(ledgers: &[Self]) -> Energy {
        let sum = |of: fn(&Self) -> f64| ledgers.iter().map(of).sum::<f64>();
        let entry = |name: &str, of: fn(&Self) -> f64| EnergyEntry { name: name.into(), value_J: sum(of) };
        Energy::new(
            sum(|l| l.input),
            sum(Self::stored),
            sum(Self::dissipated),
            vec![
                entry("work of the tool", |l| l.input),
                entry("kinetic energy gained", |l| l.kinetic),
                entry("elastic energy gained among grains", |l| l.elastic),
                entry("elastic energy gained at the tool", |l| l.tool_elastic),
                entry("gravitational energy gained", |l| l.gravitational),
                entry("lost in normal dashpots", |l| l.normal_damping),
                entry("lost by sliding friction", |l| l.sliding),
                entry("lost by tangential dashpots and slackened springs", |l| l.sticking),
                entry("spent on turning", |l| l.turning),
                entry("lost to background damping", |l| l.background),
                entry("taken from grains that fell asleep", |l| l.fallen_asleep),
            ],
        )
    }
}
