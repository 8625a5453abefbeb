//! The tread of a tire: an elastic solid on a rim that is held, inflated, and carried along.

use super::axle::Place;
use crate::scene::{Tire, TireElements, TireModel, Tread as Pattern};
use grouser_coupling::{MirrorError, Spread};
use grouser_fem::{
    Formulation, LinearSolver, Material, Settings, Solid, SolidError, State, StaticError, StaticOptions,
    VolumetricTreatment,
};
use grouser_geometry::{LugPattern, TireError, TireTread, Vec3};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error as _};

/// Everything that a tread is made from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TreadSpec {
    /// Shape and mesh.
    pub tread: TireTread,
    /// Rubber of wall and lugs.
    pub rubber: Material,
    /// How it is computed.
    pub formulation: Formulation,
    /// Where its pressure comes from.
    pub volumetric: VolumetricTreatment,
    /// Damping proportional to stiffness, β [s].
    pub damping: f64,
    /// Inflation [Pa].
    pub inflation: f64,
    /// Radius over which contact forces are spread [m]; 0 is one triangle.
    pub contact_spread: f64,
}

/// Why a tread cannot be built.
#[derive(Debug, thiserror::Error)]
pub enum TreadError {
    /// Shape or mesh.
    #[error(transparent)]
    Tire(#[from] TireError),
    /// The solid.
    #[error(transparent)]
    Solid(#[from] SolidError),
    /// The inflated state.
    #[error(transparent)]
    Static(#[from] StaticError),
    /// The mirrored surface.
    #[error(transparent)]
    Mirror(#[from] MirrorError),
    /// Sub-steps longer than the stable one.
    #[error(
        "{sub_steps} sub-steps of {sub_step_s:.2e} s are unstable: element {element} allows {stable_s:.2e} s; expected at least \
         {least} sub-steps; usual cause: a finer tread or stiffer rubber than the sub-steps were chosen for; remedy: \
         `sub_steps: Auto`"
    )]
    Unstable {
        /// Sub-steps asked for.
        sub_steps: u32,
        /// Their length [s].
        sub_step_s: f64,
        /// Element that binds.
        element: u64,
        /// Stable step [s].
        stable_s: f64,
        /// Sub-steps needed.
        least: u32,
    },
}

/// The solid with what it was made from, so that a checkpoint can make it again.
pub struct Tread {
    /// What it was made from.
    pub spec: TreadSpec,
    /// The elastic solid.
    pub solid: Solid,
    /// Nodes that the rim holds.
    pub rim: Vec<u32>,
    surface: Vec<u32>,
    /// Where the origin of the undeformed mesh was at the start [m].
    pub origin: Vec3,
}

impl Tread {
    fn build(spec: TreadSpec, origin: Vec3) -> Result<Self, SolidError> {
        let mut mesh = spec.tread.mesh().expect("shapes are checked before");
        // One rubber: the regions share it.
        let materials = vec![spec.rubber; mesh.region_names.len()];
        mesh.element_labels.clear();
        let rim = mesh.nodes_of("rim")?;
        let surface = mesh.nodes_of("outer")?;
        let settings = Settings {
            formulation: spec.formulation,
            volumetric: spec.volumetric,
            stiffness_damping: spec.damping,
            ..Settings::default()
        };
        let mut solid = Solid::new(mesh, materials, settings)?;
        solid.fix("rim")?;
        if spec.inflation != 0.0 {
            solid.inflate("inner", spec.inflation)?;
        }
        Ok(Self { spec, solid, rim, surface, origin })
    }

    /// Whether displacements lead from the frame of the rim.
    pub fn is_attached(&self) -> bool {
        self.spec.formulation == Formulation::BodyAttached
    }

    /// Carries the rim to `place` in a sub-step of `dt` [s] whose accelerations are `acceleration`.
    pub fn carry(&mut self, place: &Place, (linear, angular): (Vec3, f64), gravity: Vec3, dt: f64) {
        let mut pose = place.pose();
        if self.is_attached() {
            self.solid.state.frame = pose;
            self.solid.loads.gravity = gravity - linear;
            self.solid.loads.spin.angular_velocity = Vec3::y() * place.spin;
            self.solid.loads.spin.angular_acceleration = Vec3::y() * angular;
        } else {
            pose.translation.vector -= self.origin;
            self.solid.carry(&self.rim, &pose, dt);
        }
    }

    /// Place of a node in the world [m].
    pub fn place(&self, node: u32) -> Vec3 {
        let x = self.solid.position(node);
        if self.is_attached() {
            let frame = &self.solid.state.frame;
            frame.translation.vector + frame.rotation * x
        } else {
            self.origin + x
        }
    }

    /// Velocity of a node in the world [m/s]; `axle` is where the frame is.
    pub fn velocity(&self, node: u32, axle: &Place) -> Vec3 {
        let v = self.solid.state.velocity[node as usize];
        if self.is_attached() {
            let arm = self.place(node) - axle.position;
            axle.velocity + (Vec3::y() * axle.spin).cross(&arm) + self.solid.state.frame.rotation * v
        } else {
            v
        }
    }

    /// A vector of the world in the solid's frame.
    pub fn to_frame(&self, v: Vec3) -> Vec3 {
        if self.is_attached() { self.solid.state.frame.rotation.inverse() * v } else { v }
    }

    /// Force of the tread on the rim in the world [N].
    pub fn force_on_rim(&self) -> Vec3 {
        let sum: Vec3 = self.solid.state.reaction.iter().sum();
        if self.is_attached() { -(self.solid.state.frame.rotation * sum) } else { -sum }
    }

    /// Radius of the inflated tread [m].
    pub fn largest_radius(&self) -> f64 {
        let radius = |&n: &u32| {
            let x = self.solid.position(n);
            x.x.hypot(x.z)
        };
        self.surface.iter().map(radius).fold(0.0, f64::max)
    }
}

impl Clone for Tread {
    fn clone(&self) -> Self {
        let mut copy = Self::build(self.spec.clone(), self.origin).expect("it was built before");
        copy.solid.loads = self.solid.loads.clone();
        copy.solid.resume(self.solid.state.clone()).expect("the same mesh");
        copy
    }
}

impl Serialize for Tread {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        (&self.spec, &self.origin, &self.solid.loads, &self.solid.state).serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Tread {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let (spec, origin, loads, state): (TreadSpec, Vec3, grouser_fem::Loads, State) =
            Deserialize::deserialize(deserializer)?;
        let mut tread = Self::build(spec, origin).map_err(D::Error::custom)?;
        tread.solid.loads = loads;
        tread.solid.resume(state).map_err(D::Error::custom)?;
        Ok(tread)
    }
}

/// Shape and mesh of a scene's tire.
pub fn shape(tire: &Tire) -> TireTread {
    TireTread {
        size: tire.size.clone(),
        rim_width: tire.rim_width_m,
        wall_thickness: tire.wall_thickness_m,
        groove_depth: tire.groove_depth_m,
        pattern: match tire.tread {
            Pattern::Smooth => LugPattern::Smooth,
            Pattern::Alternating { lugs, land } => LugPattern::Alternating { count: lugs, land },
        },
        n_elements: tire.n_elements,
    }
}

impl TreadSpec {
    /// What a scene's tread of `rubber` is made from; `None` for a rigid one.
    pub fn of(tire: &Tire, rubber: grouser_contact::Material) -> Option<Self> {
        let formulation = match tire.model {
            TireModel::Rigid => return None,
            TireModel::BodyAttached => Formulation::BodyAttached,
            TireModel::Corotational => Formulation::Corotational,
            TireModel::FiniteStrain => Formulation::FiniteStrain,
        };
        Some(Self {
            tread: shape(tire),
            rubber: Material::hooke(rubber.density_kg_m3, rubber.young_pa, rubber.poisson),
            formulation,
            volumetric: match tire.elements {
                TireElements::Linear => VolumetricTreatment::PerElement,
                TireElements::AveragedPressure => VolumetricTreatment::NodalAverage,
            },
            damping: tire.damping_s,
            inflation: tire.inflation_pa,
            contact_spread: tire.contact_spread_m,
        })
    }

    /// How contact forces are spread; `None` on one triangle.
    pub fn spread(&self) -> Option<Spread> {
        let (lambda, mu) = self.rubber.elasticity.lame();
        // E/(1 − ν²).
        let plane_modulus = 4.0 * mu * (lambda + mu) / (lambda + 2.0 * mu);
        (self.contact_spread > 0.0).then_some(Spread { radius: self.contact_spread, plane_modulus })
    }

    /// The tread inflated at rest on a held rim, around the origin.
    ///
    /// # Errors
    /// [`TreadError`].
    pub fn inflated(&self) -> Result<Tread, TreadError> {
        self.tread.mesh()?;
        let mut tread = Tread::build(self.clone(), Vec3::zeros())?;
        let options =
            StaticOptions { solver: LinearSolver::SparseCholesky, load_steps: 4, ..StaticOptions::default() };
        tread.solid.solve_statics(&options)?;
        Ok(tread)
    }
}
