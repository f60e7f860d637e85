//! The next step of a march: so many cycles, and what they wear away.

use super::{
    Schedule, Updates,
    accumulated_error::accumulated_error_mm,
    exponential_step::exponential,
    extrapolated_step::extrapolated,
    interval::{adaptive_interval, fixed_interval, second_order, shared_out},
    step_record::{Standing, StepRecord, WearStep},
};

/// A step that was a shorter part of the next than this does not tell how rates go on changing through that.
const MIN_TELLING: f64 = 0.25;

/// The next step of a march by `schedule`.
pub(super) fn next_step(standing: Standing<'_>, schedule: &Schedule) -> WearStep {
    let left = schedule.cycles - standing.cycles;
    let (interval, is_last) = match schedule.updates {
        Updates::Fixed(updates) => {
            let (done, creeps) = (standing.updates, standing.creeps);
            let interval = fixed_interval(schedule.cycles, updates, done, creeps);
            (interval, done + 1 >= updates)
        }
        Updates::Auto { tolerance } => {
            let wished = adaptive_interval(standing, schedule.cycles, tolerance);
            let interval = shared_out(left, wished);
            (interval, interval >= left)
        }
    };
    let (depth_mm, predicted_mm) = worn(standing, schedule.updates, interval);
    WearStep {
        interval,
        // The last step lands on the last cycle, whatever the intervals sum up to.
        cycles_after: if is_last {
            schedule.cycles
        } else {
            standing.cycles + interval
        },
        depth_mm,
        predicted_mm,
        error_mm: accumulated_error_mm(standing),
    }
}

/// What an interval wears, mm, and what it would wear by a second rule, which tells its error.
fn worn(standing: Standing<'_>, updates: Updates, interval: f64) -> (Vec<f64>, Vec<f64>) {
    let tells = |last: &&StepRecord| last.interval > MIN_TELLING * interval;
    let (rates, last) = (standing.rates, standing.last.filter(tells));
    let exponential = exponential(rates, last, interval);
    match updates {
        Updates::Fixed(_) => (extrapolated(rates, last, interval), exponential),
        Updates::Auto { .. } => {
            let each = |node| second_order(standing, node, interval);
            let extrapolated = (0..standing.worn_mm.len()).map(each).collect();
            (exponential, extrapolated)
        }
    }
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
            let standing = Standing {
                creeps,
                rates: &now,
                last: None,
                worn_mm: &[0.0],
                cycles,
                updates,
            };
            cycles = next_step(standing, &schedule).cycles_after;
            cycles
        })
    }
}
