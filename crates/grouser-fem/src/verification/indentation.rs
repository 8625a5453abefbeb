//! Hertz: a rigid sphere pressed without friction into an elastic half space.

use std::f64::consts::PI;

use grouser_geometry::{Lattice, Vec3};

use super::{Row, VerificationError, order_row};
use crate::{LinearSolver, Material, Settings, Solid, StaticOptions, VolumetricTreatment};

/// Sphere and half space of `hertz_rigid_sphere`: radius [m], Young's modulus [Pa], Poisson's ratio, force [N].
const RADIUS: f64 = 0.01;
const YOUNG_MODULUS: f64 = 1e9;
const POISSON_RATIO: f64 = 0.3;
const FORCE: f64 = 100.0;

/// Force at Hertz's indentation for two meshes, and how fast it converges.
pub(super) fn rows() -> Result<Vec<Row>, VerificationError> {
    let mut rows = Vec::new();
    for (name, volumetric) in [
        ("four nodes", VolumetricTreatment::PerElement),
        ("four nodes, averaged pressure", VolumetricTreatment::NodalAverage),
    ] {
        let case = format!("rigid sphere on a half space, {name}");
        // Nodes come into contact one by one: coarser pairs scatter by 0.2 about the order.
        let (coarse, fine) = (force(16, volumetric)?, force(24, volumetric)?);
        rows.push(order_row(case.clone(), super::order(coarse - FORCE, fine - FORCE, 1.5), 2.0));
        rows.push(Row {
            case,
            quantity: "force at an indentation of 77.5 µm, 24 cells a side".to_owned(),
            computed: fine,
            reference: FORCE,
            tolerance: 0.03 * FORCE,
            unit: "N",
            source: "Johnson, Contact Mechanics: δ = (3F/(4 E* √R))^(2/3)",
        });
    }
    Ok(rows)
}

/// Force [N] that presses the sphere in by Hertz's indentation, by a quarter of a block of `n`³ cells.
///
/// The far sides move as under a point force (Boussinesq), which leaves an error of (a/L)³; nodes touch or not by an
/// active set: those that are pulled are let go, those that have passed the sphere are held on it.
fn force(n: usize, volumetric: VolumetricTreatment) -> Result<f64, VerificationError> {
    let plane_modulus = YOUNG_MODULUS / (1.0 - POISSON_RATIO * POISSON_RATIO);
    let indentation = (3.0 * FORCE / (4.0 * plane_modulus * RADIUS.sqrt())).powf(2.0 / 3.0);
    let contact_radius = (RADIUS * indentation).sqrt();
    // Cells grow from the contact outwards to L = 16 a.
    let (side, growth) = (16.0 * contact_radius, 5.0f64);
    let at = |k: usize| side * (growth * k as f64 / n as f64).sinh() / growth.sinh();
    let map = |p: [usize; 3]| Vec3::new(at(p[0]), at(p[1]), -at(n - p[2]));
    let mesh = Lattice { cells: [n; 3], is_closed: false }.mesh(|_| true, map);
    let settings = Settings { volumetric, ..Default::default() };
    let material = Material::hooke(1000.0, YOUNG_MODULUS, POISSON_RATIO);
    let mut block = Solid::new(mesh, vec![material], settings)?;
    block.fix_components("first_min", [true, false, false])?;
    block.fix_components("second_min", [false, true, false])?;
    for far in ["first_max", "second_max", "third_min"] {
        for node in block.mesh().nodes_of(far)? {
            let u = boussinesq(&block.mesh().nodes[node as usize], FORCE, YOUNG_MODULUS, POISSON_RATIO);
            (0..3).for_each(|c| block.prescribe(node, c, u[c], 0.0));
        }
    }
    let top = block.mesh().nodes_of("third_max")?;
    let sphere = |block: &Solid, node: u32| {
        let x = block.mesh().nodes[node as usize];
        (x.x * x.x + x.y * x.y) / (2.0 * RADIUS) - indentation
    };
    let candidates: Vec<u32> =
        top.into_iter().filter(|&n| block.mesh().nodes[n as usize].norm() < 4.0 * contact_radius).collect();
    let mut touching: Vec<bool> =
        candidates.iter().map(|&n| block.mesh().nodes[n as usize].norm() < contact_radius).collect();
    let options = StaticOptions { solver: LinearSolver::ConjugateGradients, ..Default::default() };
    for _ in 0..20 {
        for (&node, &touches) in candidates.iter().zip(&touching) {
            if touches {
                block.prescribe(node, 2, sphere(&block, node), 0.0);
            } else {
                block.release(node, 2);
            }
        }
        block.solve_statics(&options)?;
        let pressed: Vec<f64> = candidates.iter().map(|&n| -reaction(&block, n)).collect();
        let next: Vec<bool> = candidates
            .iter()
            .zip(&touching)
            .zip(&pressed)
            .map(|((&node, &touches), &pressed)| {
                let lies_above = block.state.displacement[node as usize].z > sphere(&block, node);
                if touches { pressed > 0.0 } else { lies_above }
            })
            .collect();
        if next == touching {
            return Ok(4.0 * pressed.iter().sum::<f64>());
        }
        touching = next;
    }
    Err("the contact of the sphere does not settle".into())
}

/// Force along z that the support of a node exerts [N]; 0 without support.
fn reaction(block: &Solid, node: u32) -> f64 {
    let place = block.supports().keys().position(|&n| n == node);
    place.map_or(0.0, |k| block.state.reaction[k].z)
}

/// Displacement [m] of `x` [m] in the half-space z < 0 under a point force [N] at the origin that points down; Young's modulus [Pa] and
/// Poisson's ratio [-]. Boussinesq 1885; Johnson section 3.2.
pub fn boussinesq(x: &Vec3, force: f64, young_modulus: f64, poisson_ratio: f64) -> Vec3 {
    let shear_modulus = young_modulus / (2.0 * (1.0 + poisson_ratio));
    let (r, depth) = (x.x.hypot(x.y), -x.z);
    let distance = r.hypot(depth);
    let scale = force / (4.0 * PI * shear_modulus);
    // Per unit of r.
    let radial =
        scale * (depth / distance.powi(3) - (1.0 - 2.0 * poisson_ratio) / (distance * (distance + depth)));
    let down = scale * (depth * depth / distance.powi(3) + 2.0 * (1.0 - poisson_ratio) / distance);
    Vec3::new(radial * x.x, radial * x.y, -down)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coarse_blocks_come_closer_to_hertz_with_each_refinement() {
        let errors = [6, 9, 12].map(|n| force(n, VolumetricTreatment::NodalAverage).unwrap() / FORCE - 1.0);
        assert!(
            errors[2].abs() < 0.1 && errors.windows(2).all(|e| e[1].abs() < 0.7 * e[0].abs()),
            "{errors:?}"
        );
    }
}
