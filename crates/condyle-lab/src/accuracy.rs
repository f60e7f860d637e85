//! Estimated discretisation errors of a run.
//!
//! Two cycles during the march are solved again with finer increments and with a looser slip tolerance; the first
//! cycle, on the unworn insert, is solved again with a coarser mesh. The change of their wear and the order of
//! convergence give the error of the run. The march itself estimates the error of its steps; if the insert creeps, a
//! march of half as many steps does.
//!
//! Errors of ranges of motion, and of a peak in the first cycle, come from the first cycle, solved again with each
//! change. Errors of a peak in a later cycle come from the later of the two cycles during the march, which is also
//! solved again on a coarser mesh worn to the same depth, and with the surface lowered by the error of the march's
//! steps.

mod worn_surface;

use std::{ops::ControlFlow, sync::Arc};

use condyle::{
    contact::ContactLaw,
    evolve::{
        March, MarchState, Schedule, Snapshot, StepRecord, UpdateRecord, WearTest, mean_over_volume,
    },
    geometry::Insert,
    machine::{
        MachineState,
        knee::{AP, IE},
    },
};
use condyle_case::case::Case;
use condyle_results::{
    ErrorEstimate, Part, QuantityErrors, Summary,
    catalogue::{
        AP_RANGE_MM, IE_RANGE_DEG, MASS_LOSS_MG, MAX_DEPTH_MM, PEAK_CONTACT_AREA_CYCLE,
        PEAK_CONTACT_AREA_MM2, PEAK_PRESSURE_CYCLE, PEAK_PRESSURE_MPA,
    },
    joint_range,
};

use worn_surface::WornSurface;

// Richardson's factors: the ratio of the remaining error to the change that a coarser or finer value causes.
/// For twice the increments: 1 / (1 - 1/2^2), second order.
const FINER_INCREMENTS: f64 = 4.0 / 3.0;
/// For twice the slip tolerance: first order.
const LOOSER_SLIP: f64 = -1.0;
/// For twice the edge length: second order.
const COARSER_MESH: f64 = -1.0 / 3.0;
/// For a surface corrected by the errors of the steps so far.
const MISSED: f64 = 1.0;
/// For half the updates if the insert creeps. Steps of creep are of first order and steps of wear of second; twice
/// the updates leave a third of the error, so that half the updates triple it.
const HALF_THE_UPDATES: f64 = -1.0 / 2.0;

enum Without {
    /// The user asked to stop.
    Stopped,
    /// The changed test could not be solved.
    Reason(String),
}

/// The result of a changed test, or the reason why there is none.
type Found<T> = Result<T, Without>;

/// The result of a changed test, or the reason in words.
type Stated<T> = Result<T, String>;

/// Errors of volume loss and maximum depth, %.
type OfWear = [f64; 2];

/// Highest pressure and largest area of a cycle, or errors of them, %.
type Peaks = [f64; 2];

/// The peaks of the first cycle, and its ranges of AP and IE; or errors of them, %.
type FirstCycle = [f64; 4];

struct OnTheWay {
    wear: OfWear,
    peaks: Peaks,
}

struct PartEstimate {
    wear: Stated<OfWear>,
    /// Peaks of the later cycle during the march.
    later: Stated<Peaks>,
    first: Stated<FirstCycle>,
}

impl PartEstimate {
    fn errors(self, summary: &Summary) -> QuantityErrors {
        let [mass, depth] = each(self.wear);
        let [later_pressure, later_area] = each(self.later);
        let [pressure, area, ap, ie] = each(self.first);
        let of_peak = |cycle: f64, first, later| if cycle > 0.0 { later } else { first };
        let pressure = of_peak(summary[&PEAK_PRESSURE_CYCLE], pressure, later_pressure);
        let area = of_peak(summary[&PEAK_CONTACT_AREA_CYCLE], area, later_area);
        vec![
            (&MASS_LOSS_MG, mass),
            (&MAX_DEPTH_MM, depth),
            (&PEAK_PRESSURE_MPA, pressure),
            (&PEAK_CONTACT_AREA_MM2, area),
            (&AP_RANGE_MM, ap),
            (&IE_RANGE_DEG, ie),
        ]
    }
}

