//! The wear by other laws for comparison, the part of a law's wear outside the range of its fit, and the wear of each activity.

use serde::{Deserialize, Serialize};

use super::next_step::MIN_OBSERVED;
use super::rates::{SolvedStep, mean_cycles, volume_mm3, worn};
use crate::wear::{MeanCycle, NamedLaw, NodeWear, SharedCycle, WearLaw};

/// The wear so far by a law on the surface of the march, without changing it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ComparisonLaw {
    /// Name of the law.
    pub word: String,
    /// Depth at every surface node, mm.
    pub depth_mm: Vec<f64>,
    /// Volume, from depth times area, mm3.
    pub volume_mm3: f64,
    /// Part of the volume outside the range to which the law was fitted, mm3; none if that is unknown.
    pub outside_mm3: Option<f64>,
    /// Wear per cycle at the last update; none before the first.
    last: Option<CycleByLaw>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct CycleByLaw {
    interval: f64,
    /// Depth at every surface node, mm.
    depth_mm: Vec<f64>,
    /// Volume outside the range to which the law was fitted, mm3.
    outside_mm3: Option<f64>,
}

impl ComparisonLaw {
    pub(super) fn new(law: &NamedLaw, node_count: usize) -> Self {
        Self {
            word: law.word.to_owned(),
            depth_mm: vec![0.0; node_count],
            volume_mm3: 0.0,
            outside_mm3: Some(0.0),
            last: None,
        }
    }

    /// Returns the maximum depth of wear, mm.
    pub fn max_depth_mm(&self) -> f64 {
        self.depth_mm.iter().copied().fold(0.0, f64::max)
    }

    /// Adds an interval of such cycles, whose rates continue to change as over the last one.
    ///
    /// Adams and Bashforth's rule, of second order, is stable here, since the wear by this law changes no pressure.
    pub(super) fn add(
        &mut self,
        law: &dyn WearLaw,
        cycles: &[MeanCycle<'_>],
        area_mm2: &[f64],
        interval: f64,
    ) {
        let worn = worn(law, cycles);
        let depth_mm: Vec<f64> = worn.iter().map(|worn| worn.depth_mm).collect();
        let now = CycleByLaw {
            outside_mm3: outside_mm3(&worn, area_mm2, &depth_mm),
            interval,
            depth_mm,
        };
        // Without a last interval, last = now: Euler's method. So too after a much shorter one, such as the first of an insert that
        // creeps: the change of its rates does not hold over a long one.
        let is_long = |last: &CycleByLaw| last.interval > MIN_OBSERVED * interval;
        let last = self.last.take().filter(is_long);
        let step = |now: f64, last: f64, last_interval: f64| {
            interval * now + interval * interval / (2.0 * last_interval) * (now - last)
        };
        for (node, depth_mm) in self.depth_mm.iter_mut().enumerate() {
            let rate = now.depth_mm[node];
            let (last, last_interval) = last.as_ref().map_or((rate, interval), |last| {
                (last.depth_mm[node], last.interval)
            });
            let more_mm = step(rate, last, last_interval);
            *depth_mm += more_mm;
            self.volume_mm3 += area_mm2[node] * more_mm;
        }
        let outside = now.outside_mm3.map(|rate| {
            let before = last.as_ref();
            let before = before.and_then(|last| Some((last.outside_mm3?, last.interval)));
            let (last, last_interval) = before.unwrap_or((rate, interval));
            step(rate, last, last_interval)
        });
        self.outside_mm3 = sum(self.outside_mm3, outside);
        self.last = Some(now);
    }
}

/// Returns the part of the volume of these depths outside the range to which their law was fitted, mm3; none if that
/// is unknown.
pub(super) fn outside_mm3(worn: &[NodeWear], area_mm2: &[f64], depth_mm: &[f64]) -> Option<f64> {
    let outside = |(worn, &depth_mm): (&NodeWear, &f64)| {
        if depth_mm == 0.0 {
            return Some(0.0);
        }
        Some(depth_mm * worn.part_outside?)
    };
    let outside: Option<Vec<f64>> = worn.iter().zip(depth_mm).map(outside).collect();
    Some(volume_mm3(area_mm2, &outside?))
}

pub(super) fn sum(volume_mm3: Option<f64>, more_mm3: Option<f64>) -> Option<f64> {
    Some(volume_mm3? + more_mm3?)
}

/// Wear and contact of an activity so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ActivityWear {
    /// Part of the volume worn, mm3: each node's depth is divided in proportion to the activities' sums of
    /// p |ds| there, so that the parts add up to the whole.
    pub volume_mm3: f64,
    /// Volume that its cycles would have worn as the only activity, mm3, with the principal direction of its
    /// own paths. It differs from the part above where the law depends on cross-shear.
    pub alone_mm3: f64,
    /// Longest sliding distance under pressure in its cycle of the last update, the mean over a node's share, mm.
    pub longest_path_mm: f64,
    /// Highest pressure in any of its cycles, the final one included, anywhere on the surface, MPa.
    pub peak_pressure_mpa: f64,
    /// Largest contact area in any of its cycles, the final one included, mm2.
    pub peak_contact_area_mm2: f64,
}

