//! The reasons why a march does not start, or ends early.

use condyle_fem::HexMesh;
use thiserror::Error;

use super::WearTest;
use crate::{
    Vec3,
    machine::{CycleError, HEAVY, Machine, MachineState, NotSettled, Settling, Spring},
};

/// The reason why a march ended early.
#[expect(missing_docs, reason = "the messages describe the fields")]
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum MarchError {
    /// The bodies cannot be placed on each other.
    #[error(transparent)]
    Placement(#[from] PlacementError),
    /// A cycle was not solved.
    #[error(
        "update {update}, after {cycles:.0} cycles{}: {source}",
        activity.as_ref().map_or_else(String::new, |name| format!(", activity \"{name}\""))
    )]
    Cycle {
        update: usize,
        cycles: f64,
        activity: Option<String>,
        source: CycleError,
    },
    /// The counterface left the insert.
    #[error(
        "update {update}: the counterface never touches the insert during the cycle; it may have slid or tipped off, like a hip \
         that dislocates; it was lowered at x {:.1}, z {:.1} mm and ends at {readings}; check, if a translation is large, start_mm, axes and sides, the loads and \
         their signs, and the springs that hold it; if a rotation is large, the point of its axis (vv_axis_medial_mm or point_mm)",
        start_mm.0,
        start_mm.1
    )]
    LostContact {
        update: usize,
        start_mm: (f64, f64),
        readings: String,
    },
    /// Inertia that was added to stabilise explicit steps threw the counterface off.
    #[error(
        "update {update}: the counterface never touches the insert during the cycle: friction rises so steeply with the speed that \
         the steps of explicit_step_s are stable only with {added_inertia:.0} times the machine's inertia added to it, and this \
         inertia throws the counterface off; set a shorter explicit_step_s (0 takes the longest stable step), a larger \
         slip_tolerance_mm_per_s, or integrator = \"implicit\""
    )]
    ThrownOff { update: usize, added_inertia: f64 },
    /// The insert wore through.
    #[error(
        "update {update}: the insert is worn through at ({:.1}, {:.1}) mm{}; use fewer cycles or a thicker insert",
        place_mm.x, place_mm.z,
        wear_and_creep_mm.map_or_else(String::new, |[wear, creep]| {
            format!(", by {wear:.2} mm of wear and {creep:.2} mm of creep")
        })
    )]
    WornThrough {
        update: usize,
        place_mm: Vec3,
        wear_and_creep_mm: Option<[f64; 2]>,
    },
    /// The wear law adds material, or its depth is not a number.
    #[error(
        "update {update}: the wear law gives a depth of {depth_mm} mm in a cycle at ({:.1}, {:.1}) mm; a depth is finite, and 0 or more",
        place_mm.x, place_mm.z
    )]
    InvalidDepth {
        update: usize,
        place_mm: Vec3,
        depth_mm: f64,
    },
    /// Elements below the worn surface are inverted.
    #[error(
        "update {update}: {count} elements below the worn surface are inside out, the worst at ({:.1}, {:.1}, {:.1}) \
         mm; use more updates, fewer layers or a larger edge_mm",
        place_mm.x, place_mm.y, place_mm.z
    )]
    InvertedElements {
        update: usize,
        count: usize,
        place_mm: Vec3,
    },
}

impl MarchError {
    /// Returns the error of a joint of the other side, with its places mirrored at the plane z = 0.
    #[must_use]
    pub fn mirrored(mut self) -> Self {
        match &mut self {
            Self::WornThrough { place_mm, .. }
            | Self::InvalidDepth { place_mm, .. }
            | Self::InvertedElements { place_mm, .. } => place_mm.z = -place_mm.z,
            Self::Placement(_)
            | Self::Cycle { .. }
            | Self::LostContact { .. }
            | Self::ThrownOff { .. } => {}
        }
        self
    }

    pub(super) fn inverted_elements(update: usize, mesh: &HexMesh) -> Self {
        let qualities = || mesh.qualities().enumerate();
        let worst = qualities().min_by(|a, b| a.1.total_cmp(&b.1));
        let corners = worst.map_or([Vec3::zeros(); 8], |(hex, _)| mesh.corners(hex));
        Self::InvertedElements {
            update,
            count: qualities().filter(|(_, quality)| *quality <= 0.0).count(),
            place_mm: corners.iter().sum::<Vec3>() / 8.0,
        }
    }

