//! Which way up, and which way round, a femoral component and an insert lie: told from their shapes.
//!
//! Each of the 24 orientations is scored by signs that anatomy gives to every design, seen from the
//! body's six sides: of a femur the box that is open above, two condyles with the notch between them
//! behind and the trochlea in front; of an insert two dishes beside an eminence on a flat backside,
//! wider than long, cut out behind, with the higher lip in front. What is symmetric is not told.
//! Which knee a femoral component is of is shown by the flanges of its trochlea, where they differ.

mod femur;
mod flange;
mod insert;
mod numbers;
mod orientation;
mod recognition;
mod start;
mod views;

pub use flange::flange_lead_mm;
pub use orientation::Orientation;
pub use recognition::{Recognition, Sureness};
pub use start::start_over_the_dishes_mm;
#[cfg(test)]
mod tests;
