//! Belts of shoes: chains around one wheel, tracks around a bogie, rubber bands.

use grouser_geometry::{Orientation, Pose, TriangleSurface, Vec3};
use serde::{Deserialize, Serialize};

use super::{GearError, Hull, Wheel, positive};
use crate::imprint::{Imprint, Plate};
use crate::track::{DrawnTrack, TrackShape, tight_pitch};

/// What a shoe shows to the ground.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum ShoeShape {
    /// Stiff plates, and grousers that reach deeper.
    Steel {
        /// Plates of the body.
        plates: Vec<Plate>,
        /// Undersides of the grousers.
        grousers: Vec<Plate>,
    },
    /// A band that bends with the wheel, without gaps.
    Band {
        /// Width \[m\].
        width: f64,
        /// Thickness outside the link line \[m\].
        depth: f64,
        /// Flat pieces per pitch.
        n_pieces: usize,
    },
    /// Imported triangles in the frame of a [`Plate`].
    Surface(TriangleSurface),
}

/// A shoe of a belt.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shoe {
    /// Mass \[kg\]; counted in the body's mass, and each for itself in a slack belt.
    pub mass: f64,
    /// Underside.
    pub shape: ShoeShape,
}

/// A closed belt of shoes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Belt {
    /// Wheels that it runs around, numbers in the foot.
    pub wheels: Vec<usize>,
    /// Distance of the link line outside the wheels' rolling radius \[m\].
    pub link_offset: f64,
    /// Number of shoes.
    pub n_shoes: usize,
    /// Distance of the links \[m\].
    pub pitch: f64,
    /// The shoes.
    pub shoe: Shoe,
    /// How it sits on its wheels.
    pub fit: Fit,
}

/// Largest pitch of a slack belt over that with which it lies tight; beyond, a track would come off.
const MOST_SLACK: f64 = 1.05;

/// How a belt sits on its wheels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Fit {
    /// It follows the shortest way around its wheels, as stiff as they are between them.
    #[default]
    Tight,
    /// Stiff links that are held by the tops of the wheels, hang between them, and give way to the ground below.
    Slack,
}

impl Shoe {
    /// Largest reach below the link line \[m\].
    pub fn depth(&self) -> f64 {
        match &self.shape {
            ShoeShape::Steel { plates, grousers } => {
                plates.iter().chain(grousers).map(|p| p.depth).fold(0.0, f64::max)
            }
            ShoeShape::Band { depth, .. } => *depth,
            ShoeShape::Surface(surface) => surface.vertices.iter().map(|v| -v.z).fold(0.0, f64::max),
        }
    }

    /// Largest reach to the side \[m\].
    pub fn half_width(&self) -> f64 {
        match &self.shape {
            ShoeShape::Steel { plates, grousers } => {
                plates.iter().chain(grousers).map(|p| p.across[1].max(-p.across[0])).fold(0.0, f64::max)
            }
            ShoeShape::Band { width, .. } => width / 2.0,
            ShoeShape::Surface(surface) => surface.vertices.iter().map(|v| v.y.abs()).fold(0.0, f64::max),
        }
    }
}

impl Belt {
    /// Circles (x, z, radius) of the link line around the wheels \[m\].
    pub fn circles(&self, wheels: &[Wheel]) -> Vec<[f64; 3]> {
        let circle =
            |&w: &usize| [wheels[w].centre.x, wheels[w].centre.z, wheels[w].radius + self.link_offset];
        self.wheels.iter().map(circle).collect()
    }

    /// Lateral position of the belt's middle \[m\].
    pub fn lateral(&self, wheels: &[Wheel]) -> f64 {
        self.wheels.iter().map(|&w| wheels[w].centre.y).sum::<f64>() / self.wheels.len().max(1) as f64
    }

