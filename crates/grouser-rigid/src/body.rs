//! A rigid body and its step in time; the numbers refer to `docs/theory/surfaces.md`, "Rigid tools".

use grouser_geometry::nalgebra::Matrix3;
use grouser_geometry::{Orientation, RigidMotion, Vec3, Wrench};
use serde::{Deserialize, Serialize};

use crate::{Connector, Degree, Freedom, RigidError, Work};

/// What a body is made of and what may move it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BodySpec {
    /// Mass [kg]; may be zero if no degree of freedom is free.
    pub mass: f64,
    /// Inertia about the origin of the body frame, in that frame [kg·m²].
    pub inertia: Matrix3<f64>,
    /// Place and velocity at time zero; the origin of the body frame is the centre of mass.
    pub motion: RigidMotion,
    /// What decides each degree of freedom, in the order of [`Degree::ALL`].
    pub freedoms: [Freedom; 6],
    /// Springs, dashpots and stops to the ground.
    pub connectors: Vec<Connector>,
    /// Acceleration of gravity [m/s²].
    pub gravity: Vec3,
}

impl BodySpec {
    /// A body without mass, held in all degrees of freedom, at rest at `position`: a tool to be driven.
    pub fn driven(position: Vec3) -> Self {
        Self {
            mass: 0.0,
            inertia: Matrix3::zeros(),
            motion: RigidMotion::at_rest(position),
            freedoms: Default::default(),
            connectors: Vec::new(),
            gravity: Vec3::zeros(),
        }
    }

    /// The same body with another rule for one degree of freedom.
    pub fn with(mut self, degree: Degree, freedom: Freedom) -> Self {
        self.freedoms[degree as usize] = freedom;
        self
    }
}

/// A rigid body in motion.
///
/// Each step: [`predict`](Self::predict), then evaluate the loads at the predicted place and velocity, then
/// [`correct`](Self::correct) with them. Before the first step call [`begin`](Self::begin) with the loads at time zero.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RigidBody {
    spec: BodySpec,
    time: f64,
    motion: RigidMotion,
    /// Translation and spin integrated since time zero [m, rad].
    displacement: [f64; 6],
    acceleration: Vec3,
    angular_acceleration: Vec3,
    applied: Wrench,
    reaction: Wrench,
    power: Power,
    work: Work,
}

/// Powers at one instant [W].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Power {
    applied: f64,
    gravity: f64,
    drive: f64,
    connectors_dissipated: f64,
}

impl RigidBody {
    /// Checks the description and puts the body at its place.
    ///
    /// # Errors
    /// Motion profiles and connectors out of range; a free degree of freedom without mass or inertia.
    pub fn new(spec: BodySpec) -> Result<Self, RigidError> {
        check(&spec)?;
        let mut body = Self {
            time: 0.0,
            motion: spec.motion,
            displacement: [0.0; 6],
            acceleration: Vec3::zeros(),
            angular_acceleration: Vec3::zeros(),
            applied: Wrench::default(),
            reaction: Wrench::default(),
            power: Power::default(),
            work: Work::default(),
            spec,
        };
        body.impose_velocities();
        body.begin(&Wrench::default());
        Ok(body)
    }

    /// Sets the accelerations that belong to the loads at time zero; work starts from here.
    pub fn begin(&mut self, applied: &Wrench) {
        self.evaluate(applied);
    }

    /// Moves the body by one step `dt` [s] with its present acceleration (steps 1 to 3).
    pub fn predict(&mut self, dt: f64) {
        let (before, after) = (self.time, self.time + dt);
        let mut turn = Vec3::zeros();
        for degree in Degree::ALL {
            let axis = degree.axis();
            let (velocity, acceleration) = self.rate(degree);
            let increment = match &self.spec.freedoms[degree as usize] {
                Freedom::Fixed => 0.0,
                Freedom::Prescribed(profile) => profile.displacement(after) - profile.displacement(before),
                Freedom::Free => velocity * dt + acceleration * dt * dt / 2.0,
            };
            self.displacement[degree as usize] = match &self.spec.freedoms[degree as usize] {
                Freedom::Prescribed(profile) => profile.displacement(after), // exact: nothing accumulates
                _ => self.displacement[degree as usize] + increment,
            };
            if degree.is_rotation() {
                turn[axis] = increment;
                self.motion.spin[axis] += acceleration * dt;
            } else {
                self.motion.position[axis] =
                    self.spec.motion.position[axis] + self.displacement[degree as usize];
                self.motion.velocity[axis] += acceleration * dt;
            }
        }
        let turned = Orientation::from_scaled_axis(turn) * self.motion.orientation;
        self.motion.orientation = Orientation::new_normalize(turned.into_inner());
        self.time = after;
        self.impose_velocities();
    }

