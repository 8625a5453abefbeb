//! The active zone of a bed: turned on and off, and told where tools are.

use crate::active_zone::{ActiveZone, Zone, ZoneAccount};
use crate::block::Block;
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

    /// Grains within `reach` [m] of these boxes (lower and upper corner [m]) are awake until the next call: of the bounding boxes
    /// of tools, with what they travel until then. Nothing without an active zone.
    pub fn keep_awake(&mut self, boxes: Vec<[Vec3; 2]>, reach: f64) {
        if let Some(zone) = &mut self.zone {
            zone.keep_awake(boxes, reach);
        }
    }

    /// What the active zone did so far; `None` without one.
    pub fn zone(&self) -> Option<&ZoneAccount> {
        self.zone.as_ref().map(|zone| &zone.account)
    }

    /// Elastic energy among sleeping grains and forces of planes on them: found once, as they stay until somebody falls asleep
    /// or wakes.
    pub(crate) fn weigh_sleepers(&mut self) {
        let Some(zone) = &mut self.zone else { return };
        let mut slab = zone.sleepers.slab(&self.grains, &self.settings.domain.period());
        let input = PassInput {
            grains: SharedGrains::new(&mut self.grains),
            shifts: self.settings.domain.period().shifts(),
            law: self.law,
            table: &self.table,
            // Nothing moves, and no memory of this copy is kept.
            time_step: P::Real::ZERO,
            has_ledger: true,
            largest_overlap: P::Real::from_f64(self.largest_overlap),
            set: self.set,
        };
        let mut sums = slab_forces(&mut slab, &mut Block::new(&self.table), &input).ledger;
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
        // What it added to their loads is balanced by gravity and by what holds them.
        let n_listed = zone.n_listed();
        let asleep = (0..n_listed).filter(|&place| zone.is_asleep[place]).chain(n_listed..self.grains.len());
        for place in asleep {
            self.grains.loads[place] = Load::default();
        }
    }
}
