//! Estimated discretisation errors of a run.
//!
//! Two cycles during the march are solved again with finer increments and with a looser slip tolerance; the first
//! cycle, on the unworn insert, is solved again with a coarser mesh. The change of their wear and the order of
//! convergence give the error of the run. The march itself estimates the error of its steps; if the insert creeps or
//! encloses the counterface, two marches on the coarser mesh do.
//!
//! Errors of ranges of motion, and of a peak in the first cycle, come from the first cycle, solved again with each
//! change. Errors of a peak in a later cycle come from the later of the two cycles during the march, which is also
//! solved again on a coarser mesh worn to the same depth, and with the surface lowered by the error of the march's
//! steps; the part of the peak by which it differs from that of the first cycle is due to wear, and has the error of the
//! wear as well.

mod worn_surface;

use std::{
    ops::{ControlFlow, Range},
    sync::Arc,
};

use condyle::{
    Vec3,
    evolve::{
        March, MarchState, Schedule, Snapshot, StepRecord, UpdateRecord, WearTest, mean_over_volume,
    },
    geometry::Insert,
    machine::{
        MachineState,
        knee::{AP, IE, KNEE},
    },
};
use condyle_case::case::Case;
use condyle_results::{
    ErrorEstimate, Part, QuantityErrors, Summary,
    catalogue::{
        AP_RANGE_MM, IE_RANGE_DEG, MASS_LOSS_MG, MAX_DEPTH_MM, PEAK_CONTACT_AREA_MM2,
        PEAK_MAX_SHEAR_MPA, PEAK_PRESSURE_MPA, PEAK_VON_MISES_MPA, Scalar,
    },
    joint_range,
};

use worn_surface::WornSurface;

// Richardson's factors: the ratio of the remaining error to the change that a coarser or finer value causes.
/// For twice the increments: 1 / (1 - 1/2^2), second order.
const FINER_INCREMENTS: f64 = 4.0 / 3.0;
/// For twice the slip tolerance: first order.
const LOOSER_SLIP: f64 = -1.0;
/// For twice the edge length and half the layers: second order.
const COARSER_MESH: f64 = -1.0 / 3.0;
/// The same for the peak pressure of a deformable insert, which is that of a node: first order, as finer runs of varied cases
/// show (`scripts/evidence stated-errors`).
const COARSER_DEFORMABLE_PEAK: f64 = -1.0;
/// Ratio of the faces of a mesh to those of the coarser one below which their difference does not show the error: instead of
/// four, the coarsest mesh of a disc has a ratio of one.
const MIN_FEWER_FACES: f64 = 2.0;
/// For a surface corrected by the errors of the steps so far.
const MISSED: f64 = 1.0;
/// For twice the updates if the insert creeps or encloses the counterface: between first order (2) and second (4/3).
/// Finer runs of hips, discs and creep confirm it (`docs/src/accuracy.md`).
const TWICE_THE_UPDATES: f64 = 3.0 / 2.0;
/// Length of the mean normal of the worn surface, weighted by wear, below which the insert encloses the counterface: 0.95
/// and more in knees, less than 0.9 in cups and discs, and on both sides of it in ankles.
const MIN_MEAN_NORMAL: f64 = 0.94;

/// The result of a changed test, or the reason why there is none.
type Found<T> = Result<T, String>;

/// Errors of volume loss and maximum depth, %.
type OfWear = [f64; 2];

/// The values of [`PEAKS`] in a cycle, the stresses 0 for a foundation; or errors of them, %.
type Peaks = [f64; PEAKS.len()];

/// The results whose largest values in a cycle are compared.
const PEAKS: [&Scalar; 4] = [
    &PEAK_PRESSURE_MPA,
    &PEAK_CONTACT_AREA_MM2,
    &PEAK_VON_MISES_MPA,
    &PEAK_MAX_SHEAR_MPA,
];

/// Results of the first cycle, or errors of them, %.
#[derive(Clone, Copy)]
struct FirstCycle {
    peaks: Peaks,
    /// Ranges of AP and IE.
    ranges: [f64; 2],
}

/// The errors by one part of the discretisation.
struct PartEstimate {
    wear: Found<OfWear>,
    /// Peaks of the later cycle during the march.
    later: Found<Peaks>,
    first: Found<FirstCycle>,
}

