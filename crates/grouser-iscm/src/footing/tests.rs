//! Points and triangles that press, against forces that are known.

use grouser_geometry::{HeightGrid, Pose, Vec3};

use super::Reach;
use crate::contact::{FootImprint, Integration};
use crate::imprint::{Imprint, Plate};
use crate::polygon::{PartialLoad, SubTriangles};
use crate::pressure::{Linear, PressureArray, PressureField, PressureLaw};
use crate::terrain::Terrain;

/// Ground of 1 MPa/m with points `spacing` apart and its surface at `height` \[m\].
fn linear_ground(spacing: f64, height: impl Fn(f64, f64) -> f64) -> Terrain {
    let law = PressureLaw::Linear(Linear { stiffness: 1e6 });
    let grid = HeightGrid::covering([-0.5, -0.5], [2.0, 1.0], spacing, height).unwrap();
    Terrain::new(grid, PressureField::uniform(PressureArray::new(&law, 0.005, 0.5).unwrap())).unwrap()
}

/// Mean over places of force on flat shoes with a grouser each that stand in their own print, over the exact one, less one \[-\].
fn error(spacing: f64) -> f64 {
    let (partial, n_shoes, pitch) = (PartialLoad::Proportional, 10, 0.104);
    let plate = Plate { along: [-0.0416, 0.0416], across: [-0.3, 0.3], depth: 0.03 };
    let grouser = Plate { along: [-0.02, 0.02], across: [-0.3, 0.3], depth: 0.06 };
    let (z_plate, z_grouser) = (0.10, 0.13);
    let exact = f64::from(n_shoes) * 0.6 * 1e6 * (0.04 * z_grouser + 0.0432 * z_plate);
    let places = 16;
    let mean = (0..places).map(|place| {
        let mut terrain = linear_ground(spacing, |_, _| 0.0);
        let blank = || Imprint::new(terrain.grid(), [-0.2, -0.4], [1.3, 0.4], 1.0, partial);
        let (mut grousers, mut shoes) = (blank(), blank());
        for k in 0..n_shoes {
            let x = f64::from(k) * pitch + f64::from(place) * spacing / f64::from(places);
            let at = Pose::translation(x, 0.003, -z_plate + plate.depth);
            grousers.draw_plate(&at, &grouser, 0);
            shoes.draw_plate(&at, &plate, 0);
        }
        grousers.carry_edges(terrain.grid());
        shoes.carry_edges(terrain.grid());
        let layers = vec![grousers, shoes, blank()];
        FootImprint::new(layers.clone(), Vec3::zeros(), &terrain, partial, Reach::Close)
            .stamp(&mut terrain, &Pose::identity());
        let foot = FootImprint::new(layers, Vec3::zeros(), &terrain, partial, Reach::Close);
        let integration = Integration { sub_triangles: SubTriangles::new(4), partial };
        foot.load(&terrain, &Pose::identity(), &integration).wrench.force.z
    });
    mean.sum::<f64>() / f64::from(places) / exact - 1.0
}

#[test]
fn shoes_are_carried_beside_the_prints_of_their_grousers() {
    // Where plates saw the ground in the grousers' prints they lost −17, −29, −23, −22 and −15 %.
    let errors = [0.05, 0.04, 0.025, 0.02, 0.0125].map(error);
    assert!(errors.iter().all(|error| error.abs() < 1e-3), "{errors:?}");
}

