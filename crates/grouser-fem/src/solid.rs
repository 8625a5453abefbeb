//! An elastic solid: mesh, materials, supports, loads and the state that moves.

use std::collections::BTreeMap;

use grouser_geometry::{ElementOrder, MeshError, Pose, TetrahedralMesh, Vec3};
use serde::{Deserialize, Serialize};

use crate::elements::Elements;
use crate::law::Law;
use crate::loads::{Loads, Pressure};
use crate::mass::{Mass, MassKind, consistent_element_mass};
use crate::material::{Formulation, Material, MaterialError};

/// Where the pressure of an element comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum VolumetricTreatment {
    /// From the element's own volume change; linear tetrahedra lock as ν → 0.5.
    #[default]
    PerElement,
    /// From volume changes averaged around the nodes: linear tetrahedra that do not lock.
    NodalAverage,
}

/// Choices that hold for a whole solid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// How elements follow rotation and strain.
    pub formulation: Formulation,
    /// Where the pressure comes from.
    pub volumetric: VolumetricTreatment,
    /// Lumped or consistent mass.
    pub mass: MassKind,
    /// Rayleigh damping proportional to mass, α [1/s].
    pub mass_damping: f64,
    /// Rayleigh damping proportional to stiffness, β [s].
    pub stiffness_damping: f64,
}

/// A node that is held in some components.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Support {
    /// Components that are held.
    pub held: [bool; 3],
    /// Displacement of the held components [m].
    pub displacement: Vec3,
    /// Velocity of the held components [m/s].
    pub velocity: Vec3,
}

/// Everything that changes with time.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Time [s].
    pub time: f64,
    /// Steps made.
    pub steps: u64,
    /// Displacement of each node in the solid's frame [m].
    pub displacement: Vec<Vec3>,
    /// Velocity of each node in the solid's frame [m/s].
    pub velocity: Vec<Vec3>,
    /// Acceleration of each node in the solid's frame [m/s²].
    pub acceleration: Vec<Vec3>,
    /// Forces that the caller applies to the nodes, in the solid's frame [N]; kept until the caller changes them.
    pub applied: Vec<Vec3>,
    /// Supports by node.
    pub supports: BTreeMap<u32, Support>,
    /// Force of each support on what it holds, in the order of the supports, without what accelerates the held node itself [N].
    pub reaction: Vec<Vec3>,
    /// Frame of a body-attached solid in the world.
    pub frame: Pose,
    /// Work and dissipation since the start.
    pub ledger: crate::dynamics::Ledger,
}

/// Elastic solid that computes its own motion.
pub struct Solid {
    pub(crate) mesh: TetrahedralMesh,
    pub(crate) materials: Vec<Material>,
    pub(crate) settings: Settings,
    pub(crate) laws: Vec<Law>,
    pub(crate) elements: Elements,
    pub(crate) mass: Mass,
    pub(crate) nodal_mass: Vec<f64>,
    /// Gravity, spin of the frame and pressures.
    pub loads: Loads,
    /// What changes with time; a checkpoint is this alone.
    pub state: State,
    /// Working memory of a step: forces of pressures, reactions at its start, and which components are held.
    pub(crate) force: Vec<Vec3>,
    pub(crate) last_reaction: Vec<Vec3>,
    pub(crate) held_mask: Vec<[bool; 3]>,
    /// Whether accelerations belong to the present state.
    pub(crate) is_started: bool,
}

/// Why a solid is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SolidError {
    /// The mesh is unusable.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A material is unusable.
    #[error(transparent)]
    Material(#[from] MaterialError),
    /// Nodal averaging with ten-node elements.
    #[error(
        "averaged nodal pressure is for linear tetrahedra, but the mesh has ten-node ones: those do not lock; set volumetric to PerElement"
    )]
    AveragedQuadratic,
    /// A damping coefficient is negative or not finite.
    #[error("{name} is {value}, expected a finite number ≥ 0: negative damping feeds energy into the solid")]
    Damping {
        /// The coefficient.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// Consistent mass of an element that folds over.
    #[error(
        "element {element} folds over at a corner, so its consistent mass is not positive: straighten its curved sides, or take lumped mass"
    )]
    Folded {
        /// Number of the element.
        element: u64,
    },
    /// Pressure that is infinite or not a number.
    #[error("pressure {pressure} on '{surface}' is not finite: expected Pa")]
    Pressure {
        /// Name of the surface.
        surface: String,
        /// The value.
        pressure: f64,
    },
    /// Inflation of a surface whose rim is not held.
    #[error(
        "inflation of '{surface}', which is open: the edge at node {node} is neither shared by two facets nor held; hold the nodes of the rim first, or name every facet of the cavity"
    )]
    OpenSurface {
        /// Name of the surface.
        surface: String,
        /// Node of an open edge.
        node: u32,
    },
}

