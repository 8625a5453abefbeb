//! The same bytes: threads, instruction sets, fused steps, restarts.

use crate::*;

type Law = HertzMindlin<false, false>;

fn column() -> Bed<Law> {
    let (mut spheres, settings) = falling_column::<F64>(3000, 7);
    for sphere in &mut spheres {
        sphere.velocity.z = -2.0;
    }
    Bed::new(spheres, settings, table(0.5, 0.5, Tail::CutCorrected), HertzMindlin).unwrap()
}

fn go_on(bed: &mut Bed<Law>, n_steps: u64) {
    bed.run(n_steps, 4e-5, |_| Ok::<(), Failure>(())).unwrap();
}

fn bytes(bed: &Bed<Law>) -> Vec<u8> {
    postcard::to_allocvec(bed).unwrap()
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let results = [1, 2, 3, 8].map(|n_threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().unwrap();
        pool.install(|| {
            let mut bed = column();
            go_on(&mut bed, 1000);
            assert!(bed.n_contacts() > 500 && bed.n_rebuilds() > 2);
            bytes(&bed)
        })
    });
    assert!(results.iter().all(|result| *result == results[0]));
}

#[test]
fn every_instruction_set_gives_the_same_bytes() {
    let mut baseline = column();
    baseline.use_instruction_set(InstructionSet::Baseline);
    let mut detected = column();
    go_on(&mut baseline, 800);
    go_on(&mut detected, 800);
    assert!(bytes(&baseline) == bytes(&detected));
}

#[test]
fn a_run_split_anywhere_and_restored_from_bytes_equals_the_straight_run() {
    let mut straight = column();
    go_on(&mut straight, 900);
    let mut split = column();
    for n_steps in [1, 123, 500, 276] {
        go_on(&mut split, n_steps);
        split = postcard::from_bytes(&bytes(&split)).unwrap();
    }
    assert!(bytes(&straight) == bytes(&split));
}

#[test]
fn separate_phases_equal_the_fused_sweep() {
    let mut fused = column();
    go_on(&mut fused, 300);
    let mut separate = column();
    for _ in 0..300 {
        separate.predict(4e-5).unwrap();
        separate.contact_forces(4e-5);
        separate.correct(4e-5);
    }
    assert!(bytes(&fused) == bytes(&separate));
}