    /// Ends the step `dt` [s] with the loads `applied` at the predicted place and velocity, moments about the present
    /// [`position`](RigidMotion::position) (steps 4 and 5), and adds up the work.
    pub fn correct(&mut self, applied: &Wrench, dt: f64) {
        let (acceleration, angular_acceleration, power) =
            (self.acceleration, self.angular_acceleration, self.power);
        self.evaluate(applied);
        self.motion.velocity += (self.acceleration - acceleration) * (dt / 2.0);
        self.motion.spin += (self.angular_acceleration - angular_acceleration) * (dt / 2.0);
        self.impose_velocities();
        self.update_power();
        self.work.applied += (power.applied + self.power.applied) * (dt / 2.0);
        self.work.gravity += (power.gravity + self.power.gravity) * (dt / 2.0);
        self.work.drive += (power.drive + self.power.drive) * (dt / 2.0)
            + self.work_of_jumps(&acceleration, &angular_acceleration, dt);
        self.work.connectors_dissipated +=
            (power.connectors_dissipated + self.power.connectors_dissipated) * (dt / 2.0);
    }

    /// Present time [s].
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Present place and velocity.
    pub fn motion(&self) -> &RigidMotion {
        &self.motion
    }

    /// How far the body has moved along `degree` since time zero [m or rad].
    pub fn displacement(&self, degree: Degree) -> f64 {
        self.displacement[degree as usize]
    }

    /// Loads given to the last [`correct`](Self::correct) or [`begin`](Self::begin), moment about `point` [N, N·m].
    pub fn applied_about(&self, point: &Vec3) -> Wrench {
        self.applied.moved(&self.motion.position, point)
    }

    /// What the drives and the held degrees of freedom exert on the body, moment about `point` [N, N·m].
    pub fn reaction_about(&self, point: &Vec3) -> Wrench {
        self.reaction.moved(&self.motion.position, point)
    }

    /// Power of the applied loads [W]: negative while a tool works on the ground.
    pub fn applied_power(&self) -> f64 {
        self.power.applied
    }

    /// Power of the drives [W].
    pub fn drive_power(&self) -> f64 {
        self.power.drive
    }

    /// Work done on the body since time zero.
    pub fn work(&self) -> &Work {
        &self.work
    }

    /// Kinetic energy [J].
    pub fn kinetic_energy(&self) -> f64 {
        let RigidMotion { velocity, spin, .. } = self.motion;
        (self.spec.mass * velocity.norm_squared() + spin.dot(&(self.world_inertia() * spin))) / 2.0
    }

    /// Angular momentum about the centre of mass [kg·m²/s].
    pub fn angular_momentum(&self) -> Vec3 {
        self.world_inertia() * self.motion.spin
    }

    /// Energy stored in springs and stops [J].
    pub fn stored_energy(&self) -> f64 {
        self.connector_actions().map(|(_, action)| action.stored).sum()
    }

    /// What the body was made from.
    pub fn spec(&self) -> &BodySpec {
        &self.spec
    }

    fn world_inertia(&self) -> Matrix3<f64> {
        let r = self.motion.orientation.to_rotation_matrix();
        r.matrix() * self.spec.inertia * r.matrix().transpose()
    }

    /// Velocity and acceleration along a degree of freedom.
    fn rate(&self, degree: Degree) -> (f64, f64) {
        let axis = degree.axis();
        if degree.is_rotation() {
            (self.motion.spin[axis], self.angular_acceleration[axis])
        } else {
            (self.motion.velocity[axis], self.acceleration[axis])
        }
    }

    /// Sets the velocities of held and driven degrees of freedom to their exact values.
    fn impose_velocities(&mut self) {
        for degree in Degree::ALL {
            let velocity = match &self.spec.freedoms[degree as usize] {
                Freedom::Fixed => 0.0,
                Freedom::Prescribed(profile) => profile.velocity(self.time),
                Freedom::Free => continue,
            };
            if degree.is_rotation() {
                self.motion.spin[degree.axis()] = velocity;
            } else {
                self.motion.velocity[degree.axis()] = velocity;
            }
        }
    }

    /// Work [J] of drives whose velocity jumped within the last step: what their change of velocity exceeds the trapezoid
    /// of the accelerations by, times inertia and mean velocity. Zero to third order where the profile is smooth.
    fn work_of_jumps(&self, acceleration: &Vec3, angular_acceleration: &Vec3, dt: f64) -> f64 {
        let (mut jump, mut mean) = ([Vec3::zeros(); 2], [Vec3::zeros(); 2]);
        for degree in Degree::ALL {
            if let Freedom::Prescribed(profile) = &self.spec.freedoms[degree as usize] {
                let (kind, axis) = (usize::from(degree.is_rotation()), degree.axis());
                let before = [acceleration, angular_acceleration][kind][axis];
                let (was, is) = (profile.velocity(self.time - dt), profile.velocity(self.time));
                jump[kind][axis] = is - was - (before + self.rate(degree).1) * dt / 2.0;
                mean[kind][axis] = (was + is) / 2.0;
            }
        }
        self.spec.mass * jump[0].dot(&mean[0]) + mean[1].dot(&(self.world_inertia() * jump[1]))
    }

