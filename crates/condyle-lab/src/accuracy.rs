//! How far a run's mass loss and maximum depth lie from what finer steps and meshes would give.
//!
//! Two cycles on the way are solved again with finer increments, and with a looser slip tolerance;
//! the first one, on the unworn insert, with a coarser mesh. By how much what they wear changes
//! tells the error of the run, from the order at which it falls. What the length of the march's
//! steps costs is known from the march itself.

use std::{ops::ControlFlow, sync::Arc};

use condyle::{
    contact::ContactLaw,
    evolve::{
        March, MarchError, MarchState, PlacementError, Schedule, Snapshot, StepRecord, WearTest,
        mean_over_volume, weight_of_depth,
    },
    geometry::Insert,
    machine::MachineState,
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

/// Why a part has no estimate.
enum Without {
    /// Somebody asked to stop.
    Stopped,
    /// A test changed so could not be solved.
    Reason(String),
}

/// What a changed test finds of volume loss and maximum depth, %; or why nothing.
type Found = Result<[f64; 2], Without>;

/// The estimated error of a march that is done, none of one that did nothing; a break if `watch` asks to
/// stop.
pub(crate) fn estimate(
    case: &Case,
    march: &March,
    watch: &mut dyn FnMut() -> ControlFlow<()>,
) -> ControlFlow<(), Option<ErrorEstimate>> {
    let (Some(last), Some(mut again)) = (march.state().updates.last(), Again::of(march, watch))
    else {
        return ControlFlow::Continue(None);
    };
    let test = again.as_run();
    let finer = stated(again.on_the_way(FINER_INCREMENTS, &finer(test.clone())))?;
    let looser = stated(again.once(LOOSER_SLIP, &with_contact(test.clone(), looser(case))))?;
    let coarser = match case.coarser_insert() {
        Ok(insert) => stated(again.unworn(COARSER_MESH, with_insert(test, insert)))?,
        Err(why) => Err(why),
    };
    let parts = [
        (Part::Increments, finer),
        (Part::Updates, of_updates(march.state())),
        (Part::Mesh, coarser),
        (Part::SlipTolerance, looser),
    ];
    let estimate = ErrorEstimate::of(last.mass_loss_mg, last.max_depth_mm, parts);
    ControlFlow::Continue(Some(estimate))
}

/// What was found, or why not in words.
fn stated(found: Found) -> ControlFlow<(), Result<[f64; 2], String>> {
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

fn looser(case: &Case) -> Arc<dyn ContactLaw> {
    let mut law = case.foundation();
    law.slip_tolerance_mm_per_s *= 2.0;
    Arc::new(law)
}

fn with_contact(test: WearTest, contact: Arc<dyn ContactLaw>) -> WearTest {
    WearTest { contact, ..test }
}

fn with_insert(test: WearTest, insert: Insert) -> WearTest {
    let insert = Arc::new(insert);
    WearTest { insert, ..test }
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
    march: &'a March,
    /// What the run's first cycles wore, and the motions that they ended with.
    first: &'a (StepRecord, Vec<MachineState>),
    /// Steps on the way, which stand for all, one if both are the same.
    snapshots: Vec<&'a Snapshot>,
    worn: WornSurface,
    /// By what power of the rates volume loss and maximum depth grow.
    growth: [f64; 2],
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

    /// The test of the run again, but so short that nothing to speak of is worn.
    fn as_run(&self) -> WearTest {
        WearTest {
            schedule: Schedule::fixed(1.0, 1),
            ..self.march.test().clone()
        }
    }

    /// Errors of mass loss and maximum depth in %: `factor` times what a changed test makes on the way,
    /// the mean of the snapshots.
    fn on_the_way(&mut self, factor: f64, changed: &WearTest) -> Found {
        let count = self.snapshots.len();
        let mut mean = [0.0; 2];
        for snapshot in 0..count {
            let here = self.at(snapshot, factor, changed)?;
            mean = [0, 1].map(|i| mean[i] + here[i] / count as f64);
        }
        Ok(mean)
    }

    /// The same at the last snapshot alone, for a change that makes much the same all the way.
    fn once(&mut self, factor: f64, changed: &WearTest) -> Found {
        self.at(self.snapshots.len() - 1, factor, changed)
    }

    fn at(&mut self, snapshot: usize, factor: f64, changed: &WearTest) -> Found {
        let snapshot = self.snapshots[snapshot];
        let zero_mm = self.march.state().zero_mm;
        let march = March::from_snapshot(changed.clone(), snapshot, zero_mm);
        let weights = self.worn.weights();
        let reference = worn(&snapshot.step, &weights);
        self.solved(march, &weights, reference, factor)
    }

    /// The same of another mesh, unworn.
    fn unworn(&mut self, factor: f64, changed: WearTest) -> Found {
        let march = March::start(changed)?;
        let (step, machines) = self.first;
        let reference = worn(step, &self.worn.weights());
        let weights = self.worn.weights_on(&march);
        self.solved(march.in_motion(machines), &weights, reference, factor)
    }

    fn solved(
        &mut self,
        mut march: March,
        weights: &[f64],
        reference: [f64; 2],
        factor: f64,
    ) -> Found {
        if march.update(&mut |_| (self.watch)())?.is_break() {
            return Err(Without::Stopped);
        }
        let now = match &march.state().first_step {
            Some((step, _)) => worn(step, weights),
            None => [0.0; 2],
        };
        Ok([0, 1].map(|i| self.growth[i] * 100.0 * factor * (now[i] / reference[i] - 1.0)))
    }
}

fn snapshots(state: &MarchState) -> Vec<&Snapshot> {
    let mut snapshots: Vec<&Snapshot> = state.snapshots.iter().flatten().collect();
    snapshots.dedup_by(|a, b| a.depths == b.depths);
    snapshots
}

/// The volume that a cycle wore, and the mean of its depth by `weights`.
fn worn(step: &StepRecord, weights: &[f64]) -> [f64; 2] {
    [
        step.volume_per_cycle_mm3(),
        mean_over_volume(&step.area_mm2, weights, &step.depth_per_cycle_mm),
    ]
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

/// Where the insert is worn in the end: (x, z) of its nodes, and their depth as a part of the largest.
struct WornSurface(Vec<([f64; 2], f64)>);

impl WornSurface {
    fn of(march: &March) -> Self {
        let worn_mm = march.state().depths.wear_mm();
        let deepest = worn_mm.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let depths = worn_mm.iter().map(|depth| depth / deepest);
        Self(places(march).zip(depths).collect())
    }

    /// How much every node counts for the maximum depth.
    fn weights(&self) -> Vec<f64> {
        let depths = self.0.iter().map(|(_, depth)| depth);
        depths.map(|depth| weight_of_depth(*depth)).collect()
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
            .map(|place| weight_of_depth(depth(place)))
            .collect()
    }
}

/// (x, z) of the nodes of the articulating surface.
fn places(march: &March) -> impl Iterator<Item = [f64; 2]> {
    let insert = march.insert();
    let nodes = insert.surface_nodes().iter();
    nodes.map(|&node| {
        let node = insert.mesh().nodes[node as usize];
        [node.x, node.z]
    })
}
