//! Tilting grains at rest and squeezed, at the extremes of their constants.

use super::Row;
use super::angular::{RADIUS, SAND, one, orientation, tilting};
use super::bodies::{space, wall};
use grouser_contact::{
    ArmNormalisation, ElasticPlasticRolling, F64, GrainShape, HertzMindlin, Interaction, PairTable,
    PlaneShape, PlaneTilting, Rotating, RotationLaw, Sphere, Tail, Tilting, TiltingSettings, Vector,
};
use grouser_dem::{Bed, BedSettings, Failure, Grains, Plane, sphere};
use grouser_geometry::{Orientation, Vec3};

const REST: (&str, &str) = ("angular grains at rest", "rest");

/// A grain alone and forty in a box rest for 10⁶ steps; one with twelve neighbours accounts for its energy, at the extremes of every constant.
pub fn rest_and_extremes() -> Vec<Row> {
    let gravity = Vec3::new(0.0, 0.0, -9.81);
    let mut rows = Vec::new();
    let law = tilting::<false>(GrainShape::Angular { aspect_ratio: 0.5 }, 5e-3);
    let mut bed = one(law, BedSettings { gravity, ..wall(0) }, 0.5, Orientation::identity());
    let _ = bed.run(20_000, 2e-5, |_| Ok::<(), Failure>(()));
    let (place, turn) = (bed.grains().spheres[0].position, orientation(&bed));
    let _ = bed.run(1_000_000, 2e-5, |_| Ok::<(), Failure>(()));
    let moved = (bed.grains().spheres[0].position - place).norm();
    let turned = orientation(&bed).angle_to(&turn);
    rows.push(Row::absolute(REST, "way of a grain alone in 10⁶ steps", "m", moved, (0.0, 1e-9)));
    rows.push(Row::absolute(REST, "turn of a grain alone in 10⁶ steps", "rad", turned, (0.0, 1e-6)));
    let [moved, turned] = forty_at_rest();
    rows.push(Row::absolute(REST, "largest way of forty grains in 10⁶ steps", "m", moved, (0.0, 1e-9)));
    rows.push(Row::absolute(REST, "largest turn of forty grains in 10⁶ steps", "rad", turned, (0.0, 1e-6)));

    let circle = GrainShape::Planes([PlaneShape::Circle { scale: 0.1 }; 3]);
    // Bodies within the sphere: arms of a long side are not scaled up again to reach it.
    let (small, root) = (0.05, 0.05_f64.sqrt());
    let rectangle = |aspect_ratio, scale| PlaneShape::Rectangle { aspect_ratio, scale };
    let within = |planes| {
        let settings = TiltingSettings::of(GrainShape::Planes(planes));
        let settings = TiltingSettings { arms: ArmNormalisation::LongSide, ..settings };
        Tilting::new(&settings).expect("sound")
    };
    let scale = 0.1 / root;
    let angular = within([rectangle(root, 0.1), rectangle(small, scale), rectangle(root, scale)]);
    let bodies: [(&str, Tilting<true>); 5] = [
        ("A = 0.05", tilting(GrainShape::Angular { aspect_ratio: small }, 5e-3)),
        ("A = 1", tilting(GrainShape::Cube, 5e-3)),
        ("circles, s = 0.1", tilting(circle, 5e-3)),
        ("A = 1, s = 0.1", within([rectangle(1.0, 0.1); 3])),
        ("A = 0.05, s from 0.1", angular),
    ];
    let themselves = |scale| {
        let shape = GrainShape::Planes([rectangle(small, scale); 3]);
        PlaneTilting::new(&TiltingSettings::of(shape)).expect("sound")
    };
    for degrees in [0.0_f64, 60.0] {
        let friction = degrees.to_radians().tan();
        let mut row = |name: &str, missed: f64| {
            let what = format!("energy missed, twelve neighbours, {name}, φ = {degrees}°");
            rows.push(Row::absolute(REST, what, "-", missed, (0.0, 5e-5)));
        };
        for (name, law) in bodies {
            row(name, squeezed(law, friction, Tail::CutCorrected));
        }
        for scale in [0.1, 1.0] {
            let name = format!("three rectangles, A = 0.05, s = {scale}");
            row(&name, squeezed(themselves(scale), friction, Tail::CutCorrected));
        }
        let kept = squeezed(
            tilting::<false>(GrainShape::Angular { aspect_ratio: small }, 5e-3),
            friction,
            Tail::Keep,
        );
        row("A = 0.05, tail kept", kept);
        let rolling = ElasticPlasticRolling::new(0.3, 0.3).expect("sound");
        row("rolling resistance, tail kept", squeezed(rolling, friction, Tail::Keep));
    }
    rows
}

