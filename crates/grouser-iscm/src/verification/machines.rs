//! The machines and grounds of the published tests.

use grouser_geometry::{HeightGrid, Vec3};

use crate::gear::{Belt, Shoe, ShoeShape, WheelShape};
use crate::machine::Machine;
use crate::pressure::{Linear, PressureArray, PressureField, PressureLaw};
use crate::terrain::Terrain;
use crate::vehicle::{Articulation, Axle, Component, vehicle};

/// Flat ground of 1.5 MPa/m with nodes `spacing` \[m\] apart, `length` \[m\] along x.
pub fn flat_ground(spacing: f64, length: f64) -> Terrain {
    let grid = HeightGrid::covering([-length / 2.0, -2.0], [length, 4.0], spacing, |_, _| 0.0);
    let law = PressureLaw::Linear(Linear { stiffness: 1.5e6 });
    let array = PressureArray::new(&law, 0.005, 0.5).expect("a linear law has an array");
    Terrain::new(grid.expect("a flat grid"), PressureField::uniform(array)).expect("uniform ground")
}

/// Vehicle of P2 tests 12 (wheels) and 16 (tracks): two frames of equal mass, a roll joint, four bogies.
///
/// Wheels r = w = 0.5 m, bogie lever 0.75 m; masses in kg. `lateral` shifts the centres of mass to the left \[m\].
pub fn component_vehicle(mass: f64, has_tracks: bool, lateral: f64) -> Machine {
    let shape = ShoeShape::Band { width: 0.6, depth: 0.02, n_pieces: 12 };
    let shoe = Shoe { mass: 10.0, shape };
    let belt =
        Belt { wheels: vec![0, 1], link_offset: 0.0, n_shoes: 60, pitch: 0.102_360, shoe, joints: None };
    let bogie_mass = if has_tracks { 1200.0 } else { 600.0 };
    let axle = Axle {
        along: 0.0,
        height: 0.0,
        half_track: 1.0,
        lever: 0.75,
        mass: bogie_mass,
        max_angle: 0.6,
        radius: 0.5,
        shape: WheelShape::Cylinder { width: 0.5 },
        belts: if has_tracks { vec![belt] } else { Vec::new() },
    };
    let frame = |name: &str| Component {
        name: name.into(),
        mass: mass / 2.0 - 2.0 * bogie_mass,
        centre_of_mass: Vec3::new(0.0, lateral, 0.3),
        axles: vec![axle.clone()],
    };
    let joint = Articulation {
        position: Vec3::new(-2.0, 0.0, 0.0),
        offset: 2.0,
        max_roll: Some(0.3),
        is_steered: false,
    };
    vehicle(&[frame("front"), frame("rear")], &[joint]).expect("the test vehicle is sound")
}