    pub(super) fn lost_contact(
        update: usize,
        test: &WearTest,
        end: &MachineState,
        added_inertia: f64,
    ) -> Self {
        if added_inertia > HEAVY {
            return Self::ThrownOff {
                update,
                added_inertia,
            };
        }
        Self::LostContact {
            update,
            start_mm: test.start_mm,
            readings: test.machine().mechanism.readings(&end.now.positions),
        }
    }
}

/// The reason why two bodies cannot be placed on each other.
#[expect(missing_docs, reason = "the messages describe the fields")]
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum PlacementError {
    /// A value of the test that its type permits, and the march does not.
    #[error("the wear test is invalid: {0}")]
    InvalidTest(String),
    /// Nothing of the insert lies below the counterface.
    #[error(
        "counterface and insert are apart: lowered at x {:.1}, z {:.1} mm the counterface passes the insert without \
         touching it; check length_unit, axes and start_mm",
        start_mm.0,
        start_mm.1
    )]
    Apart { start_mm: (f64, f64) },
    /// The settled counterface lies too deep in the insert.
    #[error(
        "counterface and insert overlap by {overclosure_mm:.2} mm at the start, more than half the insert's thickness \
         of {thickness_mm:.2} mm there; check length_unit, axes, start_mm and the material"
    )]
    DeepOverlap {
        overclosure_mm: f64,
        thickness_mm: f64,
    },
    /// The counterface slides off or tips over.
    #[error(
        "the counterface does not settle on the insert under the axial load: {residual_n:.3e} N remain unbalanced at \
         {readings}; check axes and start_mm"
    )]
    NotSettled { residual_n: f64, readings: String },
    /// A load acts where only a spring would hold against it.
    #[error(
        "the counterface does not settle on the insert: at the start of the cycle a load acts on the joint \"{joint}\", which its \
         spring restrains, but springs do not act while the machine settles; set settling = \"held\" for this joint, or let its load \
         start at zero"
    )]
    SprungLoad { joint: &'static str },
    /// A ligament is too short for its attachments.
    #[error(
        "the ligament \"{name}\" is strained by {percent:.0} % where the counterface settles, more than {most_percent:.0} %; check its \
         attachments and its slack length"
    )]
    TightLigament {
        name: String,
        percent: f64,
        most_percent: f64,
    },
    /// The counterface rests where the force jumps.
    #[error(
        "the counterface does not settle on the insert under the axial load: it rests at {readings}, but there the force jumps by \
         some {residual_n:.1} N as it moves by {moved_mm:.3} mm; few nodes carry the load, and the force on each jumps \
         where the counterface's curvature changes: take a smaller edge_mm"
    )]
    Unsteady {
        residual_n: f64,
        moved_mm: f64,
        readings: String,
    },
}

/// A counterface that moves less in an iteration rests, though its forces do not balance, mm.
const AT_REST_MM: f64 = 0.1;
/// A counterface farther than this from its start has slid off its support, mm.
const SLID_OFF_MM: f64 = 20.0;

impl PlacementError {
    pub(super) fn not_settled(machine: &Machine, failed: &NotSettled) -> Self {
        let mechanism = machine.mechanism;
        let is_pulled = |spring: &&Spring| {
            let joint = machine.joint(spring.along);
            let is_driven = joint.description.settling == Settling::Driven;
            let presses = machine.pressing_joint() == Some(spring.along);
            is_driven && !presses && machine.loads_at(0.0)[spring.along.place()] != 0.0
        };
        if let Some(spring) = machine.springs.iter().find(is_pulled) {
            let joint = mechanism.joint(spring.along).name;
            return Self::SprungLoad { joint };
        }
        let in_files = mechanism.in_files.iter().copied();
        let zeroed = in_files.filter(|&index| mechanism.joint(index).is_zeroed);
        let shift = |index| (mechanism.joint(index).symbol, index.of(&failed.positions));
        let shifts_mm: Vec<(&str, f64)> = zeroed.map(shift).collect();
        let has_slid_off = shifts_mm.iter().any(|(_, at_mm)| at_mm.abs() > SLID_OFF_MM);
        let (residual_n, moved_mm) = (failed.residual_n, failed.moved_mm);
        let shifts = shifts_mm
            .iter()
            .map(|(symbol, at_mm)| format!("{symbol} {at_mm:.2}"));
        let readings = format!("{} mm", shifts.collect::<Vec<_>>().join(", "));
        if moved_mm < AT_REST_MM && !has_slid_off {
            return Self::Unsteady {
                residual_n,
                moved_mm,
                readings,
            };
        }
        Self::NotSettled {
            residual_n,
            readings,
        }
    }
}
