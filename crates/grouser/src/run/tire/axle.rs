//! The axle of a tire: it sinks until the ground carries the load, then travels and turns with the slip asked for.

use crate::scene::{Roll, Vertical};
use grouser_geometry::{Orientation, Pose, RigidMotion, Vec3};
use serde::{Deserialize, Serialize};

/// Time in which a held axle stops sinking [s].
const BRAKING_S: f64 = 0.01;

/// Place and motion of an axle; it turns about y.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Place {
    /// Centre of the tire [m].
    pub position: Vec3,
    /// Its velocity [m/s].
    pub velocity: Vec3,
    /// Angle turned about y [rad].
    pub angle: f64,
    /// Angular velocity about y [rad/s].
    pub spin: f64,
}

/// What the axle is doing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Phase {
    /// Going down at constant speed.
    Sinking,
    /// Travelling since this time [s].
    Travelling {
        /// Begin of the travel [s].
        since: f64,
    },
}

/// An axle under way.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Axle {
    roll: Roll,
    /// Radius that slip is measured with [m].
    radius: f64,
    /// Vertical force of the rim at rest under load [N], and the mass that rides on the axle [kg].
    carried: [f64; 2],
    time: f64,
    phase: Phase,
    start_of_step: Place,
    now: Place,
    /// Accelerations of the present step, constant in it [m/s², rad/s²].
    acceleration: Vec3,
    angular_acceleration: f64,
    time_step: f64,
    /// Vertical force of the rim on the axle in the last step [N].
    lift: f64,
}

impl Axle {
    /// An axle about to sink from `position` [m]. `radius` [m] is the one that slip is measured with; the tire around the rim
    /// weighs `weight` [N], which the load includes.
    pub fn new(roll: &Roll, radius: f64, position: Vec3, weight: f64, gravity: f64) -> Self {
        let down = Vec3::new(0.0, 0.0, -roll.sinking_speed_m_s);
        let now = Place { position, velocity: down, angle: 0.0, spin: 0.0 };
        Self {
            roll: roll.clone(),
            radius,
            carried: [roll.load_n - weight, roll.load_n / gravity],
            time: 0.0,
            phase: Phase::Sinking,
            start_of_step: now,
            now,
            acceleration: Vec3::zeros(),
            angular_acceleration: 0.0,
            time_step: 0.0,
            lift: 0.0,
        }
    }

    /// Moves to the end of a step of `dt` [s].
    pub fn predict(&mut self, dt: f64) {
        let Place { velocity, spin, .. } = self.now;
        let toward = |now: f64, target: f64| (target - now) / dt;
        (self.acceleration, self.angular_acceleration) = match self.phase {
            Phase::Sinking => (Vec3::zeros(), 0.0),
            Phase::Travelling { since } => {
                let elapsed = self.time + dt - since;
                let speed = self.roll.speed_m_s * (elapsed / self.roll.ramp_s).min(1.0);
                let up = match self.roll.vertical {
                    Vertical::Loaded => (self.lift - self.carried[0]) / self.carried[1],
                    Vertical::Held => {
                        let left = (1.0 - elapsed / BRAKING_S).max(0.0);
                        toward(velocity.z, -self.roll.sinking_speed_m_s * left)
                    }
                };
                // s = (ω R − v)/(ω R)
                let target_spin = speed / (self.radius * (1.0 - self.roll.slip));
                (Vec3::new(toward(velocity.x, speed), 0.0, up), toward(spin, target_spin))
            }
        };
        self.start_of_step = self.now;
        self.time_step = dt;
        self.now = self.at(1.0);
        self.time += dt;
    }

    /// Place at a share of the present step [-]; accelerations are constant in it.
    pub fn at(&self, share: f64) -> Place {
        let (start, t) = (&self.start_of_step, share * self.time_step);
        Place {
            position: start.position + start.velocity * t + self.acceleration * (t * t / 2.0),
            velocity: start.velocity + self.acceleration * t,
            angle: start.angle + start.spin * t + self.angular_acceleration * (t * t / 2.0),
            spin: start.spin + self.angular_acceleration * t,
        }
    }

    /// Takes the vertical force of the rim on the axle and that of the ground on the tire [N]; the travel begins when the
    /// latter reaches the load.
    pub fn receive(&mut self, lift: f64, of_ground: f64) {
        self.lift = lift;
        if self.phase == Phase::Sinking && of_ground >= self.roll.load_n {
            self.phase = Phase::Travelling { since: self.time };
        }
    }

    /// Place and motion now.
    pub fn now(&self) -> &Place {
        &self.now
    }

    /// What it is doing.
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// Time since the start [s].
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Linear and angular acceleration of the present step [m/s², rad/s²].
    pub fn accelerations(&self) -> (Vec3, f64) {
        (self.acceleration, self.angular_acceleration)
    }

    /// Time that the travel takes, the ramp included [s].
    pub fn travel_time(roll: &Roll) -> f64 {
        roll.travel_m / roll.speed_m_s + roll.ramp_s / 2.0
    }
}

impl Place {
    /// Frame of the rim in the world.
    pub fn pose(&self) -> Pose {
        Pose::from_parts(self.position.into(), self.orientation())
    }

    /// Motion of the rim.
    pub fn motion(&self) -> RigidMotion {
        RigidMotion {
            position: self.position,
            orientation: self.orientation(),
            velocity: self.velocity,
            spin: Vec3::y() * self.spin,
        }
    }

    fn orientation(&self) -> Orientation {
        Orientation::from_scaled_axis(Vec3::y() * self.angle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn roll(vertical: Vertical) -> Roll {
        Roll {
            gap_m: 0.0,
            sinking_speed_m_s: 0.1,
            load_n: 5000.0,
            speed_m_s: 0.976,
            slip: 0.05,
            travel_m: 0.4,
            ramp_s: 0.05,
            start_m: 0.3,
            vertical,
        }
    }

    #[test]
    fn slip_and_speed_give_the_spin_of_the_notes() {
        // (ω R − v)/(ω R) = 5 % at v = 0.976 m/s and R = 0.27235 m: ω = 3.772 rad/s.
        let mut axle = Axle::new(&roll(Vertical::Held), 0.272_35, Vec3::zeros(), 0.0, 9.81);
        axle.receive(0.0, 5000.0);
        for _ in 0..2000 {
            axle.predict(1e-4);
        }
        let now = axle.now();
        assert!((now.velocity.x - 0.976).abs() < 1e-12 && (now.spin - 3.772).abs() < 5e-4, "{now:?}");
        assert!(now.velocity.z.abs() < 1e-12);
        // Half of the ramp is lost.
        assert!((now.position.x - 0.976 * (0.2 - 0.025)).abs() < 1e-6);
    }

    #[test]
    fn loaded_axle_falls_freely_without_ground_and_rests_on_its_load() {
        let mut axle = Axle::new(&roll(Vertical::Loaded), 0.27, Vec3::zeros(), 100.0, 9.81);
        axle.receive(4900.0, 5000.0);
        axle.predict(1e-3);
        assert_eq!(axle.accelerations().0.z, 0.0);
        axle.receive(-100.0, 0.0);
        axle.predict(1e-3);
        assert!((axle.accelerations().0.z + 9.81).abs() < 1e-12);
    }
}
