//! Rotation laws in the engine: angular grains, rolling resistance, inertia that is not spherical.

use crate::*;

/// Made for circles too, so that one type serves every shape.
type Angular = Rotating<HertzMindlin, Tilting<true>>;

fn angular(shape: GrainShape, inertia: GrainInertia) -> Angular {
    let rotation = Tilting::new(&TiltingSettings { inertia, ..TiltingSettings::of(shape) }).unwrap();
    Rotating { forces: HertzMindlin::new(Tail::CutCorrected), rotation }
}

fn column_of_angular_grains(n: usize) -> Bed<Angular> {
    let (spheres, settings) = falling_column::<F64>(n, 7);
    let law = angular(GrainShape::Plate { aspect_ratio: 0.5 }, GrainInertia::ThinRod);
    let mut bed = Bed::new(spheres, settings, table(0.5, 0.7, Tail::CutCorrected), law).unwrap();
    bed.grains_mut().turn_randomly(3);
    for sphere in &mut bed.grains_mut().spheres {
        sphere.velocity.z = -2.0;
    }
    bed
}

fn go_on<L: ContactLaw<f64>>(bed: &mut Bed<L>, n_steps: u64) {
    bed.run(n_steps, 2e-5, |_| Ok::<(), Failure>(())).unwrap();
}

#[test]
fn free_rotation_about_the_middle_axis_keeps_energy_and_angular_momentum() {
    let planes = [1.0, 0.7, 0.4].map(|aspect_ratio| PlaneShape::Rectangle { aspect_ratio, scale: 1.0 });
    let settings =
        TiltingSettings { inertia: GrainInertia::ThinRod, ..TiltingSettings::of(GrainShape::Planes(planes)) };
    let rotation = PlaneTilting::new(&settings).unwrap();
    let law = Rotating { forces: HertzMindlin::new(Tail::CutCorrected), rotation };
    let bead = sphere(Vec3::zeros(), 0.01, 2600.0, 0);
    let mut bed = Bed::new(vec![bead], empty_space(), table(0.5, 0.5, Tail::CutCorrected), law).unwrap();
    // The middle axis with a push: the grain turns over and over. A hundredth of a radian a step.
    bed.grains_mut().spheres[0].spin = Vector::new(1e-3, 500.0, 1e-3);
    let state = |bed: &Bed<Rotating<HertzMindlin, PlaneTilting>>| {
        (bed.grains().kinetic_energy()[1], bed.grains().spin_momentum(0))
    };
    let (energy, momentum) = state(&bed);
    let (mut most_energy, mut most_momentum, mut lowest) = (0.0_f64, 0.0_f64, f64::INFINITY);
    for _ in 0..1000 {
        go_on(&mut bed, 100);
        let (now, momentum_now) = state(&bed);
        most_energy = most_energy.max((now / energy - 1.0).abs());
        most_momentum = most_momentum.max((momentum_now - momentum).norm() / momentum.norm());
        let axis = bed.grains().orientations.as_ref().unwrap()[0] * Vec3::y();
        lowest = lowest.min(axis.y);
    }
    assert!(lowest < -0.9, "it must turn over, lowest {lowest}");
    assert!(most_energy < 1e-8, "{most_energy}");
    assert!(most_momentum < 1e-8, "{most_momentum}");
}

