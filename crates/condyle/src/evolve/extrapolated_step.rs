//! Depth that an interval wears when volume goes on changing as it did: the rule of fixed intervals.

use super::{mean_over_wear::volume_mm3, rates::Rates, step_record::StepRecord};

/// Depth that an interval wears if every cycle wears as the one solved: Euler's method.
pub(super) fn straight(rates: &Rates, interval: f64) -> Vec<f64> {
    let depth = |rate: &f64| rate * interval;
    rates.depth_per_cycle_mm.iter().map(depth).collect()
}

/// Depth that an interval wears if the volume per cycle goes on changing as it did over the last
/// one, which makes the volume second order in the interval.
///
/// The volume that this adds to Euler's goes where the rates grow, in proportion; one that it
/// takes away goes where they fall. To extrapolate every node by itself (Adams and Bashforth's
/// method) would be unstable from 1 / relaxation on: the pressure that a node has lost its
/// neighbours have got, and an interval later it comes back.
pub(super) fn extrapolated(rates: &Rates, last: Option<&StepRecord>, interval: f64) -> Vec<f64> {
    let mut depth_mm = straight(rates, interval);
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
    if pattern_mm3 != 0.0 {
        for (depth, part) in depth_mm.iter_mut().zip(&pattern) {
            *depth = (*depth + part * added_mm3 / pattern_mm3).max(0.0);
        }
    }
    depth_mm
}

/// Volume that an interval wears more than if every cycle wore as the one solved, mm3, as the volume
/// per cycle goes on changing as it did over the last one.
pub(super) fn added_mm3(rates: &Rates, last: &StepRecord, interval: f64) -> f64 {
    let change = rates.volume_per_cycle_mm3() - last.volume_per_cycle_mm3();
    interval * interval / (2.0 * last.interval) * change
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::step_record::WearStep;

    fn rates(depth_per_cycle_mm: &[f64]) -> Rates {
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
            depth_mm: straight(&rates(depth_per_cycle_mm), interval),
            predicted_mm: Vec::new(),
            error_mm: vec![0.0; depth_per_cycle_mm.len()],
        };
        step.record(rates(depth_per_cycle_mm))
    }

    #[test]
    fn verify_a_volume_that_changes_evenly_is_met_exactly() {
        // 2 mm2 x (5 -> 7 -> ...) mm a cycle, one mm a cycle more each cycle and node.
        for (before, now, per_cycle) in [
            ([2.0, 3.0], [5.0, 2.0], 2.0),
            ([5.0, 2.0], [2.0, 3.0], -2.0),
        ] {
            let depth = extrapolated(&rates(&now), Some(&last(&before, 2.0)), 3.0);
            let rate = 2.0 * (now[0] + now[1]);
            let exact = 3.0 * rate + 0.5 * 9.0 * per_cycle;
            assert!((volume_mm3(&[2.0; 2], &depth) - exact).abs() < 1e-12);
        }
    }

    #[test]
    fn what_is_added_goes_where_the_rates_grow() {
        let depth = extrapolated(&rates(&[5.0, 2.0]), Some(&last(&[2.0, 3.0], 2.0)), 3.0);
        assert!(depth[0] > 15.0 && depth[1] == 6.0);
        assert_eq!(extrapolated(&rates(&[5.0, 2.0]), None, 3.0), [15.0, 6.0]);
    }
}
