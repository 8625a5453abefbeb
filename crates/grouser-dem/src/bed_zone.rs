//! The active zone of a bed: turned on and off, told where tools are, and weighed.

use crate::active_zone::{ActiveZone, Zone, ZoneAccount};
use crate::force_pass::{PassInput, slab_forces};
use crate::shared_grains::SharedGrains;
use crate::{Bed, Failure};
use grouser_contact::{ContactLaw, ContactLedger, Load, Precision, Real};
use grouser_geometry::Vec3;

impl<L: ContactLaw<P::Real>, P: Precision> Bed<L, P> {
    /// Lets grains at rest fall asleep from now on, or wakes everybody for good. Everybody is awake at first.
    ///
    /// # Errors
    /// When the motion has become meaningless.
    pub fn set_active_zone(&mut self, settings: Option<ActiveZone>) -> Result<(), Failure> {
        if let Some(zone) = &mut self.zone {
            zone.wake_all();
            self.renew_lists()?;
        }
        self.zone = settings.map(|settings| {
            let zone = Zone::new(settings, self.grains.len(), &self.settings);
            Box::new(zone)
        });
        self.renew_lists()
    }

    /// Blocks that meet these boxes [m] (lower and upper corner) stay awake until the next call: the reach of tools, with what
    /// they travel until then. Nothing without an active zone.
    pub fn keep_awake(&mut self, boxes: Vec<[Vec3; 2]>) {
        if let Some(zone) = &mut self.zone {
            zone.keep_awake(boxes);
        }
    }

    /// What the active zone did so far; `None` without one.
    pub fn zone(&self) -> Option<&ZoneAccount> {
        self.zone.as_ref().map(|zone| &zone.account)
    }

    /// Forces among sleeping grains and of planes on them: found once, as they stay until somebody falls asleep or wakes.
    pub(crate) fn weigh_sleepers(&mut self) {
        let Some(zone) = &mut self.zone else { return };
        let mut slab = zone.sleepers.slab(&self.grains, &self.settings.domain.period());
        let asleep: Vec<usize> = zone.held().chain(zone.n_listed..self.grains.len()).collect();
        for &place in &asleep {
            self.grains.loads[place] = Load::default();
        }
        let input = PassInput {
            grains: SharedGrains::new(&mut self.grains),
            shifts: self.settings.domain.period().shifts(),
            law: self.law,
            table: &self.table,
            // Nothing moves, and no memory of this copy is kept.
            time_step: P::Real::ZERO,
            has_ledger: true,
            set: self.set,
        };
        let mut sums = slab_forces(&mut slab, &input).ledger;
        zone.plane_forces.clear();
        for (list, plane) in slab.planes.iter_mut().zip(&self.settings.planes) {
            sums += list.forces(plane, &input).ledger;
            zone.plane_forces.push(list.force);
        }
        zone.elastic = ContactLedger {
            normal_elastic: sums.normal_elastic,
            tangential_elastic: sums.tangential_elastic,
            ..Default::default()
        };
        zone.weigh(&self.grains, self.settings.gravity);
        for place in asleep {
            self.grains.loads[place] = Load::default();
        }
    }
}