/// Grains that touch the one whose number is 0.
fn contacts_of_the_middle(grains: &Grains<F64>) -> usize {
    let middle = grains.ids.iter().position(|&id| id == 0).map(|place| grains.spheres[place].position);
    let touches = |sphere: &&Sphere| {
        middle.is_some_and(|middle| (0.0..2.0 * RADIUS).contains(&(sphere.position - middle).norm()))
    };
    grains.spheres.iter().filter(touches).count().saturating_sub(1)
}

/// Twelve grains rush onto one in their middle from all sides; what the ledger misses over the kinetic energy at the start.
fn squeezed<R: RotationLaw<f64>>(rotation: R, friction: f64, tail: Tail) -> f64 {
    let golden = 0.5 * (1.0 + 5_f64.sqrt());
    let mut places = vec![Vec3::zeros()];
    for (a, b) in [(1.0, golden), (1.0, -golden), (-1.0, golden), (-1.0, -golden)] {
        places.extend([Vec3::new(0.0, a, b), Vec3::new(a, b, 0.0), Vec3::new(b, 0.0, a)]);
    }
    let mut spheres: Vec<Sphere> = Vec::new();
    for place in places {
        let out = place.try_normalize(0.0).unwrap_or_default();
        let mut grain: Sphere = sphere(out * 2.001 * RADIUS, RADIUS, SAND.density_kg_m3, 0);
        let inward = out * -1.0 + Vec3::new(-out.y, out.x, 0.2);
        grain.velocity =
            if out.norm() > 0.0 { Vector::new(inward.x, inward.y, inward.z) } else { Vector::ZERO };
        spheres.push(grain);
    }
    let between = Interaction { restitution: 0.5, friction };
    let table = PairTable::new(&[SAND], tail, |_, _| between).expect("sound");
    let law = Rotating { forces: HertzMindlin::new(tail), rotation };
    let mut bed = Bed::new(spheres, BedSettings { has_ledger: true, ..space() }, table, law).expect("sound");
    bed.grains_mut().turn_randomly(5);
    let begun = bed.energy().stored();
    let mut most_contacts = 0;
    for _ in 0..4000 {
        if bed.step(1e-6).is_err() {
            return f64::NAN;
        }
        most_contacts = most_contacts.max(contacts_of_the_middle(bed.grains()));
    }
    let energy = bed.energy();
    let missed = (energy.stored() + energy.contacts.dissipated() - begun).abs() / begun;
    if most_contacts >= 10 { missed } else { f64::NAN }
}

/// Forty grains of A = 0.1 fall into a box of four diameters and come to rest within 300,000 steps: how far any moves [m] and turns [rad]
/// in a million more.
fn forty_at_rest() -> [f64; 2] {
    let inward = [Vec3::x(), -Vec3::x(), Vec3::y(), -Vec3::y()];
    let mut settings = BedSettings { gravity: Vec3::new(0.0, 0.0, -9.81), ..wall(0) };
    settings.planes.extend(inward.map(|normal| Plane { point: normal * -4.0 * RADIUS, normal, material: 0 }));
    let spheres: Vec<Sphere> = (0..40_u32)
        .map(|k| {
            let [i, j, layer] = [k % 3, k / 3 % 3, k / 9].map(f64::from);
            let aside = Vec3::new(0.1 * (layer % 2.0), 0.13 * (layer % 3.0), 0.0);
            let place = Vec3::new(2.3 * (i - 1.0), 2.3 * (j - 1.0), 1.1 + 2.2 * layer) + aside;
            sphere(place * RADIUS, RADIUS * (1.0 - 0.01 * f64::from(k % 7)), SAND.density_kg_m3, 0)
        })
        .collect();
    let between = Interaction { restitution: 0.1, friction: 26_f64.to_radians().tan() };
    let table = PairTable::new(&[SAND], Tail::CutCorrected, |_, _| between).expect("sound");
    let rotation: Tilting = tilting(GrainShape::Angular { aspect_ratio: 0.1 }, 5e-3);
    let law = Rotating { forces: HertzMindlin::new(Tail::CutCorrected), rotation };
    let mut bed = Bed::new(spheres, settings, table, law).expect("sound");
    bed.grains_mut().turn_randomly(5);
    let after = |bed: &mut Bed<_>, steps| {
        let went = bed.run(steps, 2e-5, |_| Ok::<(), Failure>(()));
        let grains: &Grains<F64> = bed.grains();
        let turns = grains.orientations.as_ref().expect("tracked");
        let mut state: Vec<_> =
            (0..40).map(|k| (grains.ids[k], grains.spheres[k].position, turns[k])).collect();
        state.sort_by_key(|grain| grain.0);
        went.is_ok().then_some(state)
    };
    let (Some(before), Some(now)) = (after(&mut bed, 300_000), after(&mut bed, 1_000_000)) else {
        return [f64::NAN; 2];
    };
    let moves = before.iter().zip(&now).map(|(a, b)| [(a.1 - b.1).norm(), a.2.angle_to(&b.2)]);
    moves.fold([0.0; 2], |most, one| [most[0].max(one[0]), most[1].max(one[1])])
}