/// Largest angle [rad] between the axes of six free plates, six radians of precession after the start, and those of the closed form;
/// largest relative change of energy and angular momentum.
fn off_the_precession(time_step: f64) -> [f64; 3] {
    let place = |n: usize| Vec3::new(0.05 * n as f64, 0.0, 0.0);
    let beads = (0..6).map(|n| sphere(place(n), 0.01, 2600.0, 0)).collect();
    let law = angular(GrainShape::Plate { aspect_ratio: 0.5 }, GrainInertia::ThinRod);
    let mut bed = Bed::new(beads, empty_space(), table(0.5, 0.5, Tail::CutCorrected), law).unwrap();
    bed.grains_mut().turn_randomly(11);
    for (n, bead) in bed.grains_mut().spheres.iter_mut().enumerate() {
        bead.spin = Vector::new(100.0 + 10.0 * n as f64, -80.0, 60.0);
    }
    let state = |bed: &Bed<Angular>| {
        let grains = bed.grains();
        let mut state = vec![(Vec3::zeros(), Vec3::zeros()); 6];
        for (index, turn) in grains.orientations.as_ref().unwrap().iter().enumerate() {
            state[grains.ids[index] as usize] = (turn * Vec3::z(), grains.spin_momentum(index));
        }
        (state, grains.kinetic_energy()[1])
    };
    let (begun, energy) = state(&bed);
    let time = 0.016;
    bed.run((time / time_step).round() as u64, time_step, |_| Ok::<(), Failure>(())).unwrap();
    let (ended, energy_now) = state(&bed);
    let (mut most_off, mut most_momentum) = (0.0_f64, 0.0_f64);
    for ((axis, momentum), (axis_now, momentum_now)) in begun.into_iter().zip(ended) {
        // The axis goes round the angular momentum L at |L|/J, J = m r²/3 being the moment about the two other axes.
        let mass = bed.grains().spheres[0].mass;
        let turn = momentum * (3.0 / (mass * 1e-4) * time);
        let expected = grouser_geometry::Orientation::from_scaled_axis(turn) * axis;
        most_off = most_off.max((axis_now - expected).norm());
        most_momentum = most_momentum.max((momentum_now - momentum).norm() / momentum.norm());
    }
    [most_off, (energy_now / energy - 1.0).abs(), most_momentum]
}

#[test]
fn a_free_plate_precesses_as_the_closed_form_says() {
    let [coarse, ..] = off_the_precession(4e-5);
    let [fine, energy, momentum] = off_the_precession(2e-5);
    assert!(fine < 1e-4 && (3.8..4.2).contains(&(coarse / fine)), "{coarse}, {fine}");
    assert!(energy < 1e-12 && momentum < 1e-12, "{energy}, {momentum}");
}

/// Incline [°] at which a grain that rests on a plane topples, while the incline grows by 4° a second.
fn toppling_incline(aspect_ratio: f64, is_long_side_down: bool) -> f64 {
    let mut settings = empty_space();
    settings.planes = vec![Plane { point: Vec3::zeros(), normal: Vec3::z(), material: 0 }];
    let law = angular(GrainShape::Plate { aspect_ratio }, GrainInertia::Inscribed);
    let bead: Sphere = sphere(Vec3::new(0.0, 0.0, 0.01), 0.01, 2600.0, 0);
    let mut bed = Bed::new(vec![bead], settings, table(0.1, 9.0, Tail::CutCorrected), law).unwrap();
    bed.grains_mut().track_orientations();
    // Plane 2 of the grain (normal: body axis 2 = world y) holds the long side along body axis 1.
    let quarter = std::f64::consts::FRAC_PI_2;
    let turn = if is_long_side_down { 0.0 } else { quarter };
    let start = grouser_geometry::Orientation::from_scaled_axis(Vec3::y() * turn);
    bed.grains_mut().orientations.as_mut().unwrap()[0] = start;
    let expected = if is_long_side_down { (1.0 / aspect_ratio).atan() } else { aspect_ratio.atan() };
    let (first, rate, dt) = ((expected - 0.035).max(0.0), 4_f64.to_radians(), 2e-5);
    let mut time = 0.0_f64;
    let incline = |time: f64| first * (time / 0.5).min(1.0) + rate * (time - 0.5).max(0.0);
    while time < 2.5 {
        bed.run(500, dt, |grains| {
            time += dt;
            let weight = grains.spheres[0].mass * 9.81 * (time / 0.1).min(1.0);
            let (sin, cos) = incline(time).sin_cos();
            grains.loads[0].force += Vector::new(sin, 0.0, -cos) * weight;
            Ok::<(), Failure>(())
        })
        .unwrap();
        if bed.grains().orientations.as_ref().unwrap()[0].angle_to(&start) > 0.1 {
            return incline(time).to_degrees();
        }
    }
    panic!("A {aspect_ratio}: the grain never toppled");
}