    fn connector_actions(&self) -> impl Iterator<Item = (Degree, crate::ConnectorAction)> {
        self.spec.connectors.iter().map(|connector| {
            let degree = connector.degree();
            (degree, connector.action(self.displacement[degree as usize], self.rate(degree).0))
        })
    }

    /// Accelerations and reactions from Newton's and Euler's equations at the present place and velocity.
    ///
    /// Rows of held and driven degrees of freedom are replaced by their known accelerations; what is missing in those
    /// rows is the reaction.
    fn evaluate(&mut self, applied: &Wrench) {
        self.applied = *applied;
        let mut total = *applied;
        total.force += self.spec.gravity * self.spec.mass;
        for (degree, action) in self.connector_actions() {
            let side = if degree.is_rotation() { &mut total.moment } else { &mut total.force };
            side[degree.axis()] += action.force;
        }
        // I ω̇ = M − ω × (I ω)
        let inertia = self.world_inertia();
        let gyroscopic = self.motion.spin.cross(&(inertia * self.motion.spin));
        let (mut matrix, mut right_side) = (inertia, total.moment - gyroscopic);
        for degree in Degree::ALL {
            let axis = degree.axis();
            let known = match &self.spec.freedoms[degree as usize] {
                Freedom::Fixed => Some(0.0),
                Freedom::Prescribed(profile) => Some(profile.acceleration(self.time)),
                Freedom::Free => None,
            };
            match (known, degree.is_rotation()) {
                (Some(known), true) => {
                    matrix.set_row(axis, &Matrix3::identity().row(axis));
                    right_side[axis] = known;
                }
                (Some(known), false) => self.acceleration[axis] = known,
                (None, true) => {}
                (None, false) => self.acceleration[axis] = total.force[axis] / self.spec.mass,
            }
        }
        self.angular_acceleration = matrix.try_inverse().map_or(Vec3::zeros(), |m| m * right_side);
        self.reaction = Wrench {
            force: self.acceleration * self.spec.mass - total.force,
            moment: inertia * self.angular_acceleration + gyroscopic - total.moment,
        };
        for degree in Degree::ALL {
            if self.spec.freedoms[degree as usize] == Freedom::Free {
                let side =
                    if degree.is_rotation() { &mut self.reaction.moment } else { &mut self.reaction.force };
                side[degree.axis()] = 0.0; // rounding of the solution, no force
            }
        }
        self.update_power();
    }

    fn update_power(&mut self) {
        let RigidMotion { velocity, spin, .. } = self.motion;
        let power_of = |w: &Wrench| w.force.dot(&velocity) + w.moment.dot(&spin);
        self.power = Power {
            applied: power_of(&self.applied),
            gravity: self.spec.mass * self.spec.gravity.dot(&velocity),
            drive: power_of(&self.reaction),
            connectors_dissipated: self.connector_actions().map(|(_, action)| action.dissipated).sum(),
        };
    }
}

fn check(spec: &BodySpec) -> Result<(), RigidError> {
    let finite = |what, values: &[f64]| match values.iter().find(|x| !x.is_finite()) {
        Some(&value) => Err(RigidError::NotFinite { what, value }),
        None => Ok(()),
    };
    finite("mass of a body", &[spec.mass])?;
    finite("inertia of a body", spec.inertia.as_slice())?;
    finite("position of a body", spec.motion.position.as_slice())?;
    finite("orientation of a body", spec.motion.orientation.coords.as_slice())?;
    finite("velocity of a body", spec.motion.velocity.as_slice())?;
    finite("spin of a body", spec.motion.spin.as_slice())?;
    finite("gravity", spec.gravity.as_slice())?;
    if spec.mass < 0.0 {
        return Err(RigidError::Negative { what: "mass of a body", value: spec.mass });
    }
    let principal: [f64; 3] = spec.inertia.symmetric_eigenvalues().into();
    for degree in Degree::ALL {
        match &spec.freedoms[degree as usize] {
            Freedom::Fixed => {}
            Freedom::Prescribed(profile) => profile.validate()?,
            Freedom::Free if degree.is_rotation() => {
                if principal.iter().any(|&i| i <= 0.0) {
                    return Err(RigidError::NoInertia { degree, principal });
                }
            }
            Freedom::Free if spec.mass <= 0.0 => {
                return Err(RigidError::NoMass { degree, mass: spec.mass });
            }
            Freedom::Free => {}
        }
    }
    spec.connectors.iter().try_for_each(Connector::validate)
}
