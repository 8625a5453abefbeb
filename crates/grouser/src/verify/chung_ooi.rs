//! Particle impacts: Y. C. Chung, J. Y. Ooi, "Benchmark tests for verifying discrete element modelling codes at particle
//! impact level", Granular Matter 13 (2011) 643–656.

use super::Row;
use super::bodies::{IMPACT_FRACTION, Impact, impact_step, space, step_of, step_until_parted, wall};
use crate::run::COLLISION_FRACTION;
use grouser_contact::{F64, HertzMindlin, Interaction, Material, PairTable, Sphere, Tail, Vector};
use grouser_dem::{Bed, sphere};
use grouser_geometry::Vec3;

const GLASS: Material = Material { young_pa: 48e9, poisson: 0.20, density_kg_m3: 2800.0 };
const ALUMINIUM: Material = Material { young_pa: 70e9, poisson: 0.30, density_kg_m3: 2699.0 };
const ALUMINIUM_OXIDE: Material = Material { young_pa: 380e9, poisson: 0.23, density_kg_m3: 4000.0 };
/// So stiff that only the sphere deforms.
const RIGID: Material = Material { young_pa: 1e30, poisson: 0.30, density_kg_m3: 7800.0 };

/// The law of the published curves: dashpot with its tail, spring of total displacement.
const PUBLISHED: HertzMindlin<true> = HertzMindlin { tail: Tail::Keep };

/// Two spheres or a sphere and a rigid wall, of `material`, with one interaction for all.
fn table(material: Material, restitution: f64, friction: f64) -> PairTable {
    PairTable::new(&[material, RIGID], Tail::Keep, |_, _| Interaction { restitution, friction })
        .expect("published constants are sound")
}

/// Two equal spheres of a material that meet head on along z, each at `speed`.
fn head_on(material: Material, radius: f64, speed: f64) -> Vec<Sphere> {
    [-1.0, 1.0]
        .map(|side| {
            let mut body: Sphere =
                sphere(Vec3::new(0.0, 0.0, side * radius), radius, material.density_kg_m3, 0);
            body.velocity.z = -side * speed;
            body
        })
        .to_vec()
}

/// A sphere that has just reached a rigid wall at z = 0.
fn at_wall(material: Material, radius: f64, velocity: Vector<f64>) -> Sphere {
    let mut body: Sphere<F64> = sphere(Vec3::new(0.0, 0.0, radius), radius, material.density_kg_m3, 0);
    body.velocity = velocity;
    body
}

/// Elastic normal impact of two glass spheres.
pub fn test_1() -> Vec<Row> {
    let case = ("chung-ooi-1", "Hertz: F = k δ^1.5, δ = (5 m* v²/4k)^0.4, t = 2.943275 δ/v");
    let (radius, speed) = (0.01, 10.0);
    let spheres = head_on(GLASS, radius, speed);
    let table = table(GLASS, 1.0, 0.35);
    let dt =
        impact_step(&GLASS, radius, table.pair(0, 0), (radius / 2.0, spheres[0].mass / 2.0), 2.0 * speed);
    let bed = Bed::new(spheres, space(), table, PUBLISHED).expect("sound");
    let Impact { peak_force, contact_time, .. } = step_until_parted(bed, dt);
    vec![
        Row::relative(case, "largest force", "N", peak_force, (10_696.889, 1e-3)),
        Row::relative(case, "contact time", "s", contact_time, (4.033_945_6e-5, 1e-3)),
    ]
}

/// Elastic normal impact of an aluminium sphere on a rigid wall.
pub fn test_2() -> Vec<Row> {
    let case = ("chung-ooi-2", "Hertz, as test 1, against a rigid wall");
    let (radius, speed) = (0.1, 0.2);
    let body = at_wall(ALUMINIUM, radius, Vector::new(0.0, 0.0, -speed));
    let table = table(ALUMINIUM, 1.0, 0.0);
    let dt = impact_step(&ALUMINIUM, radius, table.pair(0, 1), (radius, body.mass), speed);
    let bed = Bed::new(vec![body], wall(1), table, PUBLISHED).expect("sound");
    let Impact { peak_force, contact_time, .. } = step_until_parted(bed, dt);
    vec![
        Row::relative(case, "largest force", "N", peak_force, (11_369.858, 1e-3)),
        Row::relative(case, "contact time", "s", contact_time, (7.316_566_4e-4, 1e-3)),
    ]
}

