//! The error that the length of the steps causes.

use serde::{Deserialize, Serialize};

use super::{
    rates::{mean_over_volume, volume_mm3, weight_of_depth},
    step::{StepStart, WearStep},
    step_rules::{counted, mean_decay},
};

/// Estimated error of a march from the length of its steps alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AccumulatedError {
    /// Volume of the exact march less this one, mm3.
    pub volume_mm3: f64,
    /// Maximum depth of the exact march less this one, mm; known with the last step.
    pub max_depth_mm: f64,
}

impl AccumulatedError {
    /// Adds the error of the step that led to `start`, now that the rates at its end are known:
    /// the trapezoidal rule less the step.
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

    /// Adds the error of the last step: the predicted wear less the step.
    pub(super) fn with_last(self, start: StepStart<'_>, step: &WearStep) -> Self {
        let area_mm2 = &start.rates.area_mm2;
        let predicted_mm3 = volume_mm3(area_mm2, &step.predicted_mm);
        let depths = start.worn_mm.iter().zip(&step.depth_mm);
        let weights: Vec<f64> = depths
            .map(|(worn, more)| weight_of_depth(worn + more))
            .collect();
        let error_after = |node: usize| {
            let relaxed = counted(start.rates, node) * step.interval;
            step.error_mm[node] * (-relaxed).exp() + step.predicted_mm[node] - step.depth_mm[node]
        };
        let errors_mm: Vec<f64> = (0..step.depth_mm.len()).map(error_after).collect();
        Self {
            volume_mm3: self.volume_mm3 + predicted_mm3 - volume_mm3(area_mm2, &step.depth_mm),
            max_depth_mm: mean_over_volume(area_mm2, &weights, &errors_mm),
        }
    }
}

/// Returns the depth of the exact march less this one at every node now, mm.
///
/// The exact wear of the last step follows from the motion by which the femur sank, by the
/// equation of [`super::step_rules::exponential`]. By the same equation earlier errors decay.
pub(super) fn accumulated_error_mm(start: StepStart<'_>) -> Vec<f64> {
    let nodes = 0..start.worn_mm.len();
    let Some(last) = start.last else {
        return nodes.map(|_| 0.0).collect();
    };
    let at = |node: usize| {
        let rate = start.rates.depth_per_cycle_mm[node];
        let relaxed = counted(start.rates, node) * last.interval;
        let decay = mean_decay(relaxed);
        let before = last.depth_per_cycle_mm[node];
        // Its limit without relaxation is 1/2.
        let late = if relaxed > 0.0 {
            (1.0 - decay) / relaxed
        } else {
            0.5
        };
        last.error_mm[node] * (-relaxed).exp()
            + decay * (last.interval * before - last.depth_mm[node])
            + late * last.interval * (rate - before)
    };
    nodes.map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::{StepRecord, rates::Rates};

    fn rates(depth_per_cycle_mm: f64, relaxation: f64) -> Rates {
        Rates {
            depth_per_cycle_mm: vec![depth_per_cycle_mm],
            area_mm2: vec![2.0],
            node_relaxation_per_cycle: vec![relaxation],
            relaxation_per_cycle: relaxation,
        }
    }

    /// Returns a step of 2 cycles that began with 3 mm a cycle and took `depth_mm`.
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
