//! Carried nodes, turning frames, momentum and the ledger.

use grouser_fem::{Formulation, MassKind, Material, Settings, Solid, VolumetricTreatment};
use grouser_geometry::nalgebra::{Isometry3, Translation3, UnitQuaternion};
use grouser_geometry::{Vec3, box_mesh, hollow_cylinder};

use crate::{elements, irregular_box, solid};

#[test]
fn a_carried_face_takes_a_soft_bar_with_it_and_the_ledger_closes() {
    for formulation in [Formulation::Corotational, Formulation::FiniteStrain] {
        let settings =
            Settings { formulation, stiffness_damping: 2e-4, mass_damping: 2.0, ..Default::default() };
        let mesh = box_mesh(Vec3::new(0.4, 0.1, 0.1), [8, 2, 2]);
        let mut bar = Solid::new(mesh, vec![Material::hooke(1000.0, 1e7, 0.3)], settings).unwrap();
        bar.loads.gravity = Vec3::new(0.0, 0.0, -9.81);
        bar.fix("x_min").unwrap();
        let nodes = bar.mesh().nodes_of("x_min").unwrap();
        let dt = 0.8 * bar.stable_time_step().dt;
        let pose = |t: f64| {
            let turn = UnitQuaternion::from_scaled_axis(Vec3::y() * (6.0 * t * t));
            Isometry3::from_parts(Translation3::new(0.0, 0.5 * t, 0.0), turn)
        };
        while bar.state.time < 0.4 {
            bar.carry(&nodes, &pose(bar.state.time + dt), dt);
            bar.step(dt).unwrap();
        }
        let end = pose(bar.state.time)
            * grouser_geometry::nalgebra::Point3::from(bar.mesh().nodes[nodes[3] as usize]);
        assert!((bar.position(nodes[3]) - end.coords).norm() < 1e-12);
        let ledger = bar.state.ledger;
        let residual = bar.kinetic_energy() + bar.strain_energy() - ledger.expected_energy();
        assert!(
            ledger.stiffness_damping > 0.0 && ledger.mass_damping > 0.0 && ledger.support_work.abs() > 0.1,
            "{ledger:?}"
        );
        assert!(residual.abs() < 1e-3 * ledger.throughput, "{formulation:?} {residual} {ledger:?}");
    }
}

#[test]
fn what_rests_in_the_world_circles_in_a_turning_frame() {
    // In a frame that turns at w, a body at rest in the world moves with -w x (X + u): a circle of constant radius.
    for (name, mesh, volumetric) in elements(&irregular_box([2, 2, 2])) {
        for mass in [MassKind::Lumped, MassKind::Consistent] {
            let settings =
                Settings { formulation: Formulation::Corotational, volumetric, mass, ..Default::default() };
            let mut body =
                Solid::new(mesh.clone(), vec![Material::hooke(1000.0, 1e6, 0.3)], settings).unwrap();
            let (w, rate) = (Vec3::new(3.0, 10.0, 20.0), Vec3::zeros());
            body.loads.spin.angular_velocity = w;
            body.loads.spin.angular_acceleration = rate;
            for (v, x) in body.state.velocity.iter_mut().zip(&mesh.nodes) {
                *v = -w.cross(x);
            }
            let dt = 0.05 * body.stable_time_step().dt;
            while body.state.time < 0.05 {
                body.step(dt).unwrap();
            }
            let back = UnitQuaternion::from_scaled_axis(-w * body.state.time);
            for n in 0..mesh.nodes.len() {
                let error = (body.position(n as u32) - back * mesh.nodes[n]).norm();
                assert!(error < 2e-5, "{name} {mass:?} {error:e}");
            }
        }
    }
}

#[test]
fn a_turning_ring_widens_as_the_closed_form_says() {
    // Timoshenko & Goodier: plane strain ring of E, nu: u(r) with E' = E/(1 - nu^2), nu' = nu/(1 - nu):
    // u = rho w^2 r / (8 E') (3 + nu')(1 - nu') (a^2 + b^2 + (1 + nu')/(1 - nu') a^2 b^2 / r^2 - (1 + nu')/(3 + nu') r^2)
    let (a, b, e, nu, rho, w) = (0.1, 0.2, 1e9, 0.3, 1000.0, 100.0);
    let (plane, ratio) = (e / (1.0 - nu * nu), nu / (1.0 - nu));
    let displacement = |r: f64| {
        let sum = a * a + b * b + (1.0 + ratio) / (1.0 - ratio) * a * a * b * b / (r * r)
            - (1.0 + ratio) / (3.0 + ratio) * r * r;
        rho * w * w * r / (8.0 * plane) * (3.0 + ratio) * (1.0 - ratio) * sum
    };
    for formulation in crate::FORMULATIONS {
        let mesh = hollow_cylinder(a, b, 0.02, std::f64::consts::FRAC_PI_2, [3, 24, 1]).to_quadratic();
        let settings = Settings { formulation, ..Default::default() };
        let mut ring = Solid::new(mesh, vec![Material::hooke(rho, e, nu)], settings).unwrap();
        for (side, held) in [
            ("z_min", [false, false, true]),
            ("z_max", [false, false, true]),
            ("angle_min", [false, true, false]),
            ("angle_max", [true, false, false]),
        ] {
            ring.fix_components(side, held).unwrap();
        }
        ring.loads.spin.angular_velocity = Vec3::new(0.0, 0.0, w);
        ring.solve_statics(&Default::default()).unwrap();
        for (side, r) in [("inner", a), ("outer", b)] {
            let nodes = ring.mesh().nodes_of(side).unwrap();
            let mean = nodes
                .iter()
                .map(|&n| ring.position(n).xy().norm() - ring.mesh().nodes[n as usize].xy().norm());
            let computed = mean.sum::<f64>() / nodes.len() as f64;
            assert!((computed / displacement(r) - 1.0).abs() < 2e-3, "{formulation:?} {side} {computed:e}");
        }
    }
}

#[test]
fn reactions_balance_every_load_in_force_and_moment() {
    for formulation in crate::FORMULATIONS {
        let mut block = solid(irregular_box([2, 2, 2]), formulation, VolumetricTreatment::NodalAverage, 0.45);
        block.fix("x_min").unwrap();
        block.add_pressure("x_max", 1e5).unwrap();
        block.state.applied[5] = Vec3::new(300.0, 200.0, -50.0);
        block.solve_statics(&Default::default()).unwrap();
        let attached = formulation == Formulation::BodyAttached;
        let place = |n: usize| if attached { block.mesh().nodes[n] } else { block.position(n as u32) };
        let at = Vec3::new(0.3, 0.1, 0.2);
        let reaction = block.reaction_on("x_min", &at).unwrap();
        // Follower pressure of the whole closed surface part, by the area vectors of its corners.
        let (mut force, mut moment) =
            (block.state.applied[5], (place(5) - at).cross(&block.state.applied[5]));
        for &facet in block.mesh().facets("x_max").unwrap() {
            let [p, q, r] = block.mesh().facet_corners(facet).map(|n| place(n as usize));
            let f = -1e5 * (q - p).cross(&(r - p)) / 2.0;
            force += f;
            moment += ((p + q + r) / 3.0 - at).cross(&f);
        }
        assert!((reaction.force + force).norm() < 1e-8 * 1e5, "{formulation:?}");
        assert!((reaction.moment + moment).norm() < 1e-8 * 1e5, "{formulation:?}");
    }
}
