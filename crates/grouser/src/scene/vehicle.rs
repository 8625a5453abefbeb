//! A vehicle of frames joined in a line, on wheels, bogies, chains and tracks.

use super::BeltShoe;
use crate::diagnostic::Diagnostic;
use grouser_geometry::Vec3;
use grouser_iscm::gear::{Belt, Fit, Hull, Shoe, WheelShape};
use grouser_iscm::machine::Machine;
use grouser_iscm::track::tight_pitch;
use grouser_iscm::vehicle::{Articulation, Axle, Component, vehicle};
use serde::{Deserialize, Serialize};

/// Frames, front first, and the joints between them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Vehicle {
    /// Names of the sets of chains and tracks with which it is driven, each over its own copy of the ground; one
    /// that no belt names is the bare machine.
    #[serde(default = "bare")]
    pub equipment: Vec<String>,
    /// Frames, front first.
    pub frames: Vec<Frame>,
    /// Joint of each frame but the first with the one before it.
    #[serde(default)]
    pub joints: Vec<FrameJoint>,
}

/// A frame with its axles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Frame {
    /// Name.
    pub name: String,
    /// Mass without axles and load [kg].
    pub mass_kg: f64,
    /// Centre of that mass, forward, left and up from the frame's origin [m].
    pub centre_of_mass_m: [f64; 3],
    /// Load on the frame.
    #[serde(default)]
    pub load: Option<Load>,
    /// Axles.
    pub axles: Vec<AxlePair>,
}

/// Freight.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// Mass [kg].
    pub mass_kg: f64,
    /// Its centre from the frame's origin [m].
    pub centre_m: [f64; 3],
}

/// Wheels or bogies left and right.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AxlePair {
    /// Position forward of the frame's origin [m].
    #[serde(default)]
    pub along_m: f64,
    /// Height of the pivot above the frame's origin [m].
    #[serde(default)]
    pub height_m: f64,
    /// Half of the track width [m].
    pub half_track_m: f64,
    /// Distance of a bogie's wheels from its pivot [m]; zero for single wheels.
    #[serde(default)]
    pub lever_m: f64,
    /// Mass of one side without belts [kg].
    pub mass_kg: f64,
    /// Largest angle of the bogie [°].
    #[serde(default = "thirty")]
    pub max_angle_deg: f64,
    /// Radius of the wheels [m].
    pub wheel_radius_m: f64,
    /// Width of the wheels [m].
    pub wheel_width_m: f64,
    /// Chains and tracks of one side.
    #[serde(default)]
    pub belts: Vec<BeltSet>,
}

/// A belt of shoes around one wheel or several.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BeltSet {
    /// The set it belongs to, one of the vehicle's `equipment`.
    pub equipment: String,
    /// Wheels that it runs around: 0 the rear one of a bogie, 1 the front one.
    pub wheels: Vec<usize>,
    /// Number of shoes; the pitch follows from the way around the wheels.
    pub n_shoes: usize,
    /// Mass of a shoe [kg].
    pub shoe_mass_kg: f64,
    /// Its shape.
    pub shoe: BeltShoe,
    /// By which share the links are longer than when they lie tight [-]: it then hangs above and gives way to the ground below; none for
    /// a belt that is as stiff between its wheels as they are.
    #[serde(default)]
    pub slack: Option<f64>,
}

/// Joint between two frames.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrameJoint {
    /// Position in the frame before [m].
    pub position_m: [f64; 3],
    /// Origin of the next frame behind the joint [m].
    pub offset_m: f64,
    /// Largest roll between the frames [°]; none for a stiff connection.
    #[serde(default)]
    pub max_roll_deg: Option<f64>,
    /// Whether the frames are steered against each other.
    #[serde(default)]
    pub is_steered: bool,
}

fn bare() -> Vec<String> {
    vec!["bare".into()]
}

fn thirty() -> f64 {
    30.0
}

