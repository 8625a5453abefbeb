//! One pass over the grains near a surface: touches, memories, law, equal and opposite forces.

use crate::candidates::{Candidates, centre};
use crate::spread::Remainder;
use crate::touches::{Touch, touches};
use grouser_contact::{
    Body, Contact, ContactLaw, ContactLedger, ContactVelocity, Frame, Load, Memory, PairTable, Precision,
    Real, RotationLaw, Sphere, Vector,
};
use grouser_geometry::{Orientation, TriangleSurface, Vec3};
use serde::{Deserialize, Serialize};

/// Cosine of the angle that the normal of a contact may turn in a step and still be the same contact: 45°.
const SAME_CONTACT: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// How a surface moves, and what becomes of the forces on it. Triangles lie in the frame of the surface.
pub(crate) trait Carrier {
    /// A place of the world in the frame of the surface [m].
    fn place_in_frame(&self, place: &Vec3) -> Vec3;
    /// A point of the frame in the world [m].
    fn point(&self, in_frame: &Vec3) -> Vec3;
    /// A direction of the frame in the world.
    fn direction(&self, in_frame: &Vec3) -> Vec3;
    /// Velocity of the surface at a touch, which lies at `point` in the world [m/s].
    fn velocity(&self, touch: &Touch, point: &Vec3) -> Vec3;
    /// Spin of the surface at a touch; only its part along the world's `normal` is used [rad/s].
    fn spin(&self, touch: &Touch, normal: &Vec3) -> Vec3;
    /// Inverse of the mass that moves at a touch [1/kg]; zero where the motion is prescribed.
    #[inline]
    fn inverse_mass(&self, _: &Touch) -> f64 {
        0.0
    }
    /// What the surface's mesh yields to a contact by itself [m/N], so that the law must not yield it again.
    #[inline]
    fn local_compliance(&self) -> f64 {
        0.0
    }
    /// Takes a force on the surface, in the world's frame [N].
    fn receive(&mut self, touch: &Touch, point: &Vec3, force: Vec3);
}

/// One contact between two steps.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Remembered<M> {
    id: u32,
    /// Normal in the frame of the surface.
    normal: Vec3,
    is_minimum: bool,
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

/// A contact as an observer sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Permanent number of the grain.
    pub grain: u32,
    /// Contact point in the world [m].
    pub point: Vec3,
    /// Force on the surface in the world's frame [N], as often as it counts.
    pub force: Vec3,
    /// How often it counts ([`Touch::weight`]): below zero where it takes back what others count twice.
    pub weight: f64,
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

/// What the contacts of one surface remember from step to step.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound = "M: Serialize + serde::de::DeserializeOwned")]
pub(crate) struct Contacts<M> {
    /// Contacts of the last step, by rising number of the grain.
    remembered: Vec<Remembered<M>>,
    pub ledger: ContactLedger,
    pub deepest: Option<Deepest>,
}

impl<M> Default for Contacts<M> {
    fn default() -> Self {
        Self { remembered: Vec::new(), ledger: ContactLedger::default(), deepest: None }
    }
}

impl<M> Contacts<M> {
    /// Number of contacts of the last step: places where the surface is nearest to a grain.
    pub fn n_contacts(&self) -> usize {
        self.remembered.iter().filter(|contact| contact.is_minimum).count()
    }

