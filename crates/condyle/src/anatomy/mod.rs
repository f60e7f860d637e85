//! Orientation and side of a femoral component and an insert, recognised from their shapes.
//!
//! Each of the 24 orientations is scored by signs that every design shows in the views of the
//! body's six sides: a femur is a box open above, with two condyles, the notch between them
//! behind and the trochlea in front; an insert has two dishes and an eminence on a flat backside, is
//! wider than long, cut out behind, and has the higher lip in front. A symmetric shape leaves orientations open.
//! [`Upright`] turns a body that does not lie along the axes, and [`Likeness`] tells other bodies from those of a knee.
//! The flanges of a femoral component's trochlea, where they differ, show the side.

mod likeness;
mod recognition;
mod sampled;
mod signs;
#[cfg(test)]
mod tests;
mod upright;
mod views;

pub use likeness::Likeness;
pub use recognition::{Recognition, Sureness, start_over_the_dishes_mm};
pub use signs::flange_lead_mm;
pub use upright::Upright;
pub use views::Orientation;
