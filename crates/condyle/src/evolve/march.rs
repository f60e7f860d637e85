//! The march over millions of cycles: one solved cycle, its wear, the new surface, and again.

use std::ops::ControlFlow;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::{PlacementError, WearTest, placement::place};
use crate::{
    Vec3,
    contact::Foundation,
    geometry::ArticulatingSurface,
    machine::{Chain, Cycle, CycleError, CycleRow, Effort, Freedom, MachineState, Simulator},
};

/// Why a march ended early.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum MarchError {
    /// The bodies make no knee.
    #[error(transparent)]
    Placement(#[from] PlacementError),
    /// A cycle was not solved.
    #[error("update {update}, after {cycles:.0} cycles: {source}")]
    Cycle {
        /// Which update, from 1.
        update: usize,
        /// Cycles done before it.
        cycles: f64,
        /// Why.
        source: CycleError,
    },
    /// The femur fell off the insert.
    #[error(
        "update {update}: the femur touches the insert nowhere in the whole cycle, and ends it at AP {ap_mm:.1} mm; \
         check loads, springs, axes and start_mm"
    )]
    LostContact {
        /// Which update, from 1.
        update: usize,
        /// AP at the end of the cycle.
        ap_mm: f64,
    },
    /// The insert wore through.
    #[error(
        "update {update}: the insert is worn through at ({x:.1}, {z:.1}) mm; use fewer cycles or a thicker insert"
    )]
    WornThrough {
        /// Which update, from 1.
        update: usize,
        /// Place along x.
        x: f64,
        /// Place along z.
        z: f64,
    },
}

/// How far a march has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Which update, from 1.
    pub update: usize,
    /// Cycles solved for it; the last of them counts once it repeats itself.
    pub cycles_solved: f64,
}

/// What one update found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct UpdateRecord {
    /// Cycles done after it.
    pub cycles: f64,
    /// Volume worn so far, from depth times area, mm3.
    pub volume_loss_mm3: f64,
    /// Volume worn so far, from the change of the mesh, mm3.
    pub volume_loss_mesh_mm3: f64,
    /// Mass worn so far, mg.
    pub mass_loss_mg: f64,
    /// Deepest wear so far, mm.
    pub max_depth_mm: f64,
    /// Highest pressure of its cycle, MPa.
    pub peak_pressure_mpa: f64,
    /// Largest area of its cycle, mm2.
    pub peak_contact_area_mm2: f64,
    /// Cycles solved until one repeated itself.
    pub cycles_solved: f64,
    /// Whether one did.
    pub repeats: bool,
    /// Smallest scaled Jacobian of the worn mesh.
    pub worst_quality: f64,
}

/// The motions and loads of one solved cycle, and how many cycles of wear it came after.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CycleRecord {
    /// Cycles done before it.
    pub cycles: f64,
    /// One row an increment.
    pub rows: Vec<CycleRow>,
}

/// Results of an update at every node of the articulating surface.
#[derive(Clone, Debug, PartialEq)]
pub struct NodeFields {
    /// Depth worn so far, mm.
    pub wear_depth_mm: Vec<f64>,
    /// Depth one cycle wears, mm.
    pub depth_per_cycle_mm: Vec<f64>,
    /// Highest pressure of the cycle, MPa.
    pub peak_pressure_mpa: Vec<f64>,
    /// Distance slid under pressure in the cycle, mm.
    pub sliding_distance_mm: Vec<f64>,
    /// Thickness left, mm.
    pub thickness_mm: Vec<f64>,
}

/// All that a march must remember to go on from an update, to the same bytes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MarchState {
    /// Results of the updates done.
    pub updates: Vec<UpdateRecord>,
    /// Nodes of the mesh as worn.
    pub mesh_nodes: Vec<Vec3>,
    /// Depth worn at each surface node, mm.
    pub worn_mm: Vec<f64>,
    /// The machine at the end of the last cycle.
    pub machine: MachineState,
    /// Where the femoral frame's origin is in the insert frame at neutral, mm.
    pub zero_mm: Vec3,
    /// Work done.
    pub effort: Effort,
    /// The first cycle and the last one solved.
    pub first_and_last: Option<(CycleRecord, CycleRecord)>,
}

