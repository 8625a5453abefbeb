//! Bodies connected by joints: where they stand and how a degree of freedom moves them.
//!
//! ```text
//!        z ↑   ↗ x forward        body 0 carries position (x, y), heading and height, pitch, roll;
//!          │ ╱                    x, y and heading are given by the route, the rest by equilibrium.
//!   y ←────o                      positive pitch: nose down; positive roll: leaning to the right;
//!    left                         rotations: heading about z, then pitch about y, then roll about x
//! ```

use grouser_geometry::{Orientation, Pose, Vec3};
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::track::TrackShape;

/// Standard gravity as the source paper takes it \[m/s²\].
pub const GRAVITY: f64 = 9.81;

/// How a body hangs on its parent.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Joint {
    /// Rotation about a unit vector of the parent, within limits \[rad\]; found by equilibrium.
    Free {
        /// Axis.
        axis: Vec3,
        /// Least and largest angle \[rad\].
        limits: [f64; 2],
    },
    /// Rotation about a unit vector of the parent, given by the driver (steering).
    Held {
        /// Axis.
        axis: Vec3,
    },
    /// Displacement along a unit vector of the parent on a spring, within limits \[m\].
    Sprung {
        /// Axis.
        axis: Vec3,
        /// Least and largest displacement \[m\].
        limits: [f64; 2],
        /// Stiffness \[N/m\].
        stiffness: f64,
        /// Force at zero displacement \[N\], along the axis on the body.
        preload: f64,
    },
}

/// A rigid body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Body {
    /// Name in reports.
    pub name: String,
    /// The body it hangs on; none for the first.
    pub parent: Option<usize>,
    /// Joint position in the parent's frame \[m\]; the body's own origin.
    pub attachment: Vec3,
    /// Joint; ignored for the first body.
    pub joint: Joint,
    /// Mass \[kg\].
    pub mass: f64,
    /// Centre of mass in the body's frame \[m\].
    pub centre_of_mass: Vec3,
}

/// Bodies in an order in which parents come first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Mechanism {
    bodies: Vec<Body>,
    /// Coordinate of each joint that equilibrium finds: body number.
    free: Vec<usize>,
}

/// Where the machine stands.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Configuration {
    /// Position of the first body \[m\].
    pub position: [f64; 2],
    /// Heading \[rad\], anticlockwise from x.
    pub heading: f64,
    /// Height of the first body's origin \[m\].
    pub height: f64,
    /// Pitch \[rad\], nose down.
    pub pitch: f64,
    /// Roll \[rad\], leaning to the right.
    pub roll: f64,
    /// Joint coordinates of all bodies \[rad or m\]; the first is unused.
    pub joints: Vec<f64>,
    /// Sections of slack belts below the axles, in the order of feet and belts; empty
    /// before the first rest.
    pub tracks: Vec<TrackShape>,
}

/// Why bodies make no machine.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum MechanismError {
    /// No body.
    #[error("the machine has no body")]
    Empty,
    /// Parents must come first.
    #[error("body `{name}` hangs on body {parent}, which does not come before it")]
    Parent {
        /// The body.
        name: String,
        /// Its parent.
        parent: usize,
    },
    /// A value without meaning.
    #[error("body `{name}`: {quantity} is {value}, expected {expected}")]
    Value {
        /// The body.
        name: String,
        /// The quantity.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// What was expected.
        expected: &'static str,
    },
}

/// How a degree of freedom moves the bodies behind it.
#[derive(Clone, Copy, Debug)]
pub struct Twist {
    /// First body that moves; all bodies that hang on it move too.
    pub body: usize,
    /// Angular velocity per unit \[1\].
    pub omega: Vec3,
    /// A point of the axis \[m\].
    pub point: Vec3,
    /// Velocity of translation per unit \[1\].
    pub shift: Vec3,
}

impl Twist {
    /// Velocity of a material point at `r` per unit of the degree of freedom.
    #[inline]
    pub fn velocity(&self, r: Vec3) -> Vec3 {
        self.shift + self.omega.cross(&(r - self.point))
    }
}

