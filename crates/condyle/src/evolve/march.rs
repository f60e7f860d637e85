//! The march over millions of cycles: one solved cycle of every activity, its wear, the new surface, and
//! again.

use std::ops::{ControlFlow, Range};

use super::{
    Activity, CreepRecord, CreepState, CycleRecord, DepthField, DepthFields, MarchError,
    MarchState, NodeFields, PlacementError, Progress, Snapshot, SolvedCycle, UnderSurfaceRecord,
    UpdateRecord, Updates, WearTest,
    activity_wear::SharedStep,
    comparison_laws::{LawBeside, outside_mm3, sum, worn},
    creep::CreepStep,
    creep_contact::CreepContact,
    creep_record::Depths,
    depth::{lost_mm, total_mm},
    interval::{fixed_interval, shared_out},
    march_error::WornAndCrept,
    mean_over_wear::volume_mm3,
    placement::place,
    rates::{Rates, Wearing},
    step::next_step,
    step_record::{Standing, WearStep},
};
use crate::{
    Vec3,
    contact::{
        Bodies, ContactCache, ContactMemory, ContactModel, ContactState, CycleHistory, Record,
        UnderSurface,
    },
    geometry::{ArticulatingSurface, FemoralSurface, Insert},
    machine::{Chain, Cycle, CycleRow, MachineState, Simulator, SolverCounters, TimeSettings},
    spatial::Pose,
    wear::{MeanCycle, NodeWear, SharedCycle},
};

/// The first and the last cycle, whose motions are kept, repeat themselves within this part of the
/// tolerances. Of the others only the wear counts, and it errs a hundred times less than motions.
const KEPT: f64 = 0.1;
/// An update that is to reach this part of the cycles is the last: intervals do not sum up exactly.
const LAST: f64 = 1.0 - 1e-9;

/// A wear test on its way.
///
/// The test stays as it is; what wears is the march's own insert.
pub struct March {
    test: WearTest,
    /// The femur made ready for the shares of the insert.
    femur: FemoralSurface,
    /// The insert as worn so far.
    insert: Insert,
    /// One an activity.
    chains: Vec<Chain>,
    state: MarchState,
    /// Those of the insert before the first update.
    unworn_fields: NodeFields,
    /// The histories of the last cycles, for their memory.
    spent: Vec<CycleHistory>,
    /// What those cycles pressed on; none before the first, or after an update that was stopped.
    pressed: Option<Pressed>,
    /// What makes the contact of the next update quicker.
    cache: ContactCache,
}

/// What the last cycles pressed on.
struct Pressed {
    surface: ArticulatingSurface,
    /// Where the moments of each increment are recorded, of every activity.
    instants: Vec<Vec<Range<usize>>>,
}

/// One solved cycle of every activity, and the surface that it pressed on.
struct Solved {
    surface: ArticulatingSurface,
    cycles: Vec<Cycle>,
    counters: SolverCounters,
    /// What the contact knew after them.
    memory: ContactMemory,
}

impl March {
    /// Places the femur on the unworn insert.
    ///
    /// # Errors
    /// Bodies that do not meet, overlap deeply, or do not come to rest.
    pub fn start(test: WearTest) -> Result<Self, PlacementError> {
        let (femur, surface) = (prepared(&test), test.insert.surface());
        let mut counters = SolverCounters::default();
        let bodies = Bodies {
            femur: &femur,
            insert: &test.insert,
            surface: &surface,
        };
        let (chain, settled) = place(&test, bodies, &mut counters)?;
        let at_rest = |activity: &Activity| MachineState::at_rest(&activity.machine, settled);
        let state = MarchState {
            counters,
            settled,
            ..MarchState::before(
                test.insert.mesh().nodes.clone(),
                DepthFields::none(test.insert.surface_nodes().len()),
                ContactState::default(),
                test.activities.iter().map(at_rest),
                chain.zero_mm(),
            )
        };
        Ok(Self::from_parts(test, femur, state))
    }

    /// Goes on from a state of the same test.
    pub fn resume(test: WearTest, state: MarchState) -> Self {
        let femur = prepared(&test);
        Self::from_parts(test, femur, state)
    }

