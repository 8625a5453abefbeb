//! The machines and grounds of the published tests.

use grouser_geometry::{HeightGrid, Vec3};

use crate::gear::{Belt, Fit, Foot, Shoe, ShoeShape, Wheel, WheelShape};
use crate::machine::Machine;
use crate::mechanism::{Body, Joint, Mechanism};
use crate::pressure::{Linear, PressureArray, PressureField, PressureLaw};
use crate::terrain::Terrain;
use crate::vehicle::{Articulation, Axle, Component, vehicle};

/// Flat ground of 1.5 MPa/m with nodes `spacing` \[m\] apart, `length` \[m\] along x.
pub fn flat_ground(spacing: f64, length: f64) -> Terrain {
    ground(spacing, [-length / 2.0, -2.0], [length, 4.0], |_, _| 0.0)
}

/// The same soil on a plane that rises by `slope` per metre along x.
pub(super) fn sloped_ground(spacing: f64, slope: f64) -> Terrain {
    ground(spacing, [-4.5, -2.0], [9.0, 4.0], |x, _| slope * x)
}

/// Soil of 1.5 MPa/m from `corner` \[m\] over `size` \[m\] with heights as given.
pub(super) fn ground(
    spacing: f64,
    corner: [f64; 2],
    size: [f64; 2],
    height: impl Fn(f64, f64) -> f64,
) -> Terrain {
    let grid = HeightGrid::covering(corner, size, spacing, height);
    let law = PressureLaw::Linear(Linear { stiffness: 1.5e6 });
    let array = PressureArray::new(&law, 0.005, 0.5).expect("a linear law has an array");
    Terrain::new(grid.expect("a flat grid"), PressureField::uniform(array)).expect("uniform ground")
}

/// Vehicle of P2 tests 12 (wheels) and 16 (tracks): two frames of equal mass, a roll joint, four bogies.
///
/// Wheels r = w = 0.5 m, bogie lever 0.75 m; masses in kg. `lateral` shifts the centres of mass to the left \[m\].
pub fn component_vehicle(mass: f64, has_tracks: bool, lateral: f64) -> Machine {
    component_vehicle_with(mass, has_tracks, Vec3::new(0.0, lateral, 0.3))
}

/// The track of P2 test 16 with shoes of `mass` \[kg\]: 60 shoes tight around wheels 0.75 m before and behind the pivot.
fn band_track(mass: f64) -> Belt {
    let shape = ShoeShape::Band { width: 0.6, depth: 0.02, n_pieces: 12 };
    let shoe = Shoe { mass, shape };
    Belt { wheels: vec![0, 1], link_offset: 0.0, n_shoes: 60, pitch: 0.102_360, shoe, fit: Fit::Tight }
}

/// A bogie for itself, `mass` \[kg\] on its pivot; with shoes of a given mass it has a track.
pub(super) fn bogie(mass: f64, shoe_mass: Option<f64>) -> Machine {
    let body = Body {
        name: "bogie".into(),
        parent: None,
        attachment: Vec3::zeros(),
        joint: Joint::Held { axis: Vec3::y() },
        mass,
        centre_of_mass: Vec3::zeros(),
    };
    let wheels = [-0.75, 0.75].map(|x| Wheel::cylinder(Vec3::new(x, 0.0, 0.0), 0.5, 0.5)).to_vec();
    let foot = Foot { body: 0, wheels, belts: shoe_mass.map(band_track).into_iter().collect() };
    Machine::new(Mechanism::new(vec![body]).expect("one body"), vec![foot]).expect("sound gear")
}

/// The same with the frames' centres of mass at `centre` \[m\].
pub(super) fn component_vehicle_with(mass: f64, has_tracks: bool, centre: Vec3) -> Machine {
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
        belts: if has_tracks { vec![band_track(10.0)] } else { Vec::new() },
    };
    let frame = |name: &str| Component {
        name: name.into(),
        mass: mass / 2.0 - 2.0 * bogie_mass,
        centre_of_mass: centre,
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
