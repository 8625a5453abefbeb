//! Every shape of ground carries a wheel, every law keeps its own value, and influence ends at five standard deviations.

use grouser_geometry::esri_ascii::{read_esri_ascii, write_esri_ascii};
use grouser_geometry::grey_image::read_pgm;
use grouser_geometry::xyz_text::read_xyz;
use grouser_geometry::{HeightGrid, HeightShape, Pose, Vec3};
use grouser_iscm::contact::Integration;
use grouser_iscm::gear::{Foot, Wheel};
use grouser_iscm::polygon::{PartialLoad, SubTriangles};
use grouser_iscm::pressure::*;
use grouser_iscm::terrain::{RigidShape, Terrain, Unloading};

const STIFFNESS: f64 = 1.5e6;

fn soil() -> PressureField {
    let law = PressureLaw::Linear(Linear { stiffness: STIFFNESS });
    PressureField::uniform(PressureArray::new(&law, 0.005, 0.5).unwrap())
}

/// Vertical force \[N\] on a wheel of 0.3 m whose lowest point is 5 cm below `level` \[m\].
fn lift(terrain: Terrain, level: f64) -> f64 {
    let terrain = terrain.with_unloading(Unloading::Plastic { contact_distance: 1e-9 }).unwrap();
    let foot = Foot { body: 0, wheels: vec![Wheel::cylinder(Vec3::zeros(), 0.3, 0.2)], belts: Vec::new() };
    let pose = Pose::translation(0.0, 0.0, level + 0.25);
    let imprint = foot.imprint(&terrain, &pose, 0.0, PartialLoad::Proportional);
    let integration = Integration { sub_triangles: SubTriangles::new(4), partial: PartialLoad::Proportional };
    imprint.load(&terrain, &Pose::identity(), &integration).wrench.force.z
}

fn grid(height: impl FnMut(f64, f64) -> f64) -> HeightGrid {
    HeightGrid::covering([-0.6, -0.4], [1.2, 0.8], 0.01, height).unwrap()
}

/// w K (circular segment) \[N\] at 5 cm.
fn flat() -> f64 {
    let (r, z) = (0.3_f64, 0.05_f64);
    0.2 * STIFFNESS * (r * r * ((r - z) / r).acos() - (r - z) * (2.0 * r * z - z * z).sqrt())
}

#[test]
fn ground_from_files_carries_as_ground_from_shapes() {
    let made = grid(|_, _| 0.35);
    let near = |force: f64| (force / flat() - 1.0).abs() < 2e-3;
    assert!(near(lift(Terrain::new(made.clone(), soil()).unwrap(), 0.35)));
    let esri = read_esri_ascii(write_esri_ascii(&made).as_bytes()).unwrap();
    assert!(near(lift(Terrain::new(esri, soil()).unwrap(), 0.35)));
    let mut text = String::new();
    for j in 0..made.n_y() {
        for i in 0..made.n_x() {
            let [x, y] = made.position(i, j);
            text += &format!("{x:.6} {y:.6} 0.35\n");
        }
    }
    assert!(near(lift(Terrain::new(read_xyz(text.as_bytes()).unwrap(), soil()).unwrap(), 0.35)));
    for (white, bytes) in [(255, vec![128_u8; 121 * 81]), (65_535, vec![128_u8; 2 * 121 * 81])] {
        let mut file = format!("P5\n121 81\n{white}\n").into_bytes();
        file.extend(bytes);
        let image = read_pgm(&file[..]).unwrap();
        let level = f64::from(image.samples[0]) / f64::from(image.white);
        let ground = image.to_heights(0.01, [-0.6, -0.4], 0.0, 1.0).unwrap();
        assert!(near(lift(Terrain::new(ground, soil()).unwrap(), level)), "{white}");
    }
}