impl PartEstimate {
    fn unknown(why: &str) -> Self {
        Self {
            wear: Err(why.to_owned()),
            later: Err(why.to_owned()),
            first: Err(why.to_owned()),
        }
    }

    /// Returns the errors of the numbers of a run with these peaks in its first cycle.
    fn errors(self, summary: &Summary, first_peaks: Peaks) -> QuantityErrors {
        let worn = self
            .wear
            .as_ref()
            .map_or(0.0, |[mass, depth]| mass.abs().max(depth.abs()));
        let [mass, depth] = each(self.wear);
        let later = each(self.later);
        let first = each(self.first.clone().map(|first| first.peaks));
        let [ap, ie] = each(self.first.map(|first| first.ranges));
        // A later cycle was solved again on a surface of the same depth; its own part knows the wear no better than that.
        let peaks = later.into_iter().zip(first).enumerate();
        let peaks = peaks.map(|(i, (later, first))| {
            if !is_later(summary, &first_peaks, i) {
                return (PEAKS[i], first);
            }
            let by_wear = 1.0 - first_peaks[i] / summary[PEAKS[i]];
            let with_wear = |own: f64| own.hypot(by_wear * worn).copysign(own);
            (PEAKS[i], later.map(with_wear))
        });
        let errors = [(&MASS_LOSS_MG, mass), (&MAX_DEPTH_MM, depth)];
        let errors = errors.into_iter().chain(peaks);
        let errors = errors.chain([(&AP_RANGE_MM, ap), (&IE_RANGE_DEG, ie)]);
        let is_result = |(scalar, _): &(&Scalar, _)| summary.get(scalar).is_some();
        errors.filter(is_result).collect()
    }
}

fn each<const N: usize>(found: Found<[f64; N]>) -> [Found<f64>; N] {
    match found {
        Ok(values) => values.map(Ok),
        Err(why) => std::array::from_fn(|_| Err(why.clone())),
    }
}

impl FirstCycle {
    /// Returns the errors by a change that led from `reference` to these results, with Richardson's factors.
    fn errors(self, of_peaks: Peaks, of_ranges: f64, reference: Self) -> Self {
        Self {
            peaks: errors(of_peaks, self.peaks, reference.peaks),
            ranges: errors([of_ranges; 2], self.ranges, reference.ranges),
        }
    }
}

/// Returns true if a peak of the run is higher than that of its first cycle.
fn is_later(summary: &Summary, first_peaks: &Peaks, peak: usize) -> bool {
    summary[PEAKS[peak]] > first_peaks[peak]
}

/// Estimates the error of a finished march; none for a march without updates. Breaks if `watch` requests a stop.
pub(crate) fn estimate(
    case: &Case,
    march: &March,
    summary: &Summary,
    watch: &mut dyn FnMut() -> ControlFlow<()>,
) -> ControlFlow<(), Option<ErrorEstimate>> {
    let Some(mut again) = Again::new(march, watch) else {
        return ControlFlow::Continue(None);
    };
    let mut of_peaks = [COARSER_MESH; PEAKS.len()];
    if case.contact.deformable().is_some() {
        of_peaks[0] = COARSER_DEFORMABLE_PEAK;
    }
    let (mesh, base) = again.by_mesh(case.coarser_insert(), of_peaks, summary);
    let all = 0..again.snapshots.len();
    // The slip tolerance has nearly the same effect throughout the march: the last snapshot represents it.
    let last = all.end.saturating_sub(1)..all.end;
    let increments = again.by_change(&base, FINER_INCREMENTS, all, |mut test| {
        test.time.increments *= 2;
        test
    });
    let looser = march.test().contact.with_slip_tolerance_times(2.0);
    let slip_tolerance = again.by_change(&base, LOOSER_SLIP, last, |test| WearTest {
        contact: Arc::clone(&looser),
        ..test
    });
    let updates = again.by_updates(&base, summary);
    if again.is_stopped {
        return ControlFlow::Break(());
    }
    let parts = [
        (Part::Increments, increments),
        (Part::Updates, updates),
        (Part::Mesh, mesh),
        (Part::SlipTolerance, slip_tolerance),
    ];
    let first_peaks = first_peaks(march.state());
    let parts = parts.map(|(part, own)| (part, own.errors(summary, first_peaks)));
    let estimate = ErrorEstimate::new(|scalar| summary[scalar], parts);
    ControlFlow::Continue(Some(estimate))
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
    is_stopped: bool,
}

