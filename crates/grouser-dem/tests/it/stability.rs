//! The bound of the stable step under load, against beds that shake themselves apart beyond it.

use crate::*;

/// What 3,000 steps of `share` of the bound make out of nothing, over what contacts store [-].
fn gained(bed: &Bed<Rotating<HertzMindlin, ElasticPlasticRolling>>, share: f64) -> f64 {
    let (mut low, mut high) = (1e-7, 1e-2);
    while high / low > 1.001 {
        let middle = f64::sqrt(low * high);
        *(if bed.stability(middle).share < share { &mut low } else { &mut high }) = middle;
    }
    let mut run = bed.clone();
    let before = run.energy();
    let held = run.run(3000, low, |_| Ok::<(), Failure>(()));
    let after = run.energy();
    let lost = after.contacts.dissipated() - before.contacts.dissipated();
    let gained = (after.stored() + lost - before.stored()) / before.contacts.elastic();
    if held.is_err() { f64::INFINITY } else { gained }
}

/// Loads of 30 and 200 times the weight press grains by up to 9 and 28 % of their radius; without friction two dashpots of normal
/// motion decide, with it those of the tangential one.
#[test]
fn loaded_beds_keep_their_energy_up_to_the_limit_and_gain_it_at_twice_the_limit() {
    for (gravity, friction) in [(300.0, 0.0), (300.0, 0.6), (2000.0, 0.0), (2000.0, 0.6)] {
        let (spheres, mut settings) = falling_column::<F64>(300, 1);
        settings.gravity = Vec3::z() * -gravity;
        let rotation = ElasticPlasticRolling::new(0.5, 0.3).unwrap();
        let law = Rotating { forces: HertzMindlin::new(Tail::CutCorrected), rotation };
        let between = table(0.4, friction, Tail::CutCorrected);
        let mut bed = Bed::new(spheres, settings, between, law).unwrap();
        bed.set_largest_overlap(0.8);
        let criterion = SettleCriterion { kinetic_energy_ratio: 1e-7, longest_s: 1.0 };
        let mut settling = Settling::new(criterion, 1e-5);
        while settling.advance(&mut bed).unwrap().is_none() {}
        bed.keep_ledger(true);
        let [safe, beyond] = [1.0, 2.0].map(|times| gained(&bed, times * Stability::LIMIT));
        assert!(safe.abs() < 1e-6, "{gravity} m/s², friction {friction}: {safe} at the limit");
        assert!(beyond > 1.0, "{gravity} m/s², friction {friction}: {beyond} at twice the limit");
        println!("{gravity} {friction} {safe:.1e} {beyond:.1e}");
    }
}
