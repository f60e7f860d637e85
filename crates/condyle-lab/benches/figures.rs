//! The figures that condyle holds itself to: one contact evaluation, and whole tests.
//!
//! `cargo bench -p condyle-lab` from the project's root.

use std::{hint::black_box, ops::ControlFlow, path::PathBuf};

use condyle::{
    contact::{ContactModel, Foundation, Pose, RelativeMotion, Vec6},
    evolve::{March, WearTest},
    machine::{Chain, Drive, Effort, Freedom, Waveform, settle},
};
use condyle_io::case::Case;
use divan::{Bencher, counter::ItemsCount};

fn main() {
    divan::main();
}

/// The case of that name, built; none where its data are not there.
fn built(name: &str) -> Option<WearTest> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../../cases")
        .join(name);
    let case = Case::read(&path)
        .map_err(|error| eprintln!("skipped: {name}: {error}"))
        .ok()?;
    Some(case.build(1).expect("a shipped case builds").test)
}

/// Increments of a gait cycle.
const INCREMENTS: u32 = 200;

/// Poses of static balance under 2600 N at every increment of the gait's flexion.
fn poses_at_2600_n(test: &WearTest, chain: &Chain) -> Vec<Pose> {
    let mut contact = Foundation::new(&test.contact, &test.femur, &test.insert);
    let Drive::Prescribed(flexion) = &test.machine.row(Freedom::Flexion).drive else {
        panic!("the benchmark's cases prescribe flexion");
    };
    let pose = |increment: u32| {
        let mut machine = test.machine.clone();
        let angle = flexion.at(f64::from(increment) / f64::from(INCREMENTS)).0;
        machine.freedoms[Freedom::Flexion as usize].drive = Drive::Locked(angle);
        machine.freedoms[Freedom::InferoSuperior as usize].drive =
            Drive::Loaded(Waveform::constant(-2600.0));
        let positions = settle(&machine, chain, &mut contact, 0.1, &mut Effort::default())
            .unwrap_or_else(|failed| panic!("at increment {increment}: {failed:?}"));
        chain.at(&positions).pose
    };
    (0..INCREMENTS).map(pose).collect()
}

/// One contact evaluation with its tangent, averaged over the poses of a gait under 2600 N: three
/// at every increment, as Newton's method makes them.
#[divan::bench(args = ["dm-knee.toml", "stanmore-force.toml"], sample_count = 20)]
fn contact_evaluation(bencher: Bencher<'_, '_>, case: &str) {
    evaluate_along_a_gait(bencher, case, 3);
}

/// The same with a single evaluation at every increment: the first one after the femur has moved,
/// which also looks for the nodes that have come near.
#[divan::bench(args = ["dm-knee.toml", "stanmore-force.toml"], sample_count = 20)]
fn first_contact_evaluation(bencher: Bencher<'_, '_>, case: &str) {
    evaluate_along_a_gait(bencher, case, 1);
}

fn evaluate_along_a_gait(bencher: Bencher<'_, '_>, case: &str, times: usize) {
    let Some(test) = built(case) else {
        return;
    };
    let march = March::start(test).expect("a shipped case settles");
    let test = march.test();
    let chain = Chain::new(&test.machine, march.state().zero_mm, test.flexion_axis_mm);
    let poses = poses_at_2600_n(test, &chain);
    let mut contact = Foundation::new(&test.contact, &test.femur, &test.insert);
    let twist = Vec6::new(0.1, 0.2, 1.0, 5.0, 0.0, 20.0);
    bencher
        .counter(ItemsCount::new(poses.len() * times))
        .bench_local(|| {
            for &pose in &poses {
                for _ in 0..times {
                    black_box(contact.respond(&RelativeMotion { pose, twist }));
                    black_box(contact.tangent());
                }
            }
        });
}

/// A whole test, from the parsed case to the last update, without files.
#[divan::bench(args = ["stanmore-force.toml", "stanmore-displacement.toml", "dm-knee.toml"], sample_count = 5, sample_size = 1)]
fn whole_test(bencher: Bencher, case: &str) {
    if built(case).is_none() {
        return;
    }
    bencher.with_inputs(|| ()).bench_values(|()| {
        let mut march =
            March::start(built(case).expect("looked for above")).expect("a shipped case settles");
        while !march.is_done() {
            march
                .update(&mut |_| ControlFlow::Continue(()))
                .expect("a shipped case is solved");
        }
        march.state().updates.len()
    });
}

/// Reading and preparing the bodies of a case.
#[divan::bench(args = ["stanmore-force.toml", "dm-knee.toml"], sample_count = 5, sample_size = 1)]
fn preparation(case: &str) -> bool {
    built(case).is_some()
}