impl Solid {
    /// Solid at rest, undeformed, without supports; `materials` in the order of the mesh's regions.
    ///
    /// # Errors
    /// [`SolidError`].
    pub fn new(
        mesh: TetrahedralMesh,
        materials: Vec<Material>,
        settings: Settings,
    ) -> Result<Self, SolidError> {
        mesh.validate()?;
        if materials.len() != mesh.region_names.len() {
            let (found, expected) = (materials.len(), mesh.region_names.len());
            return Err(
                MaterialError::Count { found, expected, regions: mesh.region_names.join(", ") }.into()
            );
        }
        for (material, region) in materials.iter().zip(&mesh.region_names) {
            material.validate(region)?;
        }
        if settings.mass == MassKind::Consistent {
            let is_positive = |e: &usize| consistent_element_mass(&mesh, *e).cholesky().is_some();
            if let Some(e) = (0..mesh.n_elements()).find(|e| !is_positive(e)) {
                return Err(SolidError::Folded { element: mesh.element_label(e) });
            }
        }
        let is_averaged = settings.volumetric == VolumetricTreatment::NodalAverage;
        if is_averaged && mesh.order == ElementOrder::Quadratic {
            return Err(SolidError::AveragedQuadratic);
        }
        for (name, value) in
            [("mass_damping", settings.mass_damping), ("stiffness_damping", settings.stiffness_damping)]
        {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(SolidError::Damping { name, value });
            }
        }
        let laws: Vec<Law> = materials.iter().map(|m| m.elasticity.law(settings.formulation)).collect();
        let zeros = vec![Vec3::zeros(); mesh.nodes.len()];
        let state = State {
            displacement: zeros.clone(),
            velocity: zeros.clone(),
            acceleration: zeros.clone(),
            applied: zeros,
            frame: Pose::identity(),
            ..Default::default()
        };
        let elements = Elements::new(&mesh, &laws, is_averaged);
        let mass = Mass::new(&mesh, &materials, settings.mass);
        Ok(Self {
            nodal_mass: mass.nodal(),
            mesh,
            materials,
            settings,
            laws,
            elements,
            mass,
            loads: Loads::default(),
            state,
            force: Vec::new(),
            last_reaction: Vec::new(),
            held_mask: Vec::new(),
            is_started: false,
        })
    }

    /// Mesh in the undeformed state.
    pub fn mesh(&self) -> &TetrahedralMesh {
        &self.mesh
    }

    /// Choices made at construction.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Supports by node.
    pub fn supports(&self) -> &BTreeMap<u32, Support> {
        &self.state.supports
    }

    /// Whether pressures are averaged over the nodes.
    pub fn is_pressure_averaged(&self) -> bool {
        self.settings.volumetric == VolumetricTreatment::NodalAverage
    }

    /// Mass that hangs on each node [kg].
    pub fn nodal_mass(&self) -> &[f64] {
        &self.nodal_mass
    }

    /// Position of a node in the solid's frame [m].
    pub fn position(&self, node: u32) -> Vec3 {
        self.mesh.nodes[node as usize] + self.state.displacement[node as usize]
    }

    /// Holds all components of the nodes of a named surface or node set at their present displacement.
    ///
    /// # Errors
    /// [`MeshError::UnknownName`].
    pub fn fix(&mut self, name: &str) -> Result<(), MeshError> {
        self.fix_components(name, [true; 3])
    }

    /// Holds some components of the nodes of a named surface or node set at their present displacement.
    ///
    /// # Errors
    /// [`MeshError::UnknownName`].
    pub fn fix_components(&mut self, name: &str, held: [bool; 3]) -> Result<(), MeshError> {
        for node in self.mesh.nodes_of(name)? {
            for c in (0..3).filter(|&c| held[c]) {
                self.prescribe(node, c, self.state.displacement[node as usize][c], 0.0);
            }
        }
        Ok(())
    }

    /// Prescribes one component of a node's displacement [m] and velocity [m/s]; statics moves there in one go, a step jumps.
    pub fn prescribe(&mut self, node: u32, component: usize, displacement: f64, velocity: f64) {
        self.is_started = false;
        let support = self.state.supports.entry(node).or_default();
        support.held[component] = true;
        support.displacement[component] = displacement;
        support.velocity[component] = velocity;
    }

    /// Lets go of one component of a node; nothing happens where it is not held.
    pub fn release(&mut self, node: u32, component: usize) {
        if let Some(support) = self.state.supports.get_mut(&node) {
            self.is_started = false;
            support.held[component] = false;
            if support.held == [false; 3] {
                self.state.supports.remove(&node);
            }
        }
    }

    /// Puts a pressure [Pa] on a named surface, against its outward normal.
    ///
    /// # Errors
    /// [`SolidError::Pressure`], [`SolidError::Mesh`] for an unknown name.
    pub fn add_pressure(&mut self, surface: &str, pressure: f64) -> Result<(), SolidError> {
        if !pressure.is_finite() {
            return Err(SolidError::Pressure { surface: surface.to_owned(), pressure });
        }
        let facets = self.mesh.facets(surface)?.to_vec();
        self.loads.pressures.push(Pressure { surface: surface.to_owned(), facets, pressure });
        Ok(())
    }

    /// Inflates a cavity: like [`Self::add_pressure`], but every open edge of the surface must be held.
    ///
    /// # Errors
    /// [`SolidError::OpenSurface`] beside those of [`Self::add_pressure`].
    pub fn inflate(&mut self, surface: &str, pressure: f64) -> Result<(), SolidError> {
        let mut edges = BTreeMap::<(u32, u32), usize>::new();
        for &facet in self.mesh.facets(surface)? {
            let [a, b, c] = self.mesh.facet_corners(facet);
            for (i, j) in [(a, b), (b, c), (c, a)] {
                *edges.entry((i.min(j), i.max(j))).or_default() += 1;
            }
        }
        let is_open = |node: &u32| !self.state.supports.contains_key(node);
        let open = edges
            .iter()
            .filter(|&(_, &count)| count == 1)
            .find_map(|(&(i, j), _)| [i, j].into_iter().find(|n| is_open(n)));
        match open {
            Some(node) => Err(SolidError::OpenSurface { surface: surface.to_owned(), node }),
            None => self.add_pressure(surface, pressure),
        }
    }

    /// Which components of each node are held.
    pub(crate) fn held_components(&self) -> Vec<[bool; 3]> {
        let mut held = vec![[false; 3]; self.mesh.nodes.len()];
        self.state.supports.iter().for_each(|(&n, s)| held[n as usize] = s.held);
        held
    }

    /// Adds gravity, pressures, applied forces and those of a turning frame, times `fraction` [N].
    pub(crate) fn add_external_forces(&self, fraction: f64, force: &mut [Vec3]) {
        let gravity = match self.settings.formulation {
            Formulation::BodyAttached => self.state.frame.rotation.inverse() * self.loads.gravity,
            _ => self.loads.gravity,
        };
        for ((f, applied), mass) in force.iter_mut().zip(&self.state.applied).zip(&self.nodal_mass) {
            *f += fraction * (applied + gravity * *mass);
        }
        self.add_distributed_forces(fraction, force);
    }

    /// Adds the forces of pressures and of a turning frame, times `fraction` [N].
    pub(crate) fn add_distributed_forces(&self, fraction: f64, force: &mut [Vec3]) {
        if self.loads.spin.is_turning() {
            let is_attached = self.settings.formulation == Formulation::BodyAttached;
            let place = |n: usize| if is_attached { self.mesh.nodes[n] } else { self.position(n as u32) };
            let acceleration: Vec<Vec3> =
                (0..force.len()).map(|n| self.loads.spin.acceleration_at(&place(n)) * fraction).collect();
            let mut inertia = vec![Vec3::zeros(); force.len()];
            self.mass.multiply(&acceleration, &mut inertia);
            force.iter_mut().zip(&inertia).for_each(|(f, i)| *f += i);
        }
        for load in &self.loads.pressures {
            // In the linear formulation the frame turns, not the facets.
            match self.settings.formulation {
                Formulation::BodyAttached => {
                    load.add_forces(&self.mesh, |n| self.mesh.nodes[n as usize], fraction, force);
                }
                _ => load.add_forces(&self.mesh, |n| self.position(n), fraction, force),
            }
        }
    }
}
