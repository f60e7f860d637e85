//! The next step of a march: how many cycles it takes, and what they wear.

use super::{
    Schedule, Updates,
    accumulated_error::accumulated_error_mm,
    step::{StepRecord, StepStart, WearStep},
    step_rules::{exponential, extrapolated},
};

/// The first step takes this share of the test at most, since nothing is known yet of how rates
/// change, ...
const FIRST_SHARE: f64 = 0.12;
/// ... and less where the tolerance is smaller than this: the error of a step is second order.
const FIRST_TOLERANCE: f64 = 0.05;
/// Creep goes with the logarithm of time: most of it comes at once, and takes the highest pressures away. Where the
/// insert creeps, the first step is this part of what it would be else, so that nothing to speak of wears by them.
const FIRST_OF_CREEP: f64 = 0.1;
/// A step is at most this many times as long as the one before, over which its rates were seen to
/// change, ...
const MAX_GROWTH: f64 = 1.5;
/// ... and at least this many times.
const MIN_GROWTH: f64 = 0.25;
/// Longest step in units of 1 / relaxation. A node that lies too deep alone comes back ever further
/// on the other side from 2 on: see [`super::step_rules`].
const LONGEST: f64 = 1.8;
/// A step in error is shortened by this factor until it is not.
const SHORTER: f64 = 0.9;
/// A step that was a shorter part of the next than this does not tell how rates go on changing through that.
const MIN_TELLING: f64 = 0.25;

/// The next step of a march by `schedule`.
pub(super) fn next_step(start: StepStart<'_>, schedule: &Schedule) -> WearStep {
    let left = schedule.cycles - start.cycles;
    let (interval, is_last) = match schedule.updates {
        Updates::Fixed(updates) => {
            let (done, creeps) = (start.updates, start.creeps);
            let interval = fixed_interval(schedule.cycles, updates, done, creeps);
            (interval, done + 1 >= updates)
        }
        Updates::Auto { tolerance } => {
            let wished = adaptive_interval(start, schedule.cycles, tolerance);
            let interval = shared_out(left, wished);
            (interval, interval >= left)
        }
    };
    let (depth_mm, predicted_mm) = worn(start, schedule.updates, interval);
    WearStep {
        interval,
        // The last step lands on the last cycle, whatever the intervals sum up to.
        cycles_after: if is_last {
            schedule.cycles
        } else {
            start.cycles + interval
        },
        depth_mm,
        predicted_mm,
        error_mm: accumulated_error_mm(start),
    }
}

/// What an interval wears, mm, and what it would wear by a second rule, which tells its error.
fn worn(start: StepStart<'_>, updates: Updates, interval: f64) -> (Vec<f64>, Vec<f64>) {
    let tells = |last: &&StepRecord| last.interval > MIN_TELLING * interval;
    let (rates, last) = (start.rates, start.last.filter(tells));
    let exponential = exponential(rates, last, interval);
    match updates {
        Updates::Fixed(_) => (extrapolated(rates, last, interval), exponential),
        Updates::Auto { .. } => {
            let each = |node| second_order(start, node, interval);
            let extrapolated = (0..start.worn_mm.len()).map(each).collect();
            (exponential, extrapolated)
        }
    }
}

/// The interval after `done` of a fixed number of updates: all are equal, but where the insert creeps the first is
/// shorter.
pub(super) fn fixed_interval(all_cycles: f64, updates: usize, done: usize, creeps: bool) -> f64 {
    let even = all_cycles / updates as f64;
    if !creeps || updates == 1 {
        even
    } else if done == 0 {
        FIRST_OF_CREEP * even
    } else {
        (all_cycles - FIRST_OF_CREEP * even) / (updates - 1) as f64
    }
}

/// The longest interval whose estimated error of the maximum depth is within `tolerance` times
/// the depth expected at the end, and that is stable.
pub(super) fn adaptive_interval(start: StepStart<'_>, all_cycles: f64, tolerance: f64) -> f64 {
    let left = all_cycles - start.cycles;
    let stable = LONGEST / start.rates.relaxation_per_cycle.max(f64::MIN_POSITIVE);
    let Some(last) = start.last else {
        let share = FIRST_SHARE * (tolerance / FIRST_TOLERANCE).sqrt().min(1.0);
        let part = if start.creeps { FIRST_OF_CREEP } else { 1.0 };
        return stable.min(part * share * all_cycles);
    };
    let expected_mm = deepest(start, |node| start.rates.depth_per_cycle_mm[node] * left);
    let shortest = MIN_GROWTH * last.interval;
    let mut interval = stable.min(MAX_GROWTH * last.interval);
    while interval > shortest && predicted_error_mm(start, interval) > tolerance * expected_mm {
        interval *= SHORTER;
    }
    interval.max(shortest)
}

/// By how much the maximum depth after `interval` cycles differs between the first order and the
/// second, mm: every node's rate taken as the last one, or extrapolated from the last two.
fn predicted_error_mm(start: StepStart<'_>, interval: f64) -> f64 {
    let rates = &start.rates.depth_per_cycle_mm;
    let first = deepest(start, |node| rates[node] * interval);
    let second = deepest(start, |node| second_order(start, node, interval));
    (second - first).abs()
}

