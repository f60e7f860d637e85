//! One step of the march: so many cycles, and what they wear away.

use serde::{Deserialize, Serialize};

use super::{
    Schedule, Updates,
    interval::{adaptive_interval, second_order, shared_out},
    rates::{Rates, total},
    relaxing::relaxing,
    step_error::missed,
};

/// A step of the march.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Step {
    /// Its cycles.
    pub interval: f64,
    /// Cycles of the test done after it.
    pub cycles_after: f64,
    /// What it wears at every surface node, mm.
    pub depth_mm: Vec<f64>,
    /// What it wears by a rule of second order other than its own, mm.
    pub foreseen_mm: Vec<f64>,
    /// How much deeper the exact march would be at every surface node when it begins, mm.
    pub missed_mm: Vec<f64>,
}

/// What the next step remembers of a step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepRecord {
    /// Its cycles.
    pub interval: f64,
    /// Depth that a cycle wore at every surface node when it began, mm.
    pub depth_per_cycle_mm: Vec<f64>,
    /// Depth that it took at every surface node, mm.
    pub depth_mm: Vec<f64>,
    /// How much deeper the exact march would have been at every surface node when it began, mm.
    pub missed_mm: Vec<f64>,
    /// Area of every surface node's share when it began, mm2.
    pub area_mm2: Vec<f64>,
    /// How fast wear flattened the pressure when it began, a cycle.
    pub relaxation_per_cycle: f64,
}

impl StepRecord {
    /// Volume that a cycle wore when it began, mm3.
    pub fn volume_per_cycle_mm3(&self) -> f64 {
        total(&self.area_mm2, &self.depth_per_cycle_mm)
    }

    /// Volume that it took, mm3.
    pub fn volume_mm3(&self) -> f64 {
        total(&self.area_mm2, &self.depth_mm)
    }
}

/// Where a march stands before a step.
#[derive(Clone, Copy)]
pub(super) struct Before<'a> {
    /// What a cycle wears now.
    pub rates: &'a Rates,
    /// The step that led here.
    pub last: Option<&'a StepRecord>,
    /// Depth worn so far at every surface node, mm.
    pub worn_mm: &'a [f64],
    /// Cycles done.
    pub cycles: f64,
    /// Updates done.
    pub updates: usize,
}

impl Step {
    /// The next step of a march by `schedule`.
    pub fn next(before: Before<'_>, schedule: &Schedule) -> Self {
        let left = schedule.cycles - before.cycles;
        let (interval, is_last) = match schedule.updates {
            Updates::Fixed(updates) => {
                let interval = schedule.cycles / updates as f64;
                (interval, before.updates + 1 >= updates)
            }
            Updates::Auto { tolerance } => {
                let wished = adaptive_interval(before, schedule.cycles, tolerance);
                let interval = shared_out(left, wished);
                (interval, interval >= left)
            }
        };
        let (depth_mm, foreseen_mm) = worn(before, schedule.updates, interval);
        Self {
            interval,
            cycles_after: after(before.cycles, interval, is_last, schedule),
            depth_mm,
            foreseen_mm,
            missed_mm: missed(before),
        }
    }

    /// What the next step remembers of this one.
    pub fn remembered(self, rates: Rates) -> StepRecord {
        StepRecord {
            interval: self.interval,
            relaxation_per_cycle: rates.relaxation_per_cycle,
            depth_per_cycle_mm: rates.depth_per_cycle_mm,
            depth_mm: self.depth_mm,
            missed_mm: self.missed_mm,
            area_mm2: rates.area_mm2,
        }
    }
}

/// What an interval wears, mm, and what it wears by a second rule, which tells its error.
fn worn(before: Before<'_>, updates: Updates, interval: f64) -> (Vec<f64>, Vec<f64>) {
    let (rates, last) = (before.rates, before.last);
    let relaxing = relaxing(rates, last, interval);
    match updates {
        Updates::Fixed(_) => (extrapolated(rates, last, interval), relaxing),
        Updates::Auto { .. } => {
            let each = |node| second_order(before, node, interval);
            (relaxing, (0..before.worn_mm.len()).map(each).collect())
        }
    }
}

/// The last step lands on the last cycle, whatever the intervals sum up to.
fn after(cycles: f64, interval: f64, is_last: bool, schedule: &Schedule) -> f64 {
    match is_last {
        true => schedule.cycles,
        false => cycles + interval,
    }
}

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
fn extrapolated(rates: &Rates, last: Option<&StepRecord>, interval: f64) -> Vec<f64> {
    let mut depth_mm = straight(rates, interval);
    let Some(last) = last else {
        return depth_mm;
    };
    let change = rates.volume_per_cycle_mm3() - last.volume_per_cycle_mm3();
    let added_mm3 = added_mm3(rates, last, interval);
    let towards = |(now, before): (&f64, &f64)| (now - before).max(0.0) * change.signum();
    let pattern: Vec<f64> = match change >= 0.0 {
        true => rates
            .depth_per_cycle_mm
            .iter()
            .zip(&last.depth_per_cycle_mm)
            .map(towards)
            .collect(),
        false => last
            .depth_per_cycle_mm
            .iter()
            .zip(&rates.depth_per_cycle_mm)
            .map(towards)
            .collect(),
    };
    let pattern_mm3 = total(&rates.area_mm2, &pattern);
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

    fn rates(depth_per_cycle_mm: &[f64]) -> Rates {
        Rates {
            depth_per_cycle_mm: depth_per_cycle_mm.to_vec(),
            area_mm2: vec![2.0; depth_per_cycle_mm.len()],
            node_relaxation_per_cycle: vec![0.0; depth_per_cycle_mm.len()],
            relaxation_per_cycle: 0.0,
        }
    }

    fn last(depth_per_cycle_mm: &[f64], interval: f64) -> StepRecord {
        let step = Step {
            interval,
            cycles_after: interval,
            depth_mm: straight(&rates(depth_per_cycle_mm), interval),
            foreseen_mm: Vec::new(),
            missed_mm: vec![0.0; depth_per_cycle_mm.len()],
        };
        step.remembered(rates(depth_per_cycle_mm))
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
            assert!((total(&[2.0; 2], &depth) - exact).abs() < 1e-12);
        }
    }

    #[test]
    fn what_is_added_goes_where_the_rates_grow() {
        let depth = extrapolated(&rates(&[5.0, 2.0]), Some(&last(&[2.0, 3.0], 2.0)), 3.0);
        assert!(depth[0] > 15.0 && depth[1] == 6.0);
        assert_eq!(extrapolated(&rates(&[5.0, 2.0]), None, 3.0), [15.0, 6.0]);
    }

    #[test]
    fn the_last_even_step_lands_on_the_last_cycle() {
        let schedule = Schedule::fixed(5e6, 3);
        let now = rates(&[1e-8]);
        let mut cycles = 0.0;
        for updates in 0..3 {
            let before = Before {
                rates: &now,
                last: None,
                worn_mm: &[0.0],
                cycles,
                updates,
            };
            cycles = Step::next(before, &schedule).cycles_after;
        }
        assert_eq!(cycles, 5e6);
    }
}
