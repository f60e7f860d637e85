//! A whole case as an Abaqus input file, so that anyone with a licence can check condyle against it.
//!
//! Two bodies where condyle finds them settled, the machine in reference nodes and connectors, the
//! pressure law, and one gait cycle. Comments in the file explain each block. Or the bodies alone: a rigid femur
//! pressed on the deformable insert ([`Pressed`]), which CalculiX reads too.

mod bodies;
mod contact;
mod drives;
mod error;
mod export;
mod facets;
mod heading;
mod lift;
mod machine;
mod model;
mod names;
mod options;
mod output;
mod placing;
mod pressed;
mod pressed_case;
mod step_times;
mod steps;
#[cfg(test)]
mod tests;
mod waves;

pub use error::ExportError;
pub use export::write_abaqus;
pub use options::AbaqusOptions;
pub use pressed::{Pressed, Slide};
pub use pressed_case::PressedCase;
