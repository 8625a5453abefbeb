//! Patch test, zero modes, rotation, for every element and formulation.

use grouser_fem::{Formulation, StaticOptions};
use grouser_geometry::Vec3;
use grouser_geometry::nalgebra::{DMatrix, Matrix3, Rotation3};

use crate::{FORMULATIONS, elements, irregular_box, solid};

/// Stress and displacement errors of an irregular patch whose boundary follows u = H X.
fn patch_errors(gradient: Matrix3<f64>, expected: Matrix3<f64>) {
    for (name, mesh, volumetric) in elements(&irregular_box([3, 3, 3])) {
        let mut solid = solid(mesh, Formulation::BodyAttached, volumetric, 0.3);
        let mesh = solid.mesh().clone();
        for facet in mesh.boundary().unwrap() {
            for node in mesh.facet_nodes(facet) {
                let u = gradient * mesh.nodes[node as usize];
                (0..3).for_each(|c| solid.prescribe(node, c, u[c], 0.0));
            }
        }
        solid.solve_statics(&StaticOptions::default()).unwrap();
        for fields in solid.element_fields() {
            assert!((fields.stress - expected).norm() < 1e-10 * expected.norm(), "{name}: {}", fields.stress);
        }
        for (u, x) in solid.state.displacement.iter().zip(&mesh.nodes) {
            assert!((u - gradient * x).norm() < 1e-10 * gradient.norm(), "{name}");
        }
    }
}

#[test]
fn patch_tests_return_the_constant_stress_to_1e_10_for_each_element() {
    // Timoshenko & Goodier: E = 1 GPa, nu = 0.3, strain 1e-3.
    let e = 1e-3;
    patch_errors(
        Matrix3::from_diagonal(&Vec3::new(e, -0.3 * e, -0.3 * e)),
        Matrix3::from_diagonal(&Vec3::new(1e6, 0.0, 0.0)),
    );
    let (normal, lateral) = (1_346_153.846_153_846, 576_923.076_923_077);
    patch_errors(
        Matrix3::from_diagonal(&Vec3::new(e, 0.0, 0.0)),
        Matrix3::from_diagonal(&Vec3::new(normal, lateral, lateral)),
    );
    let mut shear = Matrix3::zeros();
    shear[(0, 1)] = e;
    let mut stress = Matrix3::zeros();
    (stress[(0, 1)], stress[(1, 0)]) = (384_615.384_615_384_6, 384_615.384_615_384_6);
    patch_errors(shear, stress);
}

#[test]
fn stiffness_has_six_zero_modes_and_is_positive_otherwise_up_to_a_poissons_ratio_of_0_499() {
    for nu in [0.0, 0.3, 0.45, 0.499] {
        for (name, mesh, volumetric) in elements(&irregular_box([1, 2, 2])) {
            for formulation in FORMULATIONS {
                let k = solid(mesh.clone(), formulation, volumetric, nu).stiffness();
                let mut dense = DMatrix::zeros(3 * k.n_rows(), 3 * k.n_rows());
                for i in 0..k.n_rows() {
                    for (j, block) in k.row(i) {
                        dense.fixed_view_mut::<3, 3>(3 * i, 3 * j).copy_from(block);
                    }
                }
                assert!((&dense - dense.transpose()).norm() < 1e-12 * dense.norm());
                let mut eigenvalues: Vec<f64> = dense.symmetric_eigenvalues().iter().copied().collect();
                eigenvalues.sort_by(f64::total_cmp);
                let largest = eigenvalues[eigenvalues.len() - 1];
                assert!(eigenvalues[..6].iter().all(|l| l.abs() < 1e-12 * largest), "{name} {nu}");
                assert!(eigenvalues[6] > 1e-6 * largest, "{name} {nu} {:e}", eigenvalues[6] / largest);
            }
        }
    }
}

#[test]
fn a_quarter_turn_is_free_of_strain_and_force_where_the_formulation_rotates() {
    let turn = Rotation3::from_axis_angle(&Vec3::z_axis(), std::f64::consts::FRAC_PI_2).into_inner();
    for (name, mesh, volumetric) in elements(&irregular_box([2, 2, 2])) {
        for formulation in FORMULATIONS {
            let mut solid = solid(mesh.clone(), formulation, volumetric, 0.45);
            for (u, x) in solid.state.displacement.iter_mut().zip(&mesh.nodes) {
                *u = turn * x - x;
            }
            let strain = solid.element_fields().iter().map(|f| f.strain.norm()).fold(0.0, f64::max);
            solid.step(1e-12).unwrap_or(());
            let acceleration = solid.state.acceleration.iter().map(Vec3::norm).fold(0.0, f64::max);
            if formulation == Formulation::BodyAttached {
                assert!(strain > 0.5, "small strains must not be able to rotate");
            } else {
                assert!(strain < 1e-14 * 100.0, "{name} {formulation:?} {strain:e}");
                // c^2 / h = 1e7 m/s^2 per unit of strain
                assert!(acceleration < 1e-12 * 1e8, "{name} {formulation:?} {acceleration:e}");
            }
        }
    }
}

#[test]
fn the_blocked_kernel_and_the_tangent_agree_by_central_differences_of_the_energy() {
    for (name, mesh, volumetric) in elements(&irregular_box([2, 2, 2])) {
        for formulation in FORMULATIONS {
            let mut solid = solid(mesh.clone(), formulation, volumetric, 0.45);
            for (u, x) in solid.state.displacement.iter_mut().zip(&mesh.nodes) {
                *u = 0.05 * Vec3::new((3.0 * x.y).sin(), x.z * x.x, (2.0 * x.x).cos());
            }
            let start = solid.state.displacement.clone();
            // The forces by the blocked kernel: mass times acceleration of the first step of length zero.
            solid.step(0.0).unwrap();
            let force: Vec<Vec3> =
                solid.state.acceleration.iter().zip(solid.nodal_mass()).map(|(a, m)| a * *m).collect();
            let direction: Vec<Vec3> =
                mesh.nodes.iter().map(|x| Vec3::new(x.z, (5.0 * x.x).cos(), x.y)).collect();
            let mut energy = |d: f64| {
                for ((u, s), v) in solid.state.displacement.iter_mut().zip(&start).zip(&direction) {
                    *u = s + v * d;
                }
                solid.strain_energy()
            };
            let h = 1e-5;
            let slope = (energy(h) - energy(-h)) / (2.0 * h);
            let power: f64 = force.iter().zip(&direction).map(|(f, v)| f.dot(v)).sum();
            assert!((slope + power).abs() < 1e-6 * slope.abs(), "{name} {formulation:?}: {slope} {power}");
        }
    }
}
