//! What the length of the steps costs in accuracy.

use serde::{Deserialize, Serialize};

use super::{
    interval::{deepest, foreseen_error_mm},
    step::{Before, StepRecord},
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
    /// earlier shrinks by 1 / (1 + relaxation x interval) with every step.
    pub(super) fn after(self, before: Before<'_>) -> Self {
        let Some(last) = before.last else {
            return self;
        };
        let mean = (before.rates.volume_per_cycle_mm3() + last.volume_per_cycle_mm3) / 2.0;
        let rates = &before.rates.depth_per_cycle_mm;
        let missed =
            |node: usize| last.interval / 2.0 * (rates[node] - last.depth_per_cycle_mm[node]);
        let missed_mm = (deepest(before, missed) - deepest(before, |_| 0.0)).abs();
        Self {
            volume_mm3: self.volume_mm3 + mean * last.interval - last.volume_mm3,
            max_depth_mm: self.max_depth_mm / (1.0 + last.relaxation_per_cycle * last.interval)
                + missed_mm,
        }
    }

    /// With the last step added, `interval` cycles after `before`, foreseen from the rates so far.
    pub(super) fn with_last(self, before: Before<'_>, interval: f64, taken_mm3: f64) -> Self {
        let now = before.rates.volume_per_cycle_mm3();
        let change = |last: &StepRecord| (now - last.volume_per_cycle_mm3) / last.interval;
        let slope = before.last.map_or(0.0, change);
        let exact_mm3 = now * interval + slope * interval * interval / 2.0;
        let faded = 1.0 + before.rates.relaxation_per_cycle * interval;
        Self {
            volume_mm3: self.volume_mm3 + exact_mm3 - taken_mm3,
            max_depth_mm: self.max_depth_mm / faded + foreseen_error_mm(before, interval),
        }
    }
}