impl<'a> Again<'a> {
    fn new(march: &'a March, watch: &'a mut dyn FnMut() -> ControlFlow<()>) -> Option<Self> {
        let state = march.state();
        let worn = WornSurface::of(march);
        let mut snapshots: Vec<&Snapshot> = state.snapshots.iter().flatten().collect();
        // In a short march both snapshots belong to one step.
        snapshots.dedup_by(|a, b| a.depths == b.depths);
        Some(Self {
            first: state.first_step.as_ref()?,
            snapshots,
            growth: growth(state, &worn)?,
            worn,
            march,
            watch,
            is_stopped: false,
        })
    }

    /// Returns the test of the run shortened so far that wear and creep are negligible.
    fn as_run(&self) -> WearTest {
        WearTest {
            schedule: Schedule::fixed(1.0, 1),
            comparison_laws: Vec::new(),
            law_family: false,
            // A cycle solved again compares wear; comparison laws and creep would only take time.
            creep: None,
            ..self.march.test().clone()
        }
    }

    /// Estimates the error by a coarser mesh; also returns a test whose first cycle is solved quickly, on that mesh
    /// if it exists.
    fn by_mesh(
        &mut self,
        coarser: Found<Insert>,
        of_peaks: Peaks,
        summary: &Summary,
    ) -> (PartEstimate, Base) {
        // The run's own first cycle.
        let own = Base {
            test: self.as_run(),
            first: first_cycle(self.march.state()),
        };
        let fine = &self.march.test().insert;
        let solved = coarser.and_then(|insert| {
            if insert.surface_faces().len() as f64 * MIN_FEWER_FACES > fine.surface_faces().len() as f64 {
                return Err("the mesh of the insert is only a few elements wide, and one with twice the edge_mm has hardly fewer \
                     elements; take a smaller edge_mm"
                    .to_owned());
            }
            let insert = Arc::new(insert);
            let test = WearTest {
                insert,
                ..own.test.clone()
            };
            let march = self.started(test.clone())?;
            Ok((self.solved(march)?, test))
        });
        let (march, test) = match solved {
            Ok(solved) => solved,
            Err(why) => return (PartEstimate::unknown(&why), own),
        };
        let reference = worn(&self.first.0, &self.worn.weights());
        let weights = self.worn.weights_on(march.insert());
        let [mass, depth] = self.errors_of_wear(COARSER_MESH, &march, &weights, reference);
        // The deepest place may lie between the nodes of either mesh: its excess is the least error of the depth.
        let missed = 100.0 * self.worn.missed_between_nodes();
        let depth = if missed > depth.abs() { missed } else { depth };
        let later = self.later_peaks(summary, of_peaks, &test, |snapshot| {
            let surface = WornSurface::with(fine, &snapshot.depths.total_mm());
            snapshot.on(&test.insert, surface.depths_on(&test.insert))
        });
        let first = first_cycle(march.state());
        let part = PartEstimate {
            wear: Ok([mass, depth]),
            later,
            first: Ok(first.errors(of_peaks, COARSER_MESH, own.first)),
        };
        (part, Base { test, first })
    }

    /// Estimates the error by a change of the test: of the wear from the mean of cycles at some snapshots, of the later
    /// peaks from the last of them, and of the first cycle.
    fn by_change(
        &mut self,
        base: &Base,
        factor: f64,
        snapshots: Range<usize>,
        change: impl Fn(WearTest) -> WearTest,
    ) -> PartEstimate {
        let changed = change(self.as_run());
        let (wear, later) = match self.on_the_way(factor, snapshots, &changed) {
            Ok((wear, peaks)) => (Ok(wear), Ok(peaks)),
            Err(why) => (Err(why.clone()), Err(why)),
        };
        let first = self.started(change(base.test.clone()));
        let first = first.and_then(|march| self.solved(march));
        let first = first.map(|march| {
            let changed = first_cycle(march.state());
            changed.errors([factor; PEAKS.len()], factor, base.first)
        });
        PartEstimate { wear, later, first }
    }