fn each<const N: usize>(stated: Stated<[f64; N]>) -> [Stated<f64>; N] {
    match stated {
        Ok(values) => values.map(Ok),
        Err(why) => std::array::from_fn(|_| Err(why.clone())),
    }
}

/// Estimates the error of a finished march; none for a march without updates. Breaks if `watch` requests a stop.
pub(crate) fn estimate(
    case: &Case,
    march: &March,
    summary: &Summary,
    watch: &mut dyn FnMut() -> ControlFlow<()>,
) -> ControlFlow<(), Option<ErrorEstimate>> {
    let Some(mut again) = Again::of(march, watch) else {
        return ControlFlow::Continue(None);
    };
    let coarser = case.coarser_insert().map(Arc::new);
    let law = looser(march.test().contact.as_ref());
    let (mesh, base) = again.by_mesh(&coarser, summary)?;
    let finer = again.by_increments(&base)?;
    let looser = again.by_slip(&base, &law)?;
    let updates = again.by_updates(summary)?;
    let parts = [
        (Part::Increments, finer.errors(summary)),
        (Part::Updates, updates.errors(summary)),
        (Part::Mesh, mesh.errors(summary)),
        (Part::SlipTolerance, looser.errors(summary)),
    ];
    let estimate = ErrorEstimate::new(|scalar| summary[scalar], parts);
    ControlFlow::Continue(Some(estimate))
}

/// Propagates a stop, and converts every other reason to words.
fn stated<T>(found: Found<T>) -> ControlFlow<(), Stated<T>> {
    match found {
        Ok(percent) => ControlFlow::Continue(Ok(percent)),
        Err(Without::Reason(why)) => ControlFlow::Continue(Err(why)),
        Err(Without::Stopped) => ControlFlow::Break(()),
    }
}

fn finer(mut test: WearTest) -> WearTest {
    test.time.increments *= 2;
    test
}

fn looser(contact: &dyn ContactLaw) -> Arc<dyn ContactLaw> {
    contact.with_slip_tolerance_times(2.0)
}

fn with_contact(test: WearTest, contact: Arc<dyn ContactLaw>) -> WearTest {
    WearTest { contact, ..test }
}

fn has_later_peak(summary: &Summary) -> bool {
    summary[&PEAK_PRESSURE_CYCLE] > 0.0 || summary[&PEAK_CONTACT_AREA_CYCLE] > 0.0
}

/// Returns the last update; an error for a march with one update, which cannot be compared.
fn last_of_several(state: &MarchState) -> Stated<&UpdateRecord> {
    let last = state.updates.last().filter(|_| state.updates.len() > 1);
    last.ok_or_else(|| "one update has no other to be compared with".to_owned())
}

/// Returns the march's own estimate of the error of its steps, % of volume loss and of maximum depth.
fn of_updates(state: &MarchState) -> Stated<OfWear> {
    let last = last_of_several(state)?;
    let error = state.step_error;
    Ok([
        100.0 * error.volume_mm3 / last.volume_loss_mm3,
        100.0 * error.max_depth_mm / last.max_depth_mm,
    ])
}

/// A reference test, with whose first cycle changed tests are compared, and the results of that cycle.
struct Base {
    test: WearTest,
    first: FirstCycle,
}

/// Cycles of a run, solved again.
struct Again<'a> {
    march: &'a March,
    /// Wear of the run's first cycles, and the machine states at their ends.
    first: &'a (StepRecord, Vec<MachineState>),
    /// Steps that represent the whole march; one if both are the same.
    snapshots: Vec<&'a Snapshot>,
    worn: WornSurface,
    growth: OfWear,
    watch: &'a mut dyn FnMut() -> ControlFlow<()>,
}

impl<'a> Again<'a> {
    fn of(march: &'a March, watch: &'a mut dyn FnMut() -> ControlFlow<()>) -> Option<Self> {
        let state = march.state();
        let worn = WornSurface::of(march);
        Some(Self {
            first: state.first_step.as_ref()?,
            snapshots: snapshots(state),
            growth: growth(state, &worn)?,
            worn,
            march,
            watch,
        })
    }

