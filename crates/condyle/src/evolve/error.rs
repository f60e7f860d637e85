//! Why a march did not start, or ended early.

use std::fmt;

use condyle_fem::HexMesh;
use thiserror::Error;

use super::WearTest;
use crate::{
    Vec3,
    machine::{CycleError, Machine, MachineState, NotSettled, Readings},
};

/// A machine with more inertia added than this, as a multiple of its own, moves by that and not by its loads.
const HEAVY: f64 = 1.0;

/// Why a march ended early.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum MarchError {
    /// The bodies make no knee.
    #[error(transparent)]
    Placement(#[from] PlacementError),
    /// A cycle was not solved.
    #[error(
        "update {update}, after {cycles:.0} cycles{}: {source}",
        activity.as_ref().map_or_else(String::new, |name| format!(", activity \"{name}\""))
    )]
    Cycle {
        /// Which update, from 1.
        update: usize,
        /// Cycles done before it.
        cycles: f64,
        /// Which of several activities.
        activity: Option<String>,
        /// Why.
        source: CycleError,
    },
    /// The femur fell off the insert.
    #[error(
        "update {update}: the femur touches the insert nowhere in the whole cycle; it was lowered at x {start_x:.1}, z \
         {start_z:.1} mm and ends at {readings}; where AP or ML is far, check start_mm, axes and sides, the AP force and its \
         sign, and the springs that hold it; where VV is, vv_axis_medial_mm"
    )]
    LostContact {
        /// Which update, from 1.
        update: usize,
        /// Where the femur was lowered, along x.
        start_x: f64,
        /// Where the femur was lowered, along z.
        start_z: f64,
        /// Where the joints are at the end of the cycle.
        readings: Readings,
    },
    /// Inertia that explicit steps were given threw the femur off.
    #[error(
        "update {update}: the femur touches the insert nowhere in the whole cycle: the steps of explicit_step_s are stable \
         only with {added_inertia:.0} times the machine's inertia added to it, so steeply does friction rise with the speed, and \
         that much throws the femur off; set a shorter explicit_step_s (0 takes the longest stable step), a larger \
         slip_tolerance_mm_per_s, or integrator = \"implicit\""
    )]
    ThrownOff {
        /// Which update, from 1.
        update: usize,
        /// The most inertia that was added, as a multiple of the machine's own.
        added_inertia: f64,
    },
    /// The insert wore through.
    #[error(
        "update {update}: the insert is worn through at ({x:.1}, {z:.1}) mm{}; use fewer cycles or a thicker insert",
        by.map_or_else(String::new, |by| by.to_string())
    )]
    WornThrough {
        /// Which update, from 1.
        update: usize,
        /// Place along x.
        x: f64,
        /// Place along z.
        z: f64,
        /// How deep by what, if the insert creeps.
        by: Option<WornAndCrept>,
    },
    /// Elements turned inside out below the worn surface.
    #[error(
        "update {update}: {count} elements below the worn surface are inside out, the worst at ({x:.1}, {y:.1}, {z:.1}) \
         mm; use more updates, fewer layers or a larger edge_mm"
    )]
    InvertedElements {
        /// Which update, from 1.
        update: usize,
        /// How many.
        count: usize,
        /// Place of the worst along x.
        x: f64,
        /// Place of the worst along y.
        y: f64,
        /// Place of the worst along z.
        z: f64,
    },
}

/// How deep an insert has gone down at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WornAndCrept {
    /// By wear, mm.
    pub wear_mm: f64,
    /// By creep, mm.
    pub creep_mm: f64,
}

impl fmt::Display for WornAndCrept {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { wear_mm, creep_mm } = self;
        write!(
            f,
            ", by {wear_mm:.2} mm of wear and {creep_mm:.2} mm of creep"
        )
    }
}

impl MarchError {
    /// That of a mesh with elements inside out.
    pub(super) fn inverted_elements(update: usize, mesh: &HexMesh) -> Self {
        let qualities = || mesh.qualities().enumerate();
        let worst = qualities().min_by(|a, b| a.1.total_cmp(&b.1));
        let corners = worst.map_or([Vec3::zeros(); 8], |(hex, _)| mesh.corners(hex));
        let middle = corners.iter().sum::<Vec3>() / 8.0;
        Self::InvertedElements {
            update,
            count: qualities().filter(|(_, quality)| *quality <= 0.0).count(),
            x: middle.x,
            y: middle.y,
            z: middle.z,
        }
    }