#[test]
fn slopes_steps_and_waves_carry_what_integration_in_closed_form_says() {
    // Independent: fine midpoint sums of K (Z₀ − h) over the cylinder's outline.
    let exact = |shapes: &[HeightShape]| {
        let (n, r) = (2000, 0.3_f64);
        let mut sum = 0.0;
        for k in 0..n {
            let x = (k as f64 + 0.5) / n as f64 * 0.6 - 0.3;
            for m in 0..40 {
                let y = (m as f64 + 0.5) / 40.0 * 0.2 - 0.1;
                let underside = 0.25 - (r * r - x * x).sqrt();
                sum += (HeightShape::sum(shapes, x, y) - underside).max(0.0);
            }
        }
        STIFFNESS * sum * 0.6 * 0.2 / (40 * n) as f64
    };
    for shapes in [
        vec![HeightShape::Slope { angle: 0.1, heading: 0.4 }],
        vec![HeightShape::Step { distance: 0.105, height: -0.02, heading: 0.0 }],
        vec![
            HeightShape::Sine { amplitude: 0.02, wavelength: 0.7, heading: 0.3, phase: 1.0 },
            HeightShape::Sine { amplitude: 0.01, wavelength: 0.4, heading: 1.2, phase: 0.2 },
        ],
    ] {
        let ground = grid(|x, y| HeightShape::sum(&shapes, x, y));
        let force = lift(Terrain::new(ground, soil()).unwrap(), 0.0);
        assert!((force / exact(&shapes) - 1.0).abs() < 5e-3, "{shapes:?}: {force} for {}", exact(&shapes));
    }
}

#[test]
fn a_stump_answers_with_a_giga_pascal_a_metre() {
    let mut terrain = Terrain::new(grid(|_, _| 0.0), soil()).unwrap();
    terrain.add_rigid_object([0.0, 0.0], 1.0, 0.0, RigidShape::Stump).unwrap();
    let ratio = lift(terrain, 0.0) / flat();
    assert!((ratio * STIFFNESS / 1e9 - 1.0).abs() < 5e-3, "{ratio}");
}

#[test]
fn every_law_gives_its_published_form() {
    let at = |law: PressureLaw| law.pressure(0.05);
    let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-9, "{a} for {b}");
    // Evaluated by hand from the printed formulas at z = 5 cm.
    close(at(PressureLaw::Linear(Linear { stiffness: 1.5e6 })), 75e3);
    close(at(PressureLaw::Polynomial(Polynomial { coefficients: vec![1e6, 2e6, 4e7] })), 50e3 + 5e3 + 5e3);
    close(at(PressureLaw::Table(Table { points: vec![[0.04, 20e3], [0.06, 50e3]] })), 35e3);
    let wong = Wong { peat_stiffness: 290e3, mat_strength: 51e3, hydraulic_diameter: 0.1 };
    close(at(PressureLaw::Wong(wong)), 14_500.0 + 5_100.0);
    let reece = Reece {
        cohesion: 2e3,
        unit_weight: 16e3,
        cohesive_modulus: 10.0,
        frictional_modulus: 50.0,
        exponent: 0.5,
        plate_width: 0.2,
    };
    close(at(PressureLaw::Reece(reece)), 180e3 * 0.5);
    let bekker =
        Bekker { cohesive_modulus: 10e3, frictional_modulus: 900e3, exponent: 2.0, plate_width: 0.1 };
    close(at(PressureLaw::Bekker(bekker)), 1e6 * 0.0025);
    let small =
        MeirionGriffithSpenko { modulus: 4e6, exponent: 2.0, diameter_exponent: -0.5, diameter: 0.25 };
    close(at(PressureLaw::MeirionGriffithSpenko(small)), 4e6 * 0.0025 * 2.0);
}

#[test]
fn influence_ends_at_five_standard_deviations() {
    let positions = [[0.0, 0.0], [10.0, 0.0]];
    // Beyond 5 c of both nobody rules: equal shares.
    assert_eq!(weights(&positions, [5.0, 0.0], 0.99), [1.0, 1.0]);
    // Within 5 c the factor of the near one is 1 − exp(−d²/2c²).
    let inside = weights(&positions, [4.9, 0.0], 1.0);
    assert!((inside[1] - (1.0 - (-4.9_f64.powi(2) / 2.0).exp())).abs() < 1e-15 && inside[1] < 1.0);
    assert_eq!(weights(&positions, [5.1, 0.0], 1.0)[1], 1.0);
}