    /// A test of the same bodies and as many activities as that of a march, from a step on that march's way
    /// as if it were the first.
    pub fn from_snapshot(test: WearTest, snapshot: &Snapshot, zero_mm: Vec3) -> Self {
        let state = MarchState::before(
            snapshot.mesh_nodes.clone(),
            snapshot.depths.clone(),
            snapshot.contact.clone(),
            snapshot.machines.iter().copied(),
            zero_mm,
        );
        Self::resume(test, state)
    }

    /// The same march with its machines in the middle of a motion, such as that of another march;
    /// the next cycles repeat themselves sooner, the nearer that is to their own.
    pub fn in_motion(mut self, machines: &[MachineState]) -> Self {
        for (activity, machine) in self.state.activities.iter_mut().zip(machines) {
            activity.machine = *machine;
        }
        self
    }

    fn from_parts(test: WearTest, femur: FemoralSurface, mut state: MarchState) -> Self {
        if state.updates.is_empty() {
            let beside = |law| LawBeside::new(law, test.insert.surface_nodes().len());
            state.comparison_laws = test.comparison_laws.iter().map(beside).collect();
        }
        let mut insert = Insert::clone(&test.insert);
        insert.restore(state.mesh_nodes.clone(), &state.depths.total_mm());
        let chain = |activity: &Activity| {
            Chain::new(&activity.machine, state.zero_mm, test.flexion_axis_mm)
        };
        Self {
            chains: test.activities.iter().map(chain).collect(),
            unworn_fields: NodeFields::unworn(&insert, &state.depths),
            spent: Vec::new(),
            pressed: None,
            cache: ContactCache::default(),
            femur,
            insert,
            state,
            test,
        }
    }

    /// The test, its insert unworn.
    pub fn test(&self) -> &WearTest {
        &self.test
    }

    /// The insert as worn so far.
    pub fn insert(&self) -> &Insert {
        &self.insert
    }

    /// The femoral surface made ready for the shares of the insert.
    pub fn femur(&self) -> &FemoralSurface {
        &self.femur
    }

    /// The bodies as they are now, for a contact of one's own; `surface` is that of [`March::insert`].
    pub fn bodies<'a>(&'a self, surface: &'a ArticulatingSurface) -> Bodies<'a> {
        Bodies {
            femur: &self.femur,
            insert: &self.insert,
            surface,
        }
    }

    /// All that is needed to go on.
    pub fn state(&self) -> &MarchState {
        &self.state
    }

    /// Results of the last update at every surface node; before the first, of the unworn insert.
    pub fn fields(&self) -> &NodeFields {
        self.state.fields.as_ref().unwrap_or(&self.unworn_fields)
    }