impl Mechanism {
    /// Checks and takes the bodies.
    pub fn new(bodies: Vec<Body>) -> Result<Self, MechanismError> {
        if bodies.is_empty() {
            return Err(MechanismError::Empty);
        }
        for (n, body) in bodies.iter().enumerate() {
            let name = || body.name.clone();
            match body.parent {
                None if n > 0 => return Err(MechanismError::Parent { name: name(), parent: n }),
                Some(parent) if n == 0 || parent >= n => {
                    return Err(MechanismError::Parent { name: name(), parent });
                }
                _ => {}
            }
            if !(body.mass.is_finite() && body.mass >= 0.0) {
                let expected = "a finite mass of zero or more [kg]";
                return Err(MechanismError::Value {
                    name: name(),
                    quantity: "mass",
                    value: body.mass,
                    expected,
                });
            }
            let (axis, limits) = match body.joint {
                Joint::Free { axis, limits } | Joint::Sprung { axis, limits, .. } => (axis, limits),
                Joint::Held { axis } => (axis, [-1.0, 1.0]),
            };
            if n > 0 && (axis.norm() - 1.0).abs() > 1e-6 {
                let expected = "a unit vector";
                return Err(MechanismError::Value {
                    name: name(),
                    quantity: "length of the joint axis",
                    value: axis.norm(),
                    expected,
                });
            }
            if n > 0 && !(limits[0] <= 0.0 && limits[1] >= 0.0 && limits[0] < limits[1]) {
                let expected = "limits on both sides of zero";
                return Err(MechanismError::Value {
                    name: name(),
                    quantity: "upper joint limit",
                    value: limits[1],
                    expected,
                });
            }
        }
        if bodies.iter().map(|b| b.mass).sum::<f64>() <= 0.0 {
            let expected = "a machine with weight";
            let name = bodies[0].name.clone();
            return Err(MechanismError::Value { name, quantity: "total mass", value: 0.0, expected });
        }
        let free = (1..bodies.len()).filter(|&b| !matches!(bodies[b].joint, Joint::Held { .. })).collect();
        Ok(Self { bodies, free })
    }

    /// The bodies.
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// Total mass \[kg\].
    pub fn mass(&self) -> f64 {
        self.bodies.iter().map(|b| b.mass).sum()
    }

    /// Degrees of freedom that equilibrium finds: height, pitch, roll, then the joints.
    pub fn n_dofs(&self) -> usize {
        3 + self.free.len()
    }

    /// Name of a degree of freedom.
    pub fn dof_name(&self, dof: usize) -> &str {
        match dof {
            0 => "height",
            1 => "pitch",
            2 => "roll",
            _ => &self.bodies[self.free[dof - 3]].name,
        }
    }

    /// The body whose joint a degree of freedom is; none for height, pitch and roll.
    pub fn dof_body(&self, dof: usize) -> Option<usize> {
        (dof >= 3).then(|| self.free[dof - 3])
    }

    /// Values of the degrees of freedom.
    pub fn dofs(&self, at: &Configuration) -> Vec<f64> {
        [at.height, at.pitch, at.roll].into_iter().chain(self.free.iter().map(|&b| at.joints[b])).collect()
    }

    /// Sets the degrees of freedom.
    pub fn set_dofs(&self, at: &mut Configuration, values: &[f64]) {
        [at.height, at.pitch, at.roll] = [values[0], values[1], values[2]];
        for (k, &b) in self.free.iter().enumerate() {
            at.joints[b] = values[3 + k];
        }
    }

    /// Limits of a degree of freedom.
    pub fn limits(&self, dof: usize) -> [f64; 2] {
        match self.dof_body(dof).map(|b| self.bodies[b].joint) {
            Some(Joint::Free { limits, .. } | Joint::Sprung { limits, .. }) => limits,
            _ => [f64::NEG_INFINITY, f64::INFINITY],
        }
    }

    /// The machine with all joints at zero.
    pub fn at(&self, position: [f64; 2], heading: f64, height: f64) -> Configuration {
        Configuration {
            position,
            heading,
            height,
            pitch: 0.0,
            roll: 0.0,
            joints: vec![0.0; self.bodies.len()],
            tracks: Vec::new(),
        }
    }

    /// Poses of all bodies.
    pub fn poses(&self, at: &Configuration) -> Vec<Pose> {
        let mut poses: Vec<Pose> = Vec::with_capacity(self.bodies.len());
        for (n, body) in self.bodies.iter().enumerate() {
            let Some(parent) = body.parent else {
                let turn = Orientation::from_axis_angle(&Vec3::z_axis(), at.heading)
                    * Orientation::from_axis_angle(&Vec3::y_axis(), at.pitch)
                    * Orientation::from_axis_angle(&Vec3::x_axis(), at.roll);
                poses.push(Pose::from_parts(
                    Vec3::new(at.position[0], at.position[1], at.height).into(),
                    turn,
                ));
                continue;
            };
            let q = at.joints[n];
            let local = match body.joint {
                Joint::Free { axis, .. } | Joint::Held { axis } => {
                    Pose::from_parts(body.attachment.into(), Orientation::new(axis * q))
                }
                Joint::Sprung { axis, .. } => {
                    Pose::from_parts((body.attachment + axis * q).into(), Orientation::identity())
                }
            };
            poses.push(poses[parent] * local);
        }
        poses
    }

    /// Twists of all degrees of freedom.
    pub fn twists(&self, at: &Configuration, poses: &[Pose]) -> Vec<Twist> {
        let origin = poses[0].translation.vector;
        let heading = Orientation::from_axis_angle(&Vec3::z_axis(), at.heading);
        let pitch_axis = heading * Vec3::y();
        let roll_axis = poses[0].rotation * Vec3::x();
        let zero = Vec3::zeros();
        let mut twists = vec![
            Twist { body: 0, omega: zero, point: origin, shift: Vec3::z() },
            Twist { body: 0, omega: pitch_axis, point: origin, shift: zero },
            Twist { body: 0, omega: roll_axis, point: origin, shift: zero },
        ];
        for &b in &self.free {
            let parent = &poses[self.bodies[b].parent.unwrap_or(0)];
            let point = poses[b].translation.vector;
            twists.push(match self.bodies[b].joint {
                Joint::Free { axis, .. } | Joint::Held { axis } => {
                    Twist { body: b, omega: parent.rotation * axis, point, shift: zero }
                }
                Joint::Sprung { axis, .. } => {
                    Twist { body: b, omega: zero, point, shift: parent.rotation * axis }
                }
            });
        }
        twists
    }