    /// Returns errors in %: `factor` times the change of a changed test during the march.
    fn on_the_way(
        &mut self,
        factor: f64,
        snapshots: Range<usize>,
        changed: &WearTest,
    ) -> Found<(OfWear, Peaks)> {
        let (count, weights) = (snapshots.len() as f64, self.worn.weights());
        let (mut mean, mut peaks) = ([0.0; 2], Peaks::default());
        for number in snapshots {
            let snapshot = self.snapshots[number];
            let march = self.solved(self.march_from(changed, snapshot))?;
            let reference = worn(&snapshot.step, &weights);
            let wear = self.errors_of_wear(factor, &march, &weights, reference);
            mean = [0, 1].map(|i| mean[i] + wear[i] / count);
            peaks = self.errors_of_peaks([factor; PEAKS.len()], &march, snapshot);
        }
        Ok((mean, peaks))
    }

    /// Estimates the errors by the updates, on which the first cycle does not depend.
    fn by_updates(&mut self, base: &Base, summary: &Summary) -> PartEstimate {
        let test = self.as_run();
        // The surface that exact steps would give.
        let later = self.later_peaks(summary, [MISSED; PEAKS.len()], &test, |snapshot| {
            snapshot.lowered(&test.insert, snapshot.step.error_mm.clone())
        });
        PartEstimate {
            wear: self.wear_by_updates(base),
            later,
            first: Ok(FirstCycle {
                peaks: Peaks::default(),
                ranges: [0.0; 2],
            }),
        }
    }

    /// Returns the march's own estimate of the error of its steps of wear, in %.
    ///
    /// That estimate does not contain the effect of a wrong shape on later rates. If the insert creeps or encloses the
    /// counterface, this effect is large, and two marches estimate the error, one of them with twice the updates. They
    /// differ nearly as marches on the mesh and with the increments of the run do, at a third of its time where a coarser mesh
    /// exists.
    fn wear_by_updates(&mut self, base: &Base) -> Found<OfWear> {
        let state = self.march.state();
        let last = state.updates.last().filter(|_| state.updates.len() > 1);
        let last = last.ok_or_else(|| "a single update cannot be compared".to_owned())?;
        // Without wear there is no mean normal: it is not a number.
        let encloses = mean_normal(self.march) < MIN_MEAN_NORMAL;
        if self.march.test().creep.is_none() && !encloses {
            let error = state.step_error;
            return Ok([
                100.0 * error.volume_mm3 / last.volume_loss_mm3,
                100.0 * error.max_depth_mm / last.max_depth_mm,
            ]);
        }
        let own = self.march.test().schedule;
        let twice = Schedule::fixed(last.cycles, 2 * state.updates.len());
        let [own, twice] = [own, twice].map(|schedule| {
            let mut test = self.march.test().clone();
            test.insert = Arc::clone(&base.test.insert);
            test.schedule = schedule;
            test.time.increments = test.time.increments.div_ceil(2);
            test.comparison_laws.clear();
            test.law_family = false;
            self.marched(test)
        });
        Ok(errors([TWICE_THE_UPDATES; 2], twice?, own?))
    }

    /// Returns the volume loss of a whole march, mm3, and the mean depth at the bottom of its scar, mm: the maximum depth of a
    /// coarse mesh is that of a single node, and too irregular to be compared.
    fn marched(&mut self, test: WearTest) -> Found<OfWear> {
        let mut march = self.started(test)?;
        while !march.is_worn() {
            march = self.solved(march)?;
        }
        let state = march.state();
        let weights = WornSurface::of(&march).weights();
        let shares = march.insert().surface().shares;
        let area_mm2: Vec<f64> = shares.iter().map(|share| share.area_mm2).collect();
        let bottom_mm = mean_over_volume(&area_mm2, &weights, &state.depths.wear_mm);
        let volume_mm3 = state
            .updates
            .last()
            .map_or(0.0, |last| last.volume_loss_mm3);
        Ok([volume_mm3, bottom_mm])
    }