    /// Steps 2 to 6 of `docs/theory/surfaces.md` for the grains of `candidates`: adds to their `loads`, gives the opposite to
    /// the carrier, and shows every contact to `observe`. Laws that ask for orientations need `orientations`.
    #[inline]
    #[expect(clippy::too_many_arguments, reason = "one call site for each kind of surface")]
    pub fn pass<P: Precision, L: ContactLaw<P::Real, Memory = M>>(
        &mut self,
        candidates: &Candidates,
        (surface, material): (&TriangleSurface, u32),
        carrier: &mut impl Carrier,
        (spheres, orientations): (&[Sphere<P>], Option<&[Orientation]>),
        loads: &mut [Load<P::Real>],
        step: &Step<L, P::Real>,
        mut observe: impl FnMut(Seen),
    ) where
        M: Memory<P::Real>,
    {
        assert!(
            orientations.is_some() || !asks_for_orientations::<P, L>(),
            "this contact law asks for orientations"
        );
        let mut pass = ContactLedger::default();
        let mut now = Vec::with_capacity(self.remembered.len());
        self.deepest = None;
        for (near, triangles) in candidates.iter() {
            let sphere = &spheres[near.index as usize];
            let (radius, position) = (sphere.radius.to_f64(), centre(sphere));
            let in_frame = carrier.place_in_frame(&position);
            // 2. Where the distance from the centre is critical.
            let touches = touches(surface, triangles, &in_frame, radius);
            if touches.is_empty() {
                continue;
            }
            let normals: Vec<Vec3> = touches.iter().map(|t| normal_of(t, &in_frame, surface)).collect();
            // 3. What each remembers.
            let memories = recall(&self.remembered, near.id, &touches, &normals);
            for ((touch, &normal_in_frame), memory) in touches.iter().zip(&normals).zip(memories) {
                // 4. The law.
                let (point, normal) = (carrier.point(&touch.point), carrier.direction(&normal_in_frame));
                let overlap = radius - touch.distance;
                let velocity = carrier.velocity(touch, &point);
                let spin = carrier.spin(touch, &normal);
                let bodies =
                    bodies::<P, L>(sphere, overlap, orientations.map(|kept| &kept[near.index as usize]));
                let mut contact =
                    contact(sphere, step.law, &bodies, &normal, overlap, [&velocity, &spin], step.time_step);
                let inverse_mass = carrier.inverse_mass(touch);
                if inverse_mass > 0.0 {
                    // 1/m* = 1/m of the grain + that of the surface.
                    contact.effective_mass =
                        P::Real::from_f64(1.0 / (1.0 / sphere.mass.to_f64() + inverse_mass));
                }
                let pair = step.table.pair(sphere.material, material);
                let mut energy = ContactLedger::default();
                let compliance = carrier.local_compliance();
                let mut held_by_mesh = 0.0;
                if compliance > 0.0 {
                    let stiffness = pair.normal_modulus.to_f64() * radius.sqrt();
                    let approach = Remainder { compliance, stiffness }.approach(overlap);
                    contact.overlap = P::Real::from_f64(approach.whole);
                    held_by_mesh = approach.held_by_mesh;
                }
                let (mut response, mut memory) = step.law.respond(&contact, pair, memory);
                response.energy.normal_elastic -= P::Real::from_f64(held_by_mesh);
                let arm = P::Real::from_f64(-touch.distance);
                let mut torque = contact.normal.cross(response.tangential_force) * arm;
                if !<L::Rotation as RotationLaw<P::Real>>::IS_SPHERE {
                    let (couples, remembered) = step.law.couples(&contact, pair, &response, &bodies, memory);
                    (torque, memory) = (couples.torques[0], remembered);
                    energy.turning += couples.spent.to_f64() * step.time_step;
                }
                let is_minimum = touch.is_minimum;
                now.push(Remembered { id: near.id, normal: normal_in_frame, is_minimum, memory });
                // 5. Equal and opposite forces at one point, as often as they count.
                let weight = P::Real::from_f64(touch.weight);
                let force = (contact.normal * response.normal_force + response.tangential_force) * weight;
                loads[near.index as usize].add(force, torque * weight);
                let force = force.cast::<f64>();
                let on_surface = -Vec3::new(force.x, force.y, force.z);
                carrier.receive(touch, &point, on_surface);
                observe(Seen { grain: near.id, point, force: on_surface, weight: touch.weight });
                energy.add(&response.energy, step.time_step);
                pass.add_weighted(&energy, touch.weight);
                let separated = contact.velocity.normal.to_f64() * step.time_step;
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
    }
}

/// Unit vector from the point of a touch to the centre, in the frame; the triangle's own normal where they coincide.
fn normal_of(touch: &Touch, centre: &Vec3, surface: &TriangleSurface) -> Vec3 {
    (centre - touch.point).try_normalize(0.0).unwrap_or_else(|| surface.normal(touch.triangle as usize))
}

/// Memories of the present `touches` of grain `id`.
///
/// Each inherits from the contact of its kind (minimum or not) whose normal was nearest, among those that no other of the present
/// ones is nearer to: one memory has one heir. Touches that appear together with a saddle cancel each other, so all of them
/// remember what the contact beside them does; any other new one begins without.
fn recall<M: Copy + Default>(
    remembered: &[Remembered<M>],
    id: u32,
    touches: &[Touch],
    normals: &[Vec3],
) -> Vec<M> {
    let first = remembered.partition_point(|contact| contact.id < id);
    let n = remembered[first..].iter().take_while(|contact| contact.id == id).count();
    let remembered = &remembered[first..first + n];
    let inherited = |k: usize| {
        let is_minimum = touches[k].is_minimum;
        let is_heir = |normal: &Vec3| {
            let mine = normals[k].dot(normal);
            (normals.iter().enumerate().filter(|&(other, _)| touches[other].is_minimum == is_minimum))
                .all(|(other, n)| other == k || n.dot(normal) < mine || (n.dot(normal) == mine && k < other))
        };
        (remembered.iter().filter(|contact| contact.is_minimum == is_minimum))
            .map(|contact| (contact.normal.dot(&normals[k]), contact))
            .filter(|(likeness, contact)| *likeness > SAME_CONTACT && is_heir(&contact.normal))
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, contact)| contact.memory)
    };
    let mut memories: Vec<Option<M>> = (0..touches.len()).map(inherited).collect();
    let new_saddle = (0..touches.len()).find(|&k| !touches[k].is_minimum && memories[k].is_none());
    if let Some(saddle) = new_saddle {
        let beside = (0..touches.len())
            .filter(|&k| touches[k].is_minimum && memories[k].is_some())
            .max_by(|&a, &b| normals[a].dot(&normals[saddle]).total_cmp(&normals[b].dot(&normals[saddle])));
        let shared = beside.and_then(|k| memories[k]);
        memories.iter_mut().for_each(|memory| *memory = memory.or(shared));
    }
    memories.into_iter().map(Option::unwrap_or_default).collect()
}

