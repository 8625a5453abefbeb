//! Vehicles from components: frames joined in a line, each on axles with wheels or bogies.
//!
//! ```text
//!   forward →            y ↑  left
//!        rear frame      │      front frame
//!    o──o   o──o      joint    o──o       bogie: wheels at ± lever around its pivot
//!   ═════════════════════╋═══════════════ steering (given) and roll (free) in the joint
//!    o──o   o──o               o──o
//! ```

use grouser_geometry::Vec3;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::gear::{Belt, Foot, Wheel, WheelShape};
use crate::machine::{Machine, MachineError};
use crate::mechanism::{Body, Joint, Mechanism, MechanismError};

/// A pair of wheels or bogies, left and right.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axle {
    /// Position along the frame \[m\], forward of the frame's origin.
    pub along: f64,
    /// Height of the pivot above the frame's origin \[m\].
    pub height: f64,
    /// Half of the track width \[m\].
    pub half_track: f64,
    /// Distance of the wheels from the bogie's pivot \[m\]; zero for a single wheel.
    pub lever: f64,
    /// Mass of one side: bogie, wheels, belts \[kg\].
    pub mass: f64,
    /// Largest angle of the bogie \[rad\].
    pub max_angle: f64,
    /// Radius of the wheels \[m\].
    pub radius: f64,
    /// Surface of the wheels.
    pub shape: WheelShape,
    /// Belts of one side; wheel 0 is the rear one of a bogie, 1 the front one.
    pub belts: Vec<Belt>,
}

/// A frame of the vehicle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Component {
    /// Name.
    pub name: String,
    /// Mass without axles \[kg\].
    pub mass: f64,
    /// Centre of mass in the frame \[m\].
    pub centre_of_mass: Vec3,
    /// Axles.
    pub axles: Vec<Axle>,
}

/// Joint between a frame and the one before it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Articulation {
    /// Position in the frame before \[m\].
    pub position: Vec3,
    /// Origin of the next frame behind the joint \[m\].
    pub offset: f64,
    /// Largest roll angle between the frames \[rad\]; none for a stiff connection.
    pub max_roll: Option<f64>,
    /// Whether the frames are steered against each other.
    pub is_steered: bool,
}

/// Why components make no vehicle.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum VehicleError {
    /// Joints and frames do not match.
    #[error("{components} components need {} articulations, {articulations} were given", components.saturating_sub(1))]
    Articulations {
        /// Components.
        components: usize,
        /// Articulations.
        articulations: usize,
    },
    /// Bad bodies.
    #[error(transparent)]
    Mechanism(#[from] MechanismError),
    /// Bad gear.
    #[error(transparent)]
    Machine(#[from] MachineError),
}

/// Joins components, front first, into a machine.
pub fn vehicle(components: &[Component], articulations: &[Articulation]) -> Result<Machine, VehicleError> {
    if components.len() != articulations.len() + 1 {
        let (components, articulations) = (components.len(), articulations.len());
        return Err(VehicleError::Articulations { components, articulations });
    }
    let free = |axis, limit: f64| Joint::Free { axis, limits: [-limit, limit] };
    let (mut bodies, mut feet) = (Vec::<Body>::new(), Vec::new());
    let mut frame = None;
    for (n, component) in components.iter().enumerate() {
        let (name, mass, centre_of_mass) = (component.name.clone(), component.mass, component.centre_of_mass);
        let (mut attachment, mut parent, mut joint) = (Vec3::zeros(), frame, free(Vec3::x(), 1.0));
        if n > 0 {
            let articulation = articulations[n - 1];
            attachment = articulation.position;
            if articulation.is_steered {
                let name = format!("{name} steering");
                bodies.push(Body {
                    name,
                    parent,
                    attachment,
                    joint: Joint::Held { axis: Vec3::z() },
                    mass: 0.0,
                    centre_of_mass: Vec3::zeros(),
                });
                parent = Some(bodies.len() - 1);
                attachment = Vec3::zeros();
            }
            joint = match articulation.max_roll {
                Some(max_roll) => free(Vec3::x(), max_roll),
                None => Joint::Held { axis: Vec3::x() },
            };
        }
        // The frame's origin lies behind the joint: everything in it is shifted.
        let shift = if n > 0 { Vec3::new(-articulations[n - 1].offset, 0.0, 0.0) } else { Vec3::zeros() };
        bodies.push(Body { name, parent, attachment, joint, mass, centre_of_mass: centre_of_mass + shift });
        let this = bodies.len() - 1;
        frame = Some(this);
        for (k, axle) in component.axles.iter().enumerate() {
            for (side, y) in [("left", axle.half_track), ("right", -axle.half_track)] {
                let at = shift + Vec3::new(axle.along, y, axle.height);
                let wheel = |x| Wheel {
                    centre: Vec3::new(x, 0.0, 0.0),
                    radius: axle.radius,
                    shape: axle.shape.clone(),
                };
                let (wheels, joint) = if axle.lever > 0.0 {
                    (vec![wheel(-axle.lever), wheel(axle.lever)], free(Vec3::y(), axle.max_angle))
                } else {
                    (vec![wheel(0.0)], Joint::Held { axis: Vec3::y() })
                };
                feet.push(Foot { body: bodies.len(), wheels, belts: axle.belts.clone() });
                let name = format!("{} axle {} {side}", component.name, k + 1);
                bodies.push(Body {
                    name,
                    parent: Some(this),
                    attachment: at,
                    joint,
                    mass: axle.mass,
                    centre_of_mass: Vec3::zeros(),
                });
            }
        }
    }
    Ok(Machine::new(Mechanism::new(bodies)?, feet)?)
}
