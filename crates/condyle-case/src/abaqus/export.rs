//! A case from its test to the last line of the file.

use std::io::Write;

use condyle::evolve::March;

use super::error::ExportError;
use super::model::Model;
use super::options::AbaqusOptions;
use super::{bodies, contact, heading, machine, steps, waves};
use crate::case::{BuildWarning, Case, ContactModelWord};
use condyle_mesh::formats::InpWriter;

/// Writes `case` as one Abaqus input file in mm, N, s, tonne and MPa; `threads` share the work on
/// a mesh.
///
/// The model is that of the first cycle on the unworn insert: a right knee, a left one mirrored.
/// Returns what was put right in the meshes on the way.
///
/// # Errors
/// A deformable insert, a case that does not build, bodies that do not settle, or a file that cannot be written.
pub fn write_abaqus(
    case: &Case,
    options: AbaqusOptions,
    threads: usize,
    out: &mut impl Write,
) -> Result<Vec<BuildWarning>, ExportError> {
    if case.contact.model == ContactModelWord::Deformable {
        return Err(ExportError::Deformable);
    }
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
