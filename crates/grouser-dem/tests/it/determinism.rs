//! The same bytes: threads, instruction sets, fused steps, restarts – in every precision.

use crate::*;

type Law = HertzMindlin;

fn column<P: Precision>(n_grains: usize) -> Bed<Law, P> {
    let (mut spheres, settings) = falling_column::<P>(n_grains, 7);
    for sphere in &mut spheres {
        sphere.velocity.z = P::Real::from_f64(-2.0);
    }
    Bed::new(spheres, settings, table(0.5, 0.5, Tail::CutCorrected), HertzMindlin::new(Tail::CutCorrected))
        .unwrap()
}

fn go_on<P: Precision>(bed: &mut Bed<Law, P>, n_steps: u64) {
    bed.run(n_steps, 4e-5, |_| Ok::<(), Failure>(())).unwrap();
}

fn bytes<P: Precision>(bed: &Bed<Law, P>) -> Vec<u8> {
    postcard::to_allocvec(bed).unwrap()
}

fn on_any_number_of_threads<P: Precision>(n_grains: usize, n_steps: u64) {
    let results = [1, 2, 3, 8].map(|n_threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().unwrap();
        pool.install(|| {
            let mut bed = column::<P>(n_grains);
            go_on(&mut bed, n_steps);
            assert!(bed.n_contacts() > n_grains / 6 && bed.n_rebuilds() > 2);
            bytes(&bed)
        })
    });
    assert!(results.iter().all(|result| *result == results[0]));
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    on_any_number_of_threads::<F64>(3000, 1000);
    on_any_number_of_threads::<Mixed>(1500, 700);
    on_any_number_of_threads::<F32>(1500, 700);
}

fn on_every_instruction_set<P: Precision>(n_grains: usize, n_steps: u64) {
    alike_on_every_instruction_set(|| column::<P>(n_grains), n_grains, n_steps);
}

fn alike_on_every_instruction_set<P: Precision>(
    column: impl Fn() -> Bed<Law, P>,
    n_grains: usize,
    n_steps: u64,
) {
    let mut baseline = column();
    baseline.use_instruction_set(InstructionSet::Baseline);
    go_on(&mut baseline, n_steps);
    assert!(baseline.n_contacts() > n_grains / 6 && baseline.energy().contacts.dissipated() > 0.0);
    let mut sets = vec![InstructionSet::detect()];
    #[cfg(target_arch = "x86_64")]
    if InstructionSet::detect() == InstructionSet::Avx512 {
        sets.push(InstructionSet::Avx2);
    }
    for set in sets {
        let mut other = column();
        other.use_instruction_set(set);
        go_on(&mut other, n_steps);
        assert!(bytes(&baseline) == bytes(&other), "{set:?}");
    }
}

#[test]
fn every_instruction_set_gives_the_same_bytes() {
    on_every_instruction_set::<F64>(3000, 800);
    on_every_instruction_set::<Mixed>(1500, 700);
    on_every_instruction_set::<F32>(1500, 700);
}

fn with_every_motion<P: Precision>() {
    for (rotation, has_orientations) in
        [(Rotation::Fixed, false), (Rotation::Fixed, true), (Rotation::Free, true)]
    {
        let column = || {
            let bed = column::<P>(500);
            let settings = BedSettings { rotation, ..bed.settings().clone() };
            let spheres = bed.grains().spheres.clone();
            let mut bed =
                Bed::new(spheres, settings, bed.pair_table().clone(), HertzMindlin::new(Tail::CutCorrected))
                    .unwrap();
            if has_orientations {
                bed.grains_mut().track_orientations();
            }
            bed
        };
        alike_on_every_instruction_set(column, 500, 500);
    }
}

#[test]
fn held_grains_and_grains_with_orientations_give_the_same_bytes_on_every_instruction_set() {
    with_every_motion::<F64>();
    with_every_motion::<Mixed>();
    with_every_motion::<F32>();
}

fn split_anywhere<P: Precision>(n_grains: usize) {
    let mut straight = column::<P>(n_grains);
    go_on(&mut straight, 700);
    let mut split = column::<P>(n_grains);
    for n_steps in [1, 123, 300, 276] {
        go_on(&mut split, n_steps);
        split = postcard::from_bytes(&bytes(&split)).unwrap();
    }
    assert!(bytes(&straight) == bytes(&split));
}

#[test]
fn a_run_split_anywhere_and_restored_from_bytes_equals_the_straight_run() {
    split_anywhere::<F64>(3000);
    split_anywhere::<Mixed>(1000);
    split_anywhere::<F32>(1000);
}

fn in_separate_phases<P: Precision>() {
    let mut fused = column::<P>(1000);
    go_on(&mut fused, 300);
    let mut separate = column::<P>(1000);
    for _ in 0..300 {
        separate.predict(4e-5).unwrap();
        separate.contact_forces(4e-5);
        separate.correct(4e-5);
    }
    assert!(bytes(&fused) == bytes(&separate));
}

#[test]
fn separate_phases_equal_the_fused_sweep() {
    in_separate_phases::<F64>();
    in_separate_phases::<Mixed>();
    in_separate_phases::<F32>();
}