impl Vehicle {
    /// The machine with a set of chains and tracks on.
    ///
    /// # Errors
    /// The path below the vehicle of a part that is wrong, and what is wrong with it.
    pub fn machine(&self, equipment: &str) -> Result<Machine, (String, Diagnostic)> {
        let components: Vec<Component> = self
            .frames
            .iter()
            .enumerate()
            .map(|(n, frame)| {
                let below = |(path, message)| (format!("frames[{n}].{path}"), message);
                frame.component(equipment).map_err(below)
            })
            .collect::<Result<_, _>>()?;
        let joint = |joint: &FrameJoint| Articulation {
            position: Vec3::from(joint.position_m),
            offset: joint.offset_m,
            max_roll: joint.max_roll_deg.map(f64::to_radians),
            is_steered: joint.is_steered,
        };
        let joints: Vec<Articulation> = self.joints.iter().map(joint).collect();
        vehicle(&components, &joints).map_err(|error| {
            let message = Diagnostic::new(format!("with \"{equipment}\": {error}"))
                .expected("a machine that can stand")
                .usual_cause("a part left out, or a value in another unit");
            (String::new(), message)
        })
    }

    /// Takes the files of shoes beside the scenario, where there are any.
    pub fn find_beside(&mut self, scenario: &str) {
        let axles = self.frames.iter_mut().flat_map(|frame| &mut frame.axles);
        axles.flat_map(|axle| &mut axle.belts).for_each(|belt| belt.shoe.find_beside(scenario));
    }
}

impl Frame {
    fn component(&self, equipment: &str) -> Result<Component, (String, Diagnostic)> {
        let own = Vec3::from(self.centre_of_mass_m) * self.mass_kg;
        let (mass, moment) = match &self.load {
            None => (self.mass_kg, own),
            Some(load) => (self.mass_kg + load.mass_kg, own + Vec3::from(load.centre_m) * load.mass_kg),
        };
        let centre_of_mass = if mass > 0.0 { moment / mass } else { Vec3::zeros() };
        let with = |(n, axle): (usize, &AxlePair)| {
            axle.with(equipment).map_err(|(path, message)| (format!("axles[{n}].{path}"), message))
        };
        let axles = self.axles.iter().enumerate().map(with).collect::<Result<_, _>>()?;
        Ok(Component { name: self.name.clone(), mass, centre_of_mass, axles })
    }
}

impl AxlePair {
    fn with(&self, equipment: &str) -> Result<Axle, (String, Diagnostic)> {
        let on = self.belts.iter().enumerate().filter(|(_, belt)| belt.equipment == equipment);
        let belts: Vec<Belt> = on
            .map(|(n, belt)| belt.belt(self).map_err(|message| (format!("belts[{n}].shoe.file"), message)))
            .collect::<Result<_, _>>()?;
        let belt_mass: f64 = belts.iter().map(|belt| belt.n_shoes as f64 * belt.shoe.mass).sum();
        Ok(Axle {
            along: self.along_m,
            height: self.height_m,
            half_track: self.half_track_m,
            lever: self.lever_m,
            mass: self.mass_kg + belt_mass,
            max_angle: self.max_angle_deg.to_radians(),
            radius: self.wheel_radius_m,
            shape: WheelShape::Cylinder { width: self.wheel_width_m },
            belts,
        })
    }
}

impl BeltSet {
    fn belt(&self, axle: &AxlePair) -> Result<Belt, Diagnostic> {
        let centre = |&wheel: &usize| match (axle.lever_m > 0.0, wheel) {
            (false, _) => 0.0,
            (true, 0) => -axle.lever_m,
            (true, _) => axle.lever_m,
        };
        let circles: Vec<[f64; 3]> =
            self.wheels.iter().map(|wheel| [centre(wheel), 0.0, axle.wheel_radius_m]).collect();
        let (pitch, fit) = match self.slack {
            None => (Hull::around(&circles).length() / self.n_shoes.max(1) as f64, Fit::Tight),
            Some(slack) => (tight_pitch(&circles, self.n_shoes) * (1.0 + slack), Fit::Slack),
        };
        let shoe = Shoe { mass: self.shoe_mass_kg, shape: self.shoe.shape(pitch)? };
        Ok(Belt { wheels: self.wheels.clone(), link_offset: 0.0, n_shoes: self.n_shoes, pitch, shoe, fit })
    }
}
