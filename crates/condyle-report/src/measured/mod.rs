//! Pictures of a run against what was measured, from numbers that somebody else compared.

mod kinematics;
mod surface;
mod wear;

pub use kinematics::{ComparedCurve, compared_kinematics_svg};
pub use surface::compared_surface_svg;
pub use wear::{ComparedWear, compared_wear_svg};
