//! The march over millions of cycles: solve one cycle of every activity, wear the insert by an interval of
//! such cycles, repeat on the new surface.

use std::ops::ControlFlow;

use super::{
    Activity, CreepRecord, CreepState, CyclePeaks, Depths, FamilyWear, MarchError, MarchState,
    NodeFields, PlacementError, Progress, Snapshot, SolvedCycle, UnderSurfaceRecord, UpdateRecord,
    WearTest,
    comparison_laws::{ComparisonLaw, outside_mm3, sum, wear_of_each},
    creep::{CreepContact, CreepStep},
    next_step::next_step,
    placement::{place, start_of},
    rates::{Rates, SolvedStep, StepStart, WearStep, mean_cycles, volume_mm3, worn},
    solved_cycles::{SolvedCycles, solve},
};
use crate::{
    Vec3,
    contact::{Bodies, ContactCache, ContactMemory, ContactState, UnderSurface},
    geometry::{ArticulatingSurface, Counterface, Insert},
    machine::{Chain, Ligament, MachineState, SolverCounters},
    spatial::Pose,
    wear::{MeanCycle, NodeWear},
};

/// A wear test in progress.
///
/// The [`WearTest`] is never changed: the march wears its own copy of the insert.
pub struct March {
    test: WearTest,
    /// The counterface prepared for the shares of the insert.
    counterface: Counterface,
    insert: Insert,
    /// One per activity.
    chains: Vec<Chain>,
    state: MarchState,
    /// Fields of the insert before the first update.
    unworn_fields: NodeFields,
    /// The last solved cycles; none before the first, or after an update that was stopped.
    last: Option<SolvedCycles>,
    /// Speeds up the contact of the next update.
    cache: ContactCache,
}

/// The insert before a step, and the quality of the mesh after it.
struct Lowered {
    mesh_nodes: Vec<Vec3>,
    depths: Depths,
    worst_quality: f64,
}

impl March {
    /// Places the counterface on the unworn insert and lets it settle.
    ///
    /// # Errors
    /// A value that no test can have, and bodies that do not meet, that overlap deeply, or that do not come to rest.
    pub fn start(test: WearTest) -> Result<Self, PlacementError> {
        if let Some(invalid) = test.invalid_value() {
            return Err(PlacementError::InvalidTest(invalid));
        }
        let (counterface, surface) = (prepared(&test), test.contact.surface(&test.insert));
        let mut counters = SolverCounters::default();
        let bodies = Bodies {
            counterface: &counterface,
            insert: &test.insert,
            surface: &surface,
        };
        let (chain, settled) = place(&test, bodies, &mut counters)?;
        let zero_mm = chain.zero_mm();
        let at_start = |activity: &Activity| {
            start_of(activity, &test, bodies, zero_mm, settled, &mut counters)
        };
        let starts: Vec<_> = test.activities.iter().map(at_start).collect();
        let state = MarchState {
            counters,
            settled,
            ..MarchState::before(
                test.insert.mesh().nodes.clone(),
                Depths::by_wear(vec![0.0; test.insert.surface_nodes().len()]),
                ContactState::default(),
                starts,
                zero_mm,
            )
        };
        Ok(Self::from_parts(test, counterface, state))
    }

    /// Continues from a state of the same test.
    ///
    /// # Panics
    /// If the state has another number of nodes or activities than the test.
    pub fn resume(test: WearTest, state: MarchState) -> Self {
        let counterface = prepared(&test);
        Self::from_parts(test, counterface, state)
    }

    /// Starts a test at a step of another march with the same bodies and number of activities, as if that step
    /// were the first.
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

    /// Replaces the machine states by those of a motion in progress, such as that of another march.
    ///
    /// The closer it is to this march's own motion, the sooner the next cycles repeat.
    pub fn in_motion(mut self, machines: &[MachineState]) -> Self {
        for (activity, machine) in self.state.activities.iter_mut().zip(machines) {
            activity.machine = *machine;
        }
        self
    }

    fn from_parts(test: WearTest, counterface: Counterface, mut state: MarchState) -> Self {
        if state.updates.is_empty() {
            let nodes = test.insert.surface_nodes().len();
            let laws = test.comparison_laws.iter();
            state.comparison_laws = laws.map(|law| ComparisonLaw::new(law, nodes)).collect();
            state.law_family = test.law_family.then(FamilyWear::default);
        }
        let mut insert = Insert::clone(&test.insert);
        insert.restore(state.mesh_nodes.clone(), &state.depths.total_mm());
        let chain = |activity: &Activity| {
            Chain::new(&activity.machine, state.zero_mm, test.flexion_axis_mm)
        };
        Self {
            chains: test.activities.iter().map(chain).collect(),
            unworn_fields: NodeFields::unworn(&insert, &state.depths),
            last: None,
            cache: ContactCache::default(),
            counterface,
            insert,
            state,
            test,
        }
    }

