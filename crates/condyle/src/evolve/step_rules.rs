//! The wear of an interval: rules of second order that extrapolate the rates of two cycles, and the error that the length of
//! the steps causes.

use serde::{Deserialize, Serialize};

use super::rates::{
    Rates, StepRecord, StepStart, WearStep, mean_over_volume, volume_mm3, weight_of_depth,
};

/// Part of a node's relaxation that the rule uses. With less, a single node that lies too deep overshoots
/// further at every step before relaxation x interval reaches 2, the limit of Euler's method; with more, slow
/// changes that neighbours share count as fast ones.
const COUNTED: f64 = 0.5;

/// Returns the depth of an interval at the rates of the solved cycle: Euler's method.
fn euler(rates: &Rates, interval: f64) -> Vec<f64> {
    let depth = |rate: &f64| rate * interval;
    rates.depth_per_cycle_mm.iter().map(depth).collect()
}

/// Returns the depth of an interval over which the volume per cycle continues to change as over the last one, which
/// makes the volume second order in the interval.
///
/// The volume added to Euler's is distributed over the nodes whose rates grow, in proportion; a volume
/// removed, over those whose rates fall. Extrapolating every node by itself (Adams and Bashforth's
/// method) is unstable from 1 / relaxation on: the pressure that a node loses moves to its
/// neighbours, and an interval later it returns.
pub(super) fn extrapolated(rates: &Rates, last: Option<&StepRecord>, interval: f64) -> Vec<f64> {
    let mut depth_mm = euler(rates, interval);
    let Some(last) = last else {
        return depth_mm;
    };
    let change = rates.volume_per_cycle_mm3() - last.volume_per_cycle_mm3();
    let added_mm3 = added_mm3(rates, last, interval);
    let towards = |(now, before): (&f64, &f64)| (now - before).max(0.0) * change.signum();
    let (now, before) = (&rates.depth_per_cycle_mm, &last.depth_per_cycle_mm);
    let pattern: Vec<f64> = if change >= 0.0 {
        now.iter().zip(before).map(towards).collect()
    } else {
        before.iter().zip(now).map(towards).collect()
    };
    let pattern_mm3 = volume_mm3(&rates.area_mm2, &pattern);
    // Without a pattern the volume has no place to go; Euler's step remains.
    if pattern_mm3 != 0.0 {
        for (depth, part) in depth_mm.iter_mut().zip(&pattern) {
            *depth = (*depth + part * added_mm3 / pattern_mm3).max(0.0);
        }
    }
    depth_mm
}

/// Returns the volume of an interval beyond that of Euler's method, mm3, if the volume per cycle continues to change
/// as over the last one.
fn added_mm3(rates: &Rates, last: &StepRecord, interval: f64) -> f64 {
    let change = rates.volume_per_cycle_mm3() - last.volume_per_cycle_mm3();
    interval * interval / (2.0 * last.interval) * change
}

/// Returns the depth of an interval by a rule that is exact for rates that relax exponentially.
///
/// The rate r of a node falls by `k` (part of the [relaxation](Rates)) for every mm by which the wear of the node
/// exceeds the motion of the counterface: dr/dn = k (s - r), s the motion by which the counterface sinks per cycle. The
/// last step, of m cycles and w mm, gives s: r changed by k (s m - w). With that the solution over n cycles is
///
/// depth = n (f r + (1 - f) s), f = (1 - exp(-k n)) / (k n).
///
/// For small k n this tends to extrapolating every rate (Adams and Bashforth's method), which is
/// unstable from relaxation x interval = 1 on. The counterface's part is scaled so that the volume agrees with
/// a volume per cycle that continues to change as it did.
pub(super) fn exponential(rates: &Rates, last: Option<&StepRecord>, interval: f64) -> Vec<f64> {
    let mut depth_mm = euler(rates, interval);
    let Some(last) = last else {
        return depth_mm;
    };
    let volume = |depth_mm: &[f64]| volume_mm3(&rates.area_mm2, depth_mm);
    let wanted_mm3 = volume(&depth_mm) + added_mm3(rates, last, interval);
    // The depth at a node by the sinking of the counterface: n (1 - f) s.
    let sunk = |node: usize| {
        let counted = counted(rates, node);
        if counted == 0.0 {
            return 0.0;
        }
        let change = rates.depth_per_cycle_mm[node] - last.depth_per_cycle_mm[node];
        let sunk_mm = (last.depth_mm[node] + change / counted).max(0.0);
        interval / last.interval * (1.0 - mean_decay(counted * interval)) * sunk_mm
    };
    let sunk_mm: Vec<f64> = (0..depth_mm.len()).map(sunk).collect();
    for (node, depth) in depth_mm.iter_mut().enumerate() {
        *depth *= mean_decay(counted(rates, node) * interval);
    }
    let sunk_mm3 = volume(&sunk_mm);
    // A negative scale would let the counterface rise, and depths become negative.
    let scale = if sunk_mm3 > 0.0 {
        ((wanted_mm3 - volume(&depth_mm)) / sunk_mm3).max(0.0)
    } else {
        0.0
    };
    let each = depth_mm.iter_mut().zip(&sunk_mm);
    each.for_each(|(depth, sunk)| *depth += scale * sunk);
    depth_mm
}

