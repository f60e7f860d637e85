//! How far a run's mass loss and maximum depth lie from what finer steps and meshes would give.
//!
//! The cycle on the unworn insert is solved again, each time with one of increments, slip
//! tolerance and mesh twice as coarse; by how much what it wears changes tells the error of the
//! run, from the order at which it falls. What the length of the march's steps costs is known
//! from the march itself.

use std::ops::ControlFlow;

use condyle::{
    evolve::{March, MarchError, MarchState, Schedule, StepRecord, WearTest},
    geometry::Insert,
    machine::CycleError,
};
use condyle_io::{
    case::Case,
    results::{ErrorEstimate, Part},
};

/// Error of a run from a change that a coarser value makes: change / (2^order - 1).
///
/// Increments are second order where the motion is smooth; stick and slip leave less, and the
/// first order is the safe side. The slip tolerance is first order, the mesh second.
const INCREMENTS_ORDER: i32 = 1;
const SLIP_TOLERANCE_ORDER: i32 = 1;
const MESH_ORDER: i32 = 2;

/// Where the insert is worn deep in the end counts for the maximum depth: every place by this
/// power of its depth. The unworn cycle's rate at one node tells it less surely, since the wear
/// of a node that begins too fast slows down.
const DEEP_POWER: i32 = 1;

/// Where the insert is worn in the end: (x, z) of its nodes and their depth, mm.
struct Scar(Vec<([f64; 2], f64)>);

impl Scar {
    fn of(march: &March) -> Self {
        let worn_mm = march.state().worn_mm.iter().copied();
        Self(places(march).zip(worn_mm).collect())
    }

    /// Final depth at a place: that of the nearest node.
    fn depth_mm(&self, [x, z]: [f64; 2]) -> f64 {
        let apart2 = |[a, b]: [f64; 2]| (a - x).powi(2) + (b - z).powi(2);
        let nodes = self.0.iter().map(|(place, depth)| (apart2(*place), *depth));
        nodes
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map_or(0.0, |(_, depth)| depth)
    }

    /// The volume that a cycle of `first` wears, and its depth where the scar is deep: the mean
    /// over the unworn surface of `march`, weighted by the scar's depth.
    fn worn(&self, march: &March, first: &StepRecord) -> [f64; 2] {
        let surface = march.test().insert.surface();
        let areas = surface.shares.iter().map(|share| share.area_mm2);
        let weights = places(march).map(|place| self.depth_mm(place).powi(DEEP_POWER));
        let nodes = areas.zip(weights).zip(&first.depth_per_cycle_mm);
        let (mut depth, mut all) = (0.0, 0.0);
        for ((area, weight), rate) in nodes {
            depth += area * weight * rate;
            all += area * weight;
        }
        [first.volume_per_cycle_mm3, depth / all]
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

/// Somebody asked to stop.
pub(crate) struct Interrupted;

/// The estimated error of a march that is done; the march is given up.
pub(crate) fn estimate(
    case: &Case,
    march: March,
    watch: &mut dyn FnMut() -> ControlFlow<()>,
) -> Result<Option<ErrorEstimate>, Interrupted> {
    let Some(first) = march.state().first_step.clone() else {
        return Ok(None);
    };
    let scar = Scar::of(&march);
    let mut estimate = ErrorEstimate::default();
    add_march(&mut estimate, march.state());
    let Ok(march) = march.restarted(|test| test) else {
        return Ok(None);
    };
    let mut coarser = Coarser {
        reference: scar.worn(&march, &first),
        march: Some(march),
        scar,
        watch,
    };
    let increments = case.time.increments as usize;
    let halved = |test: WearTest| WearTest {
        time: condyle::machine::TimeSettings {
            increments: increments / 2,
            ..test.time
        },
        ..test
    };
    let fewer = coarser.change(halved, INCREMENTS_ORDER)?;
    estimate.set(Part::Increments, fewer);
    let slip_tolerance = case.contact.friction.slip_tolerance_mm_per_s;
    let looser = |mut test: WearTest| {
        test.time.increments = increments;
        test.contact.slip_tolerance_mm_per_s = 2.0 * slip_tolerance;
        test
    };
    let slip = coarser.change(looser, SLIP_TOLERANCE_ORDER)?;
    estimate.set(Part::SlipTolerance, slip);
    let mesh = match case.coarser_insert() {
        Ok(insert) => {
            coarser.change(|test| with_insert(test, insert, slip_tolerance), MESH_ORDER)?
        }
        Err(why) => Err(why),
    };
    estimate.set(Part::Mesh, mesh);
    Ok(Some(estimate))
}

fn with_insert(mut test: WearTest, insert: Insert, slip_tolerance_mm_per_s: f64) -> WearTest {
    test.contact.slip_tolerance_mm_per_s = slip_tolerance_mm_per_s;
    test.insert = insert;
    test
}

/// Solves the unworn cycle again, more coarsely.
struct Coarser<'a> {
    march: Option<March>,
    scar: Scar,
    reference: [f64; 2],
    watch: &'a mut dyn FnMut() -> ControlFlow<()>,
}

impl Coarser<'_> {
    /// Errors of mass loss and maximum depth in %, from a change and the order of its error; or why not.
    fn change(
        &mut self,
        change: impl FnOnce(WearTest) -> WearTest,
        order: i32,
    ) -> Result<Result<[f64; 2], String>, Interrupted> {
        let Some(march) = self.march.take() else {
            return Ok(Err("the part before it could not be solved".to_owned()));
        };
        let one_cycle = |test| WearTest {
            schedule: Schedule::evenly(1.0, 1),
            ..change(test)
        };
        let mut march = match march.restarted(one_cycle) {
            Ok(march) => march,
            Err(why) => return Ok(Err(why.to_string())),
        };
        let solved = march.update(&mut |_| (self.watch)()).map(|_| ());
        let first = march.state().first_step.as_ref();
        let worn = first.map(|first| self.scar.worn(&march, first));
        self.march = Some(march);
        match (solved, worn) {
            (Ok(()), Some(worn)) => Ok(Ok(self.errors(worn, order))),
            (
                Err(MarchError::Cycle {
                    source: CycleError::Interrupted,
                    ..
                }),
                _,
            ) => Err(Interrupted),
            (Err(why), _) => Ok(Err(why.to_string())),
            (Ok(()), None) => Ok(Err("nothing was worn".to_owned())),
        }
    }

    fn errors(&self, coarse: [f64; 2], order: i32) -> [f64; 2] {
        let per_change = 100.0 / (2f64.powi(order) - 1.0);
        let percent = |i: usize| per_change * (1.0 - coarse[i] / self.reference[i]);
        [percent(0), percent(1)]
    }
}

/// What the march knows of the error of its own steps.
fn add_march(estimate: &mut ErrorEstimate, state: &MarchState) {
    let (Some(last), Some(_)) = (state.updates.last(), state.updates.get(1)) else {
        let why = "one update has no other to be compared with".to_owned();
        return estimate.set(Part::Updates, Err(why));
    };
    let error = state.step_error;
    let percent = [
        100.0 * error.volume_mm3 / last.volume_loss_mm3,
        100.0 * error.max_depth_mm / last.max_depth_mm,
    ];
    estimate.set(Part::Updates, Ok(percent));
}