/// What a node wears in `interval` cycles, mm, its rate extrapolated from the last two.
pub(super) fn second_order(start: StepStart<'_>, node: usize, interval: f64) -> f64 {
    let rate = start.rates.depth_per_cycle_mm[node];
    let change = |last: &StepRecord| (rate - last.depth_per_cycle_mm[node]) / last.interval;
    rate * interval + start.last.map_or(0.0, change) * interval * interval / 2.0
}

/// The cycles that are left in equal intervals, none longer than `wished`: so the last is no stump.
pub(super) fn shared_out(left: f64, wished: f64) -> f64 {
    // A hair is allowed, so that 5 x 0.2 is five intervals and not six.
    const HAIR: f64 = 1e-9;
    left / (left / wished - HAIR).ceil().max(1.0)
}

/// The deepest node after `more` at every node.
fn deepest(start: StepStart<'_>, more: impl Fn(usize) -> f64) -> f64 {
    let worn = start.worn_mm.iter().enumerate();
    worn.map(|(node, worn)| worn + more(node))
        .fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::rates::Rates;

    #[test]
    fn the_last_fixed_step_lands_on_the_last_cycle() {
        for creeps in [false, true] {
            let ends = ends_of_three_steps(creeps);
            assert_eq!(ends[2], 5e6);
            let even = 5e6 / 3.0;
            let first = if creeps { 0.1 * even } else { even };
            assert!((ends[0] - first).abs() < 1e-6, "{ends:?}");
            assert!((ends[2] - 2.0 * ends[1] + ends[0]).abs() < 1e-6, "{ends:?}");
        }
    }

    fn ends_of_three_steps(creeps: bool) -> [f64; 3] {
        let schedule = Schedule::fixed(5e6, 3);
        let now = Rates {
            depth_per_cycle_mm: vec![1e-8],
            area_mm2: vec![2.0],
            node_relaxation_per_cycle: vec![0.0],
            relaxation_per_cycle: 0.0,
        };
        let mut cycles = 0.0;
        [0, 1, 2].map(|updates| {
            let start = StepStart {
                creeps,
                rates: &now,
                last: None,
                worn_mm: &[0.0],
                cycles,
                updates,
            };
            cycles = next_step(start, &schedule).cycles_after;
            cycles
        })
    }

    fn rates(depth_per_cycle_mm: f64, relaxation_per_cycle: f64) -> Rates {
        Rates {
            depth_per_cycle_mm: vec![depth_per_cycle_mm],
            area_mm2: vec![1.0],
            node_relaxation_per_cycle: vec![relaxation_per_cycle],
            relaxation_per_cycle,
        }
    }

    fn last(depth_per_cycle_mm: f64, interval: f64) -> StepRecord {
        StepRecord {
            interval,
            depth_per_cycle_mm: vec![depth_per_cycle_mm],
            depth_mm: vec![depth_per_cycle_mm * interval],
            error_mm: vec![0.0],
            area_mm2: vec![1.0],
            relaxation_per_cycle: 0.0,
        }
    }

    fn interval(now: &Rates, last: Option<&StepRecord>) -> f64 {
        let start = StepStart {
            creeps: false,
            rates: now,
            last,
            worn_mm: &[0.1],
            cycles: 1e6,
            updates: 2,
        };
        adaptive_interval(start, 5e6, 0.01)
    }

    #[test]
    fn steps_start_small_grow_slowly_and_stay_stable() {
        let near = |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 1e-12);
        near(interval(&rates(1e-7, 1e-6), None), 6e5 * 0.2_f64.sqrt());
        near(interval(&rates(1e-7, 1e-5), None), 1.8e5);
        near(interval(&rates(1e-7, 0.0), Some(&last(1e-7, 1e5))), 1.5e5);
        near(interval(&rates(1e-7, 2e-6), Some(&last(1e-7, 1e6))), 9e5);
    }

    #[test]
    fn verify_the_predicted_error_is_held_to_the_tolerance() {
        // 0.1 mm and 4e6 cycles of 1e-7 mm: 0.5 mm are expected, 0.005 mm may be wrong.
        let (now, before) = (rates(1e-7, 0.0), last(1.1e-7, 1e6));
        let exact = (0.005 * 2.0 * 1e6 / 1e-8_f64).sqrt();
        let found = interval(&now, Some(&before));
        assert!(found <= exact && found > SHORTER * exact, "{found} {exact}");
        let falls = last(1e-6, 1e6);
        assert_eq!(interval(&now, Some(&falls)), 2.5e5);
    }

    #[test]
    fn cycles_left_are_shared_out_evenly() {
        assert_eq!(shared_out(1.0, 0.2), 0.2);
        assert_eq!(shared_out(1.0, 0.6), 0.5);
        assert_eq!(shared_out(1.0, 7.0), 1.0);
    }
}
