//! Wrong input is named with its number and remedy.

use grouser_fem::{Formulation, Material, Settings, Solid, StaticOptions, VolumetricTreatment};
use grouser_geometry::{Vec3, box_mesh};

use crate::solid;

fn cube() -> grouser_geometry::TetrahedralMesh {
    box_mesh(Vec3::repeat(1.0), [2, 2, 2])
}

fn refusal(mesh: grouser_geometry::TetrahedralMesh) -> String {
    Solid::new(mesh, vec![Material::hooke(1000.0, 1e9, 0.3)], Settings::default()).err().unwrap().to_string()
}

#[test]
fn inverted_flat_and_unconnected_elements_are_refused_by_number() {
    let mut mesh = cube();
    mesh.connectivity[4 * 7..4 * 8].swap(0, 1);
    assert!(refusal(mesh).contains("first element 7"));
    let mut mesh = cube();
    let second = box_mesh(Vec3::repeat(1.0), [1, 1, 1]);
    let offset = mesh.nodes.len() as u32;
    mesh.nodes.extend(second.nodes.iter().map(|x| x + Vec3::repeat(5.0)));
    mesh.connectivity.extend(second.connectivity.iter().map(|n| n + offset));
    mesh.region_of_element.extend(&second.region_of_element);
    assert!(refusal(mesh).contains("2 unconnected parts (element 48"));
    let mut mesh = cube();
    mesh.connectivity[5] = 1000;
    assert!(refusal(mesh).contains("element 1 names node 1000"));
}

#[test]
fn statics_without_supports_and_inflation_of_an_open_surface_are_refused() {
    let mut free = solid(cube(), Formulation::BodyAttached, VolumetricTreatment::PerElement, 0.3);
    assert!(free.inflate("x_max", 1.0).unwrap_err().to_string().contains("is open"));
    free.fix_components("x_min", [true, false, false]).unwrap();
    let message = free.solve_statics(&StaticOptions::default()).unwrap_err().to_string();
    assert!(message.contains("3 of 6 rigid motions"), "{message}");
    assert!(free.fix("rim").unwrap_err().to_string().contains("x_max"));
}

#[test]
fn an_element_that_turns_inside_out_in_flight_is_named() {
    let mut solid = solid(cube(), Formulation::FiniteStrain, VolumetricTreatment::PerElement, 0.3);
    solid.state.velocity[0] = Vec3::repeat(1e5);
    let dt = 0.9 * solid.stable_time_step().dt;
    let failure = (0..1000).find_map(|_| solid.step(dt).err()).unwrap().to_string();
    assert!(failure.contains("is inverted") && failure.contains("step"), "{failure}");
}

#[test]
fn an_assembled_stiffness_names_an_inverted_element_within_256_steps_and_in_statics() {
    let build = || {
        let mut cube = solid(cube(), Formulation::BodyAttached, VolumetricTreatment::PerElement, 0.3);
        cube.fix("x_min").unwrap();
        cube
    };
    let mut pushed = build();
    let ends = pushed.mesh().nodes_of("x_max").unwrap();
    let dt = 0.9 * pushed.stable_time_step().dt;
    // The cube of 1 m is shorter than nothing after half of the steps.
    for &node in &ends {
        pushed.prescribe(node, 0, 0.0, -1.5 / (128.0 * dt));
    }
    let failure = (0..257).find_map(|_| pushed.step(dt).err()).unwrap().to_string();
    assert!(failure.contains("is inverted") && failure.contains("step 256"), "{failure}");
    let mut pressed = build();
    for &node in &ends {
        pressed.prescribe(node, 0, -1.5, 0.0);
    }
    let failure = pressed.solve_statics(&StaticOptions::default()).unwrap_err().to_string();
    assert!(failure.contains("is inverted"), "{failure}");
}