/// Restitution obtained for restitution asked, with both tails.
pub fn test_3() -> Vec<Row> {
    fn obtained(tail: Tail, asked: f64) -> f64 {
        let (radius, speed) = (0.0025, 3.9);
        let body = at_wall(ALUMINIUM_OXIDE, radius, Vector::new(0.0, 0.0, -speed));
        let law = HertzMindlin::new(tail);
        let between = Interaction { restitution: asked, friction: 0.0 };
        let table = PairTable::new(&[ALUMINIUM_OXIDE, RIGID], tail, |_, _| between).expect("sound");
        let dt = impact_step(&ALUMINIUM_OXIDE, radius, table.pair(0, 1), (radius, body.mass), speed);
        let bed = Bed::new(vec![body], wall(1), table, law).expect("sound");
        step_until_parted(bed, dt).bodies[0].velocity.z / speed
    }
    let case = ("chung-ooi-3", "the restitution asked for");
    let asked = [0.2, 0.4, 0.6, 0.8, 1.0];
    let rows = asked.map(|e| {
        [
            Row::absolute(case, format!("e = {e}, tail kept"), "-", obtained(Tail::Keep, e), (e, 1e-3)),
            Row::absolute(
                case,
                format!("e = {e}, tail cut and corrected"),
                "-",
                obtained(Tail::CutCorrected, e),
                (e, 1e-3),
            ),
        ]
    });
    rows.into_iter().flatten().collect()
}

/// Published curves of test 4, aluminium oxide, as digitised by the developers of Kratos Multiphysics: incident angle
/// [deg] and tangential restitution [-], then angle and spin [rad/s], then angle and rebound angle of the contact point [deg].
const TANGENTIAL_RESTITUTION: [(f64, f64); 9] = [
    (10.1584, 0.686985),
    (14.9901, 0.624382),
    (20.06, 0.61615),
    (25.05, 0.63427),
    (30.12, 0.68369),
    (40.02, 0.78089),
    (50.00, 0.84514),
    (59.98, 0.89292),
    (80.02, 0.96623),
];
const SPIN: [(f64, f64); 9] = [
    (10.0789, -212.997),
    (14.9704, -377.829),
    (19.94, -510.55),
    (24.91, -599.39),
    (29.96, -616.51),
    (39.98, -544.80),
    (50.00, -457.03),
    (60.02, -357.49),
    (80.06, -126.30),
];
const REBOUND_ANGLE: [(f64, f64); 8] = [
    (9.95883, -1.55589),
    (14.9346, -5.54381),
    (19.99, -7.5378),
    (24.96, -7.5378),
    (29.92, -3.5499),
    (39.92, 11.571),
    (49.83, 29.351),
    (59.99, 47.795),
];

/// Tangential restitution, spin and rebound angle of the contact point after an oblique impact.
fn oblique<const TOTAL_DISPLACEMENT: bool>(angle_deg: f64) -> [f64; 3] {
    oblique_in_steps::<TOTAL_DISPLACEMENT>(angle_deg, IMPACT_FRACTION)
}

/// The same with steps of a share of the collision time.
fn oblique_in_steps<const TOTAL_DISPLACEMENT: bool>(angle_deg: f64, fraction: f64) -> [f64; 3] {
    let (radius, speed) = (0.0025, 3.9);
    let (sin, cos) = angle_deg.to_radians().sin_cos();
    let body = at_wall(ALUMINIUM_OXIDE, radius, Vector::new(speed * sin, 0.0, -speed * cos));
    let table = table(ALUMINIUM_OXIDE, 0.98, 0.092);
    let pair = table.pair(0, 1);
    let dt = step_of(fraction, &ALUMINIUM_OXIDE, radius, pair, (radius, body.mass), speed);
    let law = HertzMindlin::<TOTAL_DISPLACEMENT> { tail: Tail::Keep };
    let bed = Bed::new(vec![body], wall(1), table, law).expect("sound");
    let after = step_until_parted(bed, dt).bodies[0];
    // About +y the body turns forwards; the published sign is that of clockwise spin against the motion.
    let (tangential, spin) = (after.velocity.x, after.spin.y);
    let contact_point = tangential - radius * spin;
    [tangential / (speed * sin), -spin, (contact_point / after.velocity.z).atan().to_degrees()]
}

