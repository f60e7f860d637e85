//! Newton's method on the default case: it converges quadratically, and where it stops without
//! evaluating, it might have evaluated.

use std::path::Path;

use condyle::{
    contact::{ContactMemory, ContactModel},
    evolve::{March, WearTest},
    geometry::ArticulatingSurface,
    machine::{Chain, MachineState, Simulator, TimeSettings},
};
use condyle_case::case::Case;

/// How far the residuals are followed, N.
const EXACT_N: f64 = 1e-7;
/// Below this the solution is near: Newton's method has no corner of the contact's edge or of
/// friction left on its way, N.
const NEAR_N: f64 = 1.0;
/// A residual r leaves at most this many times r^2, 1/N; the worst of a gait is 0.15.
const QUADRATIC_PER_N: f64 = 0.3;
/// The tangent is summed in single precision, and so off by some 1e-7 of itself: of a residual, a
/// correction leaves about so much besides.
const SINGLE: f64 = 3e-6;
/// Rounding of forces of some thousand newtons, N.
const ROUNDING_N: f64 = 2e-9;
/// A state that is accepted by prediction may be so many tolerances out of balance: the predicted
/// residual takes the contraction to be that of the correction before.
const PREDICTION: f64 = 5.0;

fn default_case() -> March {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let case = Case::read(&cases.join("knight-2007.toml")).expect("a shipped case is good");
    let test = case.build(1).expect("a shipped case builds").test;
    March::start(test).expect("a shipped case settles")
}

fn chain(march: &March) -> Chain {
    let test = march.test();
    Chain::new(test.machine(), march.state().zero_mm, test.flexion_axis_mm)
}

/// A contact that knows nothing yet.
fn contact<'a>(march: &'a March, surface: &'a ArticulatingSurface) -> Box<dyn ContactModel + 'a> {
    let law = &march.test().contact;
    law.contact(march.bodies(surface), ContactMemory::default())
}

fn simulator<'a>(
    test: &'a WearTest,
    chain: &'a Chain,
    contact: &'a mut dyn ContactModel,
    time: &'a TimeSettings,
) -> Simulator<'a> {
    Simulator::new(test.machine(), chain, contact, time)
}

/// The instants at which the increments of a gait cycle end, from its start.
fn ends(increments: usize) -> impl Iterator<Item = f64> {
    (1..=increments).map(move |place| place as f64 / increments as f64)
}

/// At the start of a cycle, and in the middle of its motion.
fn in_motion(march: &March) -> MachineState {
    let (test, chain, surface) = (march.test(), chain(march), march.insert().surface());
    let mut contact = contact(march, &surface);
    let mut simulator = simulator(test, &chain, contact.as_mut(), &test.time);
    let mut state = march.state().activities[0].machine;
    for to in ends(test.time.increments) {
        state = simulator
            .step(&state, to)
            .expect("a shipped case is solved");
    }
    MachineState {
        phase: state.phase % 1.0,
        ..state
    }
}

#[test]
fn near_the_solution_every_residual_is_the_square_of_the_one_before() {
    let march = default_case();
    let (test, chain, surface) = (march.test(), chain(&march), march.insert().surface());
    let mut contact = contact(&march, &surface);
    let time = TimeSettings {
        force_tolerance_n: EXACT_N,
        trusts_prediction: false,
        ..test.time
    };
    let mut simulator = simulator(test, &chain, contact.as_mut(), &time);
    let mut state = in_motion(&march);
    let (mut worst_per_n, mut pairs) = (0.0_f64, 0);
    for to in ends(time.increments) {
        state = simulator
            .step(&state, to)
            .expect("it converges to the last digits");
        let lengths_n = &simulator.residuals_n;
        assert_eq!(simulator.counters.halvings, 0, "at {to}: {lengths_n:?}");
        for pair in lengths_n.windows(2).filter(|pair| pair[0] < NEAR_N) {
            let [before, after] = [pair[0], pair[1]];
            let left = after - SINGLE * before - ROUNDING_N;
            let per_n = left / before.powi(2);
            assert!(per_n <= QUADRATIC_PER_N, "at {to}: {lengths_n:?}");
            (worst_per_n, pairs) = (worst_per_n.max(per_n), pairs + 1);
        }
    }
    println!("{pairs} pairs, at worst {worst_per_n:.2} r^2");
    assert!(pairs > time.increments);
}

/// A cycle as it was solved.
#[derive(Default)]
struct Solved {
    /// What is left out of balance where that was predicted and not evaluated, N.
    left_n: Vec<f64>,
    /// Increments that took one contact evaluation.
    at_once: usize,
}

impl Solved {
    /// A cycle from `state`, and where it ends.
    fn cycle(simulator: &mut Simulator<'_>, mut state: MachineState) -> (Self, MachineState) {
        let mut solved = Self::default();
        for to in ends(simulator.time.increments) {
            let before = simulator.counters;
            state = simulator
                .step(&state, to)
                .expect("a shipped case is solved");
            let counters = simulator.counters;
            let corrections = counters.newton_iterations - before.newton_iterations;
            let evaluations = counters.contact_evaluations - before.contact_evaluations;
            solved.at_once += usize::from(evaluations == 1);
            // One evaluation more than corrections is a step that ended with one.
            if evaluations == corrections {
                solved.left_n.push(simulator.out_of_balance_n(&state));
            }
        }
        state.phase %= 1.0;
        (solved, state)
    }

    /// How many increments ended by prediction; none far out of balance, and few at all.
    fn predicted_ends(&self, tolerance_n: f64) -> usize {
        let all = self.left_n.len();
        let above = self.left_n.iter().filter(|left| **left > tolerance_n);
        let above = above.count();
        let worst_n = self.left_n.iter().copied().fold(0.0, f64::max);
        println!("{all} predicted, {above} above {tolerance_n} N, at worst {worst_n:.3} N");
        assert!(worst_n <= PREDICTION * tolerance_n, "{worst_n}");
        assert!(20 * above <= all, "{above} of {all}");
        all
    }
}

#[test]
fn a_state_accepted_by_prediction_is_nearly_in_balance() {
    let march = default_case();
    let (test, chain, surface) = (march.test(), chain(&march), march.insert().surface());
    let mut contact = contact(&march, &surface);
    let (tolerance_n, increments) = (test.time.force_tolerance_n, test.time.increments);
    let mut simulator = simulator(test, &chain, contact.as_mut(), &test.time);
    let (first, state) = Solved::cycle(&mut simulator, in_motion(&march));
    assert!(first.predicted_ends(tolerance_n) > increments / 2);
    let (second, _) = Solved::cycle(&mut simulator, state);
    second.predicted_ends(tolerance_n);
    println!("at once: {} and then {}", first.at_once, second.at_once);
    assert!(2 * second.at_once > increments && 10 * first.at_once < increments);
}