#[test]
fn a_resting_grain_topples_where_its_shape_says() {
    for aspect_ratio in [1.0_f64, 0.75, 0.5] {
        let long = toppling_incline(aspect_ratio, true);
        let short = toppling_incline(aspect_ratio, false);
        let [expected_long, expected_short] =
            [1.0 / aspect_ratio, aspect_ratio].map(|t| t.atan().to_degrees());
        assert!((long - expected_long).abs() < 0.5, "A {aspect_ratio}, long side down: {long}°");
        assert!((short - expected_short).abs() < 0.5, "A {aspect_ratio}, short side down: {short}°");
    }
}

#[test]
fn angular_grains_give_the_same_bytes_on_any_threads_and_after_any_restart() {
    let results = [1, 3].map(|n_threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().unwrap();
        pool.install(|| {
            let mut bed = column_of_angular_grains(1500);
            go_on(&mut bed, 1200);
            assert!(bed.n_contacts() > 200);
            postcard::to_allocvec(&bed).unwrap()
        })
    });
    let mut split = column_of_angular_grains(1500);
    split.use_instruction_set(InstructionSet::Baseline);
    for n_steps in [1, 699, 500] {
        for _ in 0..n_steps {
            split.predict(2e-5).unwrap();
            split.contact_forces(2e-5);
            split.correct(2e-5);
        }
        split = postcard::from_bytes(&postcard::to_allocvec(&split).unwrap()).unwrap();
    }
    assert!(results[0] == results[1], "threads");
    assert!(results[0] == postcard::to_allocvec(&split).unwrap(), "restart, phases and instruction sets");
}

fn alike_on_every_instruction_set<const IS_ROUND: bool>(shape: GrainShape) {
    let settings = TiltingSettings { lift_damping: 1.0, ..TiltingSettings::of(shape) };
    let rotation = Tilting::<IS_ROUND>::new(&settings).unwrap();
    let after = |set| {
        let (spheres, settings) = falling_column::<F64>(300, 7);
        let law = Rotating { forces: HertzMindlin::new(Tail::CutCorrected), rotation };
        let mut bed = Bed::new(spheres, settings, table(0.5, 0.7, Tail::CutCorrected), law).unwrap();
        bed.grains_mut().turn_randomly(3);
        for sphere in &mut bed.grains_mut().spheres {
            sphere.velocity.z = -2.0;
        }
        bed.use_instruction_set(set);
        go_on(&mut bed, 1500);
        assert!(bed.n_contacts() > 50 && bed.energy().contacts.turning != 0.0);
        postcard::to_allocvec(&bed).unwrap()
    };
    let baseline = after(InstructionSet::Baseline);
    assert!(baseline == after(InstructionSet::detect()), "widest");
    #[cfg(target_arch = "x86_64")]
    if InstructionSet::detect() == InstructionSet::Avx512 {
        assert!(baseline == after(InstructionSet::Avx2), "AVX2");
    }
}

#[test]
fn angular_grains_give_the_same_bytes_on_every_instruction_set() {
    alike_on_every_instruction_set::<false>(GrainShape::Angular { aspect_ratio: 0.5 });
    alike_on_every_instruction_set::<true>(GrainShape::Disc { aspect_ratio: 0.5 });
}

#[test]
fn the_ledger_of_angular_grains_balances() {
    let residual = |dt: f64| {
        let mut bed = column_of_angular_grains(200);
        bed.set_background_damping(1e-4);
        let before = bed.energy().stored();
        bed.run((0.2 / dt).round() as u64, dt, |_| Ok::<(), Failure>(())).unwrap();
        let energy = bed.energy();
        assert!(
            energy.contacts.turning.abs() > 1e-4 * before && energy.background_damping > 0.0,
            "{energy:?}"
        );
        let lost = energy.contacts.dissipated() + energy.background_damping;
        ((before - energy.stored() - lost) / lost).abs()
    };
    let (coarse, fine) = (residual(2e-5), residual(5e-6));
    // The normal arm passes from corner to corner within 0.3°: this needs finer steps than spheres do.
    assert!(coarse < 4e-2 && fine < 5e-3, "{coarse}, {fine}");
}

