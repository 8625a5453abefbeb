//! A machine on eight driven wheels: thrust against quadrature over its rims, slip of a pull.

use grouser_iscm::equilibrium::{SearchSettings, equilibrium};
use grouser_iscm::shear::{JanosiHanamoto, machine_slip, machine_traction};
use grouser_iscm::verification::{component_vehicle, flat_ground};

const LAW: JanosiHanamoto =
    JanosiHanamoto { cohesion: 2e3, friction_angle: 0.5, shear_deformation_modulus: 0.02 };

#[test]
fn eight_wheels_thrust_as_quadrature_says_and_slip_as_much_as_their_pull_asks() {
    let (machine, terrain) = (component_vehicle(30_000.0, false, 0.0), flat_ground(0.02, 9.0));
    let from = machine.mechanism.at([2.003, 0.0021], 0.0, 0.39);
    let rest = equilibrium(&machine, &terrain, &from, 0.0, &SearchSettings::default()).unwrap();
    let found = machine_traction(&machine, &terrain, &rest, &LAW, 0.2);

    // One wheel on fresh ground, both halves of the rim in contact: midpoint rule over the angle.
    let (r, width, k) = (0.5_f64, 0.5, 1.5e6);
    let z = r - rest.configuration.height;
    let entry = ((r - z) / r).acos();
    let n = 20_000;
    let step = 2.0 * entry / f64::from(n);
    let (mut thrust, mut rim) = (0.0, 0.0);
    for m in 0..n {
        let theta = entry - (f64::from(m) + 0.5) * step;
        let p = k * r * (theta.cos() - entry.cos());
        let j = r * ((entry - theta) - 0.8 * (entry.sin() - theta.sin()));
        let tau = (2e3 + p * 0.5_f64.tan()) * (1.0 - (-j / 0.02).exp());
        thrust += 8.0 * width * r * step * tau * theta.cos();
        rim += 8.0 * width * r * step * tau;
    }
    assert!((found.thrust / thrust - 1.0).abs() < 3e-3, "{} N for {thrust} N", found.thrust);
    let torque: f64 = found.torques.iter().sum();
    assert!((torque / (rim * r) - 1.0).abs() < 3e-3, "{torque} N·m for {} N·m", rim * r);
    assert!(found.lateral_force.abs() < 1e-3 * thrust && found.resistance.abs() < 1e-3 * thrust);

    // Between the pulls at slips of 0.05 and 0.2.
    let pull =
        0.5 * (machine_traction(&machine, &terrain, &rest, &LAW, 0.05).drawbar_pull + found.drawbar_pull);
    let slow = machine_slip(&machine, &terrain, &rest, &LAW, pull).unwrap();
    assert!((slow.drawbar_pull / pull - 1.0).abs() < 1e-6 && slow.slip < 0.2 && slow.slip > 0.05);
    let error = machine_slip(&machine, &terrain, &rest, &LAW, 1e7).unwrap_err();
    assert!(error.to_string().contains("pulls at most"), "{error}");
}
