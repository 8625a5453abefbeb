//! Cantilever, thick-walled cylinder, locking.

use std::f64::consts::FRAC_PI_2;

use grouser_fem::{Formulation, LinearSolver, Material, Settings, Solid, StaticOptions, VolumetricTreatment};
use grouser_geometry::{TetrahedralMesh, Vec3, box_mesh, hollow_cylinder};

use crate::elements;

/// Inner radial displacement of a long tube under inner pressure, over the closed form (Timoshenko & Goodier, Lamé).
fn tube(mesh: TetrahedralMesh, volumetric: VolumetricTreatment, nu: f64) -> f64 {
    let (a, b, p, e) = (0.1, 0.2, 1e6, 1e9);
    let settings = Settings { volumetric, ..Default::default() };
    let mut solid = Solid::new(mesh, vec![Material::hooke(1000.0, e, nu)], settings).unwrap();
    solid.fix_components("z_min", [false, false, true]).unwrap();
    solid.fix_components("z_max", [false, false, true]).unwrap();
    solid.fix_components("angle_min", [false, true, false]).unwrap();
    solid.fix_components("angle_max", [true, false, false]).unwrap();
    solid.inflate("inner", p).unwrap();
    solid.solve_statics(&StaticOptions::default()).unwrap();
    let nodes = solid.mesh().nodes_of("inner").unwrap();
    let radial = |&n: &u32| {
        let x = solid.mesh().nodes[n as usize];
        solid.state.displacement[n as usize].dot(&Vec3::new(x.x, x.y, 0.0).normalize())
    };
    let mean = nodes.iter().map(radial).sum::<f64>() / nodes.len() as f64;
    let closed_form = (1.0 + nu) * p * a * a / (e * (b * b - a * a)) * ((1.0 - 2.0 * nu) * a + b * b / a);
    mean / closed_form
}

fn quarter(n: usize) -> TetrahedralMesh {
    hollow_cylinder(0.1, 0.2, 0.1 / n as f64, FRAC_PI_2, [n, 2 * n, 1])
}

#[test]
fn a_thick_walled_cylinder_converges_to_lame_at_second_order_with_linear_elements() {
    for volumetric in [VolumetricTreatment::PerElement, VolumetricTreatment::NodalAverage] {
        let error = |n| (tube(quarter(n), volumetric, 0.3) - 1.0).abs();
        let (coarse, fine) = (error(8), error(16));
        let order = (coarse / fine).log2();
        assert!(order > 1.9 && fine < 0.01, "{volumetric:?}: {coarse} {fine} order {order}");
    }
}

#[test]
fn plain_linear_tetrahedra_lock_and_the_other_two_do_not() {
    for (nu, locked) in [(0.45, 0.02), (0.49, 0.06), (0.499, 0.15)] {
        for (name, mesh, volumetric) in elements(&quarter(8)) {
            let ratio = tube(mesh, volumetric, nu);
            match name {
                "linear" => assert!(ratio < 1.0 - locked, "{name} {nu} {ratio}"),
                _ => assert!((ratio - 1.0).abs() < 0.02, "{name} {nu} {ratio}"),
            }
        }
    }
}

/// Deflection of the tip of a cantilever under an end force over Timoshenko's value with Cowper's shear coefficient.
fn cantilever(mesh: TetrahedralMesh, nu: f64, options: &StaticOptions) -> f64 {
    let mut solid = Solid::new(mesh, vec![Material::hooke(1000.0, 1e9, nu)], Settings::default()).unwrap();
    solid.fix("x_min").unwrap();
    // Shear of 100 N as traction: equal shares by the facets' areas.
    let facets = solid.mesh().facets("x_max").unwrap().to_vec();
    for &facet in &facets {
        let nodes = solid.mesh().facet_nodes(facet);
        // Uniform traction on a triangle loads three corners, or the three mid-sides, equally.
        let loaded = &nodes[nodes.len() - 3..];
        for &n in loaded {
            solid.state.applied[n as usize].z -= 100.0 / (3 * facets.len()) as f64;
        }
    }
    solid.solve_statics(options).unwrap();
    let tip = solid.mesh().nodes_of("x_max").unwrap();
    let mean = tip.iter().map(|&n| -solid.state.displacement[n as usize].z).sum::<f64>() / tip.len() as f64;
    let weight: f64 = solid.state.reaction.iter().map(|r| r.z).sum();
    assert!((weight - 100.0).abs() < 1e-6, "the support must carry the force: {weight}");
    // P L^3 / (3 E I) + P L / (kappa A G)
    let shear_coefficient = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu);
    mean / (0.004 + 100.0 * 2.0 * (1.0 + nu) / (shear_coefficient * 0.01 * 1e9))
}

#[test]
fn a_cantilever_bends_as_timoshenko_says_with_quadratic_elements_and_both_solvers() {
    let mesh = box_mesh(Vec3::new(1.0, 0.1, 0.1), [16, 2, 2]).to_quadratic();
    let [direct, iterative] =
        [LinearSolver::SparseCholesky, LinearSolver::ConjugateGradients].map(|solver| {
            let options = StaticOptions { solver, ..Default::default() };
            cantilever(mesh.clone(), 0.0, &options)
        });
    assert!((direct - 1.0).abs() < 0.003, "{direct}");
    assert!((direct - iterative).abs() < 1e-6, "{direct} {iterative}");
}

#[test]
fn a_cantilever_of_linear_elements_converges_at_second_order() {
    // The fixed root has a singularity at its edge; the tip sees it weakly, so the order is measured against the fine quadratic
    // solution of the same boundary values.
    let mesh = |n: usize| box_mesh(Vec3::new(1.0, 0.1, 0.1), [10 * n, n, n]);
    let options = StaticOptions::default();
    let exact = cantilever(mesh(3).to_quadratic(), 0.3, &options);
    let error = |n| (cantilever(mesh(n), 0.3, &options) - exact).abs();
    let (coarse, fine) = (error(4), error(8));
    assert!((coarse / fine).log2() > 1.7, "{exact} {coarse} {fine}");
}

#[test]
fn rotating_formulations_find_the_linear_answer_under_a_small_follower_pressure() {
    let displacement = |formulation| {
        let settings = Settings { formulation, ..Default::default() };
        let mesh = quarter(4).to_quadratic();
        let mut solid = Solid::new(mesh, vec![Material::hooke(1000.0, 1e9, 0.3)], settings).unwrap();
        solid.fix_components("z_min", [false, false, true]).unwrap();
        solid.fix_components("z_max", [false, false, true]).unwrap();
        solid.fix_components("angle_min", [false, true, false]).unwrap();
        solid.fix_components("angle_max", [true, false, false]).unwrap();
        solid.add_pressure("inner", 1e4).unwrap();
        solid.solve_statics(&StaticOptions { tolerance: 1e-8, ..Default::default() }).unwrap();
        let node = solid.mesh().nodes_of("inner").unwrap()[0];
        solid.state.displacement[node as usize].norm()
    };
    let linear = displacement(Formulation::BodyAttached);
    for formulation in [Formulation::Corotational, Formulation::FiniteStrain] {
        let ratio = displacement(formulation) / linear;
        // Second-order terms are of the size of the strain, 2e-5.
        assert!((ratio - 1.0).abs() < 1e-4, "{formulation:?} {ratio}");
    }
}
