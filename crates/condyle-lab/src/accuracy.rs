//! How far a run's mass loss and maximum depth lie from what finer steps and meshes would give.
//!
//! Two cycles on the way are solved again with finer increments, and with a looser slip tolerance;
//! the first one, on the unworn insert, with a coarser mesh. By how much what they wear changes
//! tells the error of the run, from the order at which it falls. What the length of the march's
//! steps costs is known from the march itself.

use std::ops::ControlFlow;

use condyle::{
    contact::FoundationSettings,
    evolve::{
        March, MarchError, MarchState, PlacementError, Schedule, Snapshot, StepRecord, WearTest,
    },
    geometry::Insert,
    machine::{MachineState, TimeSettings},
};
use condyle_io::{
    case::Case,
    results::{ErrorEstimate, Part},
};

/// Error of a run from the change that twice the increments make: 1 / (1 - 1/2^2), second order.
const FINER_INCREMENTS: f64 = 4.0 / 3.0;
/// From the change that twice the slip tolerance makes: first order.
const LOOSER_SLIP: f64 = -1.0;
/// From the change that twice the edge makes: second order.
const COARSER_MESH: f64 = -1.0 / 3.0;

/// What a cycle wears counts for the maximum depth by this power of the final depth at its place:
/// high enough to see the bottom of the scar alone, low enough to average over the nodes there.
const DEEP_POWER: i32 = 8;

/// Somebody asked to stop.
pub(crate) struct Interrupted;

/// Why a part has no estimate.
enum Without {
    Interrupted,
    Reason(String),
}

/// The estimated error of a march that is done; the march is given up.
pub(crate) fn estimate(
    case: &Case,
    march: March,
    watch: &mut dyn FnMut() -> ControlFlow<()>,
) -> Result<Option<ErrorEstimate>, Interrupted> {
    let Some(last) = march.state().updates.last() else {
        return Ok(None);
    };
    let (mass_loss_mg, max_depth_mm) = (last.mass_loss_mg, last.max_depth_mm);
    let updates = of_updates(march.state());
    let Some(mut again) = Again::of(march, watch) else {
        return Ok(None);
    };
    let finer = known(again.on_the_way(FINER_INCREMENTS, |mut test| {
        test.time.increments *= 2;
        test
    }))?;
    let looser = known(again.once(LOOSER_SLIP, |mut test| {
        test.contact.slip_tolerance_mm_per_s *= 2.0;
        test
    }))?;
    let coarser = match case.coarser_insert() {
        Ok(insert) => known(again.unworn(COARSER_MESH, insert))?,
        Err(why) => Err(why),
    };
    let parts = [
        (Part::Increments, finer),
        (Part::Updates, updates),
        (Part::Mesh, coarser),
        (Part::SlipTolerance, looser),
    ];
    Ok(Some(ErrorEstimate::of(mass_loss_mg, max_depth_mm, parts)))
}

fn known(found: Result<[f64; 2], Without>) -> Result<Result<[f64; 2], String>, Interrupted> {
    match found {
        Ok(percent) => Ok(Ok(percent)),
        Err(Without::Reason(why)) => Ok(Err(why)),
        Err(Without::Interrupted) => Err(Interrupted),
    }
}

/// What the march knows of the error of its own steps, % of volume loss and of maximum depth.
fn of_updates(state: &MarchState) -> Result<[f64; 2], String> {
    let (Some(last), Some(_)) = (state.updates.last(), state.updates.get(1)) else {
        return Err("one update has no other to be compared with".to_owned());
    };
    let error = state.step_error;
    Ok([
        100.0 * error.volume_mm3 / last.volume_loss_mm3,
        100.0 * error.max_depth_mm / last.max_depth_mm,
    ])
}

/// Cycles of a run, solved again.
struct Again<'a> {
    /// Nothing once it has been lost to a test that could not start.
    march: Option<March>,
    time: TimeSettings,
    contact: FoundationSettings,
    /// What the run's first cycle wore, and the motion it ended with.
    first: (StepRecord, MachineState),
    /// Cycles on the way, which stand for all, one if both are the same.
    snapshots: Vec<Snapshot>,
    scar: Scar,
    /// By what power of the rates volume loss and maximum depth grow.
    growth: [f64; 2],
    watch: &'a mut dyn FnMut() -> ControlFlow<()>,
}

impl<'a> Again<'a> {
    fn of(march: March, watch: &'a mut dyn FnMut() -> ControlFlow<()>) -> Option<Self> {
        let state = march.state();
        let scar = Scar::of(&march);
        Some(Self {
            time: march.test().time,
            contact: march.test().contact.clone(),
            first: state.first_step.clone()?,
            snapshots: snapshots(state),
            growth: growth(state, &scar)?,
            scar,
            march: Some(march),
            watch,
        })
    }

    /// Errors of mass loss and maximum depth in %: `factor` times what a change makes on the way,
    /// the mean of the snapshots.
    fn on_the_way(
        &mut self,
        factor: f64,
        change: impl Fn(WearTest) -> WearTest,
    ) -> Result<[f64; 2], Without> {
        let count = self.snapshots.len();
        let mut mean = [0.0; 2];
        for snapshot in 0..count {
            let here = self.at(snapshot, factor, &change)?;
            mean = [0, 1].map(|i| mean[i] + here[i] / count as f64);
        }
        Ok(mean)
    }

    /// The same at the last snapshot alone, for a change that makes much the same all the way.
    fn once(
        &mut self,
        factor: f64,
        change: impl Fn(WearTest) -> WearTest,
    ) -> Result<[f64; 2], Without> {
        self.at(self.snapshots.len() - 1, factor, &change)
    }

