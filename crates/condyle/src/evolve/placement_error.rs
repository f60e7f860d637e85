//! Why two bodies make no knee.

use thiserror::Error;

use crate::machine::{Freedom, NotSettled};

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
         AP {ap_mm:.2}, ML {ml_mm:.2}, IS {is_mm:.2} mm; check axes and start_mm"
    )]
    NotSettled {
        /// Force left out of balance.
        residual_n: f64,
        /// Where it got to.
        ap_mm: f64,
        /// Where it got to.
        ml_mm: f64,
        /// Where it got to.
        is_mm: f64,
    },
}

impl From<NotSettled> for PlacementError {
    fn from(failed: NotSettled) -> Self {
        let at = |freedom: Freedom| failed.positions[freedom as usize];
        Self::NotSettled {
            residual_n: failed.residual_n,
            ap_mm: at(Freedom::AnteroPosterior),
            ml_mm: at(Freedom::MedioLateral),
            is_mm: at(Freedom::InferoSuperior),
        }
    }
}
