//! Elastic solids against closed forms.

mod dynamics;
mod elements;
mod materials;
mod motion;
mod refusals;
mod statics;

use grouser_fem::{Formulation, Material, Settings, Solid, VolumetricTreatment};
use grouser_geometry::{TetrahedralMesh, Vec3, box_mesh};

/// Box with interior nodes moved at random (a fixed congruential sequence), so that no two elements are alike.
fn irregular_box(cells: [usize; 3]) -> TetrahedralMesh {
    let mut mesh = box_mesh(Vec3::new(1.0, 1.0, 1.0), cells);
    let mut seed = 1u64;
    let mut random = || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 33) as f64 / 2f64.powi(31) - 0.5
    };
    let cell = Vec3::from_fn(|i, _| 1.0 / cells[i] as f64);
    for x in &mut mesh.nodes {
        let shift = Vec3::from_fn(|i, _| 0.3 * cell[i] * random());
        if x.iter().all(|&c| c > 1e-9 && c < 1.0 - 1e-9) {
            *x += shift;
        }
    }
    mesh
}

const FORMULATIONS: [Formulation; 3] =
    [Formulation::BodyAttached, Formulation::Corotational, Formulation::FiniteStrain];

/// The three kinds of element, by name.
fn elements(mesh: &TetrahedralMesh) -> [(&'static str, TetrahedralMesh, VolumetricTreatment); 3] {
    [
        ("linear", mesh.clone(), VolumetricTreatment::PerElement),
        ("averaged", mesh.clone(), VolumetricTreatment::NodalAverage),
        ("quadratic", mesh.to_quadratic(), VolumetricTreatment::PerElement),
    ]
}

fn solid(mesh: TetrahedralMesh, formulation: Formulation, volumetric: VolumetricTreatment, nu: f64) -> Solid {
    let settings = Settings { formulation, volumetric, ..Default::default() };
    Solid::new(mesh, vec![Material::hooke(1000.0, 1e9, nu)], settings).unwrap()
}