/// Returns the wear of each of several activities in a step; nothing for a single one, which causes all wear.
pub(super) fn wear_of_each(law: &dyn WearLaw, interval: &SolvedStep<'_>) -> Vec<ActivityWear> {
    if interval.shared.len() < 2 {
        return Vec::new();
    }
    let of_one = |&(share, history): &SharedCycle<'_>| {
        // A share of 1: the law sees the cross-shear of this activity alone.
        let shared = [(1.0, history)];
        let mean = mean_cycles(&shared, interval.surface);
        let paths_mm = mean.iter().map(|mean| mean.pressed_distance_mm);
        ActivityWear {
            volume_mm3: part_mm3(interval, (share, history)),
            alone_mm3: share * alone_mm3(law, interval, &mean),
            longest_path_mm: paths_mm.fold(0.0, f64::max),
            ..ActivityWear::default()
        }
    };
    interval.shared.iter().map(of_one).collect()
}

/// Returns the activity's part of the volume that the step takes, mm3.
fn part_mm3(interval: &SolvedStep<'_>, (share, history): SharedCycle<'_>) -> f64 {
    let part = |node: usize| {
        let all = interval.mean[node].pressure_slip_mpa_mm;
        let own = share * history.sums(node).pressure_slip_mpa_mm;
        // Nodes that no activity loads have a depth of 0; the bound avoids 0/0.
        interval.step.depth_mm[node] * own / all.max(f64::MIN_POSITIVE)
    };
    let depth_mm: Vec<f64> = (0..interval.mean.len()).map(part).collect();
    volume_mm3(&interval.rates.area_mm2, &depth_mm)
}

/// Returns the volume that these cycles would wear alone, mm3: their rate times the number of cycles by which the step
/// extrapolates the rate of all activities.
fn alone_mm3(law: &dyn WearLaw, interval: &SolvedStep<'_>, mean: &[MeanCycle<'_>]) -> f64 {
    let worn = worn(law, mean);
    let depth_mm: Vec<f64> = worn.iter().map(|worn| worn.depth_mm).collect();
    let area_mm2 = &interval.rates.area_mm2;
    let cycles = volume_mm3(area_mm2, &interval.step.depth_mm)
        / interval.rates.volume_per_cycle_mm3().max(f64::MIN_POSITIVE);
    volume_mm3(area_mm2, &depth_mm) * cycles
}

impl ActivityWear {
    pub(super) fn and(self, more: Self) -> Self {
        Self {
            volume_mm3: self.volume_mm3 + more.volume_mm3,
            alone_mm3: self.alone_mm3 + more.alone_mm3,
            longest_path_mm: more.longest_path_mm,
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        contact::{CycleHistory, Moment, Record},
        wear::WEAR_LAWS,
    };

    /// Returns a cycle of one node that slides 10 mm under so many MPa.
    fn history(pressure_mpa: f64) -> CycleHistory {
        let mut history = CycleHistory::default();
        let moment = Moment {
            pressure_mpa,
            slip_mm: [10.0, 0.0],
        };
        let record = Record {
            node: 0,
            pressed_mm2: 2.0,
            moment,
        };
        let instant = history.record([record].into_iter());
        history.sort(1, &[instant]);
        history
    }

    #[test]
    fn verify_rates_that_change_evenly_are_summed_exactly() {
        // Archard's rate is r = 2.64e-10 x 10 (6 - n / 1000), n the cycles, from the second interval on.
        let kind = WEAR_LAWS.iter().find(|kind| kind.word == "archard");
        let law = kind.expect("it exists").with_defaults();
        let mut law_wear = ComparisonLaw::new(&law, 1);
        let add = |law_wear: &mut ComparisonLaw, pressure_mpa, interval| {
            let history = history(pressure_mpa);
            let shared = [(1.0, &history)];
            let cycles = [MeanCycle::new(&shared, 0, 2.0)];
            law_wear.add(law.law.as_ref(), &cycles, &[2.0], interval);
        };
        add(&mut law_wear, 6.0, 1000.0);
        let first = 2.64e-9 * 6.0 * 1000.0;
        assert!((law_wear.max_depth_mm() / first - 1.0).abs() < 1e-12);
        add(&mut law_wear, 5.0, 2000.0);
        let second = 2.64e-9 * (5.0 + 3.0) / 2.0 * 2000.0;
        assert!((law_wear.max_depth_mm() / (first + second) - 1.0).abs() < 1e-12);
        assert!((law_wear.volume_mm3 / (2.0 * (first + second)) - 1.0).abs() < 1e-12);
        assert_eq!(law_wear.outside_mm3, None);
        // The change of the rates over an interval is not extrapolated over one that is nine times as long.
        add(&mut law_wear, 4.0, 18000.0);
        let third = 2.64e-9 * 4.0 * 18000.0;
        assert!((law_wear.max_depth_mm() / (first + second + third) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn volume_outside_the_range_of_a_fit_is_reported() {
        let kind = WEAR_LAWS.iter().find(|kind| kind.word == "directional");
        let law = kind.expect("it exists").with_defaults();
        let mut law_wear = ComparisonLaw::new(&law, 1);
        let history = history(6.0);
        let shared = [(1.0, &history)];
        let cycles = [MeanCycle::new(&shared, 0, 2.0)];
        law_wear.add(law.law.as_ref(), &cycles, &[2.0], 1e6);
        assert!(law_wear.volume_mm3 > 0.0);
        assert_eq!(law_wear.outside_mm3, Some(law_wear.volume_mm3));
    }
}