#[test]
fn random_orientations_are_reproducible_and_without_preference() {
    let spheres = (0..4000).map(|n| {
        sphere(
            Vec3::new(0.02 * f64::from(n % 20), 0.02 * f64::from(n / 20 % 20), 0.02 * f64::from(n / 400)),
            5e-3,
            2600.0,
            0,
        )
    });
    let spheres: Vec<Sphere> = spheres.collect();
    let axes = |seed| {
        let mut settings = empty_space();
        settings.has_ledger = false;
        let mut bed =
            Bed::new(spheres.clone(), settings, table(0.5, 0.5, Tail::Keep), HertzMindlin::new(Tail::Keep))
                .unwrap();
        bed.grains_mut().turn_randomly(seed);
        let kept = bed.grains().orientations.clone().unwrap();
        kept.iter().map(|turn| turn * Vec3::x()).collect::<Vec<_>>()
    };
    let drawn = axes(5);
    assert_eq!(drawn, axes(5));
    assert_ne!(drawn, axes(6));
    let n = drawn.len() as f64;
    let mean: Vec3 = drawn.iter().sum::<Vec3>() / n;
    // Each component has variance 1/3: four standard errors.
    assert!(mean.norm() < 4.0 / n.sqrt(), "{mean}");
    for axis in 0..3 {
        let second = drawn.iter().map(|v| v[axis] * v[axis]).sum::<f64>() / n;
        assert!((second - 1.0 / 3.0).abs() < 4.0 * 0.3 / n.sqrt(), "{second}");
    }
}

#[test]
fn circular_figures_move_a_bed_as_spheres_do() {
    let circle = PlaneShape::Circle { scale: 1.0 };
    let round = angular(GrainShape::Planes([circle; 3]), GrainInertia::Inscribed);
    let (spheres, settings) = falling_column::<F64>(60, 7);
    let make = table(0.5, 0.5, Tail::CutCorrected);
    let mut free =
        Bed::new(spheres.clone(), settings.clone(), make.clone(), HertzMindlin::new(Tail::CutCorrected))
            .unwrap();
    let mut tilting = Bed::new(spheres, settings, make, round).unwrap();
    go_on(&mut free, 4000);
    go_on(&mut tilting, 4000);
    assert!(free.n_contacts() > 10, "grains must meet");
    let place =
        |spheres: &[Sphere], ids: &[u32], id| spheres[ids.iter().position(|&i| i == id).unwrap()].position;
    for id in 0..60 {
        let a = place(&free.grains().spheres, &free.grains().ids, id);
        let b = place(&tilting.grains().spheres, &tilting.grains().ids, id);
        assert!((a - b).norm() < 1e-9, "grain {id}: {:e} m apart", (a - b).norm());
    }
}

/// Distance [m] that a sphere rolls down a slope of 10° within 0.4 s.
fn rolled<R: RotationLaw<f64>>(rotation: R) -> f64 {
    let mut settings = empty_space();
    settings.planes = vec![Plane { point: Vec3::zeros(), normal: Vec3::z(), material: 0 }];
    let (sin, cos) = 10_f64.to_radians().sin_cos();
    settings.gravity = Vec3::new(sin, 0.0, -cos) * 9.81;
    let bead: Sphere = sphere(Vec3::new(0.0, 0.0, 0.01), 0.01, 2600.0, 0);
    let law = Rotating { forces: HertzMindlin::new(Tail::CutCorrected), rotation };
    let mut bed = Bed::new(vec![bead], settings, table(0.1, 0.8, Tail::CutCorrected), law).unwrap();
    go_on(&mut bed, 20_000);
    bed.grains().spheres[0].position.x
}