/// Oblique impacts of an aluminium oxide sphere on a rigid wall.
pub fn test_4() -> Vec<Row> {
    let published = ("chung-ooi-4", "published curve, digitised by the Kratos developers");
    let sliding =
        ("chung-ooi-4", "gross sliding: Δv_t = μ (1 + e) v_n, ω = 5 μ (1 + e) v_n/(2 r) · mean arm/r");
    let mut rows = Vec::new();
    for (angle, reference) in TANGENTIAL_RESTITUTION {
        let [found, ..] = oblique::<true>(angle);
        let name = format!("tangential restitution at {angle:.1}°");
        rows.push(Row::absolute(published, name, "-", found, (reference, 0.012)));
    }
    for (angle, reference) in SPIN {
        let [_, found, _] = oblique::<true>(angle);
        rows.push(Row::absolute(
            published,
            format!("spin at {angle:.1}°"),
            "rad/s",
            found,
            (reference, 10.0),
        ));
    }
    for (angle, reference) in REBOUND_ANGLE {
        let [.., found] = oblique::<true>(angle);
        rows.push(Row::absolute(
            published,
            format!("rebound angle at {angle:.1}°"),
            "deg",
            found,
            (reference, 1.1),
        ));
    }
    for angle in [40.0_f64, 60.0, 80.0] {
        let impulse = 0.092 * 1.98 * 3.9 * angle.to_radians().cos();
        let restitution = 1.0 - impulse / (3.9 * angle.to_radians().sin());
        // The force acts at r − δ; weighted with Hertz's force the mean of δ over an impact is B(1.4, ½)/2 δ_max.
        let arm = 1.0 - 0.81757 * 8.0888e-6 / 0.0025 * angle.to_radians().cos().powf(0.8);
        for (law, [found, spin, _]) in
            [("total displacement", oblique::<true>(angle)), ("passive spring", oblique::<false>(angle))]
        {
            let name = |what: &str| format!("{what} at {angle}°, {law}");
            rows.push(Row::relative(
                sliding,
                name("tangential restitution"),
                "-",
                found,
                (restitution, 1e-3),
            ));
            rows.push(Row::relative(
                sliding,
                name("spin"),
                "rad/s",
                spin,
                (-2.5 * impulse / 0.0025 * arm, 1e-3),
            ));
        }
    }
    rows
}

/// Oblique impacts in the steps that scenes take by default.
pub fn default_step() -> Vec<Row> {
    let case = ("oblique impacts in default steps", "the same impact in steps forty times shorter");
    let row = |angle: f64| {
        let [[found, ..], [fine, ..]] =
            [COLLISION_FRACTION, IMPACT_FRACTION].map(|fraction| oblique_in_steps::<true>(angle, fraction));
        Row::absolute(case, format!("tangential restitution at {angle}°"), "-", found, (fine, 0.01))
    };
    [10.0, 20.0, 30.0, 45.0, 70.0].map(row).to_vec()
}

/// Two aluminium spheres with equal and opposite spins: nothing but the normal motion may change.
pub fn test_7() -> Vec<Row> {
    let case = ("chung-ooi-7", "the initial spin; no tangential velocity");
    let material = Material { poisson: 0.33, density_kg_m3: 2700.0, ..ALUMINIUM };
    let mut rows = Vec::new();
    for spin in [0.174_977_33, 1.0, 20.0] {
        let mut spheres = head_on(material, 0.1, 0.2);
        spheres[0].spin.y = spin;
        spheres[1].spin.y = -spin;
        let table = table(material, 0.5, 0.4);
        let dt = impact_step(&material, 0.1, table.pair(0, 0), (0.05, spheres[0].mass / 2.0), 0.4);
        let bed = Bed::new(spheres, space(), table, PUBLISHED).expect("sound");
        let after = step_until_parted(bed, dt).bodies[0];
        rows.push(Row::absolute(
            case,
            format!("spin after, {spin} before"),
            "rad/s",
            after.spin.y,
            (spin, 1e-12 * spin),
        ));
        rows.push(Row::absolute(
            case,
            format!("tangential velocity, spin {spin}"),
            "m/s",
            after.velocity.x,
            (0.0, 1e-12),
        ));
    }
    rows
}
