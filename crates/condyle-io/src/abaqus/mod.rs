//! A whole case as an Abaqus input file, so that anyone with a licence can check condyle against it.
//!
//! Two bodies where condyle finds them settled, the machine in reference nodes and connectors, the
//! pressure law, and one gait cycle. Comments in the file explain each block.

mod bodies;
mod contact;
mod drives;
mod error;
mod export;
mod heading;
mod machine;
mod model;
mod names;
mod options;
mod output;
mod placing;
mod step_times;
mod steps;
#[cfg(test)]
mod tests;
mod waves;

pub use error::ExportError;
pub use export::write_abaqus;
pub use options::AbaqusOptions;