    /// Returns the errors of the peaks in the later cycle, in %, from a changed insert in that cycle; 0 if the first
    /// cycle has all peaks.
    fn later_peaks(
        &mut self,
        summary: &Summary,
        factors: Peaks,
        test: &WearTest,
        change: impl FnOnce(&Snapshot) -> Snapshot,
    ) -> Found<Peaks> {
        let first = first_peaks(self.march.state());
        let any_is_later = (0..PEAKS.len()).any(|i| is_later(summary, &first, i));
        let last = self.snapshots.last().copied();
        let Some(snapshot) = last.filter(|_| any_is_later) else {
            return Ok(Peaks::default());
        };
        let march = self.solved(self.march_from(test, &change(snapshot)))?;
        Ok(self.errors_of_peaks(factors, &march, snapshot))
    }

    fn march_from(&self, test: &WearTest, snapshot: &Snapshot) -> March {
        March::from_snapshot(test.clone(), snapshot, self.march.state().zero_mm)
    }

    fn started(&self, test: WearTest) -> Found<March> {
        // After a stop even the settling of a test would take time.
        if self.is_stopped {
            return Err("stopped".to_owned());
        }
        let march = March::start(test).map_err(|why| why.to_string())?;
        Ok(march.in_motion(&self.first.1))
    }

    /// Takes one update.
    fn solved(&mut self, mut march: March) -> Found<March> {
        if !self.is_stopped {
            let flow = march.update(&mut |_| (self.watch)());
            self.is_stopped = flow.map_err(|why| why.to_string())?.is_break();
        }
        if self.is_stopped {
            return Err("stopped".to_owned());
        }
        Ok(march)
    }

    fn errors_of_peaks(&self, factors: Peaks, march: &March, snapshot: &Snapshot) -> Peaks {
        let reference = peaks_of(&self.march.state().updates[snapshot.update]);
        errors(factors, first_peaks(march.state()), reference)
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

/// Returns errors in %: `factors` times the relative differences of `now` from `reference`; 0 where they are equal.
fn errors<const N: usize>(factors: [f64; N], now: [f64; N], reference: [f64; N]) -> [f64; N] {
    std::array::from_fn(|i| match now[i] == reference[i] {
        // Both may be 0, and their quotient would be NaN.
        true => 0.0,
        false => 100.0 * factors[i] * (now[i] / reference[i] - 1.0),
    })
}

fn peaks_of(update: &UpdateRecord) -> Peaks {
    let stress = update.peaks.under_surface.as_ref();
    let [mises, shear] =
        stress.map_or([0.0; 2], |under| [under.von_mises_mpa, under.max_shear_mpa]);
    [
        update.peaks.peak_pressure_mpa,
        update.peaks.contact_area_mm2,
        mises,
        shear,
    ]
}

fn first_peaks(state: &MarchState) -> Peaks {
    state.updates.first().map_or_else(Peaks::default, peaks_of)
}

/// Returns the peaks of the first cycle of a march, and the ranges of its motion, in the units of files.
fn first_cycle(state: &MarchState) -> FirstCycle {
    let cycles = state
        .activities
        .iter()
        .find_map(|own| own.first_and_last.as_ref());
    let range = |joint| cycles.map_or(0.0, |(first, _)| joint_range(&first.rows, &KNEE, joint));
    FirstCycle {
        peaks: first_peaks(state),
        ranges: [range(AP), range(IE)],
    }
}

/// Returns the volume that a cycle wore, and the mean of its depth by `weights`.
fn worn(step: &StepRecord, weights: &[f64]) -> [f64; 2] {
    [
        step.volume_per_cycle_mm3(),
        mean_over_volume(&step.area_mm2, weights, &step.depth_per_cycle_mm),
    ]
}

/// Returns the length of the mean normal of a worn surface, weighted by the worn volume: 1 on a plane.
fn mean_normal(march: &March) -> f64 {
    let surface = march.insert().surface();
    let (mut sum, mut volume_mm3) = (Vec3::zeros(), 0.0);
    let shares = surface.shares.iter().zip(&march.state().depths.wear_mm);
    for (normal, (share, depth_mm)) in surface.normals.iter().zip(shares) {
        sum += normal * share.area_mm2 * *depth_mm;
        volume_mm3 += share.area_mm2 * depth_mm;
    }
    sum.norm() / volume_mm3
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
    let so_far_mm = mean_over_volume(&step.area_mm2, &weights, &state.depths.wear_mm);
    Some([
        volume_mm3 * last.cycles / last.volume_loss_mm3,
        depth_mm * last.cycles / so_far_mm,
    ])
}
