//! Checks of a tire that rolls over a bed.

use super::{Check, grains};
use crate::run::Materials;
use crate::run::shape;
use crate::scene::{Grains, Roll, Scenario, Side, SubSteps, Tire, TireModel, Tread};
use grouser_geometry::{QualityReport, TireError, TireSize};

/// Smallest dihedral angle of a tetrahedron that is no sliver [degrees].
const LEAST_ANGLE_DEG: f64 = 5.0;
/// Sides of a face that forces are spread over at least: the mesh then yields as a half-space does within some per cent (`verify --only "finer cells"`).
const LEAST_SPREAD: f64 = 3.0;

pub fn validate(check: &mut Check, scenario: &Scenario, bed: &Grains, (tire, roll): (&Tire, &Roll)) {
    let before = check.problems.len();
    check.material(scenario, "tool.material", &tire.material);
    for (path, value, meaning) in [
        ("tool.wall_thickness_m", tire.wall_thickness_m, "a thickness [m]"),
        ("tool.groove_depth_m", tire.groove_depth_m, "a depth [m]"),
        ("motion.sinking_speed_m_s", roll.sinking_speed_m_s, "a speed downwards [m/s]"),
        ("motion.load_n", roll.load_n, "a vertical force [N]"),
        ("motion.speed_m_s", roll.speed_m_s, "a speed along x [m/s]"),
        ("motion.travel_m", roll.travel_m, "a distance [m]"),
        ("motion.ramp_s", roll.ramp_s, "a time [s]; a jump to full speed would ring through the tread"),
    ] {
        check.positive(path, value, meaning);
    }
    let not_negative = |value: f64| value >= 0.0 && value.is_finite();
    let inflation = tire.inflation_pa;
    let bar = "zero or a pressure [Pa]; 0.14 MPa is 1.4e5";
    check.require("tool.inflation_pa", inflation, not_negative(inflation), bar, "bar where Pa are asked");
    let margin = tire.refit_margin;
    let share = "zero or a share of the mean grain radius [-]";
    check.require("tool.refit_margin", margin, not_negative(margin), share, "a length in metres");
    let spread = tire.contact_spread_m;
    let radius = "zero, or a radius [m]";
    check.require("tool.contact_spread_m", spread, not_negative(spread), radius, "millimetres");
    if spread > 0.0 && tire.model == TireModel::Rigid {
        check.fail(
            "tool.contact_spread_m",
            "a rigid tread yields to no force",
            "0, or an elastic `model`",
            "",
        );
    }
    if let SubSteps::Fixed(0) = tire.sub_steps {
        check.require("tool.sub_steps", 0.0, false, "at least 1, or Auto", "");
    }
    let slip = roll.slip;
    let expected = "(ω R − v)/(ω R) in (−1, 1)";
    check.require("motion.slip", slip, slip > -1.0 && slip < 1.0, expected, "per cent");
    if let Tread::Alternating { lugs: 0, .. } = tire.tread {
        check.fail("tool.tread", "a lugged tread without lugs", "at least one, or Smooth", "");
    }
    let damping = tire.damping_s;
    let time = "zero or a time [s]";
    check.require("tool.damping_s", damping, not_negative(damping), time, "a damping ratio");
    if roll.gap_m.is_nan() || roll.gap_m < 0.0 || roll.gap_m.is_infinite() {
        check.push(
            "motion.gap_m",
            format!("`motion.gap_m` is {}: the tire starts inside the bed", roll.gap_m),
            "zero or positive: metres between the tire and the highest grain below it",
            "a sinkage given where the start above the surface is asked",
            "the load to reach is `motion.load_n`".to_owned(),
        );
    }
    if check.problems.len() == before && before == 0 {
        mesh(check, scenario, tire);
        room(check, bed, tire, roll);
        if tire.inflation_pa > 0.0 {
            grains::carries(check, scenario, bed, tire.inflation_pa, "the inflated tire");
        }
    }
}

/// Shape, mesh and quality of the tread.
fn mesh(check: &mut Check, scenario: &Scenario, tire: &Tire) {
    let path = |error: &TireError| match error {
        TireError::SizeCode { .. } => "tool.size",
        TireError::RimWidth { .. } => "tool.rim_width_m",
        TireError::Land { .. } => "tool.tread",
        TireError::Thickness { .. } => "tool.wall_thickness_m",
        TireError::TooFewElements { .. } => "tool.n_elements",
    };
    match shape(tire).mesh() {
        Err(error) => check.fail(path(&error), &error.to_string(), "a tread that can be meshed", ""),
        Ok(mesh) => {
            let angle = QualityReport::of(&mesh).smallest_dihedral_angle.to_degrees();
            if angle < LEAST_ANGLE_DEG {
                check.push(
                    "tool.n_elements",
                    format!("the tread's mesh has slivers: the smallest dihedral angle is {angle:.1}°"),
                    &format!("at least {LEAST_ANGLE_DEG}°"),
                    "walls or grooves that are thin against the cells around the tire",
                    "more elements, a thicker wall or deeper grooves".to_owned(),
                );
            }
            let outer = mesh.facets("outer").expect("treads have an outer surface");
            let surface = mesh.triangle_surface(outer).0;
            let least = LEAST_SPREAD * (2.0 * surface.area() / surface.triangles.len() as f64).sqrt();
            let (path, spread) = ("tool.contact_spread_m", tire.contact_spread_m);
            let expected =
                format!("0, or at least {LEAST_SPREAD} sides of the tread's outer faces, {least:.3} m");
            let cause = "a mesh too coarse to resolve the spread; raise `tool.n_elements`, or 0";
            check.require(path, spread, spread == 0.0 || spread >= least, &expected, cause);
        }
    }
    let rubber = Materials::of(scenario).elastic(&tire.material);
    let path = format!("materials.{}.poisson", tire.material);
    let expected =
        "below 0.5: the rubber would be incompressible; 0.45 … 0.499 with `elements: AveragedPressure`";
    check.require(&path, rubber.poisson, rubber.poisson < 0.5, expected, "rubber taken as incompressible");
}

/// The tire must stay between the walls.
fn room(check: &mut Check, bed: &Grains, tire: &Tire, roll: &Roll) {
    let Ok(size) = TireSize::parse(&tire.size) else { return };
    let [length, width, _] = bed.container.size_m;
    let depth: f64 = bed.layers.iter().map(|layer| layer.depth_m).sum();
    // Half of the chord at which the tire leaves the ground when it has sunk a quarter of the bed.
    let half = (size.outer_radius() * depth / 2.0).sqrt();
    check.require(
        "motion.start_m",
        roll.start_m,
        roll.start_m >= half,
        &format!("at least {half:.3} m from the wall at x = 0, half of the tire's footprint"),
        "the place of the axle, not of the tire's rear",
    );
    let end = roll.start_m + roll.travel_m + half;
    let expected = format!(
        "at most {:.3} m: start, travel and half of the footprint fit the bed of {length} m",
        length - roll.start_m - half
    );
    check.require("motion.travel_m", roll.travel_m, end <= length, &expected, "a bed that is too short");
    let wide = "wider than the tire by half of its width on each side";
    check.require("soil.container.size_m[1]", width, width >= 2.0 * size.width, wide, "");
    for (axis, side) in [("x", bed.container.x), ("y", bed.container.y)] {
        if side == Side::Periodic {
            let what = format!("the bed is periodic along {axis}, but a tire meets no images");
            check.fail(
                &format!("soil.container.{axis}"),
                &what,
                "`Walled`",
                "a bed taken from another scene",
            );
        }
    }
}
