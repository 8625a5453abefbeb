//! Grains that several slabs work on at once.

use crate::Grains;
use grouser_contact::{Load, Precision, Sphere, Vector};
use grouser_geometry::Orientation;

/// The arrays of a bed, seen by all threads of a sweep. Which grains a thread may touch is the matter of
/// [`crate::sweep`]; this type only makes the promise short to write.
#[derive(Clone, Copy)]
pub(crate) struct SharedGrains<P: Precision> {
    spheres: *mut Sphere<P>,
    loads: *mut Load<P::Real>,
    accelerations: *mut [Vector<P::Real>; 2],
    /// Null where no orientations are kept.
    orientations: *mut Orientation,
    n: usize,
}

// SAFETY: a sweep lets no two threads work on one grain at a time (see `crate::sweep`).
unsafe impl<P: Precision> Send for SharedGrains<P> {}
// SAFETY: as above.
unsafe impl<P: Precision> Sync for SharedGrains<P> {}

impl<P: Precision> SharedGrains<P> {
    /// The arrays of `grains`, which stay borrowed as long as the sweep lasts.
    pub fn new(grains: &mut Grains<P>) -> Self {
        let n = grains.spheres.len();
        assert!(grains.loads.len() == n && grains.accelerations.len() == n);
        let orientations = grains.orientations.as_mut();
        assert!(orientations.as_ref().is_none_or(|kept| kept.len() == n));
        Self {
            spheres: grains.spheres.as_mut_ptr(),
            loads: grains.loads.as_mut_ptr(),
            accelerations: grains.accelerations.as_mut_ptr(),
            orientations: orientations.map_or(std::ptr::null_mut(), |kept| kept.as_mut_ptr()),
            n,
        }
    }

    /// One grain.
    #[inline(always)]
    pub fn sphere(&self, grain: u32) -> &Sphere<P> {
        debug_assert!((grain as usize) < self.n);
        // SAFETY: lists hold numbers below the number of grains, and no thread moves this grain now.
        unsafe { &*self.spheres.add(grain as usize) }
    }

    /// Adds a force and a torque to one grain.
    #[inline(always)]
    pub fn add_load(&self, grain: u32, force: Vector<P::Real>, torque: Vector<P::Real>) {
        debug_assert!((grain as usize) < self.n);
        // SAFETY: as above, and no other thread writes to this grain now.
        unsafe { (*self.loads.add(grain as usize)).add(force, torque) }
    }

    /// Start of the records.
    #[inline(always)]
    pub fn spheres(&self) -> *const Sphere<P> {
        self.spheres
    }

    /// Start of the loads.
    #[inline(always)]
    pub fn loads(&self) -> *mut Load<P::Real> {
        self.loads
    }

    /// Start of the orientations; null where none are kept.
    #[inline(always)]
    pub fn all_orientations(&self) -> *const Orientation {
        self.orientations
    }

    /// Orientation of one grain as (i, j, k, real part). Laws that ask for it make the bed keep orientations.
    #[inline(always)]
    pub fn quaternion(&self, grain: u32) -> [f64; 4] {
        debug_assert!((grain as usize) < self.n && !self.orientations.is_null());
        // SAFETY: as for spheres; `Bed::new` and deserialisation keep orientations for laws that ask for them.
        let orientation: &Orientation = unsafe { &*self.orientations.add(grain as usize) };
        orientation.coords.into()
    }

    /// Orientations of a range, where they are kept.
    #[expect(clippy::mut_from_ref, reason = "exclusive access to the range is the promise of the sweep")]
    pub fn orientations(&self, range: std::ops::Range<u32>) -> Option<&mut [Orientation]> {
        let (from, n) = (range.start as usize, range.len());
        assert!(from + n <= self.n);
        // SAFETY: as for [`SharedGrains::range`].
        (!self.orientations.is_null())
            .then(|| unsafe { std::slice::from_raw_parts_mut(self.orientations.add(from), n) })
    }

    /// Everything about the grains of a range.
    #[expect(clippy::mut_from_ref, reason = "exclusive access to the range is the promise of the sweep")]
    #[expect(clippy::type_complexity, reason = "three parallel slices")]
    pub fn range(
        &self,
        range: std::ops::Range<u32>,
    ) -> (&mut [Sphere<P>], &mut [Load<P::Real>], &mut [[Vector<P::Real>; 2]]) {
        let (from, n) = (range.start as usize, range.len());
        assert!(from + n <= self.n);
        // SAFETY: the range lies inside the arrays, and no other thread looks at these grains now.
        unsafe {
            (
                std::slice::from_raw_parts_mut(self.spheres.add(from), n),
                std::slice::from_raw_parts_mut(self.loads.add(from), n),
                std::slice::from_raw_parts_mut(self.accelerations.add(from), n),
            )
        }
    }
}
