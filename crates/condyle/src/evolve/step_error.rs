//! What the length of the steps costs in accuracy.

use serde::{Deserialize, Serialize};

use super::{
    interval::{deepest, second_order},
    rates::total,
    step::{Before, Step},
};

/// Estimated error of a march from the length of its steps alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StepError {
    /// Volume that the exact march would have worn more, mm3.
    pub volume_mm3: f64,
    /// Error of the maximum depth, mm, 0 or more.
    pub max_depth_mm: f64,
}

impl StepError {
    /// With the step that led to `before` added, now that what a cycle wears at its end is known.
    ///
    /// Volume: the trapezoidal rule against what the step took; errors add up. Depth: the same at
    /// the deepest node; a node that is too deep wears less thereafter, so that an error made
    /// earlier fades. Errors of depth change their sign from step to step, so that their squares
    /// are added.
    pub(super) fn after(self, before: Before<'_>) -> Self {
        let Some(last) = before.last else {
            return self;
        };
        let now = before.rates;
        let mean = (now.volume_per_cycle_mm3() + last.volume_per_cycle_mm3()) / 2.0;
        let missed = |node: usize| {
            let mean = (now.depth_per_cycle_mm[node] + last.depth_per_cycle_mm[node]) / 2.0;
            mean * last.interval - last.depth_mm[node]
        };
        Self {
            volume_mm3: self.volume_mm3 + mean * last.interval - last.volume_mm3(),
            max_depth_mm: faded(self.max_depth_mm, last.relaxation_per_cycle * last.interval)
                .hypot(deepest(before, missed) - deepest(before, |_| 0.0)),
        }
    }

    /// With the last step added, foreseen from the rates so far.
    pub(super) fn with_last(self, before: Before<'_>, step: &Step) -> Self {
        let exact = |node| second_order(before, node, step.interval);
        let exact_mm: Vec<f64> = (0..step.depth_mm.len()).map(exact).collect();
        let volume = |depth_mm: &[f64]| total(&before.rates.area_mm2, depth_mm);
        let missed_mm =
            deepest(before, |node| exact_mm[node]) - deepest(before, |node| step.depth_mm[node]);
        let relaxed = before.rates.relaxation_per_cycle * step.interval;
        Self {
            volume_mm3: self.volume_mm3 + volume(&exact_mm) - volume(&step.depth_mm),
            max_depth_mm: faded(self.max_depth_mm, relaxed).hypot(missed_mm),
        }
    }
}

/// What is left of an error after a step of `relaxed` = relaxation x interval: as much of it as
/// Euler's method leaves, |1 - relaxed|, but no more than the exact march, 1 / (1 + relaxed), since
/// what wears too little in one step wears more in the next, and never less than nothing.
fn faded(error: f64, relaxed: f64) -> f64 {
    error * (1.0 - relaxed).abs().min(1.0 / (1.0 + relaxed))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::{rates::Rates, step::StepRecord};

    fn rates(depth_per_cycle_mm: f64) -> Rates {
        Rates {
            depth_per_cycle_mm: vec![depth_per_cycle_mm],
            area_mm2: vec![2.0],
            relaxation_per_cycle: 0.25,
        }
    }

    #[test]
    fn verify_a_step_misses_the_trapezoidal_rule_less_what_it_took() {
        let step = Step {
            interval: 2.0,
            cycles_after: 2.0,
            depth_mm: vec![6.0],
        };
        let last: StepRecord = step.remembered(rates(3.0));
        let now = rates(5.0);
        let before = Before {
            rates: &now,
            last: Some(&last),
            worn_mm: &[6.0],
            cycles: 2.0,
            updates: 1,
        };
        let earlier = StepError {
            volume_mm3: 1.0,
            max_depth_mm: 3.0,
        };
        // 2 cycles of (3 + 5)/2 mm, less 6 mm: 2 mm; of the 3 mm, 1 - 0.25 x 2 are left.
        let after = earlier.after(before);
        assert_eq!(after.volume_mm3, 1.0 + 2.0 * 2.0);
        assert_eq!(after.max_depth_mm, 1.5_f64.hypot(2.0));
    }

    #[test]
    fn an_error_fades_and_never_grows() {
        assert_eq!(faded(1.0, 0.0), 1.0);
        assert_eq!(faded(1.0, 0.9), 1.0 - 0.9);
        assert_eq!(faded(1.0, 3.0), 0.25);
    }
}