    /// Returns the test, its insert unworn.
    pub fn test(&self) -> &WearTest {
        &self.test
    }

    /// Returns the insert as worn so far.
    pub fn insert(&self) -> &Insert {
        &self.insert
    }

    /// Returns the articulating surface as worn so far, with the areas that the pressures of its contact act on.
    pub fn surface(&self) -> ArticulatingSurface {
        self.test.contact.surface(&self.insert)
    }

    /// Returns the counterface prepared for the shares of the insert.
    pub fn counterface(&self) -> &Counterface {
        &self.counterface
    }

    /// Returns the bodies in their present shape, for a contact outside the march; `surface` is the surface of
    /// [`March::insert`].
    pub fn bodies<'a>(&'a self, surface: &'a ArticulatingSurface) -> Bodies<'a> {
        Bodies {
            counterface: &self.counterface,
            insert: &self.insert,
            surface,
        }
    }

    /// Returns the state, from which [`March::resume`] continues.
    pub fn state(&self) -> &MarchState {
        &self.state
    }

    /// Returns the results of the last update at every surface node; before the first, of the unworn insert.
    pub fn fields(&self) -> &NodeFields {
        self.state.fields.as_ref().unwrap_or(&self.unworn_fields)
    }

    /// Returns the last solved cycle of the first activity; `None` before the first update of this march.
    pub fn last_cycle(&self) -> Option<SolvedCycle<'_>> {
        let last = self.last.as_ref()?;
        let cycle = &last.cycles[0];
        Some(SolvedCycle {
            rows: &cycle.rows,
            surface: &last.surface,
            chain: &self.chains[0],
            cycle,
        })
    }

    /// Returns the pose of the counterface in the insert frame with the joints of the first activity at `positions`,
    /// mm and rad.
    pub fn pose_at(&self, positions: &[f64; 6]) -> Pose {
        self.chains[0].at(positions).pose
    }

    /// Returns the tension of each ligament of an activity's machine with its joints at `positions`, mm and rad, N.
    pub fn ligament_tensions_n(&self, activity: usize, positions: &[f64; 6]) -> Vec<f64> {
        let pose = self.chains[activity].at(positions).pose;
        let ligaments = self.test.activities[activity].machine.ligaments.iter();
        let tension_n = |ligament: &Ligament| {
            let strain = ligament.strain(&self.state.zero_mm, &pose);
            ligament.tension_n(strain).0
        };
        ligaments.map(tension_n).collect()
    }

    /// Returns the settled pose of the counterface in the insert frame, at which the zeroed joints read zero.
    pub fn neutral_pose(&self) -> Pose {
        self.pose_at(&self.state.settled)
    }

    /// Returns the number of cycles done so far.
    pub fn cycles(&self) -> f64 {
        self.state.cycles()
    }

    /// Returns whether all cycles are done; the final cycle may remain to be solved.
    pub fn is_worn(&self) -> bool {
        self.cycles() >= self.test.schedule.cycles
    }

    /// Returns whether all cycles are done, and the final one is solved on the surface that they left.
    pub fn is_done(&self) -> bool {
        self.state.final_cycle.is_some()
    }

    /// Runs the test to its end.
    ///
    /// # Errors
    /// See [`March::update`].
    pub fn run(&mut self) -> Result<(), MarchError> {
        while !self.is_done() {
            let _ = self.update(&mut |_| ControlFlow::Continue(()))?;
        }
        Ok(())
    }

    /// Takes the next step: solves a repeating cycle of every activity, and wears the insert by an interval of such
    /// cycles. When all cycles are done, solves the final cycle, on the surface that they left, which wears nothing.
    ///
    /// `watch` is called after every increment and may stop the march; the result is then a break, the
    /// step in progress is lost, and earlier ones are kept.
    ///
    /// # Errors
    /// A cycle that cannot be solved, an insert worn through, or inverted elements.
    pub fn update(
        &mut self,
        watch: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<ControlFlow<(), &UpdateRecord>, MarchError> {
        let flow = if self.is_worn() {
            self.solve_final_cycle(watch)?
        } else {
            self.wear(watch)?
        };
        Ok(match (flow, self.state.updates.last()) {
            (ControlFlow::Continue(()), Some(last)) => ControlFlow::Continue(last),
            _ => ControlFlow::Break(()),
        })
    }

    /// Solves a repeating cycle of every activity, and wears the insert by an interval of such cycles.
    fn wear(
        &mut self,
        watch: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<ControlFlow<()>, MarchError> {
        let ControlFlow::Continue(solved) = self.solve(watch)? else {
            return Ok(ControlFlow::Break(()));
        };

        // The wear of one cycle, and the interval over which it can be extrapolated.
        let shared = solved.with_shares(&self.test.activities);
        let mean = mean_cycles(&shared, &solved.surface);
        let (worn, rates) = self.worn(&mean, &solved.surface)?;
        let start = self.step_start(&rates);
        let step = next_step(start, &self.test.schedule);
        let settled_error = self.state.settled_error.after(start);
        let step_error = settled_error.with_last(start, &step);

        // The new surface. Creep is computed on a copy: an update that fails leaves the state as it was.
        let (creep, creep_mm) = self.creep(&solved, &step).unzip();
        let wear_mm = step.depth_mm.clone();
        let taken = Depths { wear_mm, creep_mm };
        let (under_surface, stress) = self.under_surface(&solved).unzip();
        let before = self.lower(&solved.surface, &taken)?;

        // The results.
        if let Some(creep) = creep {
            self.state.creep = creep;
        }
        (self.state.settled_error, self.state.step_error) = (settled_error, step_error);
        self.state.under_surface = under_surface;
        let solved_step = SolvedStep {
            surface: &solved.surface,
            shared: &shared,
            mean: &mean,
            worn: &worn,
            rates: &rates,
            step: &step,
        };
        let record = self.record(
            &solved_step,
            &taken,
            before.worst_quality,
            solved.peaks(stress),
        );
        self.state.updates.push(record);
        self.sum_up(&solved_step);
        self.remember(solved, step, rates, before);
        Ok(ControlFlow::Continue(()))
    }

    /// Solves a cycle on the surface after the last update, so that motions, pressures, areas and stresses of the last
    /// cycle are those of the worn insert. Nothing wears, and the history of the contact stays that of the last update.
    fn solve_final_cycle(
        &mut self,
        watch: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<ControlFlow<()>, MarchError> {
        let ControlFlow::Continue(solved) = self.solve(watch)? else {
            return Ok(ControlFlow::Break(()));
        };
        let shared = solved.with_shares(&self.test.activities);
        let mean = mean_cycles(&shared, &solved.surface);
        let (_, rates) = self.worn(&mean, &solved.surface)?;
        let surface = &solved.surface;
        let fields = NodeFields::new(&mean, surface, &rates, &self.insert, &self.state.depths);
        self.state.fields = Some(fields);
        let (under_surface, stress) = self.under_surface(&solved).unzip();
        self.state.under_surface = under_surface;
        self.state.final_cycle = Some(solved.peaks(stress));
        self.keep(self.cycles(), solved);
        Ok(ControlFlow::Continue(()))
    }

    /// Returns the wear per mean cycle at every node, and its rates.
    ///
    /// # Errors
    /// A law that adds material, or gives no number.
    fn worn(
        &self,
        mean: &[MeanCycle<'_>],
        surface: &ArticulatingSurface,
    ) -> Result<(Vec<NodeWear>, Rates), MarchError> {
        let worn = worn(self.test.wear.as_ref(), mean);
        let is_valid = |depth_mm: f64| depth_mm.is_finite() && depth_mm >= 0.0;
        if let Some(node) = worn.iter().position(|worn| !is_valid(worn.depth_mm)) {
            return Err(MarchError::InvalidDepth {
                update: self.update_in_progress(),
                place_mm: surface.positions[node],
                depth_mm: worn[node].depth_mm,
            });
        }
        let contact = self.test.contact.as_ref();
        let rates = Rates::new(contact, &self.insert, surface, mean, &worn);
        Ok((worn, rates))
    }

    /// Returns the number of the update in progress, from 1.
    fn update_in_progress(&self) -> usize {
        let left = self.test.schedule.cycles - self.cycles();
        self.state.update_in_progress(left)
    }

    /// Solves one repeating cycle of every activity on the present surface.
    ///
    /// # Errors
    /// A cycle that cannot be solved, or in which the bodies lose contact.
    fn solve(
        &mut self,
        watch: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<ControlFlow<(), SolvedCycles>, MarchError> {
        let spent = self.last.take().map_or_else(Vec::new, |last| last.cycles);
        let spent = spent.into_iter().map(|cycle| cycle.history).collect();
        let memory = ContactMemory {
            state: self.state.contact.clone(),
            cache: std::mem::take(&mut self.cache),
        };
        let surface = self.surface();
        let mut contact = self.test.contact.contact(self.bodies(&surface), memory);
        let (test, state, chains) = (&self.test, &self.state, &self.chains);
        let solved = solve(test, state, chains, contact.as_mut(), spent, watch)?;
        let ControlFlow::Continue((cycles, counters)) = solved else {
            return Ok(ControlFlow::Break(()));
        };
        let memory = contact.into_memory();
        let solved = SolvedCycles {
            surface,
            cycles,
            counters,
            memory,
        };
        if !solved.touch() {
            let (end, added_inertia) = (&solved.cycles[0].end, counters.added_inertia);
            let update = self.update_in_progress();
            return Err(MarchError::lost_contact(update, test, end, added_inertia));
        }
        Ok(ControlFlow::Continue(solved))
    }

    /// Returns the state of the test at the start of a step that wears at `rates`.
    fn step_start<'a>(&'a self, rates: &'a Rates) -> StepStart<'a> {
        StepStart {
            rates,
            last: self.state.last_step.as_ref(),
            worn_mm: &self.state.depths.wear_mm,
            cycles: self.cycles(),
            updates: self.state.updates.len(),
            creeps: self.test.creep.is_some(),
        }
    }

    /// Returns the creep by the end of a step, and its memory then, if the insert creeps.
    fn creep(&self, solved: &SolvedCycles, wear: &WearStep) -> Option<(CreepState, Vec<f64>)> {
        const SECONDS_PER_MINUTE: f64 = 60.0;
        let law = self.test.creep.as_ref()?;
        let mut creep = self.state.creep.clone();
        let crept_mm = creep.step(&CreepStep {
            law,
            thickness_mm: self.test.insert.thickness_mm(),
            worn_mm: &wear.depth_mm,
            contact: &CreepContact::new(&self.test, &self.insert, &solved.surface, &solved.cycles),
            end_min: wear.cycles_after * self.test.cycle_seconds() / SECONDS_PER_MINUTE,
        });
        Some((creep, crept_mm))
    }

    /// Returns the stress below the surface at the increment with the highest pressure, if the insert is a solid.
    fn under_surface(&self, solved: &SolvedCycles) -> Option<(UnderSurface, UnderSurfaceRecord)> {
        let (activity, row) = solved.highest_pressure()?;
        let loads_n = solved.loads_n(activity, row);
        let (contact, state) = (self.test.contact.as_ref(), &solved.memory.state);
        let under = contact.under_surface(&self.insert, state, activity, &loads_n)?;
        let place = (activity, solved.cycles[activity].rows[row].percent);
        let record = UnderSurfaceRecord::new(&under, &self.insert, &solved.surface, place);
        Some((under, record))
    }

    /// Lowers the surface by the depths of a step: wear, and creep if the insert creeps.
    fn lower(
        &mut self,
        surface: &ArticulatingSurface,
        taken: &Depths,
    ) -> Result<Lowered, MarchError> {
        let update = self.state.updates.len() + 1;
        let down_mm = taken.total_mm();
        let mut nodes = down_mm.iter().zip(self.insert.thickness_mm());
        if let Some(node) = nodes.position(|(depth, thickness)| depth >= thickness) {
            // Wear and creep there, if the insert creeps.
            let mut depths = self.state.depths.clone();
            depths.add(taken);
            let creep_mm = depths.creep_mm.map(|creep_mm| creep_mm[node]);
            let wear_and_creep_mm = creep_mm.map(|creep_mm| [depths.wear_mm[node], creep_mm]);
            return Err(MarchError::WornThrough {
                update,
                place_mm: surface.positions[node],
                wear_and_creep_mm,
            });
        }
        self.insert.wear_down(surface, &down_mm);
        let worst_quality = self.insert.mesh().worst_quality();
        if worst_quality <= 0.0 {
            return Err(MarchError::inverted_elements(update, self.insert.mesh()));
        }
        let depths = self.state.depths.clone();
        self.state.depths.add(taken);
        let nodes = self.insert.mesh().nodes.clone();
        // The depth worn so far is the sum by causes, as in a resumed march: that by steps differs in the last bit.
        let worn_mm = self.state.depths.total_mm();
        self.insert.restore(nodes.clone(), &worn_mm);
        Ok(Lowered {
            mesh_nodes: std::mem::replace(&mut self.state.mesh_nodes, nodes),
            depths,
            worst_quality,
        })
    }

    /// The results of an update, after the insert has been lowered by `taken`.
    fn record(
        &self,
        &SolvedStep { rates, step, .. }: &SolvedStep<'_>,
        taken: &Depths,
        worst_quality: f64,
        peaks: CyclePeaks,
    ) -> UpdateRecord {
        let (area_mm2, last) = (&rates.area_mm2, self.state.updates.last());
        let lost_mm3 = volume_mm3(area_mm2, &taken.wear_mm);
        let volume_loss_mm3 = lost_mm3 + last.map_or(0.0, |last| last.volume_loss_mm3);
        let creep = self.creep_record(taken, area_mm2);
        let creep_mm3 = creep.map_or(0.0, |creep| creep.volume_mm3);
        let wear_mm = self.state.depths.wear_mm.iter();
        UpdateRecord {
            cycles: step.cycles_after,
            volume_loss_mm3,
            volume_loss_mesh_mm3: self.test.insert.volume_mm3()
                - self.insert.volume_mm3()
                - creep_mm3,
            mass_loss_mg: volume_loss_mm3 * self.test.density_mg_per_mm3,
            max_depth_mm: wear_mm.copied().fold(0.0, f64::max),
            peaks,
            worst_quality,
            creep,
        }
    }

    /// Creep after a step that took these depths.
    fn creep_record(&self, taken: &Depths, area_mm2: &[f64]) -> Option<CreepRecord> {
        let law = self.test.creep.as_ref()?;
        let crept_mm = taken.creep_mm.as_ref()?;
        let last = self.state.updates.last().and_then(|last| last.creep);
        let before_mm3 = last.map_or(0.0, |last| last.volume_mm3);
        Some(CreepRecord::new(
            before_mm3 + volume_mm3(area_mm2, crept_mm),
            &self.state.depths.wear_mm,
            self.state.depths.creep_mm.as_ref()?,
            &self.state.creep.left_mm(law),
        ))
    }

    /// Adds a step to the sums over the test, and keeps its fields.
    fn sum_up(&mut self, step: &SolvedStep<'_>) {
        let (law, state) = (self.test.wear.as_ref(), &mut self.state);
        let (area_mm2, interval) = (&step.rates.area_mm2, step.step.interval);
        let outside_mm3 = outside_mm3(step.worn, area_mm2, &step.step.depth_mm);
        state.outside_mm3 = sum(state.outside_mm3, outside_mm3);
        let others = self.test.comparison_laws.iter();
        for (law, worn) in others.zip(&mut state.comparison_laws) {
            worn.add(law.law.as_ref(), step.mean, area_mm2, interval);
        }
        if let Some(family) = &mut state.law_family {
            family.add(step.mean, area_mm2, interval);
        }
        let worn = wear_of_each(law, step);
        for (activity, worn) in state.activities.iter_mut().zip(worn) {
            activity.wear = activity.wear.and(worn);
        }
        let SolvedStep {
            mean,
            surface,
            rates,
            ..
        } = step;
        let fields = NodeFields::new(mean, surface, rates, &self.insert, &state.depths);
        if state.fields.is_none() {
            let pressures_mpa = &fields.peak_pressure_mpa;
            state.first_pressure_mpa.clone_from(pressures_mpa);
        }
        state.fields = Some(fields);
    }

    /// Keeps the data that the next update and a resumed march require.
    fn remember(
        &mut self,
        mut solved: SolvedCycles,
        step: WearStep,
        rates: Rates,
        before: Lowered,
    ) {
        let update = self.state.updates.len() - 1;
        let cycles_before = self.state.cycles_before(update);
        let memory = std::mem::take(&mut solved.memory);
        self.cache = memory.cache;
        let snapshot = Snapshot {
            update,
            step: step.record(rates, self.state.last_step.as_ref()),
            mesh_nodes: before.mesh_nodes,
            depths: before.depths,
            contact: std::mem::replace(&mut self.state.contact, memory.state),
            machines: solved.cycles.iter().map(|cycle| cycle.end).collect(),
        };
        let part = cycles_before / self.test.schedule.cycles;
        self.state.pass(part, snapshot);
        self.keep(cycles_before, solved);
    }

    /// Keeps the cycles solved after `cycles` as the last.
    fn keep(&mut self, cycles: f64, solved: SolvedCycles) {
        let (state, kept) = (&mut self.state, &solved.cycles);
        for (activity, cycle) in state.activities.iter_mut().zip(kept) {
            activity.keep(cycles, cycle);
            state.increments_solved += cycle.increments_solved as u64;
        }
        state.not_repeating += u64::from(!kept.iter().all(|cycle| cycle.repeats));
        state.counters = solved.counters;
        self.last = Some(solved);
    }
}

/// Returns the counterface of a test prepared for the shares of its insert.
fn prepared(test: &WearTest) -> Counterface {
    let spread_mm2 = test.insert.surface().mean_spread_mm2();
    test.counterface.prepared_for(spread_mm2)
}
