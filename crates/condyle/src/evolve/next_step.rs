//! The choice of the next step of a march.

use super::{
    Schedule, Updates,
    rates::{Rates, StepRecord, StepStart, WearStep},
    step_rules::{accumulated_error_mm, exponential, extrapolated},
};

/// Largest share of the test for the first step, since the change of the rates is not known yet, ...
const FIRST_SHARE: f64 = 0.12;
/// ... and the tolerance below which it takes less: the error of a step is second order.
const FIRST_TOLERANCE: f64 = 0.05;
/// Factor on the first step where the insert creeps. Creep grows with the logarithm of time: most of it comes at once
/// and removes the highest pressures, so that little should wear under them.
const FIRST_OF_CREEP: f64 = 0.1;
/// Largest growth from one step to the next, since the change of the rates was observed over the last step only, ...
const MAX_GROWTH: f64 = 1.5;
/// ... and smallest.
const MIN_GROWTH: f64 = 0.25;
/// Longest step in units of 1 / relaxation. From 2 on, a single node that lies too deep overshoots further at every
/// step: see [`super::step_rules`].
const LONGEST: f64 = 1.8;
/// Factor from one change of alternating rates to the next up to which the alternation decays fast enough for longer steps, ...
const DECAYING: f64 = 0.5;
/// ... and the longest step otherwise, in units of 1 / relaxation of the alternation.
const ALTERNATING: f64 = 1.6;
/// Part of the rates below which their changes are too small to observe whether they alternate.
const NOISE: f64 = 0.01;
/// Factor that shortens a step until its error is within the tolerance.
const SHORTER: f64 = 0.9;
/// Smallest ratio of the last interval to the next at which the change over the last is extrapolated.
pub(super) const MIN_OBSERVED: f64 = 0.25;