    /// Returns the test of the run shortened so far that wear and creep are negligible.
    fn as_run(&self) -> WearTest {
        WearTest {
            schedule: Schedule::fixed(1.0, 1),
            comparison_laws: Vec::new(),
            // A cycle solved again compares wear; comparison laws and creep would only take time.
            creep: None,
            ..self.march.test().clone()
        }
    }

    /// Estimates the error by a coarser mesh; also returns a test whose first cycle is solved quickly, on that mesh
    /// if it exists.
    fn by_mesh(
        &mut self,
        coarser: &Stated<Arc<Insert>>,
        summary: &Summary,
    ) -> ControlFlow<(), (PartEstimate, Base)> {
        // The run's own first cycle.
        let own = Base {
            test: self.as_run(),
            first: first_cycle(self.march.state()),
        };
        let insert = match coarser {
            Ok(insert) => insert,
            Err(why) => return ControlFlow::Continue((unknown(why), own)),
        };
        let test = WearTest {
            insert: Arc::clone(insert),
            ..self.as_run()
        };
        let unworn = stated(self.unworn(&test))?;
        let later = if has_later_peak(summary) {
            stated(self.worn_on(&test))?
        } else {
            Ok([0.0; 2])
        };
        ControlFlow::Continue(match unworn {
            Err(why) => (unknown(&why), own),
            Ok((wear, first)) => {
                let told = PartEstimate {
                    wear: Ok(self.between_the_nodes_too(wear)),
                    later,
                    first: Ok(errors(COARSER_MESH, first, own.first)),
                };
                (told, Base { test, first })
            }
        })
    }

    /// Returns the errors of wear by the mesh; the error of the depth is at least the excess of the deepest place
    /// between the nodes.
    fn between_the_nodes_too(&self, [mass, depth]: OfWear) -> OfWear {
        let missed = 100.0 * self.worn.missed_between_nodes();
        [mass, if missed > depth.abs() { missed } else { depth }]
    }

    fn by_increments(&mut self, base: &Base) -> ControlFlow<(), PartEstimate> {
        let test = finer(self.as_run());
        let on_the_way = stated(self.on_the_way(FINER_INCREMENTS, &test))?;
        let first = stated(self.again_first(FINER_INCREMENTS, finer(base.test.clone()), base))?;
        ControlFlow::Continue(told(on_the_way, first))
    }

    fn by_slip(
        &mut self,
        base: &Base,
        looser: &Arc<dyn ContactLaw>,
    ) -> ControlFlow<(), PartEstimate> {
        // The slip tolerance has nearly the same effect throughout the march: the last snapshot represents it.
        let test = with_contact(self.as_run(), Arc::clone(looser));
        let on_the_way = stated(self.at(self.snapshots.len() - 1, LOOSER_SLIP, &test))?;
        let test = with_contact(base.test.clone(), Arc::clone(looser));
        let first = stated(self.again_first(LOOSER_SLIP, test, base))?;
        ControlFlow::Continue(told(on_the_way, first))
    }

    /// Estimates the errors by the updates, on which the first cycle does not depend.
    fn by_updates(&mut self, summary: &Summary) -> ControlFlow<(), PartEstimate> {
        let later = if has_later_peak(summary) {
            stated(self.as_deep_as_exact())?
        } else {
            Ok([0.0; 2])
        };
        let wear = if self.march.test().creep.is_some() {
            stated(self.with_half_the_updates())?
        } else {
            of_updates(self.march.state())
        };
        ControlFlow::Continue(PartEstimate {
            wear,
            later,
            first: Ok([0.0; 4]),
        })
    }

    /// Estimates the errors of a march with creep, in %, from a march with half as many updates.
    ///
    /// The march estimates the error of its steps of wear, but not of its steps of creep, which change the later
    /// wear.
    fn with_half_the_updates(&mut self) -> Found<OfWear> {
        let state = self.march.state();
        let last = last_of_several(state).map_err(Without::Reason)?;
        let test = WearTest {
            schedule: Schedule::fixed(last.cycles, state.updates.len() / 2),
            comparison_laws: Vec::new(),
            ..self.march.test().clone()
        };
        let mut march = March::start(test)?.in_motion(&self.first.1);
        while !march.is_done() {
            march = self.solved(march)?;
        }
        let worn = |update: &UpdateRecord| [update.volume_loss_mm3, update.max_depth_mm];
        let halved = march.state().updates.last().map_or([0.0; 2], worn);
        Ok(errors(HALF_THE_UPDATES, halved, worn(last)))
    }

