//! Why two bodies make no knee.

use thiserror::Error;

use crate::machine::{Machine, NotSettled};

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
