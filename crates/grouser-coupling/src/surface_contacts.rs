//! Contacts between grains and a triangle surface that moves as a rigid body.

use crate::candidates::{Candidates, centre};
use crate::neighbourhood::{Touch, touches};
use grouser_contact::{
    Contact, ContactLaw, ContactLedger, Load, Memory, PairTable, Precision, Real, Sphere, Vector,
};
use grouser_geometry::{RigidMotion, TriangleSurface, Vec3, Wrench};
use serde::{Deserialize, Serialize};

/// Cosine of the angle that the normal of a contact may turn in a step and still be the same contact: 45°.
const SAME_CONTACT: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Contacts of one surface with the grains of one bed, and what they remember.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound = "M: Serialize + serde::de::DeserializeOwned")]
pub struct SurfaceContacts<M> {
    surface: TriangleSurface,
    /// Distance of the farthest vertex from the origin of the body frame [m].
    farthest: f64,
    material: u32,
    candidates: Candidates,
    /// Contacts of the last step, by rising number of the grain.
    remembered: Vec<Remembered<M>>,
    ledger: ContactLedger,
    deepest: Option<Deepest>,
}

/// One contact between two steps.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Remembered<M> {
    id: u32,
    /// Normal in the frame of the surface.
    normal: Vec3,
    memory: M,
}

/// The deepest contact of a step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Deepest {
    /// Permanent number of the grain.
    pub grain: u32,
    /// Its centre [m].
    pub position: Vec3,
    /// Overlap over radius [-]; above 1 for a grain whose centre has passed through the surface.
    pub depth: f64,
}

/// What one step needs beside the contacts.
pub struct Step<'a, L, T: Real> {
    /// The law.
    pub law: &'a L,
    /// Constants of every pair of materials.
    pub table: &'a PairTable<T>,
    /// Time step [s].
    pub time_step: f64,
    /// Upper bound of the speed of any grain [m/s].
    pub fastest: f64,
}

impl<M> SurfaceContacts<M> {
    /// No contacts yet of a surface, given in its body frame, made of row `material` of the material table.
    /// The mesh doctor must have found it sound.
    pub fn new(surface: TriangleSurface, material: u32) -> Self {
        Self {
            farthest: surface.vertices.iter().fold(0.0, |most, vertex| most.max(vertex.norm())),
            surface,
            material,
            candidates: Candidates::default(),
            remembered: Vec::new(),
            ledger: ContactLedger::default(),
            deepest: None,
        }
    }

    /// Forces of one step: adds to the `loads` of the grains, and returns force and moment on the surface about the
    /// origin of its body frame.
    ///
    /// `ids` are the permanent numbers of the grains; results do not depend on the order in which grains are stored. The surface is
    /// rigid: R* and m* are those of the grain, and the contact point lies on the surface.
    pub fn forces<P: Precision, L: ContactLaw<P::Real, Memory = M>>(
        &mut self,
        motion: &RigidMotion,
        (spheres, ids): (&[Sphere<P>], &[u32]),
        loads: &mut [Load<P::Real>],
        step: &Step<L, P::Real>,
    ) -> Wrench
    where
        M: Memory<P::Real>,
    {
        // 1. Grains near the surface.
        let speed = step.fastest + motion.velocity.norm() + motion.spin.norm() * self.farthest;
        self.candidates.refresh(&self.surface, motion, (spheres, ids), speed * step.time_step);

        let mut total = Wrench::default();
        let mut pass = ContactLedger::default();
        let mut now = Vec::with_capacity(self.remembered.len());
        self.deepest = None;
        for (near, triangles) in self.candidates.iter() {
            let sphere = &spheres[near.index as usize];
            let (radius, position) = (sphere.radius.to_f64(), centre(sphere));
            let in_body = motion.point_in_body(&position);
            // 2. One contact for each smooth neighbourhood.
            let touches = touches(&self.surface, triangles, &in_body, radius);
            let normals: Vec<Vec3> = touches.iter().map(|t| normal_of(t, &in_body, &self.surface)).collect();
            for (k, touch) in touches.iter().enumerate() {
                // 3. What it remembers: the contact of this grain whose normal was nearest.
                let normal_in_body = normals[k];
                let memory = recall(&self.remembered, near.id, &normals, k).unwrap_or_default();
                // 4. The law.
                let (point, normal) = (motion.point(&touch.point), motion.orientation * normal_in_body);
                let overlap = radius - touch.distance;
                let contact = contact(sphere, &normal, overlap, motion, &point, step.time_step);
                let pair = step.table.pair(sphere.material, self.material);
                let (response, memory) = step.law.respond(&contact, pair, memory);
                now.push(Remembered { id: near.id, normal: normal_in_body, memory });
                // 5. Equal and opposite forces at one point.
                let force = contact.normal * response.normal_force + response.tangential_force;
                let arm = P::Real::from_f64(-touch.distance);
                loads[near.index as usize].add(force, contact.normal.cross(response.tangential_force) * arm);
                let force = force.cast::<f64>();
                let on_surface = -Vec3::new(force.x, force.y, force.z);
                total += Wrench::of_force_at(on_surface, &point, &motion.position);
                pass.add(&response.energy, step.time_step);
                let separated = contact.velocity.dot(contact.normal).to_f64() * step.time_step;
                // 6. A centre that was on the other side before this step has passed through the surface.
                let has_passed = separated > touch.distance;
                let depth = if has_passed { 1.0 + touch.distance / radius } else { overlap / radius };
                if self.deepest.is_none_or(|deepest| depth > deepest.depth) {
                    self.deepest = Some(Deepest { grain: near.id, position, depth });
                }
            }
        }
        self.remembered = now;
        self.ledger.record(&pass);
        total
    }