    /// Returns errors in %: `factor` times the change of a changed test during the march. Errors of the wear are the
    /// mean over the snapshots; errors of the peaks come from the later snapshot.
    fn on_the_way(&mut self, factor: f64, changed: &WearTest) -> Found<OnTheWay> {
        let count = self.snapshots.len();
        let (mut mean, mut peaks) = ([0.0; 2], [0.0; 2]);
        for snapshot in 0..count {
            let here = self.at(snapshot, factor, changed)?;
            mean = [0, 1].map(|i| mean[i] + here.wear[i] / count as f64);
            peaks = here.peaks;
        }
        Ok(OnTheWay { wear: mean, peaks })
    }

    fn at(&mut self, snapshot: usize, factor: f64, changed: &WearTest) -> Found<OnTheWay> {
        let snapshot = self.snapshots[snapshot];
        let march = self.solved(self.march_from(changed, snapshot))?;
        let weights = self.worn.weights();
        let reference = worn(&snapshot.step, &weights);
        let peaks = peaks_of(&self.march.state().updates[snapshot.update]);
        Ok(OnTheWay {
            wear: self.errors_of_wear(factor, &march, &weights, reference),
            peaks: errors(factor, first_peaks(march.state()), peaks),
        })
    }

    fn march_from(&self, test: &WearTest, snapshot: &Snapshot) -> March {
        March::from_snapshot(test.clone(), snapshot, self.march.state().zero_mm)
    }

    /// Returns the errors of the peaks in the later cycle, in %: the difference between the surface of the march and
    /// the surface that exact steps would give.
    fn as_deep_as_exact(&mut self) -> Found<Peaks> {
        let test = self.as_run();
        let Some(snapshot) = self.snapshots.last().copied() else {
            return Ok([0.0; 2]);
        };
        let exact = snapshot.lowered(&test.insert, snapshot.step.error_mm.clone());
        self.peaks_at(MISSED, &test, &exact, snapshot.update)
    }

    /// Returns the errors of the peaks in the later cycle, in %, from a coarser mesh worn to the same depth.
    fn worn_on(&mut self, coarser: &WearTest) -> Found<Peaks> {
        let Some(snapshot) = self.snapshots.last().copied() else {
            return Ok([0.0; 2]);
        };
        let depths_mm = snapshot.depths.total_mm();
        let worn = WornSurface::with(&self.march.test().insert, &depths_mm);
        let depths_mm = worn.depths_on(&coarser.insert);
        let coarse = snapshot.on(&coarser.insert, depths_mm);
        self.peaks_at(COARSER_MESH, coarser, &coarse, snapshot.update)
    }

    fn peaks_at(
        &mut self,
        factor: f64,
        test: &WearTest,
        snapshot: &Snapshot,
        update: usize,
    ) -> Found<Peaks> {
        let march = self.solved(self.march_from(test, snapshot))?;
        let reference = peaks_of(&self.march.state().updates[update]);
        Ok(errors(factor, first_peaks(march.state()), reference))
    }

    /// Returns the errors of wear in % from an unworn coarser mesh, and its first cycle.
    fn unworn(&mut self, coarser: &WearTest) -> Found<(OfWear, FirstCycle)> {
        let march = self.started(coarser.clone())?;
        let reference = worn(&self.first.0, &self.worn.weights());
        let weights = self.worn.weights_on(march.insert());
        let wear = self.errors_of_wear(COARSER_MESH, &march, &weights, reference);
        Ok((wear, first_cycle(march.state())))
    }

    /// Returns the errors of the first cycle in %, from a change of the test.
    fn again_first(&mut self, factor: f64, changed: WearTest, base: &Base) -> Found<FirstCycle> {
        let march = self.started(changed)?;
        Ok(errors(factor, first_cycle(march.state()), base.first))
    }

    fn started(&mut self, test: WearTest) -> Found<March> {
        let march = March::start(test)?.in_motion(&self.first.1);
        self.solved(march)
    }