#[test]
fn rolling_resistance_holds_a_sphere_on_a_slope_below_its_friction() {
    let free = rolled(Free);
    // 5/7 g sin β t²/2
    assert!((free - 5.0 / 14.0 * 9.81 * 10_f64.to_radians().sin() * 0.16).abs() < 0.02 * free, "{free}");
    // tan 10° = 0.176
    assert!(rolled(ElasticPlasticRolling::new(0.25, 0.3).unwrap()) < 2e-4);
    let slowed = rolled(ConstantRolling::new(0.1).unwrap());
    let expected = 5.0 / 14.0 * 9.81 * (10_f64.to_radians().sin() - 0.1 * 10_f64.to_radians().cos()) * 0.16;
    assert!((slowed - expected).abs() < 0.02 * expected, "{slowed} against {expected}");
}

/// Power [W] that the law puts into a settled bed of 200 grains, and the kinetic energy over Σ m g r.
fn unrest<R: RotationLaw<f64>>(rotation: R) -> [f64; 2] {
    let (spheres, settings) = falling_column::<F64>(200, 7);
    let scale: f64 = spheres.iter().map(|sphere| sphere.mass * 9.81 * sphere.radius).sum();
    let law = Rotating { forces: HertzMindlin::new(Tail::CutCorrected), rotation };
    let mut bed = Bed::new(spheres, settings, table(0.5, 0.5, Tail::CutCorrected), law).unwrap();
    bed.grains_mut().turn_randomly(3);
    let run = |bed: &mut Bed<_>, n_steps| bed.run(n_steps, 4e-5, |_| Ok::<(), Failure>(())).unwrap();
    run(&mut bed, 15_000);
    let before = bed.energy().contacts.turning;
    run(&mut bed, 2500);
    let energy = bed.energy();
    [(before - energy.contacts.turning) / 0.1, (energy.kinetic + energy.rotational) / scale]
}

#[test]
fn a_bed_of_elongated_grains_comes_to_rest_unless_each_rectangle_stands_for_itself() {
    let settings = TiltingSettings::of(GrainShape::Angular { aspect_ratio: 0.1 });
    let [power, motion] = unrest(Tilting::<false>::new(&settings).unwrap());
    let rectangle = PlaneShape::Rectangle { aspect_ratio: 0.1, scale: 1.0 };
    let alike = TiltingSettings::of(GrainShape::Planes([rectangle; 3]));
    let [printed_power, printed_motion] = unrest(PlaneTilting::new(&alike).unwrap());
    assert!(power < 0.05 && motion < 5e-3, "{power} W, {motion}");
    assert!(
        printed_power > 100.0 * power && printed_motion > 100.0 * motion,
        "{printed_power} W, {printed_motion}"
    );
}

/// Kinetic energy over Σ m g r of 200 cubes that settled at a friction of 0.3 and have had one of 55° for 0.4 s; no dashpot on the lift.
fn cubes_at_55_degrees(build_up: f64) -> f64 {
    let (spheres, settings) = falling_column::<F64>(200, 7);
    let scale: f64 = spheres.iter().map(|sphere| sphere.mass * 9.81 * sphere.radius).sum();
    let cubes = TiltingSettings { build_up, ..TiltingSettings::of(GrainShape::Cube) };
    let law = Rotating {
        forces: HertzMindlin::new(Tail::CutCorrected),
        rotation: Tilting::<false>::new(&cubes).unwrap(),
    };
    let mut bed = Bed::new(spheres, settings, table(0.3, 0.3, Tail::CutCorrected), law).unwrap();
    bed.grains_mut().turn_randomly(3);
    go_on(&mut bed, 30_000);
    bed.set_pair_table(table(0.3, 1.428, Tail::CutCorrected)).unwrap();
    go_on(&mut bed, 20_000);
    let energy = bed.energy();
    (energy.kinetic + energy.rotational) / scale
}

#[test]
fn torques_that_follow_every_vibration_make_rough_cubes_flutter_and_those_that_build_up_do_not() {
    let (at_once, built_up) = (cubes_at_55_degrees(0.0), cubes_at_55_degrees(10.0));
    assert!(built_up < 1e-3 && at_once > 100.0 * built_up, "{at_once} against {built_up}");
}
