//! Speed costs no accuracy: the shipped cases as they run, against the same solved without any of
//! the shortcuts that make them fast.
//!
//! The other run searches contact by brute force and takes every sample of the femur anew, so that
//! every share is looked at, and nothing that was seen before is extrapolated.
//! Its tolerances are ten times tighter, and every force that is called balanced was computed.

use std::{ops::ControlFlow, path::Path, sync::Arc};

use condyle::{
    contact::{ContactLaw, ContactMemory, ContactModel, Foundation, Search, TouchedNode},
    evolve::{CycleRecord, March, Progress, WearTest},
    geometry::{ArticulatingSurface, Counterface},
    machine::{Chain, JointIndex, Simulator, SolverCounters, knee::KNEE, settle},
    spatial::RelativeMotion,
};
use condyle_case::case::Case;

/// Largest relative error of a result.
const TOLERANCE: f64 = 1e-3;
/// How much tighter the exact run's tolerances are.
const TIGHTER: f64 = 10.0;

/// A shipped case; none if its meshes are not there.
fn case(name: &str) -> Option<Case> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let is_there = root.join("../shared/data/dm-knee").is_dir();
    if name.starts_with("dm") && !is_there {
        eprintln!("skipped: {name}: the data of subject DM are not there");
        return None;
    }
    Some(Case::read(&root.join("cases").join(name)).expect("a shipped case is good"))
}

/// Its test.
fn built(case: &Case) -> WearTest {
    case.build(1).expect("a shipped case builds").test
}

/// Its law of contact without any shortcut.
fn plain(case: &Case) -> Foundation {
    let mut law = case.foundation(&built(case).insert);
    law.settings.search = Search::BruteForce;
    law.settings.sample_reuse_mm = 0.0;
    law
}

/// Its test without shortcuts in the contact, with tighter tolerances, and without trust in
/// predictions.
fn exact(case: &Case) -> WearTest {
    let mut test = built(case);
    test.contact = Arc::new(plain(case));
    let time = &mut test.time;
    time.force_tolerance_n /= TIGHTER;
    time.repeat_tolerance_mm /= TIGHTER;
    time.repeat_tolerance_rad /= TIGHTER;
    time.trusts_prediction = false;
    test
}

/// A march to its end.
fn marched(case: &Case, test: WearTest) -> March {
    let mut march = March::start(test).expect("a shipped case settles");
    assert_settled(case, &march);
    while !march.is_done() {
        let update = march.update(&mut go_on).expect("a solved update");
        assert!(update.is_continue(), "nobody stops it");
    }
    march
}

fn go_on(_: Progress) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// A contact of a march's bodies that knows nothing yet.
fn anew<'a>(
    march: &'a March,
    surface: &'a ArticulatingSurface,
    law: &'a dyn ContactLaw,
) -> Box<dyn ContactModel + 'a> {
    law.contact(march.bodies(surface), ContactMemory::default())
}

/// The neutral position is one for the contact searched by brute force too.
fn assert_settled(case: &Case, march: &March) {
    let (test, zero_mm) = (march.test(), march.state().zero_mm);
    let chain = Chain::new(test.machine(), zero_mm, test.flexion_axis_mm);
    let (surface, law) = (march.insert().surface(), plain(case));
    let mut contact = anew(march, &surface, &law);
    let settled = settle(
        test.machine(),
        &chain,
        contact.as_mut(),
        test.time.force_tolerance_n,
        &mut SolverCounters::default(),
    )
    .expect("it has settled before");
    let found = &march.state().activities[0].machine.now.positions;
    for joint in JointIndex::ALL {
        let apart = joint.of(&settled) - joint.of(found);
        let name = KNEE.joint(joint).long_name;
        assert!(apart.abs() < 1e-4, "{name}: {apart}");
    }
}

