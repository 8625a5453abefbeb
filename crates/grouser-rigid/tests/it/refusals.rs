//! Bodies that cannot exist are refused with the cause.

use grouser_geometry::Vec3;
use grouser_geometry::nalgebra::Matrix3;
use grouser_rigid::{BodySpec, Degree, Freedom, RigidBody, RigidError, VelocityProfile};

#[test]
fn free_body_without_mass_or_inertia_is_refused() {
    let spec = BodySpec::driven(Vec3::zeros()).with(Degree::Z, Freedom::Free);
    let message = RigidBody::new(spec).unwrap_err().to_string();
    assert!(message.starts_with("the body is free to move along Z but its mass is 0 kg"), "{message}");

    let mut spec = BodySpec::driven(Vec3::zeros()).with(Degree::AboutY, Freedom::Free);
    spec.inertia = Matrix3::from_diagonal(&Vec3::new(1.0, -2.0, 1.0));
    assert!(matches!(RigidBody::new(spec), Err(RigidError::NoInertia { degree: Degree::AboutY, .. })));
}

#[test]
fn numbers_that_are_not_finite_are_refused_by_name() {
    let mut spec = BodySpec::driven(Vec3::zeros());
    spec.motion.velocity.y = f64::NAN;
    let message = RigidBody::new(spec).unwrap_err().to_string();
    assert!(message.starts_with("velocity of a body is NaN"), "{message}");
    let spec = BodySpec::driven(Vec3::zeros())
        .with(Degree::X, Freedom::Prescribed(VelocityProfile::constant(f64::INFINITY)));
    assert!(RigidBody::new(spec).is_err());
}
