//! Beds that make no sense, and motion that has become meaningless.

use crate::*;

fn bed_of(spheres: Vec<Sphere>, settings: BedSettings) -> Result<Bed<HertzMindlin>, BedError> {
    Bed::new(spheres, settings, table(0.5, 0.5, Tail::CutCorrected), HertzMindlin::new(Tail::CutCorrected))
}

#[test]
fn an_empty_bed_is_refused() {
    assert_eq!(bed_of(Vec::new(), empty_space()).unwrap_err(), BedError::Empty);
}

#[test]
fn a_grain_without_size_and_a_short_period_are_refused() {
    let mut spheres = head_on(0.0, 0.1);
    spheres[1].radius = -1.0;
    assert!(matches!(bed_of(spheres, empty_space()).unwrap_err(), BedError::Grain { grain: 1, .. }));
    let mut settings = empty_space();
    settings.domain = Domain { lower: Vec3::zeros(), upper: Vec3::repeat(0.05), is_periodic: [true; 3] };
    assert!(matches!(bed_of(head_on(0.0, 0.1), settings).unwrap_err(), BedError::Period { axis: 0, .. }));
}

#[test]
fn a_nan_in_flight_names_its_grain() {
    let mut bed = bed_of(head_on(0.0, 0.1), empty_space()).unwrap();
    bed.step(1e-5).unwrap();
    let place = bed.grains().ids.iter().position(|&id| id == 1).unwrap();
    bed.grains_mut().spheres[place].velocity.y = f64::NAN;
    assert_eq!(bed.step(1e-5).unwrap_err(), Failure::NonFinite { grain: 1 });
}

#[test]
fn a_grain_that_leaves_the_box_is_named() {
    let mut bed = bed_of(vec![sphere(Vec3::zeros(), 0.01, 2600.0, 0)], empty_space()).unwrap();
    bed.grains_mut().spheres[0].velocity.z = -100.0;
    let result = bed.run(3000, 1e-5, |_| Ok::<(), Failure>(()));
    assert!(matches!(result.unwrap_err(), Failure::Lost { grain: 0, position } if position.z < -1.0));
}

#[test]
fn grains_too_soft_for_their_speed_are_named() {
    let mut bed = bed_of(head_on(0.0, 30.0), empty_space()).unwrap();
    let result = bed.run(1000, 1e-6, |_| Ok::<(), Failure>(()));
    assert!(matches!(result.unwrap_err(), Failure::OverlapTooLarge { depth, .. } if depth > LARGEST_OVERLAP));
}

#[test]
fn beds_of_no_one_or_two_grains_are_refused_or_move_for_a_hundred_thousand_seeds() {
    let between = table(0.5, 0.5, Tail::CutCorrected);
    for seed in 0..100_000_u64 {
        let n_grains = (seed % 3) as usize;
        let is_periodic = [seed & 4 == 0, seed & 8 == 0, false];
        let domain = Domain { lower: Vec3::zeros(), upper: Vec3::repeat(0.1), is_periodic };
        let radii = match seed & 16 {
            0 => RadiusDistribution::Uniform { from_m: 1e-3, to_m: 1e-2 },
            _ => RadiusDistribution::Graded { from_m: 1e-4, to_m: 1e-2 },
        };
        let layer = Layer { radii, n_grains, density: SAND.density_kg_m3, material: 0 };
        let spheres =
            random_packing::<F64>(&domain, &[layer], seed.wrapping_mul(0x9e37_79b9_7f4a_7c15)).unwrap();
        assert_eq!(spheres.len(), n_grains);
        let planes = vec![Plane { point: Vec3::zeros(), normal: Vec3::z(), material: 0 }];
        let settings = BedSettings { domain, planes, gravity: Vec3::z() * -9.81, ..empty_space() };
        match Bed::new(spheres, settings, between.clone(), HertzMindlin::new(Tail::CutCorrected)) {
            Ok(mut bed) => bed.run(2, 1e-6, |_| Ok::<(), Failure>(())).unwrap(),
            Err(error) => assert!(n_grains == 0 && error == BedError::Empty, "{seed}: {error}"),
        }
    }
}