    fn solved(&mut self, mut march: March) -> Found<March> {
        if march.update(&mut |_| (self.watch)())?.is_break() {
            return Err(Without::Stopped);
        }
        Ok(march)
    }

    fn errors_of_wear(
        &self,
        factor: f64,
        march: &March,
        weights: &[f64],
        reference: OfWear,
    ) -> OfWear {
        let now = match &march.state().first_step {
            Some((step, _)) => worn(step, weights),
            None => [0.0; 2],
        };
        [0, 1].map(|i| self.growth[i] * 100.0 * factor * (now[i] / reference[i] - 1.0))
    }
}

fn unknown(why: &str) -> PartEstimate {
    PartEstimate {
        wear: Err(why.to_owned()),
        later: Err(why.to_owned()),
        first: Err(why.to_owned()),
    }
}

/// Returns the estimate from the cycles during the march and the first cycle.
fn told(on_the_way: Stated<OnTheWay>, first: Stated<FirstCycle>) -> PartEstimate {
    let (wear, later) = match on_the_way {
        Ok(OnTheWay { wear, peaks }) => (Ok(wear), Ok(peaks)),
        Err(why) => (Err(why.clone()), Err(why)),
    };
    PartEstimate { wear, later, first }
}

/// Returns errors in %: `factor` times the relative difference of `now` from `reference`; 0 where they are equal.
fn errors<const N: usize>(factor: f64, now: [f64; N], reference: [f64; N]) -> [f64; N] {
    std::array::from_fn(|i| {
        // Both may be 0, and their quotient would be NaN.
        if now[i] == reference[i] {
            return 0.0;
        }
        100.0 * factor * (now[i] / reference[i] - 1.0)
    })
}

fn peaks_of(update: &UpdateRecord) -> Peaks {
    [update.peak_pressure_mpa, update.peak_contact_area_mm2]
}

fn first_peaks(state: &MarchState) -> Peaks {
    state.updates.first().map_or([0.0; 2], peaks_of)
}

/// Returns the peaks of the first cycle of a march, and the ranges of its motion, in the units of files.
fn first_cycle(state: &MarchState) -> FirstCycle {
    let [pressure, area] = first_peaks(state);
    let cycles = state.activities.first().map(|own| &own.first_and_last);
    let first = cycles.and_then(|cycles| cycles.as_ref());
    let range = |joint| first.map_or(0.0, |(first, _)| joint_range(&first.rows, joint));
    [pressure, area, range(AP), range(IE)]
}

fn snapshots(state: &MarchState) -> Vec<&Snapshot> {
    let mut snapshots: Vec<&Snapshot> = state.snapshots.iter().flatten().collect();
    // In a short march both snapshots belong to one step.
    snapshots.dedup_by(|a, b| a.depths == b.depths);
    snapshots
}

/// Returns the volume that a cycle wore, and the mean of its depth by `weights`.
fn worn(step: &StepRecord, weights: &[f64]) -> [f64; 2] {
    [
        step.volume_per_cycle_mm3(),
        mean_over_volume(&step.area_mm2, weights, &step.depth_per_cycle_mm),
    ]
}

impl<E: std::error::Error> From<E> for Without {
    fn from(why: E) -> Self {
        Self::Reason(why.to_string())
    }
}

/// Returns the powers of the rates with which volume loss and maximum depth grow.
///
/// Rates that are 1 % higher throughout correspond to a test that is 1 % longer: volume and depth grow by 1 % times
/// rate x cycles / (total so far), with the rate at the end. A spreading scar deepens more slowly at the end than on
/// average, which reduces the error.
fn growth(state: &MarchState, worn_surface: &WornSurface) -> Option<[f64; 2]> {
    let (last, step) = (state.updates.last()?, state.last_step.as_ref()?);
    let weights = worn_surface.weights();
    let [volume_mm3, depth_mm] = worn(step, &weights);
    let so_far_mm = mean_over_volume(&step.area_mm2, &weights, state.depths.wear_mm());
    Some([
        volume_mm3 * last.cycles / last.volume_loss_mm3,
        depth_mm * last.cycles / so_far_mm,
    ])
}