/// Mean over places of the force on plates 2.08 cm apart and on a wheel above these gaps, which stand in their own print, over the exact
/// ones, less one; and of the force left on all of it 1 mm higher, over the exact one before \[-\].
fn errors_of_gaps(spacing: f64) -> [f64; 3] {
    let (partial, n_shoes, pitch) = (PartialLoad::Proportional, 10, 0.104);
    let plate = Plate { along: [-0.0416, 0.0416], across: [-0.3, 0.3], depth: 0.0 };
    let (z_plate, z_wheel) = (0.10, 0.07);
    let exact =
        [f64::from(n_shoes) * 0.0832 * 0.6 * z_plate, f64::from(n_shoes - 1) * 0.0208 * 0.5 * z_wheel]
            .map(|volume| 1e6 * volume);
    let places = 16;
    let mut sums = [0.0; 3];
    for place in 0..places {
        let mut terrain = linear_ground(spacing, |_, _| 0.0);
        let blank = || Imprint::new(terrain.grid(), [-0.2, -0.4], [1.3, 0.4], 1.0, partial);
        let (mut shoes, mut wheel) = (blank(), blank());
        let first = f64::from(place) * spacing / f64::from(places);
        for k in 0..n_shoes {
            let at = Pose::translation(first + f64::from(k) * pitch, 0.003, -z_plate);
            shoes.draw_plate(&at, &plate, 0);
        }
        let above = Plate { along: [0.0, f64::from(n_shoes - 1) * pitch], across: [-0.25, 0.25], depth: 0.0 };
        wheel.draw_plate(&Pose::translation(first, 0.003, -z_wheel), &above, 1);
        shoes.carry_edges(terrain.grid());
        wheel.carry_edges(terrain.grid());
        let layers = vec![blank(), shoes, wheel];
        FootImprint::new(layers.clone(), Vec3::zeros(), &terrain, partial, Reach::Close)
            .stamp(&mut terrain, &Pose::identity());
        let foot = FootImprint::new(layers, Vec3::zeros(), &terrain, partial, Reach::Close);
        let integration = Integration { sub_triangles: SubTriangles::new(4), partial };
        for polygon in foot.polygons(&terrain, &Pose::identity(), &integration) {
            sums[polygon.layer - 1] += polygon.force.z;
        }
        let lifted = Pose::translation(0.0, 0.0, 1e-3);
        sums[2] += foot.load(&terrain, &lifted, &integration).wrench.force.z;
    }
    let mean = sums.map(|sum| sum / f64::from(places));
    [mean[0] / exact[0] - 1.0, mean[1] / exact[1] - 1.0, mean[2] / (exact[0] + exact[1])]
}

#[test]
fn wheels_stand_on_the_ground_between_plates() {
    let errors = [0.05, 0.04, 0.03, 0.025, 0.02, 0.0125].map(errors_of_gaps);
    // Where the wheel saw the ground under the plates it lost −99, −50, −35, −26, −13 and −8 %; the walls of the gaps still carried 39,
    // 29, 24, 22, 19 and 13 % of everything once it was lifted.
    for [plates, wheel, lifted] in errors {
        assert!(plates.abs() < 1e-4 && wheel.abs() < 2e-3 && lifted.abs() < 2e-4, "{errors:.5?}");
    }
}

#[test]
fn triangles_far_above_the_ground_answer_once_the_gear_sinks_onto_them() {
    let partial = PartialLoad::Proportional;
    let terrain = linear_ground(0.04, |_, _| 0.0);
    let blank = || Imprint::new(terrain.grid(), [-0.2, -0.4], [1.3, 0.4], 1.0, partial);
    let (mut low, mut high) = (blank(), blank());
    // Wheels, 1 mm in the ground, and plates 2 cm above it.
    let plate = |from: f64| Plate { along: [from, from + 0.4], across: [-0.3, 0.3], depth: 0.0 };
    high.draw_plate(&Pose::translation(0.003, 0.0, -1e-3), &plate(0.0), 0);
    low.draw_plate(&Pose::translation(0.003, 0.0, 0.02), &plate(0.6), 0);
    low.carry_edges(terrain.grid());
    high.carry_edges(terrain.grid());
    let foot = FootImprint::new(vec![low, high], Vec3::zeros(), &terrain, partial, Reach::Close);
    let integration = Integration { sub_triangles: SubTriangles::new(4), partial };
    for (sunk, both) in [(0.0, false), (3.9e-3, false), (4.1e-3, false), (0.03, true)] {
        let motion = Pose::translation(0.0, 0.0, -sunk);
        let lift = foot.load(&terrain, &motion, &integration).wrench.force.z;
        let (wheels, plates) = (sunk + 1e-3, f64::max(sunk - 0.02, 0.0));
        let exact = 1e6 * 0.4 * 0.6 * (wheels + plates);
        assert!((lift / exact - 1.0).abs() < 1e-9 && both == (plates > 0.0), "{sunk}: {lift}, {exact} N");
    }
    assert!(foot.footings.len() == 1 && foot.footings[0].layer == 1);
}