    /// The surface in its body frame.
    pub fn surface(&self) -> &TriangleSurface {
        &self.surface
    }

    /// Number of contacts of the last step.
    pub fn n_contacts(&self) -> usize {
        self.remembered.len()
    }

    /// Energy of the contacts since the beginning.
    pub fn ledger(&self) -> &ContactLedger {
        &self.ledger
    }

    /// The deepest contact of the last step.
    pub fn deepest(&self) -> Option<Deepest> {
        self.deepest
    }
}

/// Unit vector from the point of a touch to the centre, in the body frame; the triangle's own normal where they coincide.
fn normal_of(touch: &Touch, centre: &Vec3, surface: &TriangleSurface) -> Vec3 {
    (centre - touch.point).try_normalize(0.0).unwrap_or_else(|| surface.normal(touch.triangle as usize))
}

/// Memory of the contact of grain `id` whose normal was nearest to `normals[k]`, among those that no other of the grain's
/// present contacts is nearer to: one memory has one heir.
fn recall<M: Copy>(remembered: &[Remembered<M>], id: u32, normals: &[Vec3], k: usize) -> Option<M> {
    let is_heir = |normal: &Vec3| {
        let mine = normals[k].dot(normal);
        (normals.iter().enumerate())
            .all(|(other, n)| other == k || n.dot(normal) < mine || (n.dot(normal) == mine && k < other))
    };
    let first = remembered.partition_point(|contact| contact.id < id);
    remembered[first..]
        .iter()
        .take_while(|contact| contact.id == id)
        .map(|contact| (contact.normal.dot(&normals[k]), contact))
        .filter(|(likeness, contact)| *likeness > SAME_CONTACT && is_heir(&contact.normal))
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, contact)| contact.memory)
}

/// The contact as the law sees it, in the precision of the bed.
fn contact<P: Precision>(
    sphere: &Sphere<P>,
    normal: &Vec3,
    overlap: f64,
    motion: &RigidMotion,
    point: &Vec3,
    time_step: f64,
) -> Contact<P::Real> {
    let narrow = |v: &Vec3| Vector::new(v.x, v.y, v.z).cast::<P::Real>();
    let real = P::Real::from_f64;
    let normal = narrow(normal);
    let arm = real(sphere.radius.to_f64() - overlap);
    let velocity = sphere.velocity - (sphere.spin * arm).cross(normal) - narrow(&motion.velocity_at(point));
    Contact {
        overlap: real(overlap),
        normal,
        velocity,
        normal_spin: real(0.5) * (sphere.spin + narrow(&motion.spin)).dot(normal),
        effective_radius: real(sphere.radius.to_f64()),
        effective_mass: sphere.mass,
        time_step: real(time_step),
    }
}