/// Largest difference over a cycle of every freedom, as a fraction of its range.
fn kinematics_apart(found: &CycleRecord, exact: &CycleRecord) -> [f64; 6] {
    [0, 1, 2, 3, 4, 5].map(|j| {
        let places = exact.rows.iter().map(|row| row.positions[j]);
        let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| {
            (low.min(at), high.max(at))
        });
        let rows = found.rows.iter().zip(&exact.rows);
        let apart = rows.map(|(found, exact)| (found.positions[j] - exact.positions[j]).abs());
        apart.fold(0.0, f64::max) / (high - low)
    })
}

/// Asserts that a case as it runs is the exact one, and prints how near it is.
fn assert_exact(name: &str) {
    let Some(case) = case(name) else { return };
    let (found, exact) = (marched(&case, built(&case)), marched(&case, exact(&case)));
    let (now, truth) = (found.state(), exact.state());
    let mut apart = Vec::new();
    let (last, true_last) = (now.updates.last().unwrap(), truth.updates.last().unwrap());
    let off = |found: f64, exact: f64| (found / exact - 1.0).abs();
    apart.push((
        "mass loss".to_owned(),
        off(last.mass_loss_mg, true_last.mass_loss_mg),
    ));
    apart.push((
        "maximum depth".to_owned(),
        off(last.max_depth_mm, true_last.max_depth_mm),
    ));
    let (cycles, true_cycles) = (
        &now.activities[0].first_and_last,
        &truth.activities[0].first_and_last,
    );
    let ((first, last), (true_first, true_last)) =
        (cycles.as_ref().unwrap(), true_cycles.as_ref().unwrap());
    for (which, found, exact) in [("first", first, true_first), ("last", last, true_last)] {
        for (joint, off) in KNEE.joints.iter().zip(kinematics_apart(found, exact)) {
            apart.push((format!("{} in the {which} cycle", joint.long_name), off));
        }
    }
    println!("{name}: {:?} exact {:?}", now.counters, truth.counters);
    for (what, off) in &apart {
        println!("  {what}: {:.5} %", 100.0 * off);
    }
    for (what, off) in &apart {
        assert!(*off <= TOLERANCE, "{name}: {what} is {off:e} away");
    }
}

/// Steps from every tenth increment of a gait, as fractions of the way to the next: in the end of
/// some 0.001 to 0.02 mm, and one to the increment itself.
const SMALL_STEPS: [f64; 9] = [0.0, 0.002, 0.004, 0.01, 0.02, 0.03, 0.05, 0.06, 0.08];

/// What a foundation walked along a gait in small steps may be from one made anew: a
/// hundred-thousandth of the force, or half of what may be left out of balance, if that is more.
const ASTRAY: f64 = 1e-5;

/// What shares that have just passed from one arc of a generic femur to the other may add to the
/// force: the mean gap over a share bends with the surface, so it jumps there by spread times the
/// change of curvature, and an extrapolated sample jumps a little later.
fn jump_n(
    march: &March,
    surface: &ArticulatingSurface,
    law: &Foundation,
    touched: &[TouchedNode],
    motion: &RelativeMotion,
) -> f64 {
    let Counterface::Generic(femur) = march.counterface() else {
        return 0.0;
    };
    let shape = femur.shape();
    let (sine, cosine) = shape.transition_deg.to_radians().sin_cos();
    let change_per_mm = 1.0 / shape.posterior_radius_mm - 1.0 / shape.distal_radius_mm;
    let jump_n = |node: &TouchedNode| {
        let share = &surface.shares[node.node as usize];
        let place = motion.pose.to_counterface(&share.centre);
        let is_passing = (place.x * cosine - place.y * sine).abs() <= law.settings.sample_reuse_mm;
        let slope = law.stiffness_mpa_per_mm(march.insert(), node.node as usize);
        let jump_mm = share.spread_mm2 * change_per_mm;
        f64::from(u8::from(is_passing)) * jump_mm * slope * share.area_mm2
    };
    touched.iter().map(jump_n).sum()
}