    /// That of a femur that has left the insert in a test, at the end of a cycle.
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
        let (start_x, start_z) = test.start_mm;
        Self::LostContact {
            update,
            start_x,
            start_z,
            readings: Readings::new(test.machine().mechanism, &end.now.positions),
        }
    }
}

/// Why two bodies make no knee.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PlacementError {
    /// Nothing of the insert lies below the femur.
    #[error(
        "femur and insert are apart: lowered at x {x_mm:.1}, z {z_mm:.1} mm the femur passes the insert without \
         touching it; check length_unit, axes and start_mm"
    )]
    Apart {
        /// Where the femur was lowered.
        x_mm: f64,
        /// Where the femur was lowered.
        z_mm: f64,
    },
    /// The settled femur lies too deep in the insert.
    #[error(
        "femur and insert overlap by {overclosure_mm:.2} mm at the start, more than half the insert's thickness \
         of {thickness_mm:.2} mm there; check length_unit, axes, start_mm and the material"
    )]
    DeepOverlap {
        /// Deepest overclosure.
        overclosure_mm: f64,
        /// Thickness there.
        thickness_mm: f64,
    },
    /// The femur slides off or tips over.
    #[error(
        "the femur does not settle on the insert under the axial load: {residual_n:.3e} N are left over at \
         {}; check axes and start_mm",
        listed(shifts_mm)
    )]
    NotSettled {
        /// Force left out of balance.
        residual_n: f64,
        /// Where it got to: the shifts that settling zeroes, by the names that messages give them.
        shifts_mm: Vec<(&'static str, f64)>,
    },
    /// The femur rests where the force jumps.
    #[error(
        "the femur does not settle on the insert under the axial load: it rests at {}, but there the force jumps by \
         some {residual_n:.1} N as it moves by {moved_mm:.3} mm; the load rests on few nodes, each of which feels at once \
         where the femur's curvature changes: take a smaller edge_mm",
        listed(shifts_mm)
    )]
    Unsteady {
        /// Force left out of balance.
        residual_n: f64,
        /// How far it goes to and fro.
        moved_mm: f64,
        /// Where it is: the shifts that settling zeroes, by the names that messages give them.
        shifts_mm: Vec<(&'static str, f64)>,
    },
}

/// A femur that moves less in an iteration rests, though its forces do not balance, mm.
const AT_REST_MM: f64 = 0.1;
/// A femur that has come farther than this from where it started has slid off what it was to rest on, mm.
const SLID_OFF_MM: f64 = 20.0;

/// Shifts as a message tells them, such as `AP 1.00, ML 0.00, IS -0.20 mm`.
fn listed(shifts_mm: &[(&'static str, f64)]) -> String {
    let shift = |(symbol, at_mm): &(&str, f64)| format!("{symbol} {at_mm:.2}");
    let shifts: Vec<String> = shifts_mm.iter().map(shift).collect();
    format!("{} mm", shifts.join(", "))
}

impl PlacementError {
    /// A machine that does not come to rest.
    pub(super) fn not_settled(machine: &Machine, failed: &NotSettled) -> Self {
        let mechanism = machine.mechanism;
        let in_files = mechanism.in_files.into_iter();
        let zeroed = in_files.filter(|&index| mechanism.joint(index).is_zeroed);
        let shift = |index| (mechanism.joint(index).symbol, index.of(&failed.positions));
        let (residual_n, moved_mm) = (failed.residual_n, failed.moved_mm);
        let shifts_mm: Vec<(&str, f64)> = zeroed.map(shift).collect();
        let has_slid_off = shifts_mm.iter().any(|(_, at_mm)| at_mm.abs() > SLID_OFF_MM);
        if moved_mm < AT_REST_MM && !has_slid_off {
            return Self::Unsteady {
                residual_n,
                moved_mm,
                shifts_mm,
            };
        }
        Self::NotSettled {
            residual_n,
            shifts_mm,
        }
    }
}