/// A wear test on its way.
pub struct March {
    test: WearTest,
    chain: Chain,
    unworn_volume_mm3: f64,
    state: MarchState,
    fields: NodeFields,
}

impl March {
    /// Places the femur on the unworn insert.
    ///
    /// # Errors
    /// Bodies that do not meet, overlap deeply, or do not come to rest.
    pub fn start(test: WearTest) -> Result<Self, PlacementError> {
        let test = prepared(test);
        let mut effort = Effort::default();
        let (chain, settled) = place(&test, &mut effort)?;
        let state = MarchState {
            updates: Vec::new(),
            mesh_nodes: test.insert.mesh().nodes.clone(),
            worn_mm: vec![0.0; test.insert.surface_nodes().len()],
            machine: MachineState::at_rest(&test.machine, settled),
            zero_mm: chain.zero_mm(),
            effort,
            first_and_last: None,
        };
        Ok(Self::from_parts(test, chain, state))
    }

    /// Goes on from a state of the same test.
    pub fn resume(test: WearTest, state: MarchState) -> Self {
        let test = prepared(test);
        let chain = Chain::new(&test.machine, state.zero_mm, test.flexion_axis_mm);
        Self::from_parts(test, chain, state)
    }

    fn from_parts(mut test: WearTest, chain: Chain, state: MarchState) -> Self {
        let unworn_volume_mm3 = test.insert.volume_mm3();
        test.insert
            .restore(state.mesh_nodes.clone(), &state.worn_mm);
        let fields = NodeFields::unworn(&test, &state.worn_mm);
        Self {
            test,
            chain,
            unworn_volume_mm3,
            state,
            fields,
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
        self.state.updates.len() >= self.test.schedule.updates
    }

    /// Solves the next cycle that repeats itself, and wears the insert by an interval of it.
    ///
    /// `watch` is told of every increment, and may stop the march; an update begun is then lost,
    /// those before are kept.
    ///
    /// # Errors
    /// A cycle that cannot be solved, an insert worn through, or a stop asked for.
    pub fn update(
        &mut self,
        watch: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<&UpdateRecord, MarchError> {
        let update = self.state.updates.len() + 1;
        let cycles_before = self.cycles();
        let mut effort = self.state.effort;
        let (surface, cycle) =
            self.repeating_cycle(update, &mut effort, watch)
                .map_err(|source| MarchError::Cycle {
                    update,
                    cycles: cycles_before,
                    source,
                })?;
        if cycle.rows.iter().all(|row| row.axial_force_n == 0.0) {
            let ap_mm = cycle.end.now.positions[Freedom::AnteroPosterior as usize];
            return Err(MarchError::LostContact { update, ap_mm });
        }
        self.state.effort = effort;
        let area_mm2: Vec<f64> = surface.shares.iter().map(|share| share.area_mm2).collect();
        let step_mm = self.wear_down(&surface, &cycle, update)?;
        let worn: f64 = area_mm2
            .iter()
            .zip(&step_mm)
            .map(|(area, depth)| area * depth)
            .sum();
        let volume_loss_mm3 = worn
            + self
                .state
                .updates
                .last()
                .map_or(0.0, |last| last.volume_loss_mm3);
        self.state.updates.push(UpdateRecord {
            cycles: cycles_before + self.test.schedule.interval(),
            volume_loss_mm3,
            volume_loss_mesh_mm3: self.unworn_volume_mm3 - self.test.insert.volume_mm3(),
            mass_loss_mg: volume_loss_mm3 * self.test.density_mg_per_mm3,
            max_depth_mm: largest(&self.state.worn_mm),
            peak_pressure_mpa: cycle
                .rows
                .iter()
                .map(|row| row.peak_pressure_mpa)
                .fold(0.0, f64::max),
            peak_contact_area_mm2: cycle
                .rows
                .iter()
                .map(|row| row.contact_area_mm2)
                .fold(0.0, f64::max),
            cycles_solved: cycle.increments_solved as f64 / self.test.time.increments as f64,
            repeats: cycle.repeats,
            worst_quality: self.test.insert.mesh().worst_quality(),
        });
        self.keep(cycle, cycles_before);
        Ok(&self.state.updates[update - 1])
    }

    /// Cycles done so far.
    pub fn cycles(&self) -> f64 {
        self.state.updates.last().map_or(0.0, |last| last.cycles)
    }

    /// A cycle that repeats itself, the geometry held still, and the surface it pressed on.
    fn repeating_cycle(
        &self,
        update: usize,
        effort: &mut Effort,
        watch: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<(ArticulatingSurface, Cycle), CycleError> {
        let mut simulator = Simulator {
            machine: &self.test.machine,
            chain: &self.chain,
            contact: Foundation::new(&self.test.contact, &self.test.femur, &self.test.insert),
            time: &self.test.time,
        };
        let increments = self.test.time.increments as f64;
        let mut watch_cycle = |solved| {
            watch(Progress {
                update,
                cycles_solved: solved as f64 / increments,
            })
        };
        let cycle = simulator.cycle(&self.state.machine, effort, &mut watch_cycle)?;
        Ok((simulator.contact.into_surface(), cycle))
    }

    /// Wears the insert by one interval of a cycle; returns the depth at every surface node.
    fn wear_down(
        &mut self,
        surface: &ArticulatingSurface,
        cycle: &Cycle,
        update: usize,
    ) -> Result<Vec<f64>, MarchError> {
        let interval = self.test.schedule.interval();
        let nodes = 0..cycle.history.node_count();
        let per_cycle_mm: Vec<f64> = nodes
            .clone()
            .map(|node| self.test.wear.depth_per_cycle_mm(&cycle.history.node(node)))
            .collect();
        let step_mm: Vec<f64> = per_cycle_mm.iter().map(|depth| depth * interval).collect();
        for node in nodes.clone() {
            if step_mm[node] >= self.test.insert.thickness_mm()[node] {
                let place = surface.positions[node];
                return Err(MarchError::WornThrough {
                    update,
                    x: place.x,
                    z: place.z,
                });
            }
        }
        self.test.insert.wear_down(surface, &step_mm);
        self.state
            .worn_mm
            .iter_mut()
            .zip(&step_mm)
            .for_each(|(worn, step)| *worn += step);
        self.state
            .mesh_nodes
            .clone_from(&self.test.insert.mesh().nodes);
        self.fields = NodeFields {
            wear_depth_mm: self.state.worn_mm.clone(),
            depth_per_cycle_mm: per_cycle_mm,
            peak_pressure_mpa: nodes
                .clone()
                .map(|node| cycle.history.node(node).peak_pressure_mpa())
                .collect(),
            sliding_distance_mm: nodes
                .map(|node| cycle.history.node(node).sliding_distance_mm())
                .collect(),
            thickness_mm: self.test.insert.thickness_mm().to_vec(),
        };
        Ok(step_mm)
    }

    fn keep(&mut self, cycle: Cycle, cycles: f64) {
        self.state.machine = cycle.end;
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

/// The test with its femur made ready for the shares of its insert.
fn prepared(test: WearTest) -> WearTest {
    let spread_mm2 = test.insert.surface().mean_spread_mm2();
    WearTest {
        femur: test.femur.prepared_for(spread_mm2),
        ..test
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

impl NodeFields {
    fn unworn(test: &WearTest, worn_mm: &[f64]) -> Self {
        let none = vec![0.0; worn_mm.len()];
        Self {
            wear_depth_mm: worn_mm.to_vec(),
            depth_per_cycle_mm: none.clone(),
            peak_pressure_mpa: none.clone(),
            sliding_distance_mm: none,
            thickness_mm: test.insert.thickness_mm().to_vec(),
        }
    }
}
