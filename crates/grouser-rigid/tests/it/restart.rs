//! A body written and read back in mid-flight continues with the same bytes.

use grouser_geometry::nalgebra::Matrix3;
use grouser_geometry::{Vec3, Wrench};
use grouser_rigid::{BodySpec, Degree, Freedom, RigidBody, VelocityProfile};

#[test]
fn restarted_body_continues_byte_for_byte() {
    let mut spec = BodySpec::driven(Vec3::new(0.0, 0.1, 0.2));
    spec.mass = 1.5;
    spec.inertia = Matrix3::from_diagonal(&Vec3::new(1.0, 2.0, 3.0));
    spec.motion.spin = Vec3::new(0.3, 2.0, 0.1);
    spec.freedoms = std::array::from_fn(|_| Freedom::Free);
    let spec = spec.with(
        Degree::X,
        Freedom::Prescribed(VelocityProfile::Table { start: 0.1, points: vec![[0.0, 0.0], [0.3, 1.0]] }),
    );
    let step = |body: &mut RigidBody| {
        body.predict(1e-3);
        let m = *body.motion();
        let load = Wrench { force: -m.position * 30.0 - m.velocity, moment: m.position };
        body.correct(&load, 1e-3);
    };
    let mut straight = RigidBody::new(spec).unwrap();
    (0..300).for_each(|_| step(&mut straight));
    let checkpoint = postcard::to_allocvec(&straight).unwrap();
    let mut resumed: RigidBody = postcard::from_bytes(&checkpoint).unwrap();
    (0..300).for_each(|_| step(&mut straight));
    (0..300).for_each(|_| step(&mut resumed));
    assert_eq!(postcard::to_allocvec(&straight).unwrap(), postcard::to_allocvec(&resumed).unwrap());
}
