//! Several materials in one mesh, damping proportional to mass, elements that fold over.

use grouser_fem::{MassKind, Material, Settings, Solid, SolidError, StaticOptions};
use grouser_geometry::{Vec3, box_mesh};

use crate::{elements, irregular_box};

#[test]
fn two_materials_in_series_stretch_like_two_springs() {
    // F = 100 N on 0.01 m²; 0.5 m of 1 GPa and 0.5 m of 0.25 GPa: 5e-6 m + 2e-5 m.
    for (name, mut mesh, volumetric) in elements(&box_mesh(Vec3::new(1.0, 0.1, 0.1), [8, 2, 2])) {
        mesh.region_names = vec!["carcass".to_owned(), "tread".to_owned()];
        for e in 0..mesh.n_elements() {
            let middle = mesh.element_positions(e).iter().take(4).map(|x| x.x).sum::<f64>() / 4.0;
            mesh.region_of_element[e] = u32::from(middle > 0.5);
        }
        let materials = vec![Material::hooke(1000.0, 1e9, 0.0), Material::hooke(1500.0, 0.25e9, 0.0)];
        let settings = Settings { volumetric, ..Default::default() };
        let mut bar = Solid::new(mesh.clone(), materials.clone(), settings).unwrap();
        let mass: f64 = bar.nodal_mass().iter().sum();
        assert!((mass - 12.5).abs() < 1e-9, "{mass}");
        bar.fix("x_min").unwrap();
        bar.add_pressure("x_max", -1e4).unwrap();
        bar.solve_statics(&StaticOptions::default()).unwrap();
        for n in bar.mesh().nodes_of("x_max").unwrap() {
            let u = bar.state.displacement[n as usize];
            assert!((u - Vec3::new(2.5e-5, 0.0, 0.0)).norm() < 1e-9 * 2.5e-5, "{name} {u}");
        }
        assert!(Solid::new(mesh, materials[..1].to_vec(), settings).is_err());
    }
}

#[test]
fn damping_by_mass_slows_a_free_body_exponentially() {
    for mass in [MassKind::Lumped, MassKind::Consistent] {
        let settings = Settings { mass, mass_damping: 20.0, ..Default::default() };
        let mesh = irregular_box([2, 2, 2]);
        let mut body = Solid::new(mesh, vec![Material::hooke(1000.0, 1e6, 0.3)], settings).unwrap();
        body.state.velocity.fill(Vec3::new(2.0, -1.0, 0.5));
        let (dt, start) = (0.02 * body.stable_time_step().dt, body.kinetic_energy());
        while body.state.time < 0.05 {
            body.step(dt).unwrap();
        }
        let expected = start * (-2.0 * 20.0 * body.state.time).exp();
        let energy = body.kinetic_energy();
        // The damping force belongs to the velocity half a step before: first order in α dt.
        assert!((energy / expected - 1.0).abs() < 2.0 * 20.0 * dt, "{mass:?} {energy} {expected}");
        let residual = energy - body.state.ledger.expected_energy();
        assert!(residual.abs() < 20.0 * dt * start, "{mass:?} {residual}");
    }
}

#[test]
fn an_element_that_folds_at_a_corner_works_with_lumped_mass_and_never_panics_with_consistent_mass() {
    let mut mesh = box_mesh(Vec3::repeat(1.0), [1, 1, 1]).to_quadratic();
    let [corner, side] = [mesh.element(2)[0] as usize, mesh.element(2)[4] as usize];
    let middle = mesh.nodes[side];
    let mut share = 0.0;
    // Push the mid-side node towards the corner until the mesh folds but its quadrature points do not.
    while share < 1.0 {
        mesh.nodes[side] = middle + (mesh.nodes[corner] - middle) * share;
        let is_folded = (0..mesh.n_elements()).any(|e| mesh.is_folded(e));
        if is_folded {
            break;
        }
        share += 0.02;
    }
    assert!(share < 1.0 && mesh.validate().is_ok(), "{share}");
    let material = vec![Material::hooke(1000.0, 1e6, 0.3)];
    assert!(Solid::new(mesh.clone(), material.clone(), Settings::default()).is_ok());
    let consistent = Settings { mass: MassKind::Consistent, ..Default::default() };
    match Solid::new(mesh, material, consistent) {
        Ok(solid) => assert!(solid.stable_time_step().dt > 0.0),
        Err(refused) => assert!(matches!(refused, SolidError::Folded { .. }), "{refused}"),
    }
}
