//! `summary.json`: the answer in one table.

use condyle::{
    evolve::{MarchState, UpdateRecord},
    machine::knee::{AP, IE},
};
use serde::{Deserialize, Serialize};

use super::{
    activities::ActivitySummary,
    creep::CreepSummary,
    cycle_motion::{joint_range, medial_load_share},
    error_estimate::ErrorEstimate,
    femur_pose::NeutralPose,
    law_wear::LawWear,
    plausibility::PlausibilityWarning,
    under_surface::UnderSurfaceSummary,
};

/// What a summary is made from.
pub struct SummaryInput<'a> {
    /// The march, done.
    pub state: &'a MarchState,
    /// Increments a cycle.
    pub increments: usize,
    /// Hexahedra of the insert.
    pub hexahedra: usize,
    /// Nodes of the articulating surface.
    pub articulating_nodes: usize,
    /// Seconds from the parsed case to the last update, files and report apart; of a run that was
    /// stopped, those of all its parts but for updates begun and lost.
    pub wall_s: f64,
    /// Hash of case and meshes, in hexadecimal.
    pub inputs_blake3: String,
    /// What was put right or looks doubtful.
    pub warnings: Vec<String>,
    /// Estimated discretisation errors; none if the case asks for none.
    pub error: Option<ErrorEstimate>,
    /// Where the femur settled.
    pub neutral_pose: NeutralPose,
    /// What every law of wear says of the run.
    pub wear_laws: Vec<LawWear>,
    /// What the polyethylene wears over what conventional one would; none of conventional one.
    pub wear_over_conventional: Option<f64>,
    /// What each of several activities did.
    pub activities: Vec<ActivitySummary>,
    /// By how much peak pressures are off the deformable insert that the pressure law was fitted to, %; none where
    /// nobody says.
    pub pressure_law_peak_error_percent: Option<f64>,
}

/// The numbers of a finished run; units are in the names.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// What makes these numbers doubtful, the worst first; empty where nothing does.
    #[serde(default)]
    pub plausibility: Vec<PlausibilityWarning>,
    /// Gait cycles.
    pub cycles: f64,
    /// Mass worn, mg.
    pub mass_loss_mg: f64,
    /// Volume worn, from depth times area, mm3.
    pub volume_loss_mm3: f64,
    /// Volume worn, from the change of the mesh less the volume of creep, mm3.
    pub volume_loss_mesh_mm3: f64,
    /// Deepest wear, mm.
    pub max_depth_mm: f64,
    /// Estimated discretisation errors of mass loss and deepest wear; none if the case asks for none.
    pub error: Option<ErrorEstimate>,
    /// What every law of wear says of the same histories, that of the run first; only that one moved the
    /// surface.
    #[serde(default)]
    pub wear_laws: Vec<LawWear>,
    /// What cross-linked polyethylene is taken to wear over what conventional one would, by every law; not there where
    /// the insert is of conventional one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wear_over_conventional: Option<f64>,
    /// What each of several activities did and wore; motions and ranges below are those of the first. Not there
    /// where the case has one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub activities: Vec<ActivitySummary>,
    /// What creep came to; not there where the insert does not creep.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub creep: Option<CreepSummary>,
    /// Highest pressure anywhere, between nodes too, in any cycle, MPa.
    pub peak_pressure_mpa: f64,
    /// Cycles done before the cycle that has it.
    #[serde(default)]
    pub peak_pressure_cycle: f64,
    /// Highest pressure of the first cycle, MPa.
    #[serde(default)]
    pub first_cycle_peak_pressure_mpa: f64,
    /// Highest pressure of the last cycle solved, MPa.
    #[serde(default)]
    pub last_cycle_peak_pressure_mpa: f64,
    /// By how much peak pressures are off the deformable insert that the pressure law was fitted to, at most in stance,
    /// %; not there where the case does not say.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pressure_law_peak_error_percent: Option<f64>,
    /// Largest contact area in any cycle, mm2.
    pub peak_contact_area_mm2: f64,
    /// Cycles done before the cycle that has it.
    #[serde(default)]
    pub peak_contact_area_cycle: f64,
    /// Largest contact area of the first cycle, mm2.
    #[serde(default)]
    pub first_cycle_contact_area_mm2: f64,
    /// Largest contact area of the last cycle solved, mm2.
    #[serde(default)]
    pub last_cycle_contact_area_mm2: f64,
    /// Cycles done before the last cycle solved.
    #[serde(default)]
    pub last_cycle: f64,
    /// Stress below the surface and what has yielded; not there where the insert is no solid.
    #[serde(flatten)]
    pub under_surface: Option<UnderSurfaceSummary>,
    /// Range of AP in the first cycle, mm.
    pub ap_range_mm: f64,
    /// Range of IE in the first cycle, degrees.
    pub ie_range_deg: f64,
    /// Medial part of the axial force, averaged over the first cycle, weighted by force.
    pub medial_load_share: f64,
    /// Where the femur settled, in the insert frame: there AP, ML and IS read zero.
    pub neutral_pose: NeutralPose,
    /// Updates of the geometry.
    pub updates: usize,
    /// Increments a cycle.
    pub increments: usize,
    /// Cycles solved in all.
    pub cycles_solved: f64,
    /// Updates whose cycle did not repeat itself within the tolerance.
    pub cycles_not_repeating: usize,
    /// Newton iterations in all.
    pub newton_iterations: u64,
    /// Contact evaluations in all.
    pub contact_evaluations: u64,
    /// Newton iterations of a cycle solved, on average.
    pub newton_iterations_per_cycle: f64,
    /// Contact evaluations of a cycle solved, on average.
    pub contact_evaluations_per_cycle: f64,
    /// Steps that were halved.
    pub step_halvings: u64,
    /// Steps of the explicit integrator; none of the implicit one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub explicit_steps: Option<u64>,
    /// Most inertia that explicit steps added, as a part of the machine's own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub added_inertia: Option<f64>,
    /// Hexahedra of the insert.
    pub hexahedra: usize,
    /// Nodes of its articulating surface.
    pub articulating_nodes: usize,
    /// Smallest scaled Jacobian of any update's mesh.
    pub worst_quality: f64,
    /// What was put right or looks doubtful.
    pub warnings: Vec<String>,
    /// Seconds from the parsed case to the last update, files and report apart; of a run that was
    /// stopped, those of all its parts but for updates begun and lost.
    pub wall_s: f64,
    /// Version of condyle.
    pub version: String,
    /// Hash of case and meshes, in hexadecimal.
    pub inputs_blake3: String,
}