    /// The cycle of the first activity that was solved last; none before the first update of this march.
    pub fn last_cycle(&self) -> Option<SolvedCycle<'_>> {
        let pressed = self.pressed.as_ref()?;
        let (_, last) = self.state.activities[0].first_and_last.as_ref()?;
        Some(SolvedCycle {
            rows: &last.rows,
            surface: &pressed.surface,
            chain: &self.chains[0],
            history: &self.spent[0],
            instants: &pressed.instants[0],
        })
    }

    /// Where the femur is in the insert frame with the joints of the first activity at `positions`,
    /// mm and rad.
    pub fn pose_at(&self, positions: &[f64; 6]) -> Pose {
        self.chains[0].at(positions).pose
    }

    /// Where the femur settled in the insert frame: there AP, ML and IS read zero.
    pub fn neutral_pose(&self) -> Pose {
        self.pose_at(&self.state.settled)
    }

    /// Cycles done so far.
    pub fn cycles(&self) -> f64 {
        self.state.updates.last().map_or(0.0, |last| last.cycles)
    }

    /// Whether all cycles are done.
    pub fn is_done(&self) -> bool {
        self.cycles() >= self.test.schedule.cycles
    }

    /// Solves the next cycle of every activity that repeats itself, and wears the insert by an interval of
    /// them.
    ///
    /// `watch` is told of every increment, and may stop the march; then the answer is a break, the update
    /// begun is lost, and those before are kept.
    ///
    /// # Errors
    /// A cycle that cannot be solved, an insert worn through, or elements turned inside out.
    pub fn update(
        &mut self,
        watch: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<ControlFlow<(), &UpdateRecord>, MarchError> {
        let spent = std::mem::take(&mut self.spent);
        self.pressed = None;
        let cache = std::mem::take(&mut self.cache);
        match self.solve(spent, cache, watch)? {
            ControlFlow::Break(()) => Ok(ControlFlow::Break(())),
            ControlFlow::Continue(solved) => self.wear(solved).map(ControlFlow::Continue),
        }
    }

    /// One cycle of every activity that repeats itself, the geometry held still.
    fn solve(
        &self,
        mut spent: Vec<CycleHistory>,
        cache: ContactCache,
        watch: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<ControlFlow<(), Solved>, MarchError> {
        let surface = self.insert.surface();
        let state = self.state.contact.clone();
        let memory = ContactMemory { state, cache };
        let mut contact = self.test.contact.contact(self.bodies(&surface), memory);
        let mut counters = self.state.counters;
        let mut cycles = Vec::with_capacity(self.test.activities.len());
        // A march that was stopped has given its histories away.
        spent.resize_with(self.test.activities.len(), CycleHistory::default);
        for (number, spent) in spent.into_iter().enumerate() {
            let solved =
                self.solve_activity(number, contact.as_mut(), spent, &mut counters, watch)?;
            let ControlFlow::Continue(cycle) = solved else {
                return Ok(ControlFlow::Break(()));
            };
            cycles.push(cycle);
        }
        let memory = contact.into_memory();
        Ok(ControlFlow::Continue(Solved {
            surface,
            cycles,
            counters,
            memory,
        }))
    }

    /// A cycle of one activity that repeats itself, on a contact that the others share.
    fn solve_activity(
        &self,
        number: usize,
        contact: &mut dyn ContactModel,
        spent: CycleHistory,
        counters: &mut SolverCounters,
        watch: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<ControlFlow<(), Cycle>, MarchError> {
        let update = self.state.updates.len() + 1;
        let (cycles, time) = (self.cycles(), self.time());
        let machine = &self.test.activities[number].machine;
        let own = &self.state.activities[number];
        let mut simulator = Simulator::new(machine, &self.chains[number], contact, &time);
        simulator.warm_starts.clone_from(&own.warm_starts);
        simulator.history = spent;
        let (increments, interval) = (time.increments as f64, self.likely_interval());
        let activities = self.test.activities.len() as f64;
        let mut watch_cycle = |solved| {
            let cycles_solved = solved as f64 / increments;
            let part = (number as f64 + cycles_solved.min(1.0)) / activities;
            watch(Progress {
                update,
                cycles_solved,
                cycles: cycles + interval * part,
            })
        };
        let solved = simulator.cycle(&own.machine, counters, &mut watch_cycle);
        let name = &self.test.activities[number].name;
        solved.map_err(|source| MarchError::Cycle {
            update,
            cycles,
            activity: (self.test.activities.len() > 1).then(|| name.clone()),
            source,
        })
    }

    /// Wears the insert by an interval of solved cycles.
    fn wear(&mut self, solved: Solved) -> Result<&UpdateRecord, MarchError> {
        self.check_contact(&solved)?;
        let cycles_before = self.cycles();
        let shared = with_shares(&self.test, &solved.cycles);
        let cycles = mean_cycles(&shared, &solved.surface);
        let worn = worn(self.test.wear.as_ref(), &cycles);
        let rates = self.rates(&solved.surface, &cycles, &worn);
        let standing = self.standing(&rates);
        let step = next_step(standing, &self.test.schedule);
        let settled_error = self.state.settled_error.after(standing);
        let step_error = settled_error.with_last(standing, &step);
        let mut taken = vec![DepthField::wear(step.depth_mm.clone())];
        let mut creep = self.state.creep.clone();
        taken.extend(self.crept(&mut creep, &solved, &step));
        let (under, under_record) = self.under_surface(&solved).unzip();
        let before = self.lower(&solved.surface, &taken)?;
        self.state.creep = creep;
        (self.state.settled_error, self.state.step_error) = (settled_error, step_error);
        let lost_mm3 = volume_mm3(&rates.area_mm2, &lost_mm(&taken, rates.area_mm2.len()));
        let record = self.record(
            &solved.cycles,
            step.cycles_after,
            lost_mm3,
            self.creep_record(&taken, &rates.area_mm2),
            before.worst_quality,
        );
        let record = UpdateRecord {
            under_surface: under_record,
            ..record
        };
        self.state.under_surface = under;
        self.state.updates.push(record);
        self.state.counters = solved.counters;
        let outside_mm3 = outside_mm3(&worn, &rates.area_mm2, &step.depth_mm);
        self.state.outside_mm3 = sum(self.state.outside_mm3, outside_mm3);
        self.wear_by_laws_beside(&cycles, &rates.area_mm2, step.interval);
        self.add_wear_of_activities(&solved, &shared, &cycles, &rates, &step);
        let fields = NodeFields::of(
            &cycles,
            &solved.surface,
            &rates,
            &self.insert,
            &self.state.depths,
        );
        self.keep_fields(fields);
        let snapshot = Snapshot {
            update: self.state.updates.len() - 1,
            step: step.record(rates),
            mesh_nodes: before.mesh_nodes,
            depths: before.depths,
            contact: std::mem::replace(&mut self.state.contact, solved.memory.state),
            machines: solved.cycles.iter().map(|cycle| cycle.end).collect(),
        };
        let part = cycles_before / self.test.schedule.cycles;
        self.state.pass(part, snapshot);
        self.cache = solved.memory.cache;
        self.keep(solved.cycles, solved.surface, cycles_before);
        let last = self.state.updates.len() - 1;
        Ok(&self.state.updates[last])
    }

    /// Where the march stands before a step, and what a cycle wears there.
    fn standing<'a>(&'a self, rates: &'a Rates) -> Standing<'a> {
        Standing {
            rates,
            last: self.state.last_step.as_ref(),
            worn_mm: self.state.depths.wear_mm(),
            cycles: self.cycles(),
            updates: self.state.updates.len(),
            creeps: self.test.creep.is_some(),
        }
    }

    /// An error where no activity brings the bodies together.
    fn check_contact(&self, solved: &Solved) -> Result<(), MarchError> {
        let rows = || solved.cycles.iter().flat_map(|cycle| &cycle.rows);
        if rows().any(|row| row.axial_force_n != 0.0) {
            return Ok(());
        }
        Err(MarchError::lost_contact(
            self.state.updates.len() + 1,
            &self.test,
            &solved.cycles[0].end,
            solved.counters.added_inertia,
        ))
    }

    fn rates(
        &self,
        surface: &ArticulatingSurface,
        cycles: &[MeanCycle<'_>],
        worn: &[NodeWear],
    ) -> Rates {
        let wearing = Wearing {
            contact: self.test.contact.as_ref(),
            insert: &self.insert,
            surface,
        };
        Rates::of(&wearing, cycles, worn)
    }

    /// What is below the surface at the increment with the highest pressure, if the insert is a solid.
    fn under_surface(&self, solved: &Solved) -> Option<(UnderSurface, UnderSurfaceRecord)> {
        let (activity, row) = highest(&solved.cycles)?;
        let cycle = &solved.cycles[activity];
        let surface = &solved.surface;
        let load = |record: &Record| {
            let area_mm2 = surface.shares[record.node as usize].area_mm2;
            (record.node, record.moment.pressure_mpa * area_mm2)
        };
        let touched = cycle.history.instant(&cycle.instants[row]).iter();
        let loads: Vec<(u32, f64)> = touched.map(load).collect();
        let contact = self.test.contact.as_ref();
        let under = contact.under_surface(&self.insert, &solved.memory.state, activity, &loads)?;
        let place = (activity, cycle.rows[row].percent);
        let record = UnderSurfaceRecord::of(&under, &self.insert, surface, place);
        Some((under, record))
    }

    /// What the laws beside that of the test would have worn in an interval of these cycles.
    fn wear_by_laws_beside(&mut self, cycles: &[MeanCycle<'_>], area_mm2: &[f64], interval: f64) {
        let laws = self.test.comparison_laws.iter();
        for (law, beside) in laws.zip(&mut self.state.comparison_laws) {
            beside.wear(law.law.as_ref(), cycles, area_mm2, interval);
        }
    }

    /// Adds what each of several activities wore in a step.
    fn add_wear_of_activities(
        &mut self,
        solved: &Solved,
        shared: &[SharedCycle<'_>],
        mean: &[MeanCycle<'_>],
        rates: &Rates,
        step: &WearStep,
    ) {
        let step = SharedStep {
            law: self.test.wear.as_ref(),
            surface: &solved.surface,
            mean,
            rates,
            step,
        };
        let worn = step.of_each(shared, &solved.cycles);
        for (activity, worn) in self.state.activities.iter_mut().zip(worn) {
            activity.wear = activity.wear.and(worn);
        }
    }

    fn keep_fields(&mut self, fields: NodeFields) {
        if self.state.fields.is_none() {
            let pressures_mpa = &fields.peak_pressure_mpa;
            self.state.first_pressure_mpa.clone_from(pressures_mpa);
        }
        self.state.fields = Some(fields);
    }

    /// What creep takes by the end of a step, if the insert creeps.
    fn crept(
        &self,
        creep: &mut CreepState,
        solved: &Solved,
        wear: &WearStep,
    ) -> Option<DepthField> {
        const SECONDS_PER_MINUTE: f64 = 60.0;
        let law = self.test.creep.as_ref()?;
        let step = CreepStep {
            law,
            thickness_mm: self.test.insert.thickness_mm(),
            worn_mm: &wear.depth_mm,
            contact: &CreepContact::of(&self.test, &self.insert, &solved.cycles),
            end_min: wear.cycles_after * self.test.cycle_seconds() / SECONDS_PER_MINUTE,
        };
        Some(DepthField::creep(creep.step(&step)))
    }

    /// What creep has come to after a step that took this.
    fn creep_record(&self, taken: &[DepthField], area_mm2: &[f64]) -> Option<CreepRecord> {
        let law = self.test.creep.as_ref()?;
        let crept = taken.iter().find(|field| field.name == DepthField::CREEP)?;
        let last = self.state.updates.last().and_then(|last| last.creep);
        let before_mm3 = last.map_or(0.0, |last| last.volume_mm3);
        let depths = Depths {
            wear_mm: self.state.depths.wear_mm(),
            creep_mm: self.state.depths.creep_mm()?,
            left_mm: &self.state.creep.left_mm(law),
        };
        Some(depths.record(before_mm3 + volume_mm3(area_mm2, &crept.depth_mm)))
    }

    /// Takes the surface down by what a step takes; how it was before.
    fn lower(
        &mut self,
        surface: &ArticulatingSurface,
        taken: &[DepthField],
    ) -> Result<Before, MarchError> {
        let down_mm = total_mm(taken, surface.positions.len());
        let mut nodes = down_mm.iter().zip(self.insert.thickness_mm());
        if let Some(node) = nodes.position(|(depth, thickness)| depth >= thickness) {
            let place = surface.positions[node];
            return Err(MarchError::WornThrough {
                update: self.state.updates.len() + 1,
                x: place.x,
                z: place.z,
                by: self.through_at(node, taken),
            });
        }
        self.insert.wear_down(surface, &down_mm);
        let worst_quality = self.insert.mesh().worst_quality();
        if worst_quality <= 0.0 {
            let update = self.state.updates.len() + 1;
            return Err(MarchError::inverted_elements(update, self.insert.mesh()));
        }
        let depths = self.state.depths.clone();
        self.state.depths.add(taken);
        let nodes = self.insert.mesh().nodes.clone();
        Ok(Before {
            mesh_nodes: std::mem::replace(&mut self.state.mesh_nodes, nodes),
            depths,
            worst_quality,
        })
    }

    /// What has worn and crept through at a node, if the insert creeps.
    fn through_at(&self, node: usize, taken: &[DepthField]) -> Option<WornAndCrept> {
        let crept = taken.iter().find(|field| field.name == DepthField::CREEP)?;
        let before_mm = self
            .state
            .depths
            .creep_mm()
            .map_or(0.0, |creep| creep[node]);
        Some(WornAndCrept {
            wear_mm: self.state.depths.wear_mm()[node] + taken[0].depth_mm[node],
            creep_mm: before_mm + crept.depth_mm[node],
        })
    }

    /// What the update that has just taken `lost_mm3` off the insert found.
    fn record(
        &self,
        cycles: &[Cycle],
        cycles_after: f64,
        lost_mm3: f64,
        creep: Option<CreepRecord>,
        worst_quality: f64,
    ) -> UpdateRecord {
        let last = self.state.updates.last();
        let volume_loss_mm3 = lost_mm3 + last.map_or(0.0, |last| last.volume_loss_mm3);
        let most = |value| {
            cycles
                .iter()
                .map(|cycle| cycle.most(value))
                .fold(0.0, f64::max)
        };
        let solved: usize = cycles.iter().map(|cycle| cycle.increments_solved).sum();
        UpdateRecord {
            cycles: cycles_after,
            volume_loss_mm3,
            volume_loss_mesh_mm3: self.test.insert.volume_mm3()
                - self.insert.volume_mm3()
                - creep.map_or(0.0, |creep| creep.volume_mm3),
            mass_loss_mg: volume_loss_mm3 * self.test.density_mg_per_mm3,
            max_depth_mm: largest(self.state.depths.wear_mm()),
            peak_pressure_mpa: most(|row| row.peak_pressure_mpa),
            peak_contact_area_mm2: most(|row| row.contact_area_mm2),
            cycles_solved: solved as f64 / self.test.time.increments as f64,
            repeats: cycles.iter().all(|cycle| cycle.repeats),
            worst_quality,
            creep,
            under_surface: None,
        }
    }

    /// How nearly the next cycle repeats itself.
    fn time(&self) -> TimeSettings {
        let time = self.test.time;
        let is_last = self.cycles() + self.likely_interval() >= LAST * self.test.schedule.cycles;
        if self.state.updates.is_empty() || is_last {
            return time.repeating_within(KEPT);
        }
        time
    }

    /// Cycles that the next step will likely take.
    fn likely_interval(&self) -> f64 {
        let schedule = &self.test.schedule;
        let last = self.state.last_step.as_ref().map(|last| last.interval);
        let left = schedule.cycles - self.cycles();
        match schedule.updates {
            Updates::Fixed(updates) => {
                let (done, creeps) = (self.state.updates.len(), self.test.creep.is_some());
                fixed_interval(schedule.cycles, updates, done, creeps)
            }
            Updates::Auto { .. } => last.map_or(0.0, |last| shared_out(left, last)),
        }
    }

    fn keep(&mut self, solved: Vec<Cycle>, surface: ArticulatingSurface, cycles: f64) {
        let activities = self.state.activities.iter_mut();
        let kept = activities.zip(solved).map(|(activity, cycle)| {
            activity.machine = cycle.end;
            activity.warm_starts = cycle.warm_starts;
            remember(&mut activity.first_and_last, cycles, cycle.rows);
            (cycle.history, cycle.instants)
        });
        let (spent, instants) = kept.unzip();
        self.spent = spent;
        self.pressed = Some(Pressed { surface, instants });
    }
}

/// What a step began with, and the worst element that it left.
struct Before {
    mesh_nodes: Vec<Vec3>,
    depths: DepthFields,
    worst_quality: f64,
}

/// Remembers the motions of a cycle as the last ones, and as the first ones too if they are.
fn remember(
    first_and_last: &mut Option<(CycleRecord, CycleRecord)>,
    cycles: f64,
    rows: Vec<CycleRow>,
) {
    let last = CycleRecord { cycles, rows };
    let first = first_and_last.take().map(|(first, _)| first);
    *first_and_last = Some((first.unwrap_or_else(|| last.clone()), last));
}

/// The activity and the row of the highest pressure of all cycles, the first of them.
fn highest(cycles: &[Cycle]) -> Option<(usize, usize)> {
    let rows = cycles.iter().enumerate().flat_map(|(activity, cycle)| {
        let rows = cycle.rows.iter().enumerate();
        rows.map(move |(row, own)| ((activity, row), own.peak_pressure_mpa))
    });
    let higher = |most: ((usize, usize), f64), next: ((usize, usize), f64)| {
        if next.1 > most.1 { next } else { most }
    };
    rows.reduce(higher).map(|(place, _)| place)
}

/// The history of one cycle of every activity, with the activity's share.
fn with_shares<'a>(test: &WearTest, cycles: &'a [Cycle]) -> Vec<SharedCycle<'a>> {
    let histories = cycles.iter().map(|cycle| &cycle.history);
    let shares = test.activities.iter().map(|activity| activity.share);
    shares.zip(histories).collect()
}

/// What every node of the surface went through.
fn mean_cycles<'a>(
    cycles: &'a [SharedCycle<'a>],
    surface: &ArticulatingSurface,
) -> Vec<MeanCycle<'a>> {
    let shares = surface.shares.iter().enumerate();
    shares
        .map(|(node, share)| MeanCycle::of(cycles, node, share.area_mm2))
        .collect()
}

/// The femur of a test made ready for the shares of its insert.
fn prepared(test: &WearTest) -> FemoralSurface {
    let spread_mm2 = test.insert.surface().mean_spread_mm2();
    test.femur.prepared_for(spread_mm2)
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}