pub(super) fn next_step(start: StepStart<'_>, schedule: &Schedule) -> WearStep {
    let left = schedule.cycles - start.cycles;
    let (interval, is_last) = match schedule.updates {
        Updates::Fixed(updates) => {
            let (done, creeps) = (start.updates, start.creeps);
            let interval = fixed_interval(schedule.cycles, updates, done, creeps);
            (interval, done + 1 >= updates)
        }
        Updates::Auto { tolerance } => {
            let longest = adaptive_interval(start, schedule.cycles, tolerance);
            let interval = equal_interval(left, longest);
            (interval, interval >= left)
        }
    };
    let (depth_mm, predicted_mm) = worn(start, schedule.updates, interval);
    WearStep {
        interval,
        // The last step ends exactly at the last cycle, which the sum of the intervals may miss by rounding.
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

/// Returns the depth of an interval, mm, and the depth by a second rule, whose difference estimates the error.
fn worn(start: StepStart<'_>, updates: Updates, interval: f64) -> (Vec<f64>, Vec<f64>) {
    let is_long = |last: &&StepRecord| last.interval > MIN_OBSERVED * interval;
    let (rates, last) = (start.rates, start.last.filter(is_long));
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

/// Returns the interval after `done` of a fixed number of updates: all are equal, but the first is shorter where the
/// insert creeps.
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

/// Returns the longest interval whose estimated error of the maximum depth is within `tolerance` times the depth
/// expected at the end, and that is stable.
fn adaptive_interval(start: StepStart<'_>, all_cycles: f64, tolerance: f64) -> f64 {
    let (left, rates_mm) = (all_cycles - start.cycles, &start.rates.depth_per_cycle_mm);
    // Without relaxation every step is stable.
    let stable = LONGEST / start.rates.relaxation_per_cycle.max(f64::MIN_POSITIVE);
    let Some(last) = start.last else {
        let share = FIRST_SHARE * (tolerance / FIRST_TOLERANCE).sqrt().min(1.0);
        let part = if start.creeps { FIRST_OF_CREEP } else { 1.0 };
        // The error of the first step is second order in its length, hence the root of the tolerance.
        return part * stable.min(share * all_cycles);
    };
    let first_order = |interval| deepest(start, |node| rates_mm[node] * interval);
    let second_order = |interval| deepest(start, |node| second_order(start, node, interval));
    let tolerance_mm = tolerance * first_order(left);
    let shortest = MIN_GROWTH * last.interval;
    // `stable` counts wear alone: creep flattens the pressure as well.
    let growth = if start.creeps {
        stable_growth(start.rates, last)
    } else {
        MAX_GROWTH
    };
    let mut interval = stable.min(growth * last.interval);
    // The difference between first and second order estimates the error of the first.
    let error_mm = |interval| (second_order(interval) - first_order(interval)).abs();
    while interval > shortest && error_mm(interval) > tolerance_mm {
        interval *= SHORTER;
    }
    interval.max(shortest)
}

/// Returns the largest growth of the interval at which alternations of the rates decay.
///
/// Where an alternation has the rate `l` of relaxation, an interval `h` changes the sign of the last change of the
/// rates and multiplies it by `l h - 1`.
fn stable_growth(rates: &Rates, last: &StepRecord) -> f64 {
    let mean_square = |values: &mut dyn Iterator<Item = f64>| {
        let parts = values.zip(&rates.area_mm2);
        parts.map(|(value, area)| area * value * value).sum::<f64>()
    };
    let reversals = last.reversals_mm(&rates.depth_per_cycle_mm);
    let [before, now] =
        [0, 1].map(|step| mean_square(&mut reversals.iter().map(|changes| changes[step])));
    let all = mean_square(&mut rates.depth_per_cycle_mm.iter().copied());
    // Without any wear there is no alternation.
    let seen = (before + NOISE * NOISE * all).max(f64::MIN_POSITIVE);
    let factor = (now / seen).sqrt();
    if factor > DECAYING {
        ALTERNATING / (1.0 + factor)
    } else {
        MAX_GROWTH
    }
}

/// Returns the depth of a node after `interval` cycles, mm, its rate extrapolated from the last two.
fn second_order(start: StepStart<'_>, node: usize, interval: f64) -> f64 {
    let rate = start.rates.depth_per_cycle_mm[node];
    let change = |last: &StepRecord| (rate - last.depth_per_cycle_mm[node]) / last.interval;
    rate * interval + start.last.map_or(0.0, change) * interval * interval / 2.0
}

/// Returns the length of equal intervals, none longer than `longest`, that fill the cycles left.
pub(super) fn equal_interval(left: f64, longest: f64) -> f64 {
    // Without it, rounding would make six intervals of 1 / 0.2 and not five.
    const ROUNDING: f64 = 1e-9;
    left / (left / longest - ROUNDING).ceil().max(1.0)
}

/// Returns the maximum depth after `more` at every node, mm.
fn deepest(start: StepStart<'_>, more: impl Fn(usize) -> f64) -> f64 {
    let worn = start.worn_mm.iter().enumerate();
    worn.map(|(node, worn)| worn + more(node))
        .fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_fixed_step_ends_at_the_last_cycle() {
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
            change_before_mm: vec![0.0],
        }
    }

    fn start<'a>(rates: &'a Rates, last: Option<&'a StepRecord>) -> StepStart<'a> {
        StepStart {
            creeps: false,
            rates,
            last,
            worn_mm: &[0.1],
            cycles: 1e6,
            updates: 2,
        }
    }

    fn interval(now: &Rates, last: Option<&StepRecord>) -> f64 {
        adaptive_interval(start(now, last), 5e6, 0.01)
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
    fn steps_of_creep_shorten_while_rates_alternate() {
        let longer = |changes: [f64; 2]| {
            let [before, now] = changes.map(|change| change * 1e-9);
            let last = StepRecord {
                change_before_mm: vec![before],
                ..last(1e-7, 1e5)
            };
            let rates = rates(1e-7 + now, 1e-6);
            let start = StepStart {
                creeps: true,
                ..start(&rates, Some(&last))
            };
            adaptive_interval(start, 5e6, 0.01) / 1e5
        };
        // Alternations that grow, stay, and decay slowly and fast; without a reversal; and below what is observed.
        let near =
            |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 0.01, "{found}");
        near(longer([-10.0, 15.0]), 1.6 / 2.5);
        near(longer([10.0, -10.0]), 1.6 / 2.0);
        near(longer([10.0, -6.0]), 1.6 / 1.6);
        near(longer([10.0, -4.0]), 1.5);
        near(longer([10.0, 15.0]), 1.5);
        near(longer([0.1, -0.4]), 1.5);
    }

    #[test]
    fn verify_the_predicted_error_is_within_the_tolerance() {
        // 0.1 mm and 4e6 cycles of 1e-7 mm: 0.5 mm are expected, 0.005 mm may be wrong.
        let (now, before) = (rates(1e-7, 0.0), last(1.1e-7, 1e6));
        let exact = (0.005 * 2.0 * 1e6 / 1e-8_f64).sqrt();
        let found = interval(&now, Some(&before));
        assert!(found <= exact && found > SHORTER * exact, "{found} {exact}");
        let falls = last(1e-6, 1e6);
        assert_eq!(interval(&now, Some(&falls)), 2.5e5);
    }

    #[test]
    fn cycles_left_are_divided_evenly() {
        assert_eq!(equal_interval(1.0, 0.2), 0.2);
        assert_eq!(equal_interval(1.0, 0.6), 0.5);
        assert_eq!(equal_interval(1.0, 7.0), 1.0);
    }
}
