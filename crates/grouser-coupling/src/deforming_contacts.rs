//! Contacts between grains and the surface of a solid that deforms.

use crate::candidates::{Candidates, Margin};
use crate::closest_point::natural_coordinates;
use crate::contact_pass::{Carrier, Contacts, Deepest, Seen, Step, asks_for_orientations};
use crate::mirror::Mirror;
use crate::spread::Spread;
use crate::touches::Touch;
use grouser_contact::{ContactLaw, ContactLedger, Load, Memory, Precision, Sphere};
use grouser_geometry::{Orientation, TriangleSurface, Vec3};
use serde::{Deserialize, Serialize};

/// Contacts of the deforming surface of one solid with the grains of one bed, and what they remember.
///
/// Each step ([`crate::coupled_step`]): [`Self::follow`] or [`Self::follow_in`] brings the surface to the nodes,
/// [`Self::forces`] loads the grains, [`Self::spread`] gives the opposite forces to the nodes.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound = "M: Serialize + serde::de::DeserializeOwned")]
pub struct DeformingContacts<M> {
    mirror: Mirror,
    /// The surface as it is now, in the world.
    surface: TriangleSurface,
    /// Velocity of each vertex [m/s].
    velocity: Vec<Vec3>,
    /// Force on each vertex in the last step [N].
    force: Vec<Vec3>,
    /// Inverse of the mass that moves with each vertex [1/kg].
    inverse_mass: Vec<f64>,
    /// What the mesh yields to a contact by itself [m/N].
    local_compliance: f64,
    /// What any vertex has moved since the forces were asked for [m].
    moved: f64,
    material: u32,
    margin: Margin,
    candidates: Candidates,
    contacts: Contacts<M>,
}

/// A surface that moves with its vertices and gives them the forces.
struct Deforming<'a> {
    surface: &'a TriangleSurface,
    velocity: &'a [Vec3],
    force: &'a mut [Vec3],
    inverse_mass: &'a [f64],
    local_compliance: f64,
}

impl Deforming<'_> {
    fn vertices(&self, touch: &Touch) -> [usize; 3] {
        self.surface.triangles[touch.triangle as usize].map(|vertex| vertex as usize)
    }
}

impl Carrier for Deforming<'_> {
    fn place_in_frame(&self, place: &Vec3) -> Vec3 {
        *place
    }
    fn point(&self, in_frame: &Vec3) -> Vec3 {
        *in_frame
    }
    fn direction(&self, in_frame: &Vec3) -> Vec3 {
        *in_frame
    }
    fn velocity(&self, touch: &Touch, point: &Vec3) -> Vec3 {
        let weights = natural_coordinates(point, &self.surface.corners(touch.triangle as usize));
        let vertices = self.vertices(touch);
        (0..3).fold(Vec3::zeros(), |sum, k| sum + self.velocity[vertices[k]] * weights[k])
    }
    /// Half of the curl of the triangle's velocity about its normal: ω·n = Σ v_k·(x_(k+1) − x_(k+2)) / (4 A).
    fn spin(&self, touch: &Touch, normal: &Vec3) -> Vec3 {
        let corners = self.surface.corners(touch.triangle as usize);
        let vertices = self.vertices(touch);
        let area = self.surface.area_vector(touch.triangle as usize).norm();
        if area == 0.0 {
            return Vec3::zeros();
        }
        let circulation: f64 = (0..3)
            .map(|k| self.velocity[vertices[k]].dot(&(corners[(k + 1) % 3] - corners[(k + 2) % 3])))
            .sum();
        normal * (circulation / (4.0 * area))
    }
    /// Σ_k L_k² / m_k.
    fn inverse_mass(&self, touch: &Touch) -> f64 {
        let weights = natural_coordinates(&touch.point, &self.surface.corners(touch.triangle as usize));
        let vertices = self.vertices(touch);
        (0..3).map(|k| weights[k] * weights[k] * self.inverse_mass[vertices[k]]).sum()
    }
    fn local_compliance(&self) -> f64 {
        self.local_compliance
    }
    /// Shares the force out by natural coordinates (P0 Eq. 42).
    fn receive(&mut self, touch: &Touch, point: &Vec3, force: Vec3) {
        let weights = natural_coordinates(point, &self.surface.corners(touch.triangle as usize));
        for (vertex, weight) in self.vertices(touch).into_iter().zip(weights) {
            self.force[vertex] += force * weight;
        }
    }
}

impl<M> DeformingContacts<M> {
    /// No contacts yet of the surface that `mirror` makes of the nodes, which lie at `position(node)` [m]; made of row
    /// `material` of the material table.
    pub fn new(mirror: Mirror, position: impl Fn(u32) -> Vec3, material: u32, margin: Margin) -> Self {
        let vertices: Vec<Vec3> = (0..mirror.n_vertices()).map(|v| mirror.at_vertex(v, &position)).collect();
        Self {
            velocity: vec![Vec3::zeros(); vertices.len()],
            force: vec![Vec3::zeros(); vertices.len()],
            inverse_mass: vec![0.0; vertices.len()],
            surface: TriangleSurface { vertices, triangles: mirror.triangles().to_vec() },
            mirror,
            local_compliance: 0.0,
            moved: 0.0,
            material,
            margin,
            candidates: Candidates::default(),
            contacts: Contacts::default(),
        }
    }

