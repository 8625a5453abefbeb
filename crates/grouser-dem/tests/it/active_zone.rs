//! The active zone: sleeping grains cost nothing, carry what they carried, and wake when something reaches them.

use crate::*;

type Law = HertzMindlin<false, false>;

const DT: f64 = 4e-5;

fn zone() -> ActiveZone {
    ActiveZone { block_m: 0.016, calm_speed: 2e-3, calm_time_s: 4e-3, imbalance: 0.1 }
}

/// A bed at rest, periodic in x and y, 0.06 m wide.
fn settled(n: usize) -> Bed<Law> {
    let (spheres, mut settings) = falling_column::<F64>(n, 7);
    // Grains that roll freely may go on for long.
    settings.rotation = Rotation::Fixed;
    let mut bed = Bed::new(spheres, settings, table(0.3, 0.5, Tail::CutCorrected), HertzMindlin).unwrap();
    go_on(&mut bed, 25_000);
    bed
}

fn go_on(bed: &mut Bed<Law>, n_steps: u64) {
    bed.run(n_steps, DT, |_| Ok::<(), Failure>(())).unwrap();
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
    let mut bed = settled(600);
    bed.set_active_zone(Some(zone())).unwrap();
    let (_, place) = highest(&bed);
    bed.grains_mut().spheres[place].velocity.z = speed;
    bed
}

#[test]
fn a_bed_at_rest_falls_asleep_and_carries_its_weight_and_its_elastic_energy() {
    let mut bed = settled(600);
    let before = bed.energy();
    let n_contacts = bed.n_contacts();
    bed.set_active_zone(Some(zone())).unwrap();
    go_on(&mut bed, 1000);
    let account = *bed.zone().unwrap();
    assert_eq!(account.n_awake, 0, "{account:?}");
    assert!((-bed.plane_force(0).z / weight(&bed) - 1.0).abs() < 1e-2, "{}", bed.plane_force(0).z);
    assert!((bed.n_contacts() as f64 / n_contacts as f64 - 1.0).abs() < 0.01);
    let (after, scale) = (bed.energy(), before.contacts.elastic());
    assert!((after.contacts.elastic() / scale - 1.0).abs() < 0.02, "{scale} {}", after.contacts.elastic());
    // Nothing changes any more.
    let asleep = postcard::to_allocvec(&bed.grains().spheres).unwrap();
    go_on(&mut bed, 500);
    assert!(asleep == postcard::to_allocvec(&bed.grains().spheres).unwrap());
    // Turned off, the bed is at rest still: no contact has forgotten its spring.
    bed.set_active_zone(None).unwrap();
    go_on(&mut bed, 500);
    let [kinetic, _] = bed.grains().kinetic_energy();
    assert!(kinetic < 1e-6 * weight(&bed) * 4e-3, "{kinetic}");
    assert!((bed.energy().contacts.elastic() / scale - 1.0).abs() < 0.02);
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
    assert!(most > 20 && account.n_woken > 0, "{most} awake at most");
    assert_eq!(account.n_awake, 0, "{account:?}");
    assert_eq!(account.n_surprised, 0);
    assert!(
        (-bed.plane_force(0).z / weight(&bed) - 1.0).abs() < 2e-2,
        "{}",
        bed.plane_force(0).z / weight(&bed)
    );
}

#[test]
fn momentum_at_the_border_is_accounted_for() {
    // What gravity and floor give is what the grains have, what sleepers took up, and what falling asleep took.
    let mut bed = thrown_from_sleepers(0.5);
    // The floor's force of the first instant.
    bed.step(DT).unwrap();
    let momentum = |bed: &Bed<Law>| bed.grains().momentum().z;
    let (before, weight) = (momentum(&bed), weight(&bed));
    let mut impulse = 0.0;
    for _ in 0..4000 {
        let floor = -bed.plane_force(0).z;
        bed.step(DT).unwrap();
        // The trapezium of the two instants of a step.
        impulse += DT * (0.5 * (floor - bed.plane_force(0).z) - weight);
    }
    let account = bed.zone().unwrap();
    let found = momentum(&bed) - before + account.withheld.z + account.momentum_taken.z;
    assert!(account.n_woken > 0);
    assert!((impulse - found).abs() < 0.01 * before.abs(), "{impulse} against {found}, {account:?}");
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
            assert!(account.n_woken > 0 && account.n_fallen_asleep > 0, "{account:?}");
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

#[test]
fn a_tool_wakes_what_it_was_said_to_reach_and_what_it_touches_all_the_same() {
    let mut bed = settled(600);
    bed.set_active_zone(Some(zone())).unwrap();
    go_on(&mut bed, 1000);
    assert_eq!(bed.zone().unwrap().n_awake, 0);
    let (top, _) = highest(&bed);
    bed.keep_awake(vec![[Vec3::new(0.02, 0.02, top - 0.01), Vec3::new(0.03, 0.03, top)]]);
    go_on(&mut bed, 400);
    let n_kept = bed.zone().unwrap().n_awake;
    assert!(n_kept > 5 && n_kept < 300, "{n_kept}");
    bed.keep_awake(Vec::new());
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
