//! How far a run's mass loss and maximum depth lie from what finer steps and meshes would give.
//!
//! The cycle on the unworn insert is solved again, each time with one of increments, slip
//! tolerance and mesh changed; by how much what it wears changes tells the error of the run, from
//! the order at which it falls. What the length of the march's steps costs is known from the
//! march itself.

use std::ops::ControlFlow;

use condyle::{
    contact::FoundationSettings,
    evolve::{March, MarchError, MarchState, PlacementError, Schedule, StepRecord, WearTest},
    machine::{CycleError, MachineState, TimeSettings},
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
    let finer = known(again.error(FINER_INCREMENTS, |mut test| {
        test.time.increments *= 2;
        test
    }))?;
    let looser = known(again.error(LOOSER_SLIP, |mut test| {
        test.contact.slip_tolerance_mm_per_s *= 2.0;
        test
    }))?;
    let coarser = match case.coarser_insert() {
        Ok(insert) => known(again.error(COARSER_MESH, |test| WearTest { insert, ..test }))?,
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

/// The unworn cycle, solved again.
struct Again<'a> {
    /// Nothing once it has been lost to a test that could not start.
    march: Option<March>,
    time: TimeSettings,
    contact: FoundationSettings,
    /// The motion that the run's first cycle ended with: every cycle solved again is near it.
    motion: MachineState,
    /// What the run's first cycle wore.
    first: StepRecord,
    scar: Scar,
    /// By what power of the rates volume loss and maximum depth grow.
    growth: [f64; 2],
    watch: &'a mut dyn FnMut() -> ControlFlow<()>,
}

impl<'a> Again<'a> {
    fn of(march: March, watch: &'a mut dyn FnMut() -> ControlFlow<()>) -> Option<Self> {
        let state = march.state();
        Some(Self {
            time: march.test().time,
            contact: march.test().contact.clone(),
            motion: state.first_cycle_end?,
            first: state.first_step.clone()?,
            growth: growth(state)?,
            scar: Scar::of(&march),
            march: Some(march),
            watch,
        })
    }

    /// Errors of mass loss and maximum depth in %: `factor` times what the change makes.
    fn error(
        &mut self,
        factor: f64,
        change: impl FnOnce(WearTest) -> WearTest,
    ) -> Result<[f64; 2], Without> {
        let mut march = self.restarted(change)?;
        let reference = self.scar.worn(&march, &self.first.depth_per_cycle_mm);
        let solved = march.update(&mut |_| (self.watch)()).map(|_| ());
        let first = march.state().first_step.as_ref();
        let worn = first.map(|first| self.scar.worn(&march, &first.depth_per_cycle_mm));
        self.march = Some(march);
        solved?;
        let worn = worn.ok_or_else(|| Without::Reason("nothing was worn".to_owned()))?;
        let change = |i: usize| 100.0 * factor * (worn[i] / reference[i] - 1.0);
        Ok([0, 1].map(|i| self.growth[i] * change(i)))
    }

    /// The test changed, unworn, in the run's motion; so short that it stays unworn.
    fn restarted(&mut self, change: impl FnOnce(WearTest) -> WearTest) -> Result<March, Without> {
        let lost = || Without::Reason("the part before it could not be solved".to_owned());
        let march = self.march.take().ok_or_else(lost)?;
        let unchanged = |test| WearTest {
            time: self.time,
            contact: self.contact.clone(),
            schedule: Schedule::evenly(1.0, 1),
            ..test
        };
        let march = march.restarted(|test| change(unchanged(test)))?;
        Ok(march.in_motion(self.motion))
    }
}

impl From<PlacementError> for Without {
    fn from(why: PlacementError) -> Self {
        Self::Reason(why.to_string())
    }
}

impl From<MarchError> for Without {
    fn from(why: MarchError) -> Self {
        match why {
            MarchError::Cycle {
                source: CycleError::Interrupted,
                ..
            } => Self::Interrupted,
            why => Self::Reason(why.to_string()),
        }
    }
}

/// By what power of the rates volume loss and maximum depth grow.
///
/// Rates that are 1 % higher all along are a test that is 1 % longer: volume and depth grow by
/// rate x cycles / (all so far) of that, with the rate of the end. A scar that spreads deepens
/// more slowly in the end than on the average, and so forgives.
fn growth(state: &MarchState) -> Option<[f64; 2]> {
    let (last, step) = (state.updates.last()?, state.last_step.as_ref()?);
    let rates = state.worn_mm.iter().zip(&step.depth_per_cycle_mm);
    let (_, rate) = rates.max_by(|a, b| a.0.total_cmp(b.0))?;
    Some([
        step.volume_per_cycle_mm3 * last.cycles / last.volume_loss_mm3,
        rate * last.cycles / last.max_depth_mm,
    ])
}

/// Where the insert is worn in the end: (x, z) of its nodes and their depth as a part of the largest.
struct Scar(Vec<([f64; 2], f64)>);

impl Scar {
    fn of(march: &March) -> Self {
        let worn_mm = &march.state().worn_mm;
        let deepest = worn_mm.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let depths = worn_mm.iter().map(|depth| depth / deepest);
        Self(places(march).zip(depths).collect())
    }

    /// How deep it is at a place: that of the nearest node.
    fn depth(&self, [x, z]: [f64; 2]) -> f64 {
        let apart2 = |[a, b]: [f64; 2]| (a - x).powi(2) + (b - z).powi(2);
        let nodes = self.0.iter().map(|(place, depth)| (apart2(*place), *depth));
        nodes
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map_or(0.0, |(_, depth)| depth)
    }

    /// The volume that these rates wear from the surface of `march`, and the mean of the rates
    /// where the scar is deep.
    fn worn(&self, march: &March, rates: &[f64]) -> [f64; 2] {
        let shares = &march.test().insert.surface().shares;
        let nodes = shares.iter().zip(places(march)).zip(rates);
        let [mut volume, mut deep, mut all] = [0.0; 3];
        for ((share, place), rate) in nodes {
            let weight = share.area_mm2 * self.depth(place).powi(DEEP_POWER);
            volume += share.area_mm2 * rate;
            deep += weight * rate;
            all += weight;
        }
        [volume, deep / all]
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
