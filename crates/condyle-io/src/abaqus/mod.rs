//! A whole case as an Abaqus input file, so that anyone with a licence can check condyle against it.
//!
//! Two bodies where condyle finds them settled, the machine in reference nodes and connectors, the
//! pressure law, and one gait cycle. Comments in the file explain each block.

mod bodies;
mod contact;
mod drives;
mod error;
mod femur;
mod heading;
mod machine;
mod model;
mod names;
mod output;
mod placing;
mod steps;
#[cfg(test)]
mod tests;
mod waves;

use std::io::Write;

use condyle::evolve::March;

use crate::case::{BuildWarning, Case};
use crate::mesh::InpWriter;

pub use error::ExportError;

use model::Model;

/// Which of the ways to write the model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AbaqusOptions {
    /// An elastic insert under hard contact, rather than a rigid one under the case's pressure law.
    pub deformable: bool,
    /// For Abaqus/Explicit rather than Abaqus/Standard.
    pub explicit: bool,
}

/// Writes `case` as one Abaqus input file in mm, N, s, tonne and MPa; `threads` share the work on
/// a mesh.
///
/// The model is that of the first cycle on the unworn insert: a right knee, a left one mirrored.
/// Returns what was put right in the meshes on the way.
///
/// # Errors
/// A case that does not build, bodies that do not settle, or a file that cannot be written.
pub fn write_abaqus(
    case: &Case,
    options: AbaqusOptions,
    threads: usize,
    out: &mut impl Write,
) -> Result<Vec<BuildWarning>, ExportError> {
    let built = case.build(threads)?;
    let march = March::start(built.test)?;
    let model = Model::new(case, &march, options)?;
    write(&model, &mut InpWriter::new(out)).map_err(|source| ExportError::Write { source })?;
    Ok(built.warnings)
}

fn write<W: Write>(model: &Model<'_>, inp: &mut InpWriter<W>) -> std::io::Result<()> {
    heading::write(model, inp)?;
    bodies::write(model, inp)?;
    machine::write(model, inp)?;
    contact::write(model, inp)?;
    waves::write(model, inp)?;
    steps::write(model, inp)
}
