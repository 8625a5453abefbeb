//! The state of every grain, kept sorted in space.

use crate::Domain;
use grouser_contact::{Load, Precision, Real, Sphere, Vector};
use grouser_geometry::nalgebra::Quaternion;
use grouser_geometry::{Orientation, Vec3};
use rand::{RngExt, SeedableRng};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// What the rotation of grains is allowed to do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Rotation {
    /// Grains turn freely.
    #[default]
    Free,
    /// Grains never turn: the stiff bound of every rotation law.
    Fixed,
}

/// Spheres in motion. Arrays are sorted in space and re-sorted now and then; `ids` name the grains for good.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Grains<P: Precision> {
    /// Position, velocity, spin, size and material of each grain.
    pub spheres: Vec<Sphere<P>>,
    /// Permanent number of each grain.
    pub ids: Vec<u32>,
    /// Force and torque of the present step; gravity is not among them.
    pub loads: Vec<Load<P::Real>>,
    /// Orientation of each grain's body frame, when the scene asks for it.
    pub orientations: Option<Vec<Orientation>>,
    /// Linear and angular acceleration at the end of the last step [m/s², rad/s²]; the torque [N·m] in place of the latter
    /// where the inertia is not spherical.
    pub(crate) accelerations: Vec<[Vector<P::Real>; 2]>,
    /// Upper bound of the speed of any grain in the present step [m/s].
    pub(crate) fastest: f64,
    /// Principal moments of inertia over m r² [-].
    pub(crate) inertia_ratios: [f64; 3],
    pub(crate) smallest_radius: f64,
    pub(crate) largest_radius: f64,
}

impl<P: Precision> Grains<P> {
    /// Grains numbered in the order given, at rest in their orientation.
    pub(crate) fn new(spheres: Vec<Sphere<P>>) -> Self {
        let n = spheres.len();
        let radii = spheres.iter().map(|sphere| sphere.radius.to_f64());
        let smallest_radius = radii.clone().fold(f64::INFINITY, f64::min);
        let largest_radius = radii.fold(0.0, f64::max);
        Self {
            spheres,
            ids: (0..n as u32).collect(),
            loads: vec![Load::default(); n],
            orientations: None,
            accelerations: vec![[Vector::ZERO; 2]; n],
            fastest: 0.0,
            inertia_ratios: [0.4; 3],
            smallest_radius,
            largest_radius,
        }
    }

    /// Number of grains.
    pub fn len(&self) -> usize {
        self.spheres.len()
    }

    /// There are no grains.
    pub fn is_empty(&self) -> bool {
        self.spheres.is_empty()
    }

    /// Speed of the fastest grain in the present step [m/s].
    pub fn fastest(&self) -> f64 {
        self.fastest
    }

    /// Keeps an orientation for each grain from now on.
    pub fn track_orientations(&mut self) {
        let n = self.len();
        self.orientations.get_or_insert_with(|| vec![Orientation::identity(); n]);
    }

    /// Turns every grain at random, each direction as likely as any other; the same `seed` gives the same orientations
    /// for the same permanent numbers. Keeps orientations from now on.
    pub fn turn_randomly(&mut self, seed: u64) {
        self.track_orientations();
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(seed);
        // K. Shoemake, Uniform random rotations, Graphics Gems III (1992).
        let drawn: Vec<Orientation> = (0..self.len())
            .map(|_| {
                let [u, v, w]: [f64; 3] = std::array::from_fn(|_| random.random());
                let ((s1, c1), (s2, c2)) = ((TAU * v).sin_cos(), (TAU * w).sin_cos());
                let (a, b) = ((1.0 - u).sqrt(), u.sqrt());
                Orientation::new_normalize(Quaternion::new(b * c2, a * s1, a * c1, b * s2))
            })
            .collect();
        for (orientation, &id) in self.orientations.iter_mut().flatten().zip(&self.ids) {
            *orientation = drawn[id as usize];
        }
    }

    /// Angular momentum of grain at place `index` about its centre [kg·m²/s].
    pub fn spin_momentum(&self, index: usize) -> Vec3 {
        let sphere = &self.spheres[index];
        let spin = sphere.spin.cast::<f64>();
        let spin = Vec3::new(spin.x, spin.y, spin.z);
        let moment = sphere.mass.to_f64() * sphere.radius.to_f64().powi(2);
        let ratios = Vec3::from(self.inertia_ratios);
        match &self.orientations {
            None => spin * (moment * ratios.x),
            Some(kept) => {
                let body = kept[index].inverse_transform_vector(&spin);
                kept[index].transform_vector(&body.component_mul(&ratios)) * moment
            }
        }
    }

    /// Puts grain `order[k]` at place k; grains beyond the order stay where they are.
    pub(crate) fn reorder(&mut self, order: &[u32]) {
        fn sorted<V: Copy>(values: &mut Vec<V>, order: &[u32]) {
            let sorted: Vec<V> = order.iter().map(|&old| values[old as usize]).collect();
            if sorted.len() == values.len() {
                *values = sorted;
            } else {
                values[..sorted.len()].copy_from_slice(&sorted);
            }
        }
        sorted(&mut self.spheres, order);
        sorted(&mut self.ids, order);
        sorted(&mut self.loads, order);
        sorted(&mut self.accelerations, order);
        if let Some(orientations) = &mut self.orientations {
            sorted(orientations, order);
        }
    }

    /// Moves those of the first `n` grains that left a periodic box back into it.
    pub(crate) fn wrap(&mut self, domain: &Domain, n: usize) {
        for sphere in &mut self.spheres[..n] {
            sphere.position = domain.wrapped(sphere.position);
        }
    }

    /// Translational and rotational kinetic energy [J].
    pub fn kinetic_energy(&self) -> [f64; 2] {
        let (mut linear, mut angular) = (0.0, 0.0);
        for (index, sphere) in self.spheres.iter().enumerate() {
            linear += 0.5 * sphere.mass.to_f64() * sphere.velocity.norm_squared().to_f64();
            let spin = sphere.spin.cast::<f64>();
            angular += 0.5 * self.spin_momentum(index).dot(&Vec3::new(spin.x, spin.y, spin.z));
        }
        [linear, angular]
    }

    /// Momentum [kg·m/s].
    pub fn momentum(&self) -> Vec3 {
        let mut sum = Vec3::zeros();
        for sphere in &self.spheres {
            let v = sphere.velocity.cast::<f64>();
            sum += Vec3::new(v.x, v.y, v.z) * sphere.mass.to_f64();
        }
        sum
    }
}

/// A solid sphere at rest: centre [m], radius [m], density [kg/m³], row of the material table.
pub fn sphere<P: Precision>(centre: Vec3, radius: f64, density: f64, material: u32) -> Sphere<P> {
    Sphere {
        position: Vector::new(centre.x, centre.y, centre.z).cast(),
        radius: P::Coordinate::from_f64(radius),
        velocity: Vector::ZERO,
        mass: P::Real::from_f64(density * 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3)),
        spin: Vector::ZERO,
        material,
    }
}