    /// Whether `body` moves when the joint of `moved` moves.
    pub fn hangs_on(&self, body: usize, moved: usize) -> bool {
        let mut b = Some(body);
        while let Some(n) = b {
            if n == moved {
                return true;
            }
            b = self.bodies[n].parent;
        }
        false
    }

    /// Generalised forces of weight and springs \[N or N·m\].
    pub fn own_forces(&self, at: &Configuration, poses: &[Pose], twists: &[Twist]) -> Vec<f64> {
        let mut forces = vec![0.0; twists.len()];
        for (n, body) in self.bodies.iter().enumerate() {
            if body.mass == 0.0 {
                continue;
            }
            let centre = poses[n] * nalgebra::Point3::from(body.centre_of_mass);
            for (force, twist) in forces.iter_mut().zip(twists) {
                if self.hangs_on(n, twist.body) {
                    *force -= body.mass * GRAVITY * twist.velocity(centre.coords).z;
                }
            }
        }
        for (k, &b) in self.free.iter().enumerate() {
            if let Joint::Sprung { stiffness, preload, .. } = self.bodies[b].joint {
                forces[3 + k] += preload - stiffness * at.joints[b];
            }
        }
        forces
    }

    /// Centre of mass of the whole machine \[m\].
    pub fn centre_of_mass(&self, poses: &[Pose]) -> Vec3 {
        let weighted = self
            .bodies
            .iter()
            .zip(poses)
            .map(|(b, pose)| (pose * nalgebra::Point3::from(b.centre_of_mass)).coords * b.mass);
        weighted.sum::<Vec3>() / self.mass()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn machine() -> Mechanism {
        let body = |name: &str, parent, attachment, joint, mass| Body {
            name: name.into(),
            parent,
            attachment,
            joint,
            mass,
            centre_of_mass: Vec3::new(0.1, 0.05, 0.4),
        };
        let free = |axis| Joint::Free { axis, limits: [-0.5, 0.5] };
        Mechanism::new(vec![
            body("frame", None, Vec3::zeros(), free(Vec3::x()), 1000.0),
            body("link", Some(0), Vec3::new(-2.0, 0.0, 0.3), Joint::Held { axis: Vec3::z() }, 10.0),
            body("rear", Some(1), Vec3::zeros(), free(Vec3::x()), 800.0),
            body("bogie", Some(2), Vec3::new(-2.0, 1.0, -0.2), free(Vec3::y()), 300.0),
        ])
        .unwrap()
    }

    #[test]
    fn twists_are_the_derivatives_of_the_poses_and_weight_that_of_the_energy() {
        let machine = machine();
        let mut at = machine.at([1.0, 2.0], 0.7, 0.9);
        at.joints[1] = 0.3;
        machine.set_dofs(&mut at, &[0.9, 0.1, -0.2, 0.15, 0.25]);
        let poses = machine.poses(&at);
        let twists = machine.twists(&at, &poses);
        let weight = machine.own_forces(&at, &poses, &twists);
        let energy =
            |at: &Configuration| GRAVITY * machine.mass() * machine.centre_of_mass(&machine.poses(at)).z;
        for dof in 0..machine.n_dofs() {
            let moved = |step: f64| {
                let mut q = machine.dofs(&at);
                q[dof] += step;
                let mut other = at.clone();
                machine.set_dofs(&mut other, &q);
                other
            };
            let local = nalgebra::Point3::new(0.3, -0.4, 0.5);
            let h = 1e-6;
            let velocity =
                (machine.poses(&moved(h))[3] * local - machine.poses(&moved(-h))[3] * local) / (2.0 * h);
            let exact = twists[dof].velocity((poses[3] * local).coords);
            assert!((velocity - exact).norm() < 1e-8, "degree of freedom {dof}");
            let slope = (energy(&moved(h)) - energy(&moved(-h))) / (2.0 * h);
            assert!((weight[dof] + slope).abs() < 1e-4, "degree of freedom {dof}: {} {slope}", weight[dof]);
        }
    }

    #[test]
    fn children_before_parents_and_skewed_axes_are_refused() {
        let mut bodies = machine().bodies.clone();
        bodies.swap(2, 3);
        assert!(matches!(Mechanism::new(bodies), Err(MechanismError::Parent { .. })));
        let mut bodies = machine().bodies.clone();
        bodies[2].joint = Joint::Free { axis: Vec3::new(1.0, 1.0, 0.0), limits: [-0.1, 0.1] };
        assert!(matches!(Mechanism::new(bodies), Err(MechanismError::Value { .. })));
    }
}
