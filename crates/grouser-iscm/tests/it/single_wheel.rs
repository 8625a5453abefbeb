//! Properties of the single wheel's operating point in both fidelities.

use grouser_iscm::pressure::{Bekker, Linear, PressureLaw, Table};
use grouser_iscm::shear::JanosiHanamoto;
use grouser_iscm::wheel::{
    Lugs, OperatingPoint, PressurePeak, SingleWheel, WheelError, WheelSoil, closed_form, grid,
    slip_for_drawbar_pull,
};

const WHEEL: SingleWheel = SingleWheel { radius: 0.25, width: 0.2, lugs: None, load: 800.0 };

fn soil() -> WheelSoil {
    WheelSoil {
        pressure: PressureLaw::Bekker(Bekker {
            cohesive_modulus: 0.99e3,
            frictional_modulus: 1528.43e3,
            exponent: 1.1,
            plate_width: 0.2,
        }),
        shear: JanosiHanamoto {
            cohesion: 1040.0,
            friction_angle: 28_f64.to_radians(),
            shear_deformation_modulus: 0.015,
        },
        peak: PressurePeak::Bottom,
        rebound: None,
    }
}

fn both(wheel: &SingleWheel, soil: &WheelSoil, slip: f64, slip_angle: f64) -> [OperatingPoint; 2] {
    let settings = grid::GridSettings::for_wheel(wheel);
    [
        closed_form::operating_point(wheel, soil, slip, slip_angle).unwrap(),
        grid::operating_point(wheel, soil, slip, slip_angle, &settings).unwrap(),
    ]
}

#[test]
fn the_default_grid_is_within_one_percent_of_the_closed_form_and_of_a_grid_four_times_finer() {
    let coarse = grid::GridSettings::for_wheel(&WHEEL);
    let fine = grid::GridSettings { spacing: coarse.spacing / 4.0, ..coarse };
    for slip in [-0.2, 0.05, 0.2, 0.5, 0.9] {
        let [exact, on_grid] = both(&WHEEL, &soil(), slip, 0.0);
        let finer = grid::operating_point(&WHEEL, &soil(), slip, 0.0, &fine).unwrap();
        for reference in [exact, finer] {
            assert!((on_grid.sinkage / reference.sinkage - 1.0).abs() < 0.01, "slip {slip}: {on_grid:?}");
            let difference = (on_grid.drawbar_pull - reference.drawbar_pull).abs() / WHEEL.load;
            assert!(difference < 0.01, "slip {slip}: {difference} of the load");
        }
    }
}

#[test]
fn left_and_right_are_mirror_images_and_straight_travel_has_no_side() {
    for [left, right] in [0, 1].map(|k| [0.2, -0.2].map(|angle| both(&WHEEL, &soil(), 0.3, angle)[k])) {
        assert!((left.lateral_force + right.lateral_force).abs() < 1e-6 * WHEEL.load);
        assert!((left.drawbar_pull - right.drawbar_pull).abs() < 1e-6 * WHEEL.load);
        assert!(left.lateral_force < 0.0, "the ground pushes against the sliding");
    }
    assert!(both(&WHEEL, &soil(), 0.3, 0.0).iter().all(|p| p.lateral_force.abs() < 1e-9));
}

#[test]
fn stronger_ground_and_taller_lugs_pull_more() {
    let point = |wheel, soil: &WheelSoil| both(&wheel, soil, 0.3, 0.0);
    let strong = WheelSoil { shear: JanosiHanamoto { cohesion: 3000.0, ..soil().shear }, ..soil() };
    let lugs = Some(Lugs { height: 0.02, share: 1.0 });
    for k in [0, 1] {
        let plain = point(WHEEL, &soil())[k].drawbar_pull;
        assert!(point(WHEEL, &strong)[k].drawbar_pull > plain);
        assert!(point(SingleWheel { lugs, ..WHEEL }, &soil())[k].drawbar_pull > plain);
    }
}

#[test]
fn lugs_without_height_change_nothing_and_their_energy_balances() {
    let flat = SingleWheel { lugs: Some(Lugs { height: 0.0, share: 1.0 }), ..WHEEL };
    assert_eq!(both(&flat, &soil(), 0.3, 0.1), both(&WHEEL, &soil(), 0.3, 0.1));
    let lugged = SingleWheel { lugs: Some(Lugs { height: 0.02, share: 0.7 }), ..WHEEL };
    for point in both(&lugged, &soil(), 0.3, 0.1) {
        assert!(point.energy_residual().abs() < 1e-12, "{}", point.energy_residual());
        assert!(point.shear_loss > 0.0 && point.compaction_loss > 0.0);
    }
}

#[test]
fn the_slip_of_a_pull_gives_that_pull() {
    let settings = grid::GridSettings::for_wheel(&WHEEL);
    for pull in [-100.0, 0.0, 60.0] {
        let exact =
            slip_for_drawbar_pull(|s| closed_form::operating_point(&WHEEL, &soil(), s, 0.0), pull).unwrap();
        assert!((exact.drawbar_pull - pull).abs() < 1e-5, "{}", exact.drawbar_pull);
        let on_grid =
            slip_for_drawbar_pull(|s| grid::operating_point(&WHEEL, &soil(), s, 0.0, &settings), pull)
                .unwrap();
        assert!((on_grid.slip - exact.slip).abs() < 0.01, "{} for {}", on_grid.slip, exact.slip);
    }
    let error = slip_for_drawbar_pull(|s| closed_form::operating_point(&WHEEL, &soil(), s, 0.0), 900.0);
    assert!(matches!(error, Err(WheelError::NoSlip { .. })));
}

#[test]
fn a_load_beyond_the_ground_and_values_without_meaning_are_named() {
    let at = |wheel: SingleWheel, soil: &WheelSoil, slip, angle| {
        closed_form::operating_point(&wheel, soil, slip, angle).unwrap_err().to_string()
    };
    let heavy = SingleWheel { load: 1e7, ..WHEEL };
    assert!(at(heavy, &soil(), 0.1, 0.0).contains("the ground carries"));
    let shallow = WheelSoil { pressure: PressureLaw::Table(Table { points: vec![[0.002, 1e3]] }), ..soil() };
    assert!(at(WHEEL, &shallow, 0.1, 0.0).contains("data that end too early"));
    assert!(at(WHEEL, &soil(), 1.2, 0.0).contains("slip is 1.2"));
    assert!(at(WHEEL, &soil(), f64::NAN, 0.0).contains("NaN"));
    assert!(at(SingleWheel { width: 0.0, ..WHEEL }, &soil(), 0.1, 0.0).contains("width"));
    let linear = PressureLaw::Linear(Linear { stiffness: -1.0 });
    assert!(at(WHEEL, &WheelSoil { pressure: linear, ..soil() }, 0.1, 0.0).contains("stiffness"));
    let both =
        WheelSoil { peak: PressurePeak::WongReece { c_1: 0.2, c_2: 0.3 }, rebound: Some(1e8), ..soil() };
    assert!(at(WHEEL, &both, 0.1, 0.0).contains("rebound"));
}
