//! Contact at a pose as an input file of CalculiX and Abaqus: a rigid femur pressed on the deformable insert.

mod facets;
mod pressed;
mod pressed_case;
#[cfg(test)]
mod tests;

pub use pressed::{Pressed, Slide};
pub use pressed_case::{ExportError, PressedCase};