/// Walks a foundation along the first cycle of a test, and holds its force at every step against
/// that of one made anew.
fn assert_small_steps_are_exact(name: &str) {
    let Some(case) = case(name) else { return };
    let march = March::start(built(&case)).expect("a shipped case settles");
    let (test, state) = (march.test(), march.state());
    let (surface, law) = (march.insert().surface(), case.foundation(march.insert()));
    let chain = Chain::new(test.machine(), state.zero_mm, test.flexion_axis_mm);
    let mut walked = anew(&march, &surface, &law);
    let mut simulator = Simulator::new(test.machine(), &chain, walked.as_mut(), &test.time);
    let start = &state.activities[0].machine;
    let rows = simulator
        .cycle(start, &mut |_| ControlFlow::Continue(()))
        .expect("a solved cycle")
        .continue_value()
        .expect("nobody stops it")
        .rows;
    let mut walked = anew(&march, &surface, &law);
    let (mut worst_n, mut worst) = (0.0_f64, 0.0_f64);
    for (row, next) in rows.iter().zip(&rows[1..]).step_by(10) {
        for part in SMALL_STEPS {
            let between =
                |j: usize| row.positions[j] + part * (next.positions[j] - row.positions[j]);
            let positions = [0, 1, 2, 3, 4, 5].map(between);
            let motion = chain.at(&positions).motion(&[0.0; 6]);
            let fresh = anew(&march, &surface, &law).respond(&motion).wrench;
            let force_n = fresh.force;
            let apart_n = (walked.respond(&motion).wrench.force - force_n).norm();
            let touched = walked.evaluate(&motion).touched;
            let allowed_n = (ASTRAY * force_n.norm()).max(0.5 * test.time.force_tolerance_n)
                + jump_n(&march, &surface, &law, &touched, &motion);
            let place = format!("{name} {} %: {apart_n:.1e} N", row.percent);
            assert!(apart_n <= allowed_n, "{place} of {}", force_n.norm());
            worst_n = worst_n.max(apart_n);
            worst = worst.max(apart_n / force_n.norm());
        }
    }
    println!("{name}: {worst_n:.1e} N, {worst:.1e} of the force");
}

#[test]
fn samples_extrapolated_along_the_gait_of_the_default_case_keep_the_force() {
    assert_small_steps_are_exact("knight-2007.toml");
}

#[test]
fn samples_extrapolated_along_the_gait_of_a_real_implant_keep_the_force() {
    assert_small_steps_are_exact("dm-knee.toml");
}

#[test]
fn the_default_case_is_within_a_thousandth_of_itself_without_shortcuts() {
    assert_exact("knight-2007.toml");
}

#[test]
fn a_real_implant_is_within_a_thousandth_of_itself_without_shortcuts() {
    assert_exact("dm-knee.toml");
}

/// Asserts that what a march knows of the cycles before changes not a bit: it is given up and
/// resumed at every update, which leaves of it what a checkpoint holds.
fn assert_the_same_when_resumed(name: &str) {
    let Some(case) = case(name) else { return };
    let test = built(&case);
    let start = |test| March::start(test).expect("a shipped case settles");
    let (mut whole, mut resumed) = (start(test.clone()), start(test.clone()));
    for update in 1..=4 {
        assert!(
            whole
                .update(&mut go_on)
                .expect("a solved update")
                .is_continue()
        );
        resumed = March::resume(test.clone(), resumed.state().clone());
        assert!(
            resumed
                .update(&mut go_on)
                .expect("a solved update")
                .is_continue()
        );
        assert!(whole.state() == resumed.state(), "{name}: update {update}");
    }
}

#[test]
fn the_default_case_resumed_at_every_update_is_the_same_to_the_bit() {
    assert_the_same_when_resumed("knight-2007.toml");
}

#[test]
fn a_real_implant_resumed_at_every_update_is_the_same_to_the_bit() {
    assert_the_same_when_resumed("dm-knee.toml");
}
