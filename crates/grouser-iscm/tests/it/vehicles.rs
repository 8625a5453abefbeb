//! The machines of the published test cases.

use grouser_geometry::{HeightGrid, Vec3};
use grouser_iscm::gear::{Belt, Foot, Shoe, ShoeShape, Wheel};
use grouser_iscm::machine::Machine;
use grouser_iscm::mechanism::{Body, Joint, Mechanism};
use grouser_iscm::pressure::{Linear, PressureArray, PressureField, PressureLaw};
use grouser_iscm::terrain::Terrain;

pub fn flat(spacing: f64, length: f64) -> Terrain {
    let grid = HeightGrid::covering([-length / 2.0, -2.0], [length, 4.0], spacing, |_, _| 0.0).unwrap();
    let law = PressureLaw::Linear(Linear { stiffness: 1.5e6 });
    Terrain::new(grid, PressureField::uniform(PressureArray::new(&law, 0.005, 0.5).unwrap())).unwrap()
}

/// P2 tests 12 and 16: two components joined by a roll joint, each on two bogies of two wheels.
pub fn component_vehicle(mass: f64, band: bool) -> Machine {
    let bogie_mass = 600.0;
    let body = |name: &str, parent, attachment, joint, mass| Body {
        name: name.into(),
        parent,
        attachment,
        joint,
        mass,
        centre_of_mass: Vec3::zeros(),
    };
    let free = |axis| Joint::Free { axis, limits: [-0.6, 0.6] };
    let component = (mass - 4.0 * bogie_mass) / 2.0;
    let mut bodies = vec![
        body("front", None, Vec3::zeros(), free(Vec3::x()), component),
        body("rear", Some(0), Vec3::new(-4.0, 0.0, 0.0), free(Vec3::x()), component),
    ];
    let mut feet = Vec::new();
    for (parent, name) in ["front", "rear"].into_iter().enumerate() {
        for (side, y) in [("left", 1.0), ("right", -1.0)] {
            feet.push(Foot {
                body: bodies.len(),
                wheels: [-0.75, 0.75].map(|x| Wheel::cylinder(Vec3::new(x, 0.0, 0.0), 0.5, 0.5)).to_vec(),
                belts: if band { vec![test_band()] } else { vec![] },
            });
            let attachment = Vec3::new(0.0, y, 0.0);
            bodies.push(body(
                &format!("{name} {side} bogie"),
                Some(parent),
                attachment,
                free(Vec3::y()),
                bogie_mass,
            ));
        }
    }
    Machine::new(Mechanism::new(bodies).unwrap(), feet).unwrap()
}

fn test_band() -> Belt {
    let shape = ShoeShape::Band { width: 0.6, depth: 0.02, n_pieces: 12 };
    let (n_shoes, pitch) = (60, 0.102_360);
    Belt {
        wheels: vec![0, 1],
        link_offset: 0.0,
        n_shoes,
        pitch,
        shoe: Shoe { mass: 10.0, shape },
        joints: None,
    }
}