    pub(super) fn check(&self, wheels_of: &[Wheel]) -> Result<(), GearError> {
        if let Some(&wheel) = self.wheels.iter().find(|&&w| w >= wheels_of.len()) {
            return Err(GearError::NoSuchWheel { wheel, n_wheels: wheels_of.len() });
        }
        positive("belt", "number of wheels", self.wheels.len() as f64)?;
        positive("belt", "pitch", self.pitch)?;
        positive("belt", "number of shoes", self.n_shoes as f64)?;
        positive("shoe", "width", 2.0 * self.shoe.half_width())?;
        let needed = Hull::around(&self.circles(wheels_of)).length();
        let length = self.pitch * self.n_shoes as f64;
        if self.fit == Fit::Slack {
            let two = "two wheels or more: a chain around one wheel is tight";
            if self.wheels.len() < 2 {
                return Err(GearError::Size {
                    part: "slack belt",
                    quantity: "number of wheels",
                    value: 1.0,
                    expected: two,
                });
            }
            let tight = tight_pitch(&self.circles(wheels_of), self.n_shoes);
            if !(1.0 - 1e-9..=MOST_SLACK).contains(&(self.pitch / tight)) {
                return Err(GearError::SlackPitch { pitch: self.pitch, tight, longest: MOST_SLACK * tight });
            }
            return Ok(());
        }
        if (length / needed - 1.0).abs() <= 0.01 {
            Ok(())
        } else {
            Err(GearError::BeltLength { n_shoes: self.n_shoes, pitch: self.pitch, length, needed })
        }
    }

    /// Joints of a tight belt (x, z) in the body's frame \[m\], spread evenly over the way around the wheels after the belt has run by
    /// `travel` \[m\].
    pub fn tight_joints(&self, wheels: &[Wheel], travel: f64) -> Vec<[f64; 2]> {
        let hull = Hull::around(&self.circles(wheels));
        let pitch = hull.length() / self.n_shoes as f64;
        (0..self.n_shoes).map(|k| hull.at(k as f64 * pitch - travel).position).collect()
    }

    /// Joints of the belt on a body at `pose`; a slack one has its lower section along `shape`, an earlier one.
    pub fn joints(
        &self,
        wheels: &[Wheel],
        pose: &Pose,
        travel: f64,
        shape: Option<&TrackShape>,
    ) -> Vec<[f64; 2]> {
        match self.fit {
            Fit::Tight => self.tight_joints(wheels, travel),
            Fit::Slack => DrawnTrack::new(self, wheels, pose, travel, shape, 0).joints,
        }
    }

    /// Draws all shoes on a body at `pose`; a slack belt has its joints given. Owners count from `first`.
    pub(super) fn draw(
        &self,
        wheels: &[Wheel],
        pose: &Pose,
        travel: f64,
        slack: Option<&[[f64; 2]]>,
        first: u16,
        grousers: &mut Imprint,
        shoes: &mut Imprint,
    ) {
        let y = self.lateral(wheels);
        let frame = |[x, z]: [f64; 2], direction: f64| {
            // Anticlockwise in the x–z plane is clockwise about y.
            let turn = Orientation::from_axis_angle(&Vec3::y_axis(), -direction);
            pose * Pose::from_parts(Vec3::new(x, y, z).into(), turn)
        };
        if let ShoeShape::Band { width, depth, n_pieces } = self.shoe.shape
            && slack.is_none()
        {
            let hull = Hull::around(&self.circles(wheels));
            let n = self.n_shoes * n_pieces.max(1);
            let length = hull.length() / n as f64;
            for k in 0..n {
                let point = hull.at((k as f64 + 0.5) * length - travel);
                let half = length / 2.0 * (1.0 + depth / point.radius);
                let plate = Plate { along: [-half, half], across: [-width / 2.0, width / 2.0], depth };
                let owner = first + (k / n_pieces.max(1)) as u16;
                shoes.draw_plate(&frame(point.position, point.direction), &plate, owner);
            }
            return;
        }
        let joints = slack.map_or_else(|| self.tight_joints(wheels, travel), <[_]>::to_vec);
        for (owner, a) in joints.iter().enumerate() {
            let b = joints[(owner + 1) % joints.len()];
            let middle = [(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0];
            let at = frame(middle, (b[1] - a[1]).atan2(b[0] - a[0]));
            let owner = first + owner as u16;
            match &self.shoe.shape {
                ShoeShape::Steel { plates, grousers: deep } => {
                    plates.iter().for_each(|plate| shoes.draw_plate(&at, plate, owner));
                    deep.iter().for_each(|plate| grousers.draw_plate(&at, plate, owner));
                }
                ShoeShape::Band { width, depth, .. } => {
                    let half = self.pitch / 2.0;
                    let plate =
                        Plate { along: [-half, half], across: [-width / 2.0, width / 2.0], depth: *depth };
                    shoes.draw_plate(&at, &plate, owner);
                }
                ShoeShape::Surface(surface) => {
                    if (at.rotation * Vec3::z()).z > 0.2 {
                        shoes.draw_surface(&at, surface, owner);
                    }
                }
            }
        }
    }
}
