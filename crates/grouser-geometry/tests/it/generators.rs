//! Areas, volumes and inertias of generated shapes against closed forms.

use std::f64::consts::{PI, TAU};

use approx::assert_relative_eq;
use grouser_geometry::generate::{
    GrouseredWheel, ShapeError, cone, cuboid, cylinder, disc_plate, grousered_wheel, icosphere, plane,
};
use grouser_geometry::mesh_doctor::{Closedness, examine};
use grouser_geometry::nalgebra::Matrix3;
use grouser_geometry::{TriangleSurface, Vec3};

/// Area of the regular polygon of n sides inside a circle of radius r.
fn polygon(n: usize, r: f64) -> f64 {
    n as f64 / 2.0 * r * r * (TAU / n as f64).sin()
}

fn assert_sound(surface: &TriangleSurface, closedness: Closedness) {
    assert_eq!(examine(surface, closedness), []);
}

#[test]
fn box_has_the_volume_inertia_and_centre_of_the_textbook() {
    let surface = cuboid(Vec3::new(1.0, 2.0, 3.0)).unwrap();
    assert_sound(&surface, Closedness::Required);
    let solid = surface.solid_properties();
    assert_relative_eq!(solid.volume, 6.0, epsilon = 1e-14);
    assert_relative_eq!(solid.centroid, Vec3::new(0.0, 0.0, 1.5), epsilon = 1e-14);
    let inertia = Vec3::new(4.0 + 9.0, 1.0 + 9.0, 1.0 + 4.0) * 6.0 / 12.0;
    assert_relative_eq!(solid.inertia, Matrix3::from_diagonal(&inertia), epsilon = 1e-13);
}

#[test]
fn prism_and_pyramid_volumes_are_those_of_the_inscribed_polygon() {
    for n in [3, 10, 64] {
        let plate = disc_plate(0.04, 0.01, n).unwrap();
        assert_sound(&plate, Closedness::Required);
        assert_relative_eq!(plate.volume(), polygon(n, 0.04) * 0.01, max_relative = 1e-12);
        let penetrometer = cone(0.016, 0.06, n).unwrap();
        assert_sound(&penetrometer, Closedness::Required);
        assert_relative_eq!(penetrometer.volume(), polygon(n, 0.016) * 0.02, max_relative = 1e-12);
        assert_relative_eq!(penetrometer.solid_properties().centroid.z, 0.045, max_relative = 1e-12);
    }
    let drum = cylinder(0.5, 2.0, 1000).unwrap().solid_properties();
    assert_relative_eq!(drum.inertia[(2, 2)] / drum.volume, 0.125, max_relative = 1e-4);
    assert_relative_eq!(drum.inertia[(0, 0)] / drum.volume, 0.0625 + 4.0 / 12.0, max_relative = 1e-4);
}

#[test]
fn plane_keeps_its_area_and_faces_up_however_it_is_cut() {
    for (n, m) in [(1, 1), (7, 3), (50, 100)] {
        let sheet = plane(2.0, 0.5, n, m).unwrap();
        assert_sound(&sheet, Closedness::Optional);
        assert_eq!(sheet.triangles.len(), 2 * n * m);
        assert_relative_eq!(sheet.area(), 1.0, max_relative = 1e-12);
        assert!((0..sheet.triangles.len()).all(|t| sheet.normal(t) == Vec3::z()));
    }
}

#[test]
fn sphere_converges_to_volume_and_area_at_second_order_in_edge_length() {
    let errors: Vec<f64> = (2..6)
        .map(|n| {
            let sphere = icosphere(2.0, n).unwrap();
            assert_sound(&sphere, Closedness::Required);
            assert_eq!(sphere.triangles.len(), 20 * 4usize.pow(n as u32));
            1.0 - sphere.volume() / (4.0 / 3.0 * PI * 8.0)
        })
        .collect();
    assert!(errors.windows(2).all(|e| (e[0] / e[1] - 4.0).abs() < 0.1), "{errors:?}");
}

#[test]
fn wheel_is_rim_polygon_plus_rectangular_grousers() {
    let wheel = GrouseredWheel {
        radius: 0.125,
        width: 0.1,
        n_grousers: 12,
        grouser_height: 0.01,
        grouser_thickness: 0.003,
        n_rim_segments: 5,
    };
    let surface = grousered_wheel(&wheel).unwrap();
    assert_sound(&surface, Closedness::Required);
    // Rim: chords of 12 grousers and of 60 rim pieces; a grouser stands on the chord of its own thickness.
    let grouser_angle = 2.0 * f64::asin(0.0015 / 0.125);
    let rim_angle = (TAU / 12.0 - grouser_angle) / 5.0;
    let triangle = |angle: f64| 0.125f64.powi(2) * angle.sin() / 2.0;
    let standing = 0.135 - (0.125f64.powi(2) - 0.0015f64.powi(2)).sqrt();
    let section = 12.0 * (triangle(grouser_angle) + 5.0 * triangle(rim_angle) + standing * 0.003);
    assert_relative_eq!(surface.volume(), section * 0.1, max_relative = 1e-12);
    assert_relative_eq!(surface.bounding_box().max.x, 0.135, max_relative = 1e-15);
    assert_relative_eq!(surface.solid_properties().centroid, Vec3::zeros(), epsilon = 1e-15);

    let smooth = grousered_wheel(&GrouseredWheel { n_grousers: 0, n_rim_segments: 90, ..wheel }).unwrap();
    assert_sound(&smooth, Closedness::Required);
    assert_relative_eq!(smooth.volume(), polygon(90, 0.125) * 0.1, max_relative = 1e-12);
}

#[test]
fn impossible_shapes_are_refused_with_the_name_of_the_measure() {
    assert_eq!(
        cylinder(-0.1, 1.0, 20).unwrap_err().to_string(),
        "cylinder: radius is -0.1 m, expected a finite length above zero; usual cause: a forgotten key or a wrong unit; \
         remedy: give it in metres"
    );
    assert!(disc_plate(0.1, f64::NAN, 20).unwrap_err().to_string().contains("thickness is NaN m"));
    assert!(cone(0.1, 0.1, 2).unwrap_err().to_string().contains("number of sides is 2, expected 3 to"));
    assert!(matches!(icosphere(1.0, 40), Err(ShapeError::Count { value: 40, .. })));
    let crowded = GrouseredWheel {
        radius: 0.125,
        width: 0.1,
        n_grousers: 12,
        grouser_height: 0.01,
        grouser_thickness: 0.07,
        n_rim_segments: 4,
    };
    assert!(grousered_wheel(&crowded).unwrap_err().to_string().contains("12 grousers of 0.07 m need"));
}