/// Returns the relaxation of a node that the rule uses, per cycle.
fn counted(rates: &Rates, node: usize) -> f64 {
    COUNTED * rates.node_relaxation_per_cycle[node]
}

/// Returns the mean of exp(-t) for t from 0 to `relaxed`.
fn mean_decay(relaxed: f64) -> f64 {
    // Below this the series is more accurate than the quotient, and the quotient fails at 0.
    const SMALL: f64 = 1e-5;
    if relaxed > SMALL {
        -(-relaxed).exp_m1() / relaxed
    } else {
        1.0 - relaxed / 2.0
    }
}

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
    /// the trapezoidal rule minus the step.
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

    /// Adds the error of the last step: the predicted wear minus the step.
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
/// The exact wear of the last step follows from the motion by which the counterface sank, by the
/// equation of [`exponential`]. By the same equation earlier errors decay.
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

    fn rates_of(depth_per_cycle_mm: &[f64]) -> Rates {
        Rates {
            depth_per_cycle_mm: depth_per_cycle_mm.to_vec(),
            area_mm2: vec![2.0; depth_per_cycle_mm.len()],
            node_relaxation_per_cycle: vec![0.0; depth_per_cycle_mm.len()],
            relaxation_per_cycle: 0.0,
        }
    }

    fn last(depth_per_cycle_mm: &[f64], interval: f64) -> StepRecord {
        let step = WearStep {
            interval,
            cycles_after: interval,
            depth_mm: euler(&rates_of(depth_per_cycle_mm), interval),
            predicted_mm: Vec::new(),
            error_mm: vec![0.0; depth_per_cycle_mm.len()],
        };
        step.record(rates_of(depth_per_cycle_mm), None)
    }

    #[test]
    fn verify_a_volume_that_changes_evenly_is_met_exactly() {
        // 2 mm2 x (5 -> 7 -> ...) mm a cycle, one mm a cycle more each cycle and node.
        for (before, now, per_cycle) in [
            ([2.0, 3.0], [5.0, 2.0], 2.0),
            ([5.0, 2.0], [2.0, 3.0], -2.0),
        ] {
            let depth = extrapolated(&rates_of(&now), Some(&last(&before, 2.0)), 3.0);
            let rate = 2.0 * (now[0] + now[1]);
            let exact = 3.0 * rate + 0.5 * 9.0 * per_cycle;
            assert!((volume_mm3(&[2.0; 2], &depth) - exact).abs() < 1e-12);
        }
    }

    #[test]
    fn what_is_added_goes_where_the_rates_grow() {
        let depth = extrapolated(&rates_of(&[5.0, 2.0]), Some(&last(&[2.0, 3.0], 2.0)), 3.0);
        assert!(depth[0] > 15.0 && depth[1] == 6.0);
        assert_eq!(extrapolated(&rates_of(&[5.0, 2.0]), None, 3.0), [15.0, 6.0]);
    }

    /// Rate at which the wear rate of a node falls as the node wears faster than the counterface sinks.
    const RELAXATION: f64 = 1.0;

    /// Nodes of equal areas that wear as the counterface sinks on them: r = k (sunk - worn).
    struct Bed<S: Fn(usize, f64, f64) -> f64> {
        nodes: usize,
        /// Sinking of the counterface at a node, by numbers of cycles and mean depth, mm.
        sunk_mm: S,
    }

    impl<S: Fn(usize, f64, f64) -> f64> Bed<S> {
        fn rates(&self, worn_mm: &[f64], cycles: f64) -> Rates {
            let mean_mm = worn_mm.iter().sum::<f64>() / self.nodes as f64;
            let sunk_mm = |node: usize| (self.sunk_mm)(node, cycles, mean_mm);
            let rate = |node: usize| RELAXATION * (sunk_mm(node) - worn_mm[node]);
            Rates {
                depth_per_cycle_mm: (0..self.nodes).map(rate).collect(),
                area_mm2: vec![1.0; self.nodes],
                node_relaxation_per_cycle: vec![RELAXATION; self.nodes],
                relaxation_per_cycle: RELAXATION,
            }
        }

        /// Returns the depth at the nodes after even steps, each as long as `interval`.
        fn worn_mm(
            &self,
            steps: usize,
            interval: f64,
            rule: impl Fn(&Rates, Option<&StepRecord>, f64) -> Vec<f64>,
        ) -> Vec<f64> {
            let mut worn_mm = vec![0.0; self.nodes];
            let mut last = None;
            for step in 0..steps {
                let rates = self.rates(&worn_mm, step as f64 * interval);
                let depth_mm = rule(&rates, last.as_ref(), interval);
                worn_mm.iter_mut().zip(&depth_mm).for_each(|(w, d)| *w += d);
                let step = WearStep {
                    interval,
                    cycles_after: 0.0,
                    predicted_mm: Vec::new(),
                    error_mm: vec![0.0; self.nodes],
                    depth_mm,
                };
                last = Some(step.record(rates, last.as_ref()));
            }
            worn_mm
        }
    }

    fn deepest(worn_mm: &[f64]) -> f64 {
        worn_mm.iter().copied().fold(0.0, f64::max)
    }

    fn by_euler(rates: &Rates, _: Option<&StepRecord>, interval: f64) -> Vec<f64> {
        euler(rates, interval)
    }

    #[test]
    fn verify_rates_that_relax_exponentially_are_met_to_second_order() {
        // Two nodes share a load: the mean rate stays 1, the difference of 0.8 relaxes.
        let bed = Bed {
            nodes: 2,
            sunk_mm: |node: usize, _, mean_mm| [1.4, 0.6][node] / RELAXATION + mean_mm,
        };
        let cycles = 5.0_f64;
        let exact = cycles + 0.4 * (1.0 - (-cycles).exp());
        let error = |steps: usize, rule: fn(&Rates, Option<&StepRecord>, f64) -> Vec<f64>| {
            deepest(&bed.worn_mm(steps, cycles / steps as f64, rule)) / exact - 1.0
        };
        assert!(error(10, exponential).abs() < 0.01);
        assert!(error(20, exponential).abs() < error(20, by_euler).abs() / 2.0);
        let fall = error(80, exponential) / error(160, exponential);
        assert!((fall - 4.0).abs() < 0.4, "{fall}");
    }

    #[test]
    fn verify_a_moving_scar_is_met_to_second_order() {
        // The counterface sinks most in a hollow that moves from node 3 to node 8.
        let bump = |node: usize, cycles: f64| {
            let place = 3.0 + cycles - node as f64;
            1.0 + 0.5 * (1.0 + (place / 2.0).tanh())
        };
        let bed = Bed {
            nodes: 12,
            sunk_mm: |node, cycles, _| cycles + bump(node, cycles),
        };
        let after = |steps: usize, rule: fn(&Rates, Option<&StepRecord>, f64) -> Vec<f64>| {
            deepest(&bed.worn_mm(steps, 5.0 / steps as f64, rule))
        };
        let exact = after(4000, exponential);
        let error = |steps, rule| after(steps, rule) / exact - 1.0;
        assert!(
            error(10, exponential).abs() < 0.01,
            "{}",
            error(10, exponential)
        );
        let fall = error(80, exponential) / error(160, exponential);
        assert!((fall - 4.0).abs() < 0.4, "{fall}");
    }

    #[test]
    fn verify_a_node_too_deep_comes_back_as_long_as_by_euler() {
        // One node lies deeper than the other by a thousandth of a mm; the load is shared.
        let bed = Bed {
            nodes: 2,
            sunk_mm: |node: usize, _, mean_mm| 1.0 / RELAXATION + mean_mm + [0.5e-3, -0.5e-3][node],
        };
        let uneven = |interval: f64, steps: usize| {
            let worn_mm = bed.worn_mm(steps, interval, exponential);
            (worn_mm[0] - worn_mm[1] - 1e-3).abs() / 1e-3
        };
        assert!(uneven(1.9, 200) < 0.01);
        assert!(uneven(2.1, 80) > 10.0);
        assert!((uneven(2.0, 60) - uneven(2.0, 40)).abs() < 1e-6);
    }

    #[test]
    fn a_node_that_nothing_presses_is_not_worn() {
        let at = |rate: f64, relaxation: f64| Rates {
            depth_per_cycle_mm: vec![rate, 1.0],
            area_mm2: vec![1.0; 2],
            node_relaxation_per_cycle: vec![relaxation, 1.0],
            relaxation_per_cycle: 1.0,
        };
        let last = WearStep {
            interval: 1.0,
            cycles_after: 1.0,
            depth_mm: vec![0.5, 1.0],
            predicted_mm: Vec::new(),
            error_mm: vec![0.0; 2],
        };
        let last = last.record(at(0.5, 1.0), None);
        let depth_mm = exponential(&at(0.0, 0.0), Some(&last), 1.0);
        assert_eq!(depth_mm[0], 0.0);
    }
}

#[cfg(test)]
mod error_tests {
    use super::*;

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
        step.record(rates(3.0, 0.0), None)
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
        // The counterface does not sink, so the rate of 3 falls by k for every mm: after Euler's 6 mm to
        // 3 - 6 k, where the exact depth is 3 (1 - exp(-2 k))/k.
        let counted = 0.2_f64;
        let last = last(6.0, 0.0);
        let now = rates(3.0 - 6.0 * counted, 2.0 * counted);
        let exact = 3.0 * (1.0 - (-2.0 * counted).exp()) / counted;
        assert!((accumulated_error_mm(start(&now, &last))[0] - (exact - 6.0)).abs() < 1e-12);
    }

    #[test]
    fn what_was_missed_fades_as_the_node_relaxes() {
        // This step errs by nothing: the rate stays, and so the counterface sinks as it wears.
        let relaxation = 0.7;
        let (now, last) = (rates(3.0, relaxation), last(6.0, 1.0));
        let error_mm = accumulated_error_mm(start(&now, &last))[0];
        assert!((error_mm - (-2.0 * counted(&now, 0)).exp()).abs() < 1e-12);
    }
}