    /// The same contacts with forces spread over the surface, whose nodes lie at `reference(node)` [m] while it is not deformed, and
    /// with what such forces press into the mesh taken from the law, which must be one of Hertz's normal force. For meshes finer than a
    /// few contact radii. Call it before [`Self::with_nodal_masses`].
    pub fn with_spread(mut self, spread: Spread, reference: impl Fn(u32) -> Vec3) -> Self {
        self.mirror = self.mirror.spread_over(spread.radius, reference);
        self.local_compliance = spread.compliance();
        self
    }

    /// The same contacts with a surface as heavy as its nodes, `mass(node)` [kg], infinite where held: m* of a contact is then
    /// the reduced mass of grain and surface, and dashpots do not overpower light nodes. Without it the surface counts as
    /// one of prescribed motion.
    pub fn with_nodal_masses(mut self, mass: impl Fn(u32) -> f64) -> Self {
        for (vertex, inverse) in self.inverse_mass.iter_mut().enumerate() {
            *inverse = self.mirror.inverse_mass(vertex, &mass);
        }
        self
    }

    /// Brings the surface to where the nodes are now [m], moving as they do [m/s].
    pub fn follow(&mut self, position: impl Fn(u32) -> Vec3, velocity: impl Fn(u32) -> Vec3) {
        self.bring_to(position, |mirror, vertex, _| mirror.at_vertex(vertex, &velocity));
    }

    /// Brings the surface to where the nodes are now [m], `dt` [s] after they were asked for last; it moves with its mean
    /// velocity since.
    pub fn follow_in(&mut self, dt: f64, position: impl Fn(u32) -> Vec3) {
        self.bring_to(position, |_, _, way| way / dt);
    }

    /// `velocity(mirror, vertex, way)` [m/s] of a vertex that has moved by `way` [m].
    fn bring_to(&mut self, position: impl Fn(u32) -> Vec3, velocity: impl Fn(&Mirror, usize, Vec3) -> Vec3) {
        let mut moved = 0.0_f64;
        for vertex in 0..self.mirror.n_vertices() {
            let place = self.mirror.at_vertex(vertex, &position);
            let before = std::mem::replace(&mut self.surface.vertices[vertex], place);
            moved = moved.max((place - before).norm());
            self.velocity[vertex] = velocity(&self.mirror, vertex, place - before);
        }
        self.moved += moved;
        self.candidates.surface_has_deformed();
    }

    /// Forces of one step: adds to the `loads` of the grains; the opposite forces wait for [`Self::spread`].
    ///
    /// `ids` are the permanent numbers of the grains; results do not depend on the order in which grains are stored. R* is that
    /// of the grain, m* too unless [`Self::with_nodal_masses`] was called, and the contact point lies on the surface.
    pub fn forces<P: Precision, L: ContactLaw<P::Real, Memory = M>>(
        &mut self,
        (spheres, ids): (&[Sphere<P>], &[u32]),
        loads: &mut [Load<P::Real>],
        step: &Step<L, P::Real>,
        observe: impl FnMut(Seen),
    ) where
        M: Memory<P::Real>,
    {
        const { assert!(!asks_for_orientations::<P, L>(), "angular grains: use `forces_on_turned`") };
        self.forces_on_turned((spheres, ids, None), loads, step, observe);
    }

    /// [`Self::forces`] on grains whose `orientations` are kept; `None` where the law does not ask for them.
    ///
    /// # Panics
    /// When the law asks for orientations and there are none.
    pub fn forces_on_turned<P: Precision, L: ContactLaw<P::Real, Memory = M>>(
        &mut self,
        (spheres, ids, orientations): (&[Sphere<P>], &[u32], Option<&[Orientation]>),
        loads: &mut [Load<P::Real>],
        step: &Step<L, P::Real>,
        observe: impl FnMut(Seen),
    ) where
        M: Memory<P::Real>,
    {
        // 1. Grains near the surface.
        let travel = step.fastest * step.time_step + std::mem::take(&mut self.moved);
        self.candidates.refresh(&self.surface, |place| *place, (spheres, ids), travel, self.margin);
        // 2. to 6.
        self.force.fill(Vec3::zeros());
        let mut carrier = Deforming {
            surface: &self.surface,
            velocity: &self.velocity,
            force: &mut self.force,
            inverse_mass: &self.inverse_mass,
            local_compliance: self.local_compliance,
        };
        let surface = (&self.surface, self.material);
        self.contacts.pass(
            &self.candidates,
            surface,
            &mut carrier,
            (spheres, orientations),
            loads,
            step,
            observe,
        );
    }

    /// Gives the forces of the last step to the nodes: calls `add(node, force)` [N], in an order that is always the same.
    pub fn spread(&self, add: impl FnMut(u32, Vec3)) {
        self.mirror.spread(&self.force, add);
    }

    /// The surface as it was last brought to the nodes.
    pub fn surface(&self) -> &TriangleSurface {
        &self.surface
    }

    /// Force on each vertex of the surface in the last step [N].
    pub fn vertex_forces(&self) -> &[Vec3] {
        &self.force
    }

    /// Number of contacts of the last step.
    pub fn n_contacts(&self) -> usize {
        self.contacts.n_contacts()
    }

    /// How often the hierarchy was refitted and asked.
    pub fn n_refits(&self) -> u64 {
        self.candidates.n_refreshes()
    }

    /// Energy of the contacts since the beginning.
    pub fn ledger(&self) -> &ContactLedger {
        &self.contacts.ledger
    }

    /// The deepest contact of the last step.
    pub fn deepest(&self) -> Option<Deepest> {
        self.contacts.deepest
    }
}
