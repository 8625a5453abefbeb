//! The active zone: sleeping grains cost nothing, stay where they are, and wake when something reaches them.

use crate::*;
use std::sync::OnceLock;

type Law = HertzMindlin;

const DT: f64 = 4e-5;

fn zone() -> ActiveZone {
    ActiveZone { block_m: 0.018, rest_speed: 2e-3, rest_time_s: 4e-3, wake: 0.5 }
}

fn go_on(bed: &mut Bed<Law>, n_steps: u64) {
    bed.run(n_steps, DT, |_| Ok::<(), Failure>(())).unwrap();
}

/// A bed of 600 grains at rest, periodic in x and y, 0.06 m wide.
fn settled() -> Bed<Law> {
    static SETTLED: OnceLock<Bed<Law>> = OnceLock::new();
    let settle = || {
        let (spheres, mut settings) = falling_column::<F64>(600, 7);
        // Grains that roll freely may go on for long.
        settings.rotation = Rotation::Fixed;
        let table = table(0.3, 0.5, Tail::CutCorrected);
        let mut bed = Bed::new(spheres, settings, table, HertzMindlin::new(Tail::CutCorrected)).unwrap();
        go_on(&mut bed, 12_000);
        bed.set_background_damping(0.05);
        go_on(&mut bed, 8_000);
        bed.set_background_damping(0.0);
        bed
    };
    SETTLED.get_or_init(settle).clone()
}

fn weight(bed: &Bed<Law>) -> f64 {
    bed.grains().spheres.iter().map(|sphere| sphere.mass * 9.81).sum()
}

/// Height of the highest point [m] and its grain's place.
fn highest(bed: &Bed<Law>) -> (f64, usize) {
    let heights = bed.grains().spheres.iter().enumerate().map(|(k, s)| (s.position.z + s.radius, k));
    heights.fold((0.0, 0), |top, next| if next.0 > top.0 { next } else { top })
}

/// A bed that sleeps soon, and a grain thrown up from its top at `speed` [m/s].
fn thrown_from_sleepers(speed: f64) -> Bed<Law> {
    let mut bed = settled();
    bed.set_active_zone(Some(zone())).unwrap();
    let (_, place) = highest(&bed);
    bed.grains_mut().spheres[place].velocity.z = speed;
    bed
}

#[test]
fn a_bed_at_rest_falls_asleep_and_wakes_with_its_springs() {
    let mut bed = settled();
    let before = bed.energy();
    let n_contacts = bed.n_contacts();
    bed.set_active_zone(Some(zone())).unwrap();
    go_on(&mut bed, 1000);
    let account = *bed.zone().unwrap();
    assert_eq!(account.n_awake, 0, "{account:?}");
    assert_eq!(account.n_changes, 1, "{account:?}");
    assert!((-bed.plane_force(0).z / weight(&bed) - 1.0).abs() < 1e-2, "{}", bed.plane_force(0).z);
    assert!((bed.n_contacts() as f64 / n_contacts as f64 - 1.0).abs() < 0.01);
    assert_eq!(bed.contacts().count(), bed.n_contacts());
    let (after, scale) = (bed.energy(), before.contacts.elastic());
    assert!((after.contacts.elastic() / scale - 1.0).abs() < 1e-3, "{scale} {}", after.contacts.elastic());
    // Nothing changes any more.
    let asleep = postcard::to_allocvec(&bed.grains().spheres).unwrap();
    go_on(&mut bed, 500);
    assert!(asleep == postcard::to_allocvec(&bed.grains().spheres).unwrap());
    // Turned off, the bed is at rest still: no contact has forgotten its spring.
    bed.set_active_zone(None).unwrap();
    go_on(&mut bed, 500);
    let [kinetic, _] = bed.grains().kinetic_energy();
    assert!(kinetic < 1e-6 * weight(&bed) * 4e-3, "{kinetic}");
    assert!((bed.energy().contacts.elastic() / scale - 1.0).abs() < 1e-3);
}

#[test]
fn a_grain_that_falls_on_sleepers_wakes_them_and_they_fall_asleep_again() {
    let mut bed = thrown_from_sleepers(0.8);
    let (mut flew_alone, mut most) = (false, 0);
    for _ in 0..300 {
        go_on(&mut bed, 20);
        let n_awake = bed.zone().unwrap().n_awake;
        flew_alone |= n_awake == 1;
        most = if flew_alone { most.max(n_awake) } else { 0 };
    }
    assert!(flew_alone, "all but the flying grain sleep");
    go_on(&mut bed, 6000);
    let account = bed.zone().unwrap();
    assert!(most > 5 && account.n_woken > 0, "{most} awake at most, {account:?}");
    assert_eq!(account.n_awake, 0, "{account:?}");
    assert_eq!(account.n_surprised, 0);
    assert!((-bed.plane_force(0).z / weight(&bed) - 1.0).abs() < 2e-2, "{}", bed.plane_force(0).z);
}

/// A bed of which only what lies within reach of its top is awake.
fn awake_at_the_top(wake: f64) -> Bed<Law> {
    let mut bed = settled();
    bed.set_active_zone(Some(ActiveZone { wake, ..zone() })).unwrap();
    let (top, _) = highest(&bed);
    bed.keep_awake(vec![[Vec3::new(0.0, 0.0, top - 0.03), Vec3::new(0.06, 0.06, top)]], 0.0);
    go_on(&mut bed, 1000);
    let n_awake = bed.zone().unwrap().n_awake;
    assert!((100..400).contains(&n_awake), "{n_awake}");
    bed
}

