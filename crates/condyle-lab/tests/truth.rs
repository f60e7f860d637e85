//! Speed costs no accuracy: the shipped cases as they run, against the same solved without any of
//! the shortcuts that make them fast.
//!
//! The other run searches contact by brute force: its foundation is made anew for every single
//! evaluation, so that every share is looked at, and nothing that was seen before is moved along.
//! Its tolerances are ten times tighter, and every force that is called balanced was computed.

use std::{ops::ControlFlow, path::Path};

use condyle::{
    Vec3,
    contact::{ContactModel, Foundation, RelativeMotion, Tangent, TouchedNode, Vec6},
    evolve::{CycleRecord, March, MarchError, Progress, WearTest},
    machine::{Chain, Effort, FREEDOMS, settle},
};
use condyle_io::case::Case;

/// How far a result may be from the exact one, as a fraction.
const TOLERANCE: f64 = 1e-3;
/// How much tighter the exact run's tolerances are.
const TIGHTER: f64 = 10.0;

/// A foundation that knows nothing of the evaluations before.
struct BruteForce<'a> {
    test: &'a WearTest,
    last: Foundation<'a>,
}

impl<'a> BruteForce<'a> {
    fn new(test: &'a WearTest) -> Self {
        let last = anew(test);
        Self { test, last }
    }
}

fn anew(test: &WearTest) -> Foundation<'_> {
    Foundation::new(&test.contact, &test.femur, &test.insert)
}

impl ContactModel for BruteForce<'_> {
    fn respond(&mut self, motion: &RelativeMotion) -> Vec6 {
        self.last = anew(self.test);
        self.last.respond(motion)
    }

    fn tangent(&self) -> Tangent {
        self.last.tangent()
    }

    fn mean_slip(&self) -> [Vec3; 2] {
        self.last.mean_slip()
    }

    fn node_count(&self) -> usize {
        self.last.node_count()
    }

    fn touched(&mut self, motion: &RelativeMotion) -> Vec<TouchedNode> {
        self.respond(motion);
        self.last.touched(motion)
    }
}

/// A shipped case, built; none where its meshes are not there.
fn built(name: &str) -> Option<WearTest> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let is_there = root.join("../shared/data/dm-knee").is_dir();
    if name.starts_with("dm") && !is_there {
        let in_ci = std::env::var("CI").is_ok_and(|value| value == "true");
        assert!(!in_ci, "{name}: subject DM's data are needed under CI=true");
        eprintln!("skipped: {name}: the data of subject DM are not there");
        return None;
    }
    let case = Case::read(&root.join("cases").join(name)).expect("a shipped case is good");
    Some(case.build(1).expect("a shipped case builds").test)
}

/// A test with tighter tolerances, and without foresight.
fn tightened(mut test: WearTest) -> WearTest {
    let time = &mut test.time;
    time.force_tolerance_n /= TIGHTER;
    time.repeat_tolerance_mm /= TIGHTER;
    time.repeat_tolerance_rad /= TIGHTER;
    time.foresees = false;
    test
}

fn brute_force<'a>(test: &'a WearTest) -> Box<dyn ContactModel + 'a> {
    Box::new(BruteForce::new(test))
}

/// A march to its end.
fn marched(test: WearTest, update: impl Fn(&mut March) -> Result<(), MarchError>) -> March {
    let mut march = March::start(test).expect("a shipped case settles");
    assert_settled(&march);
    while !march.is_done() {
        update(&mut march).expect("a solved update");
    }
    march
}

fn go_on(_: Progress) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// The neutral position is one for the contact searched by brute force too.
fn assert_settled(march: &March) {
    let (test, zero_mm) = (march.test(), march.state().zero_mm);
    let chain = Chain::new(&test.machine, zero_mm, test.flexion_axis_mm);
    let tolerance_n = test.time.force_tolerance_n;
    let (mut contact, mut effort) = (BruteForce::new(test), Effort::default());
    let settled = settle(
        &test.machine,
        &chain,
        &mut contact,
        tolerance_n,
        &mut effort,
    )
    .expect("it has settled before");
    for freedom in FREEDOMS {
        let apart =
            settled[freedom as usize] - march.state().machine.now.positions[freedom as usize];
        assert!(apart.abs() < 1e-4, "{freedom:?}: {apart}");
    }
}

/// Largest difference over a cycle of every freedom, as a fraction of its range.
fn kinematics_apart(found: &CycleRecord, exact: &CycleRecord) -> [f64; 6] {
    FREEDOMS.map(|freedom| {
        let j = freedom as usize;
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
    let (Some(found), Some(exact)) = (built(name), built(name).map(tightened)) else {
        return;
    };
    let found = marched(found, |march| march.update(&mut go_on).map(|_| ()));
    let without = |march: &mut March| march.update_on(brute_force, &mut go_on).map(|_| ());
    let exact = marched(exact, without);
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
    let (cycles, true_cycles) = (&now.first_and_last, &truth.first_and_last);
    let ((first, last), (true_first, true_last)) =
        (cycles.as_ref().unwrap(), true_cycles.as_ref().unwrap());
    for (which, found, exact) in [("first", first, true_first), ("last", last, true_last)] {
        for (freedom, off) in FREEDOMS.iter().zip(kinematics_apart(found, exact)) {
            apart.push((format!("{freedom:?} in the {which} cycle"), off));
        }
    }
    println!("{name}: {:?} exact {:?}", now.effort, truth.effort);
    for (what, off) in &apart {
        println!("  {what}: {:.5} %", 100.0 * off);
    }
    for (what, off) in &apart {
        assert!(*off <= TOLERANCE, "{name}: {what} is {off:e} away");
    }
}

#[test]
fn the_default_case_is_within_a_thousandth_of_itself_without_shortcuts() {
    assert_exact("stanmore-force.toml");
}

#[test]
fn a_real_implant_is_within_a_thousandth_of_itself_without_shortcuts() {
    assert_exact("dm-knee.toml");
}
