//! Running gear: wheels and belts of shoes on a body, and their imprint on the ground.

mod belt;
mod hull;
mod wheel;
pub mod x3d;

use grouser_geometry::{Pose, Vec3};
use serde::{Deserialize, Serialize};
use thiserror::Error;

pub use belt::{Belt, Fit, Shoe, ShoeShape};
pub use hull::{Hull, HullPoint, Piece};
pub use wheel::{TreadPattern, TreadedWheel, Wheel, WheelShape, treaded_wheel};

use crate::contact::FootImprint;
use crate::footing::Reach;
use crate::imprint::Imprint;
use crate::polygon::PartialLoad;
use crate::terrain::Terrain;
use crate::track::{DrawnTrack, TrackShape};

/// Wheels and belts that stand on one body: a wheel, or a bogie with its track.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Foot {
    /// The body.
    pub body: usize,
    /// Wheels, axles along y of the body.
    pub wheels: Vec<Wheel>,
    /// Chains and tracks around them.
    pub belts: Vec<Belt>,
}

/// Why running gear cannot be used.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum GearError {
    /// A size without meaning.
    #[error("{part}: {quantity} is {value}, expected {expected}")]
    Size {
        /// The part.
        part: &'static str,
        /// The quantity.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// What was expected.
        expected: &'static str,
    },
    /// A belt around a wheel that is not there.
    #[error("the belt runs around wheel {wheel}, the foot has {n_wheels}; wheels count from 0")]
    NoSuchWheel {
        /// The wheel.
        wheel: usize,
        /// Wheels of the foot.
        n_wheels: usize,
    },
    /// Links too short or far too long for a slack belt.
    #[error(
        "the links of a slack belt have a pitch of {pitch:.5} m; expected {tight:.5} m, where they would lie tight, to {longest:.5} m"
    )]
    SlackPitch {
        /// Their pitch \[m\].
        pitch: f64,
        /// Where they lie tight \[m\].
        tight: f64,
        /// Longest \[m\].
        longest: f64,
    },
    /// Shoes that do not fill the belt.
    #[error(
        "{n_shoes} shoes of {pitch} m pitch make {length:.4} m, the way around the wheels is {needed:.4} m; a tight belt may differ by \
         1 %; remedy: pitch {:.5} m",
        needed / *n_shoes as f64
    )]
    BeltLength {
        /// Shoes.
        n_shoes: usize,
        /// Their pitch \[m\].
        pitch: f64,
        /// Length of the belt \[m\].
        length: f64,
        /// Length of the way around the wheels \[m\].
        needed: f64,
    },
}

pub(crate) fn positive(part: &'static str, quantity: &'static str, value: f64) -> Result<(), GearError> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(GearError::Size { part, quantity, value, expected: "a finite value above zero" })
    }
}

/// Height above the highest ground under the gear up to which its underside is drawn \[m\].
const HEADROOM: f64 = 0.2;

impl Foot {
    /// Refuses gear without meaning.
    pub fn check(&self) -> Result<(), GearError> {
        for wheel in &self.wheels {
            wheel.check()?;
        }
        self.belts.iter().try_for_each(|belt| belt.check(&self.wheels))
    }

    /// Grid models of the gear on a body at `pose` after the wheels have rolled by `travel` \[m\].
    ///
    /// Owners are wheel numbers in the layer of wheels, shoe numbers in the others.
    pub fn imprint(&self, terrain: &Terrain, pose: &Pose, travel: f64, partial: PartialLoad) -> FootImprint {
        self.imprint_with(terrain, pose, travel, partial, &[])
    }

    /// The same with the lower sections of slack belts, in their order, along earlier shapes; those not given are taken as tight.
    pub fn imprint_with(
        &self,
        terrain: &Terrain,
        pose: &Pose,
        travel: f64,
        partial: PartialLoad,
        shapes: &[TrackShape],
    ) -> FootImprint {
        let grid = terrain.grid();
        let (mut low, mut high) = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
        let depth = self.belts.iter().map(|b| b.shoe.depth()).fold(0.0, f64::max);
        for wheel in &self.wheels {
            let half = self.belts.iter().map(|b| b.shoe.half_width()).fold(wheel.half_width(), f64::max);
            let reach = wheel.outer_radius() + depth;
            let reach = Vec3::new(reach, half, reach);
            low = low.inf(&(wheel.centre - reach));
            high = high.sup(&(wheel.centre + reach));
        }
        let (mut min, mut max) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for corner in 0..8 {
            let pick = |k: usize| if corner >> k & 1 == 0 { low[k] } else { high[k] };
            let p = pose * nalgebra::Point3::new(pick(0), pick(1), pick(2));
            for k in 0..2 {
                min[k] = min[k].min(p[k]);
                max[k] = max[k].max(p[k]);
            }
        }
        let [is, js] = Imprint::window(grid, min, max);
        let nodes = js.flat_map(|j| is.clone().map(move |i| j * grid.n_x() + i));
        let highest = nodes.map(|node| terrain.height(node)).fold(f64::NEG_INFINITY, f64::max);
        let blank = || Imprint::new(grid, min, max, highest + HEADROOM, partial);
        let mut layers = Vec::with_capacity(3);
        let mut tracks = Vec::new();
        if !self.belts.is_empty() {
            let (mut grousers, mut shoes) = (blank(), blank());
            let mut first = 0;
            for belt in &self.belts {
                let track = (belt.fit == Fit::Slack).then(|| {
                    let shape = shapes.get(tracks.len());
                    DrawnTrack::new(belt, &self.wheels, pose, travel, shape, first)
                });
                let joints = track.as_ref().map(|track| track.joints.as_slice());
                belt.draw(&self.wheels, pose, travel, joints, first, &mut grousers, &mut shoes);
                tracks.extend(track);
                first += belt.n_shoes as u16;
            }
            layers.extend([grousers, shoes].into_iter().filter(|layer| !layer.is_empty()));
        }
        let mut wheels = blank();
        for (owner, wheel) in self.wheels.iter().enumerate() {
            wheel.draw(pose, travel, &mut wheels, owner as u16);
        }
        layers.push(wheels);
        for layer in &mut layers {
            layer.carry_edges(grid);
        }
        let reach = if tracks.is_empty() { Reach::Close } else { Reach::Far };
        let mut drawn = FootImprint::new(layers, pose.translation.vector, terrain, partial, reach);
        for track in &mut tracks {
            track.find_touches(&drawn, terrain);
        }
        drawn.tracks = tracks;
        drawn
    }
}
