//! The march over millions of cycles: one solved cycle, its wear, the new surface, and again.

use std::ops::ControlFlow;

use super::{
    CycleRecord, MarchError, MarchState, NodeFields, PlacementError, Progress, Snapshot,
    UpdateRecord, Updates, WearTest,
    interval::shared_out,
    placement::place,
    rates::{Rates, total},
    step::{Before, Step},
};
use crate::{
    Vec3,
    contact::{ContactModel, CycleHistory, Former, Foundation},
    geometry::ArticulatingSurface,
    machine::{Chain, Cycle, CycleRow, MachineState, Simulator, SolverCounters, TimeSettings},
};

/// The first and the last cycle, whose motions are kept, repeat themselves within this part of the
/// tolerances. Of the others only the wear counts, and it errs a hundred times less than motions.
const KEPT: f64 = 0.1;
/// An update that is to reach this part of the cycles is the last: intervals do not sum up exactly.
const LAST: f64 = 1.0 - 1e-9;

/// A wear test on its way.
pub struct March {
    test: WearTest,
    chain: Chain,
    unworn_nodes: Vec<Vec3>,
    unworn_volume_mm3: f64,
    state: MarchState,
    fields: NodeFields,
    /// The last cycle's history, for its memory.
    spent: CycleHistory,
    /// What the contact of the last update knew, for the next one.
    former: Option<Former>,
}

impl March {
    /// Places the femur on the unworn insert.
    ///
    /// # Errors
    /// Bodies that do not meet, overlap deeply, or do not come to rest.
    pub fn start(test: WearTest) -> Result<Self, PlacementError> {
        Self::placed(prepared(test, 0.0))
    }

    /// The same test changed, from its start; this march is given up.
    ///
    /// # Errors
    /// As [`March::start`].
    pub fn restarted(
        mut self,
        change: impl FnOnce(WearTest) -> WearTest,
    ) -> Result<Self, PlacementError> {
        let none = vec![0.0; self.state.worn_mm.len()];
        self.test.insert.restore(self.unworn_nodes, &none);
        let averaged_mm2 = self.test.insert.surface().mean_spread_mm2();
        Self::placed(prepared(change(self.test), averaged_mm2))
    }

    /// The same march with its machine in the middle of a motion, such as that of another march;
    /// the next cycle repeats itself sooner, the nearer that is to its own.
    pub fn in_motion(mut self, machine: MachineState) -> Self {
        self.state.machine = machine;
        self
    }

    /// The same bodies in a test changed otherwise, from a step on the way as if it were the first.
    pub fn returned_to(
        mut self,
        snapshot: &Snapshot,
        change: impl FnOnce(WearTest) -> WearTest,
    ) -> Self {
        let (nodes, worn_mm) = (snapshot.mesh_nodes.clone(), snapshot.worn_mm.clone());
        let increments = self.test.time.increments;
        self.test = change(self.test);
        if self.test.time.increments != increments {
            self.former = None;
        }
        self.test.insert.restore(nodes.clone(), &worn_mm);
        self.fields = NodeFields::unworn(&self.test, &worn_mm);
        self.state = MarchState::at(nodes, worn_mm, snapshot.machine, self.state.zero_mm);
        self
    }

    fn placed(test: WearTest) -> Result<Self, PlacementError> {
        let mut counters = SolverCounters::default();
        let (chain, settled) = place(&test, &mut counters)?;
        let state = MarchState {
            counters,
            ..MarchState::at(
                test.insert.mesh().nodes.clone(),
                vec![0.0; test.insert.surface_nodes().len()],
                MachineState::at_rest(&test.machine, settled),
                chain.zero_mm(),
            )
        };
        Ok(Self::from_parts(test, chain, state))
    }

    /// Goes on from a state of the same test.
    pub fn resume(test: WearTest, state: MarchState) -> Self {
        let test = prepared(test, 0.0);
        let chain = Chain::new(&test.machine, state.zero_mm, test.flexion_axis_mm);
        Self::from_parts(test, chain, state)
    }

    fn from_parts(mut test: WearTest, chain: Chain, state: MarchState) -> Self {
        let unworn_volume_mm3 = test.insert.volume_mm3();
        let unworn_nodes = test.insert.mesh().nodes.clone();
        test.insert
            .restore(state.mesh_nodes.clone(), &state.worn_mm);
        let fields = NodeFields::unworn(&test, &state.worn_mm);
        Self {
            test,
            chain,
            unworn_nodes,
            unworn_volume_mm3,
            state,
            fields,
            spent: CycleHistory::default(),
            former: None,
        }
    }

