//! What other laws would have worn by the histories of a march, and what of its own law was out of range.

use serde::{Deserialize, Serialize};

use super::rates::{volume_mm3, worn};
use crate::wear::{MeanCycle, NamedLaw, NodeWear, WearLaw};

/// What a law would have worn so far, had its wear not moved the surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ComparisonLaw {
    /// The word for the law.
    pub word: String,
    /// Depth at every surface node, mm.
    pub depth_mm: Vec<f64>,
    /// Volume, from depth times area, mm3.
    pub volume_mm3: f64,
    /// What of the volume is outside of what the law was fitted to, mm3; none where that is not known.
    pub outside_mm3: Option<f64>,
    /// What a cycle of the last update wore by it; none before the first.
    last: Option<CycleByLaw>,
}

/// What a cycle wears by a law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct CycleByLaw {
    /// Cycles of the update's interval.
    interval: f64,
    /// Depth at every surface node, mm.
    depth_mm: Vec<f64>,
    /// Volume outside of what the law was fitted to, mm3.
    outside_mm3: Option<f64>,
}

impl ComparisonLaw {
    /// A law that has worn nothing yet.
    pub(super) fn new(law: &NamedLaw, node_count: usize) -> Self {
        Self {
            word: law.word.to_owned(),
            depth_mm: vec![0.0; node_count],
            volume_mm3: 0.0,
            outside_mm3: Some(0.0),
            last: None,
        }
    }

    /// Deepest wear, mm.
    pub fn max_depth_mm(&self) -> f64 {
        self.depth_mm.iter().copied().fold(0.0, f64::max)
    }

    /// Adds an interval of cycles like these, whose rates go on changing as they did over the last one.
    ///
    /// That is Adams and Bashforth's rule, of second order. It is stable here, since what this law wears
    /// changes no pressure.
    pub(super) fn add(
        &mut self,
        law: &dyn WearLaw,
        cycles: &[MeanCycle<'_>],
        area_mm2: &[f64],
        interval: f64,
    ) {
        let now = CycleByLaw::of(law, cycles, area_mm2, interval);
        let step = |now: f64, last: f64, last_interval: f64| {
            interval * now + interval * interval / (2.0 * last_interval) * (now - last)
        };
        for (node, depth_mm) in self.depth_mm.iter_mut().enumerate() {
            let rate = now.depth_mm[node];
            let (last, last_interval) = self.last.as_ref().map_or((rate, interval), |last| {
                (last.depth_mm[node], last.interval)
            });
            let more_mm = step(rate, last, last_interval);
            *depth_mm += more_mm;
            self.volume_mm3 += area_mm2[node] * more_mm;
        }
        let outside = now.outside_mm3.map(|rate| {
            let last = self.last.as_ref();
            let before = last.and_then(|last| Some((last.outside_mm3?, last.interval)));
            let (last, last_interval) = before.unwrap_or((rate, interval));
            step(rate, last, last_interval)
        });
        self.outside_mm3 = sum(self.outside_mm3, outside);
        self.last = Some(now);
    }
}

impl CycleByLaw {
    fn of(law: &dyn WearLaw, cycles: &[MeanCycle<'_>], area_mm2: &[f64], interval: f64) -> Self {
        let worn = worn(law, cycles);
        let depth_mm: Vec<f64> = worn.iter().map(|worn| worn.depth_mm).collect();
        Self {
            outside_mm3: outside_mm3(&worn, area_mm2, &depth_mm),
            interval,
            depth_mm,
        }
    }
}

/// What of these depths is outside of what their law was fitted to, mm3; none where that is not known.
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

/// The sum of two volumes, if both are known.
pub(super) fn sum(volume_mm3: Option<f64>, more_mm3: Option<f64>) -> Option<f64> {
    Some(volume_mm3? + more_mm3?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        contact::{CycleHistory, Moment, Record},
        wear::WEAR_LAWS,
    };

    /// A cycle of one node that slides 10 mm under so many MPa.
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
        let law = WEAR_LAWS[0].with_defaults();
        let mut beside = ComparisonLaw::new(&law, 1);
        let add = |beside: &mut ComparisonLaw, pressure_mpa, interval| {
            let history = history(pressure_mpa);
            let shared = [(1.0, &history)];
            let cycles = [MeanCycle::new(&shared, 0, 2.0)];
            beside.add(law.law.as_ref(), &cycles, &[2.0], interval);
        };
        add(&mut beside, 6.0, 1000.0);
        let first = 2.64e-9 * 6.0 * 1000.0;
        assert!((beside.max_depth_mm() / first - 1.0).abs() < 1e-12);
        add(&mut beside, 5.0, 2000.0);
        let second = 2.64e-9 * (5.0 + 3.0) / 2.0 * 2000.0;
        assert!((beside.max_depth_mm() / (first + second) - 1.0).abs() < 1e-12);
        assert!((beside.volume_mm3 / (2.0 * (first + second)) - 1.0).abs() < 1e-12);
        assert_eq!(beside.outside_mm3, None);
    }

    #[test]
    fn volume_outside_is_told_where_a_law_says_what_it_was_fitted_to() {
        let kind = WEAR_LAWS.iter().find(|kind| kind.word == "directional");
        let law = kind.expect("is there").with_defaults();
        let mut beside = ComparisonLaw::new(&law, 1);
        let history = history(6.0);
        let shared = [(1.0, &history)];
        let cycles = [MeanCycle::new(&shared, 0, 2.0)];
        beside.add(law.law.as_ref(), &cycles, &[2.0], 1e6);
        assert!(beside.volume_mm3 > 0.0);
        assert_eq!(beside.outside_mm3, Some(beside.volume_mm3));
    }
}