type FrameOf<P, L> =
    <<L as ContactLaw<<P as Precision>::Real>>::Rotation as RotationLaw<<P as Precision>::Real>>::Frame;
type BodyOf<P, L> = Body<<P as Precision>::Real, FrameOf<P, L>>;

/// Law `L` must know how grains are turned; known when compiled.
pub(crate) const fn asks_for_orientations<P: Precision, L: ContactLaw<P::Real>>() -> bool {
    <FrameOf<P, L> as Frame<P::Real>>::IS_TRACKED
}

/// The grain and the surface as a rotation law sees them.
fn bodies<P: Precision, L: ContactLaw<P::Real>>(
    sphere: &Sphere<P>,
    overlap: f64,
    orientation: Option<&Orientation>,
) -> [BodyOf<P, L>; 2] {
    let radius = sphere.radius.to_f64();
    let frame = orientation
        .map_or_else(Default::default, |kept| FrameOf::<P, L>::from_quaternion(kept.coords.into()));
    let moment = sphere.mass * P::Real::from_f64(radius * radius);
    let arm = P::Real::from_f64(radius - overlap);
    let grain = Body { arm, spin: sphere.spin, inverse_moment: P::Real::ONE / moment, frame };
    [grain, Body::at_rest(FrameOf::<P, L>::default())]
}

/// The contact as the law sees it, in the precision of the bed; `velocity` and `spin` are those of the surface.
fn contact<P: Precision, L: ContactLaw<P::Real>>(
    sphere: &Sphere<P>,
    law: &L,
    bodies: &[BodyOf<P, L>; 2],
    normal: &Vec3,
    overlap: f64,
    [velocity, spin]: [&Vec3; 2],
    time_step: f64,
) -> Contact<P::Real> {
    let narrow = |v: &Vec3| Vector::new(v.x, v.y, v.z).cast::<P::Real>();
    let real = P::Real::from_f64;
    let normal = narrow(normal);
    // The surface's velocity at the contact point is added to that of a body that rests.
    let of_grain = law.rotation().velocity_at_contact(normal, sphere.velocity, bodies);
    let velocity = of_grain - narrow(velocity);
    Contact {
        overlap: real(overlap),
        normal,
        velocity: ContactVelocity::of(velocity, normal),
        normal_spin: real(0.5) * (sphere.spin + narrow(spin)).dot(normal),
        effective_radius: real(sphere.radius.to_f64()),
        effective_mass: sphere.mass,
        time_step: real(time_step),
    }
}