/// Five shoes with a grouser each and a wheel above them: layers with the first shoe at `first` and links at a height of `z` \[m\].
fn five_shoes(terrain: &Terrain, first: f64, z: f64) -> Vec<Imprint> {
    let (partial, pitch) = (PartialLoad::Proportional, 0.104);
    let plate = Plate { along: [-0.0416, 0.0416], across: [-0.3, 0.3], depth: 0.03 };
    let grouser = Plate { along: [-0.02, 0.02], across: [-0.3, 0.3], depth: 0.06 };
    let blank = || Imprint::new(terrain.grid(), [-0.2, -0.4], [1.3, 0.4], 1.0, partial);
    let (mut grousers, mut shoes, mut wheel) = (blank(), blank(), blank());
    for k in 0..5 {
        let at = Pose::translation(first + f64::from(k) * pitch, 0.003, z);
        grousers.draw_plate(&at, &grouser, 0);
        shoes.draw_plate(&at, &plate, 0);
    }
    let above = Plate { along: [0.0, 4.0 * pitch], across: [-0.25, 0.25], depth: 0.01 };
    wheel.draw_plate(&Pose::translation(first, 0.003, z), &above, 1);
    let mut layers = vec![grousers, shoes, wheel];
    layers.iter_mut().for_each(|layer| layer.carry_edges(terrain.grid()));
    layers
}

#[test]
fn gear_close_to_the_ground_answers_and_prints_as_all_of_it_does() {
    let partial = PartialLoad::Proportional;
    let mut terrain = linear_ground(0.04, |x, _| 0.02 * (9.0 * x).sin());
    let integration = Integration { sub_triangles: SubTriangles::new(4), partial };
    let mut both_sizes = [0, 0];
    for step in 0..40 {
        let layers = five_shoes(&terrain, 0.013 + 7e-3 * f64::from(step), -0.03 - 5e-4 * f64::from(step % 7));
        let [close, far] = [Reach::Close, Reach::Far]
            .map(|reach| FootImprint::new(layers.clone(), Vec3::zeros(), &terrain, partial, reach));
        for (sum, foot) in both_sizes.iter_mut().zip([&close, &far]) {
            *sum += foot.footings.iter().map(|footing| footing.sites.len()).sum::<usize>();
        }
        let motion = Pose::translation(0.0, 0.0, -1e-3 * f64::from(step % 4));
        let [a, b] = [&close, &far].map(|foot| foot.load(&terrain, &motion, &integration));
        assert!((a.wrench.force - b.wrench.force).norm() <= 1e-9 * b.wrench.force.norm(), "{a:?}\n{b:?}");
        assert!((a.stiffness - b.stiffness).norm() <= 1e-9 * b.stiffness.norm(), "{a:?}\n{b:?}");
        let mut other = terrain.clone();
        close.stamp(&mut terrain, &motion);
        far.stamp(&mut other, &motion);
        let differs = |(a, b): (&f64, &f64)| (a - b).abs() > 1e-12;
        assert!(!terrain.sinkage().iter().zip(other.sinkage()).any(differs), "prints differ in step {step}");
    }
    assert!(both_sizes[0] < both_sizes[1], "{both_sizes:?}");
}

#[test]
fn force_has_no_jump_as_shoes_move_over_the_prints_of_others() {
    let partial = PartialLoad::Proportional;
    let mut terrain = linear_ground(0.04, |_, _| 0.0);
    FootImprint::new(five_shoes(&terrain, 0.013, -0.05), Vec3::zeros(), &terrain, partial, Reach::Close)
        .stamp(&mut terrain, &Pose::identity());
    let integration = Integration { sub_triangles: SubTriangles::new(4), partial };
    // 5 mm above the prints: loaded on what the first shoes left higher.
    let forces: Vec<f64> = (0..=2000)
        .map(|k| {
            let layers = five_shoes(&terrain, 0.013 + 2e-5 * f64::from(k), -0.045);
            let foot = FootImprint::new(layers, Vec3::zeros(), &terrain, partial, Reach::Close);
            foot.load(&terrain, &Pose::identity(), &integration).wrench.force.z
        })
        .collect();
    let most = forces.iter().fold(0.0_f64, |most, force| most.max(*force));
    let jump = |every: usize| {
        let sparse: Vec<f64> = forces.iter().step_by(every).copied().collect();
        sparse.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max)
    };
    // A jump stays as large as it is however small the steps; here ten times smaller steps give about ten times smaller differences.
    let (coarse, fine) = (jump(10), jump(1));
    assert!(most > 1e4 && fine < 5e-3 * most && coarse > 5.0 * fine, "{coarse} and {fine} of {most} N");
}