    /// The test, its insert as worn.
    pub fn test(&self) -> &WearTest {
        &self.test
    }

    /// All that is needed to go on.
    pub fn state(&self) -> &MarchState {
        &self.state
    }

    /// Results of the last update at every surface node; before the first, of the unworn insert.
    pub fn fields(&self) -> &NodeFields {
        &self.fields
    }

    /// Whether all cycles are done.
    pub fn is_done(&self) -> bool {
        self.cycles() >= self.test.schedule.cycles
    }

    /// Solves the next cycle that repeats itself, and wears the insert by an interval of it.
    ///
    /// `watch` is told of every increment, and the march breaks where it does; an update begun is
    /// then lost, those before are kept.
    ///
    /// # Errors
    /// A cycle that cannot be solved, or an insert worn through.
    pub fn update(
        &mut self,
        watch: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<ControlFlow<(), &UpdateRecord>, MarchError> {
        let spent = std::mem::take(&mut self.spent);
        let former = self.former.take();
        let WearTest {
            contact,
            femur,
            insert,
            ..
        } = &self.test;
        let mut contact = Foundation::after(former, contact, femur, insert);
        let mut counters = self.state.counters;
        let solved = self.repeating_cycle(&mut contact, spent, &mut counters, watch)?;
        let ControlFlow::Continue(cycle) = solved else {
            return Ok(ControlFlow::Break(()));
        };
        let (surface, former) = contact.into_parts();
        self.former = Some(former);
        let record = self.wear(&surface, cycle, counters)?;
        Ok(ControlFlow::Continue(record))
    }

    /// As [`March::update`], on another model of contact: the one made for the test as worn so far.
    ///
    /// # Errors
    /// As [`March::update`].
    pub fn update_on(
        &mut self,
        model: impl for<'a> Fn(&'a WearTest) -> Box<dyn ContactModel + 'a>,
        watch: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<ControlFlow<(), &UpdateRecord>, MarchError> {
        let spent = std::mem::take(&mut self.spent);
        let mut counters = self.state.counters;
        let mut contact = model(&self.test);
        let solved = self.repeating_cycle(contact.as_mut(), spent, &mut counters, watch)?;
        drop(contact);
        let ControlFlow::Continue(cycle) = solved else {
            return Ok(ControlFlow::Break(()));
        };
        let record = self.wear(&self.test.insert.surface(), cycle, counters)?;
        Ok(ControlFlow::Continue(record))
    }

    /// Wears the insert by an interval of a solved cycle.
    fn wear(
        &mut self,
        surface: &ArticulatingSurface,
        cycle: Cycle,
        counters: SolverCounters,
    ) -> Result<&UpdateRecord, MarchError> {
        let update = self.state.updates.len() + 1;
        let cycles = self.cycles();
        if cycle.rows.iter().all(|row| row.axial_force_n == 0.0) {
            return Err(MarchError::lost_contact(
                update,
                &self.test.machine,
                &cycle.end,
            ));
        }
        let rates = Rates::of(
            &cycle,
            surface,
            self.test.wear.as_ref(),
            &self.test.contact,
            self.test.insert.thickness_mm(),
        );
        let before = Before {
            rates: &rates,
            last: self.state.last_step.as_ref(),
            worn_mm: &self.state.worn_mm,
            cycles,
            updates: update - 1,
        };
        let step = Step::next(before, &self.test.schedule);
        let worn_mm3 = total(&rates.area_mm2, &step.depth_mm);
        let settled_error = self.state.settled_error.after(before);
        let step_error = settled_error.with_last(before, &step);
        let (mesh_nodes, worn_mm) = self.wear_down(surface, &cycle, &rates, &step)?;
        self.state.counters = counters;
        (self.state.settled_error, self.state.step_error) = (settled_error, step_error);
        let record = self.record(&cycle, &step, worn_mm3);
        self.state.updates.push(record);
        let snapshot = Snapshot {
            step: step.remembered(rates),
            mesh_nodes,
            worn_mm,
            machine: cycle.end,
        };
        let part = cycles / self.test.schedule.cycles;
        self.state.pass(part, snapshot);
        self.keep(cycle, cycles);
        Ok(&self.state.updates[update - 1])
    }

    /// What the update that has just worn the insert by `worn_mm3` found.
    fn record(&self, cycle: &Cycle, step: &Step, worn_mm3: f64) -> UpdateRecord {
        let last = self.state.updates.last();
        let volume_loss_mm3 = worn_mm3 + last.map_or(0.0, |last| last.volume_loss_mm3);
        let most = |value: fn(&CycleRow) -> f64| cycle.rows.iter().map(value).fold(0.0, f64::max);
        UpdateRecord {
            cycles: step.cycles_after,
            volume_loss_mm3,
            volume_loss_mesh_mm3: self.unworn_volume_mm3 - self.test.insert.volume_mm3(),
            mass_loss_mg: volume_loss_mm3 * self.test.density_mg_per_mm3,
            max_depth_mm: largest(&self.state.worn_mm),
            peak_pressure_mpa: most(|row| row.peak_pressure_mpa),
            peak_contact_area_mm2: most(|row| row.contact_area_mm2),
            cycles_solved: cycle.increments_solved as f64 / self.test.time.increments as f64,
            repeats: cycle.repeats,
            worst_quality: self.test.insert.mesh().worst_quality(),
        }
    }

    /// Cycles done so far.
    pub fn cycles(&self) -> f64 {
        self.state.updates.last().map_or(0.0, |last| last.cycles)
    }

    /// A cycle that repeats itself, the geometry held still; breaks where `watch` does.
    fn repeating_cycle(
        &self,
        contact: &mut dyn ContactModel,
        spent: CycleHistory,
        counters: &mut SolverCounters,
        watch: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<ControlFlow<(), Cycle>, MarchError> {
        let update = self.state.updates.len() + 1;
        let time = self.time();
        let mut simulator = Simulator::new(&self.test.machine, &self.chain, contact, &time);
        simulator.warm_starts.clone_from(&self.state.warm_starts);
        simulator.history = spent;
        let increments = self.test.time.increments as f64;
        let (cycles, interval) = (self.cycles(), self.likely_interval());
        let mut watch_cycle = |solved| {
            let cycles_solved = solved as f64 / increments;
            watch(Progress {
                update,
                cycles_solved,
                cycles: cycles + interval * cycles_solved.min(1.0),
            })
        };
        simulator
            .cycle(&self.state.machine, counters, &mut watch_cycle)
            .map_err(|source| MarchError::Cycle {
                update,
                cycles,
                source,
            })
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
            Updates::Fixed(updates) => schedule.cycles / updates as f64,
            Updates::Auto { .. } => last.map_or(0.0, |last| shared_out(left, last)),
        }
    }

    /// Wears the insert by a step; the nodes of its mesh and the depth worn before it.
    fn wear_down(
        &mut self,
        surface: &ArticulatingSurface,
        cycle: &Cycle,
        rates: &Rates,
        step: &Step,
    ) -> Result<(Vec<Vec3>, Vec<f64>), MarchError> {
        let thickness_mm = self.test.insert.thickness_mm();
        let mut nodes = step.depth_mm.iter().zip(thickness_mm);
        if let Some(node) = nodes.position(|(depth, thickness)| depth >= thickness) {
            let place = surface.positions[node];
            return Err(MarchError::WornThrough {
                update: self.state.updates.len() + 1,
                x: place.x,
                z: place.z,
            });
        }
        self.test.insert.wear_down(surface, &step.depth_mm);
        let worn = self.state.worn_mm.iter().zip(&step.depth_mm);
        let worn = worn.map(|(worn, step)| worn + step).collect();
        let worn_before = std::mem::replace(&mut self.state.worn_mm, worn);
        let nodes = self.test.insert.mesh().nodes.clone();
        let nodes_before = std::mem::replace(&mut self.state.mesh_nodes, nodes);
        let thickness_mm = self.test.insert.thickness_mm();
        self.fields = NodeFields::of(cycle, rates, &self.state.worn_mm, thickness_mm);
        Ok((nodes_before, worn_before))
    }

    fn keep(&mut self, cycle: Cycle, cycles: f64) {
        self.state.machine = cycle.end;
        self.state.warm_starts = cycle.warm_starts;
        self.spent = cycle.history;
        let last = CycleRecord {
            cycles,
            rows: cycle.rows,
        };
        let first = self
            .state
            .first_and_last
            .take()
            .map_or_else(|| last.clone(), |(first, _)| first);
        self.state.first_and_last = Some((first, last));
    }
}

/// The test with its femur made ready for the shares of its insert; it may have been for shares
/// that spread over `averaged_mm2`.
fn prepared(test: WearTest, averaged_mm2: f64) -> WearTest {
    let spread_mm2 = test.insert.surface().mean_spread_mm2();
    WearTest {
        femur: test.femur.prepared_for(spread_mm2 - averaged_mm2),
        ..test
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}