#[test]
fn the_border_takes_up_what_it_gives_and_nothing_else() {
    let mut bed = awake_at_the_top(f64::INFINITY);
    let mass = |bed: &Bed<Law>| -> f64 {
        let of_awake = bed.grains().spheres.iter().take(bed.zone().unwrap().n_awake);
        of_awake.map(|sphere| sphere.mass).sum()
    };
    // Above the border nobody touches the floor: contact forces of awake and sleeping grains cancel to the last digits.
    bed.predict(DT).unwrap();
    bed.contact_forces(DT);
    let loads = &bed.grains().loads;
    let sum: f64 = loads.iter().map(|load| load.force.z).sum();
    let scale: f64 = loads.iter().map(|load| load.force.z.abs()).sum();
    assert!(scale > 1.0 && sum.abs() < 1e-13 * scale, "{sum} of {scale}");
    bed.correct(DT);
    // What gravity gives the awake grains while they are shaken is what they have and what the border took up.
    let spheres = &mut bed.grains_mut().spheres;
    for sphere in spheres.iter_mut().filter(|sphere| sphere.velocity.norm_squared() > 0.0) {
        sphere.velocity.z += 0.02;
    }
    let awake_mass = {
        let moving = bed.grains().spheres.iter().filter(|sphere| sphere.velocity.norm_squared() > 0.0);
        moving.map(|sphere| sphere.mass).sum::<f64>()
    };
    assert!(awake_mass > 0.0 && mass(&bed) > 0.0);
    let (before, account_before) = (bed.grains().momentum().z, *bed.zone().unwrap());
    go_on(&mut bed, 2000);
    let account = *bed.zone().unwrap();
    assert_eq!(account.n_changes, account_before.n_changes);
    let gravity = -9.81 * awake_mass * 2000.0 * DT;
    let taken = account.border_impulse.z - account_before.border_impulse.z;
    let found = bed.grains().momentum().z - before + taken;
    // The border's sum lags by a step, and counts the first and the last instant whole instead of half.
    assert!((gravity - found).abs() < 2.0 * 9.81 * awake_mass * DT, "{gravity} against {found}");
}

#[test]
fn a_tool_wakes_what_it_was_said_to_reach_and_what_it_touches_all_the_same() {
    let mut bed = settled();
    bed.set_active_zone(Some(zone())).unwrap();
    go_on(&mut bed, 1000);
    assert_eq!(bed.zone().unwrap().n_awake, 0);
    let (top, _) = highest(&bed);
    bed.keep_awake(vec![[Vec3::new(0.02, 0.02, top - 0.01), Vec3::new(0.03, 0.03, top)]], 0.0);
    go_on(&mut bed, 400);
    let n_kept = bed.zone().unwrap().n_awake;
    assert!(n_kept > 5 && n_kept < 300, "{n_kept}");
    bed.keep_awake(Vec::new(), 0.0);
    go_on(&mut bed, 400);
    assert_eq!(bed.zone().unwrap().n_awake, 0);
    // A push on a grain that nobody announced.
    let (_, place) = highest(&bed);
    let id = bed.grains().ids[place];
    bed.run(2000, DT, |grains| {
        let place = grains.ids.iter().position(|&i| i == id).unwrap();
        grains.loads[place].force.z += 0.1;
        Ok::<(), Failure>(())
    })
    .unwrap();
    assert!(bed.zone().unwrap().n_surprised > 0);
    let place = bed.grains().ids.iter().position(|&i| i == id).unwrap();
    assert!(bed.grains().spheres[place].position.z > top + 0.01, "it flies");
}

#[test]
fn blocks_wake_when_the_force_on_them_changes() {
    // The awake top becomes ten times as heavy.
    let n_woken = [f64::INFINITY, 0.5].map(|wake| {
        let mut bed = awake_at_the_top(wake);
        let n_woken = bed.zone().unwrap().n_woken;
        bed.run(500, DT, |grains| {
            for (sphere, load) in grains.spheres.iter().zip(&mut grains.loads) {
                load.force.z -= 9.0 * 9.81 * sphere.mass * f64::from(u8::from(sphere.velocity.z != 0.0));
            }
            Ok::<(), Failure>(())
        })
        .unwrap();
        bed.zone().unwrap().n_woken - n_woken
    });
    assert!(n_woken[0] == 0 && n_woken[1] > 3, "{n_woken:?}");
}

#[test]
fn sleepers_give_the_same_bytes_on_any_threads_and_after_any_restart() {
    let start = postcard::to_allocvec(&thrown_from_sleepers(0.3)).unwrap();
    let results = [1, 2, 3].map(|n_threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().unwrap();
        pool.install(|| {
            let mut bed: Bed<Law> = postcard::from_bytes(&start).unwrap();
            go_on(&mut bed, 3000);
            let account = *bed.zone().unwrap();
            assert!(account.n_woken > 0 && account.n_changes > 2, "{account:?}");
            postcard::to_allocvec(&bed).unwrap()
        })
    });
    let mut split: Bed<Law> = postcard::from_bytes(&start).unwrap();
    for n_steps in [1, 299, 1400, 1300] {
        go_on(&mut split, n_steps);
        split = postcard::from_bytes(&postcard::to_allocvec(&split).unwrap()).unwrap();
    }
    assert!(results[0] == results[1] && results[0] == results[2], "threads");
    assert!(results[0] == postcard::to_allocvec(&split).unwrap(), "restart");
}