    fn at(
        &mut self,
        snapshot: usize,
        factor: f64,
        change: &impl Fn(WearTest) -> WearTest,
    ) -> Result<[f64; 2], Without> {
        let (march, as_run) = (self.taken()?, self.as_run());
        let snapshot = &self.snapshots[snapshot];
        let march = march.returned_to(snapshot, |test| change(as_run(test)));
        let weights = self.scar.weights();
        let reference = worn(&snapshot.step, &weights);
        self.solved(march, &weights, reference, factor)
    }

    /// The same of another mesh, unworn.
    fn unworn(&mut self, factor: f64, insert: Insert) -> Result<[f64; 2], Without> {
        let as_run = self.as_run();
        let march = self.taken()?;
        let march = march.restarted(|test| as_run(WearTest { insert, ..test }))?;
        let reference = worn(&self.first.0, &self.scar.weights());
        let weights = self.scar.weights_on(&march);
        self.solved(march.in_motion(self.first.1), &weights, reference, factor)
    }

    fn taken(&mut self) -> Result<March, Without> {
        let lost = || Without::Reason("the part before it could not be solved".to_owned());
        self.march.take().ok_or_else(lost)
    }

    /// What makes a test that of the run again, but so short that nothing to speak of is worn.
    fn as_run(&self) -> impl FnOnce(WearTest) -> WearTest + use<> {
        let (time, contact) = (self.time, self.contact.clone());
        move |test| WearTest {
            time,
            contact,
            schedule: Schedule::fixed(1.0, 1),
            ..test
        }
    }

    fn solved(
        &mut self,
        mut march: March,
        weights: &[f64],
        reference: [f64; 2],
        factor: f64,
    ) -> Result<[f64; 2], Without> {
        let solved = march.update(&mut |_| (self.watch)());
        let solved = solved.map(|update| update.is_continue());
        let now = match &march.state().first_step {
            Some((step, _)) => worn(step, weights),
            None => [0.0; 2],
        };
        self.march = Some(march);
        if !solved? {
            return Err(Without::Interrupted);
        }
        Ok([0, 1].map(|i| self.growth[i] * 100.0 * factor * (now[i] / reference[i] - 1.0)))
    }
}

fn snapshots(state: &MarchState) -> Vec<Snapshot> {
    let mut snapshots: Vec<Snapshot> = state.snapshots.iter().flatten().cloned().collect();
    snapshots.dedup_by(|a, b| a.worn_mm == b.worn_mm);
    snapshots
}

/// The volume that a cycle wore, and the mean of its depth by `weights`.
fn worn(step: &StepRecord, weights: &[f64]) -> [f64; 2] {
    [
        step.volume_per_cycle_mm3(),
        mean(step, weights, &step.depth_per_cycle_mm),
    ]
}

/// Mean over the surface by `weights`.
fn mean(step: &StepRecord, weights: &[f64], values: &[f64]) -> f64 {
    let [mut sum, mut all] = [0.0; 2];
    for ((area, weight), value) in step.area_mm2.iter().zip(weights).zip(values) {
        sum += area * weight * value;
        all += area * weight;
    }
    sum / all
}

impl From<PlacementError> for Without {
    fn from(why: PlacementError) -> Self {
        Self::Reason(why.to_string())
    }
}

impl From<MarchError> for Without {
    fn from(why: MarchError) -> Self {
        Self::Reason(why.to_string())
    }
}

/// By what power of the rates volume loss and maximum depth grow.
///
/// Rates that are 1 % higher all along are a test that is 1 % longer: volume and depth grow by
/// rate x cycles / (all so far) of that, with the rate of the end. A scar that spreads deepens
/// more slowly in the end than on the average, and so forgives.
fn growth(state: &MarchState, scar: &Scar) -> Option<[f64; 2]> {
    let (last, step) = (state.updates.last()?, state.last_step.as_ref()?);
    let weights = scar.weights();
    let [volume_mm3, depth_mm] = worn(step, &weights);
    let so_far_mm = mean(step, &weights, &state.worn_mm);
    Some([
        volume_mm3 * last.cycles / last.volume_loss_mm3,
        depth_mm * last.cycles / so_far_mm,
    ])
}

/// Where the insert is worn in the end: (x, z) of its nodes, and their depth as a part of the largest.
struct Scar(Vec<([f64; 2], f64)>);

impl Scar {
    fn of(march: &March) -> Self {
        let worn_mm = &march.state().worn_mm;
        let deepest = worn_mm.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let depths = worn_mm.iter().map(|depth| depth / deepest);
        Self(places(march).zip(depths).collect())
    }

    /// How much every node counts for the maximum depth.
    fn weights(&self) -> Vec<f64> {
        let depths = self.0.iter().map(|(_, depth)| depth);
        depths.map(|depth| depth.powi(DEEP_POWER)).collect()
    }

    /// The same on another mesh, whose nodes are as deep as the nearest one here.
    fn weights_on(&self, march: &March) -> Vec<f64> {
        let depth = |[x, z]: [f64; 2]| {
            let apart2 = |[a, b]: [f64; 2]| (a - x).powi(2) + (b - z).powi(2);
            let nodes = self.0.iter().map(|(place, depth)| (apart2(*place), *depth));
            let nearest = nodes.min_by(|a, b| a.0.total_cmp(&b.0));
            nearest.map_or(0.0, |(_, depth)| depth)
        };
        places(march)
            .map(|place| depth(place).powi(DEEP_POWER))
            .collect()
    }
}

/// (x, z) of the nodes of the articulating surface.
fn places(march: &March) -> impl Iterator<Item = [f64; 2]> {
    let insert = &march.test().insert;
    let nodes = insert.surface_nodes().iter();
    nodes.map(|&node| {
        let node = insert.mesh().nodes[node as usize];
        [node.x, node.z]
    })
}