impl Summary {
    /// The summary of a march; none before its first update.
    pub fn new(input: SummaryInput<'_>) -> Option<Self> {
        let state = input.state;
        let updates = &state.updates;
        let last = updates.last()?;
        let first_cycle = &state.activities.first()?.first_and_last.as_ref()?.0.rows;
        let explicit = Some(&state.counters).filter(|counters| counters.explicit_steps > 0);
        let cycles_solved: f64 = updates.iter().map(|update| update.cycles_solved).sum();
        let per_cycle = |work: u64| work as f64 / cycles_solved;
        let first = updates.first()?;
        let pressure = Largest::of(state, |update| update.peak_pressure_mpa);
        let area = Largest::of(state, |update| update.peak_contact_area_mm2);
        Some(Self {
            plausibility: Vec::new(),
            cycles: last.cycles,
            mass_loss_mg: last.mass_loss_mg,
            volume_loss_mm3: last.volume_loss_mm3,
            volume_loss_mesh_mm3: last.volume_loss_mesh_mm3,
            max_depth_mm: last.max_depth_mm,
            error: input.error,
            wear_laws: input.wear_laws,
            wear_over_conventional: input.wear_over_conventional,
            activities: input.activities,
            creep: CreepSummary::of(state),
            peak_pressure_mpa: pressure.value,
            peak_pressure_cycle: pressure.cycle,
            first_cycle_peak_pressure_mpa: first.peak_pressure_mpa,
            last_cycle_peak_pressure_mpa: last.peak_pressure_mpa,
            pressure_law_peak_error_percent: input.pressure_law_peak_error_percent,
            peak_contact_area_mm2: area.value,
            peak_contact_area_cycle: area.cycle,
            first_cycle_contact_area_mm2: first.peak_contact_area_mm2,
            last_cycle_contact_area_mm2: last.peak_contact_area_mm2,
            last_cycle: state.cycles_before(updates.len() - 1),
            under_surface: UnderSurfaceSummary::of(state),
            ap_range_mm: joint_range(first_cycle, AP),
            ie_range_deg: joint_range(first_cycle, IE),
            medial_load_share: medial_load_share(first_cycle),
            neutral_pose: input.neutral_pose,
            updates: updates.len(),
            increments: input.increments,
            cycles_solved,
            cycles_not_repeating: updates.iter().filter(|update| !update.repeats).count(),
            newton_iterations: state.counters.newton_iterations,
            contact_evaluations: state.counters.contact_evaluations,
            newton_iterations_per_cycle: per_cycle(state.counters.newton_iterations),
            contact_evaluations_per_cycle: per_cycle(state.counters.contact_evaluations),
            step_halvings: state.counters.halvings,
            explicit_steps: explicit.map(|counters| counters.explicit_steps),
            added_inertia: explicit.map(|counters| counters.added_inertia),
            hexahedra: input.hexahedra,
            articulating_nodes: input.articulating_nodes,
            worst_quality: worst_quality(updates),
            warnings: input.warnings,
            wall_s: input.wall_s,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            inputs_blake3: input.inputs_blake3,
        })
    }
}

/// The worst quality of an element that any update left.
fn worst_quality(updates: &[UpdateRecord]) -> f64 {
    let each = updates.iter().map(|update| update.worst_quality);
    each.fold(f64::INFINITY, f64::min)
}

/// The largest value of any cycle solved.
struct Largest {
    value: f64,
    /// Cycles done before the first cycle that has it.
    cycle: f64,
}

impl Largest {
    fn of(state: &MarchState, value: fn(&UpdateRecord) -> f64) -> Self {
        let mut largest = Self {
            value: 0.0,
            cycle: 0.0,
        };
        for (number, update) in state.updates.iter().enumerate() {
            if value(update) > largest.value {
                largest.value = value(update);
                largest.cycle = state.cycles_before(number);
            }
        }
        largest
    }
}
