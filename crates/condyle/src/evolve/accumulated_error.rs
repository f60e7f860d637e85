//! What the length of the steps costs in accuracy.

use serde::{Deserialize, Serialize};

use super::{
    rates::{mean_over_volume, volume_mm3, weight_of_depth},
    step::{StepRecord, StepStart, WearStep},
    step_rules::{counted, left},
};

/// Estimated error of a march from the length of its steps alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AccumulatedError {
    /// Volume that the exact march would have worn more, mm3.
    pub volume_mm3: f64,
    /// How much deeper the exact march would be where it is deepest, mm; known with the last step.
    pub max_depth_mm: f64,
}

impl AccumulatedError {
    /// With the step that led to `start` added, now that what a cycle wears at its end is known:
    /// the trapezoidal rule against what the step took.
    pub(super) fn after(self, start: StepStart<'_>) -> Self {
        let Some(last) = start.last else {
            return self;
        };
        let rates = start.rates;
        let mean = (rates.volume_per_cycle_mm3() + last.volume_per_cycle_mm3()) / 2.0;
        let error_mm3 = mean * last.interval - last.volume_mm3();
        Self {
            volume_mm3: self.volume_mm3 + error_mm3,
            ..self
        }
    }

    /// With the last step added: what is predicted against what it takes.
    pub(super) fn with_last(self, start: StepStart<'_>, step: &WearStep) -> Self {
        let area_mm2 = &start.rates.area_mm2;
        let predicted_mm3 = volume_mm3(area_mm2, &step.predicted_mm);
        let error_mm = error_after(start, step);
        Self {
            volume_mm3: self.volume_mm3 + predicted_mm3 - volume_mm3(area_mm2, &step.depth_mm),
            max_depth_mm: mean_over_volume(
                area_mm2,
                &deep(start.worn_mm, &step.depth_mm),
                &error_mm,
            ),
        }
    }
}

/// How much deeper the exact march would be at every node after `step`, mm.
fn error_after(start: StepStart<'_>, step: &WearStep) -> Vec<f64> {
    let after = |node: usize| {
        let relaxed = counted(start.rates, node) * step.interval;
        step.error_mm[node] * (-relaxed).exp() + step.predicted_mm[node] - step.depth_mm[node]
    };
    (0..step.depth_mm.len()).map(after).collect()
}

/// How much every node counts for the maximum depth.
fn deep(worn_mm: &[f64], more_mm: &[f64]) -> Vec<f64> {
    let depths = worn_mm.iter().zip(more_mm).map(|(worn, more)| worn + more);
    depths.map(weight_of_depth).collect()
}

/// How much deeper the exact march would be at every node by now, mm.
///
/// What the last step should have worn follows from where the femur turned out to sink, by the
/// equation of [`super::step_rules::exponential`]. By the same equation an error made earlier has faded.
pub(super) fn accumulated_error_mm(start: StepStart<'_>) -> Vec<f64> {
    let at = |node: usize| match start.last {
        None => 0.0,
        Some(last) => {
            let rate = start.rates.depth_per_cycle_mm[node];
            error_at(last, node, rate, counted(start.rates, node))
        }
    };
    (0..start.worn_mm.len()).map(at).collect()
}

/// The same at a node that relaxes by `counted` a cycle and now wears by `rate`.
fn error_at(last: &StepRecord, node: usize, rate: f64, counted: f64) -> f64 {
    let relaxed = counted * last.interval;
    let left = left(relaxed);
    let before = last.depth_per_cycle_mm[node];
    // (1 - left) / relaxed, which is 1/2 where nothing relaxes.
    let late = if relaxed > 0.0 {
        (1.0 - left) / relaxed
    } else {
        0.5
    };
    last.error_mm[node] * (-relaxed).exp()
        + left * (last.interval * before - last.depth_mm[node])
        + late * last.interval * (rate - before)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::rates::Rates;

    fn rates(depth_per_cycle_mm: f64, relaxation: f64) -> Rates {
        Rates {
            depth_per_cycle_mm: vec![depth_per_cycle_mm],
            area_mm2: vec![2.0],
            node_relaxation_per_cycle: vec![relaxation],
            relaxation_per_cycle: relaxation,
        }
    }

    /// A step of 2 cycles that began with 3 mm a cycle and took `depth_mm`.
    fn last(depth_mm: f64, error_mm: f64) -> StepRecord {
        let step = WearStep {
            interval: 2.0,
            cycles_after: 2.0,
            depth_mm: vec![depth_mm],
            predicted_mm: Vec::new(),
            error_mm: vec![error_mm],
        };
        step.record(rates(3.0, 0.0))
    }

    fn start<'a>(now: &'a Rates, last: &'a StepRecord) -> StepStart<'a> {
        StepStart {
            creeps: false,
            rates: now,
            last: Some(last),
            worn_mm: &[6.0],
            cycles: 2.0,
            updates: 1,
        }
    }

    #[test]
    fn verify_a_step_misses_the_trapezoidal_rule_less_what_it_took() {
        let (now, last) = (rates(5.0, 0.0), last(6.0, 1.5));
        let earlier = AccumulatedError {
            volume_mm3: 1.0,
            ..AccumulatedError::default()
        };
        // 2 cycles of (3 + 5)/2 mm, less 6 mm: 2 mm, of 2 mm2; of depth 1.5 mm were lacking before.
        let start = start(&now, &last);
        assert_eq!(earlier.after(start).volume_mm3, 1.0 + 2.0 * 2.0);
        assert_eq!(accumulated_error_mm(start), [1.5 + 2.0]);
    }

    #[test]
    fn verify_what_a_step_missed_where_the_rate_relaxes() {
        // The femur does not sink, so the rate of 3 falls by k for every mm: after Euler's 6 mm to
        // 3 - 6 k, where the exact depth is 3 (1 - exp(-2 k))/k.
        let counted = 0.2_f64;
        let last = last(6.0, 0.0);
        let now = rates(3.0 - 6.0 * counted, 2.0 * counted);
        let exact = 3.0 * (1.0 - (-2.0 * counted).exp()) / counted;
        assert!((accumulated_error_mm(start(&now, &last))[0] - (exact - 6.0)).abs() < 1e-12);
    }

    #[test]
    fn what_was_missed_fades_as_the_node_relaxes() {
        // This step errs by nothing: the rate stays, and so the femur sinks as it wears.
        let relaxation = 0.7;
        let (now, last) = (rates(3.0, relaxation), last(6.0, 1.0));
        let error_mm = accumulated_error_mm(start(&now, &last))[0];
        assert!((error_mm - (-2.0 * counted(&now, 0)).exp()).abs() < 1e-12);
    }
}
