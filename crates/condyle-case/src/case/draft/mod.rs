//! A case drafted from two mesh files: unit, axes and start are concluded from the shapes.

mod body;
mod knee;

pub use knee::DraftError;

use self::body::{Alone, Concluded};
use self::knee::{ConcludedOrigin, ConcludedSide};
use super::build::Body;
use super::contents::Case;
use super::frame::{Axes, Side};
use super::machine::Preset;
use crate::config::quoted;
use condyle::anatomy::{Orientation, start_over_the_dishes_mm};
use condyle::geometry::{GenericInsertShape, TriangleMesh};
use condyle_mesh::repair::CheckedMesh;
use std::path::Path;

/// Input of a draft.
#[derive(Clone, Copy, Debug)]
pub struct Draft<'a> {
    /// The simulator.
    pub preset: Preset,
    /// The side of the knee; by default, that of the femur's shape.
    pub side: Option<Side>,
    /// Mesh of the femoral component.
    pub femur: &'a Path,
    /// Mesh of the insert, closed or an open articulating surface.
    pub insert: &'a Path,
}

/// A case drafted from meshes.
#[derive(Clone, Debug)]
pub struct Drafted {
    /// The case file, with the conclusions and their certainty as remarks.
    pub text: String,
    /// The conclusions, one per line.
    pub remarks: Vec<String>,
}

impl Draft<'_> {
    /// Returns the case, to be kept in `folder`.
    ///
    /// # Errors
    /// A file that cannot be read, does not form a shell, or does not have the size of a part of a knee.
    pub fn drafted(&self, folder: &Path) -> Result<Drafted, DraftError> {
        let femur = Concluded::from(Body::Femur, self.femur)?;
        let insert = Concluded::from(Body::Insert, self.insert)?;
        let femur_lies = femur.orientation(&insert.best());
        let insert_lies = insert.orientation(&[femur_lies]);
        let (femur_shell, whole) = (femur.shell(&femur_lies)?, insert.shell(&insert_lies)?);
        let mut alone = Alone::of(whole).map_err(|source| insert.refused(source))?;
        let origin = ConcludedOrigin::centred(&mut alone.shell.mesh);
        let of_insert = [origin.key, &thickness(&alone.shell), &alone.key()].concat();
        let bodies = [
            keys_of("femur", &femur, &femur_lies),
            keys_of("insert", &insert, &insert_lies) + &of_insert,
        ];
        let start_mm = self.start_mm(&femur_shell.mesh, &alone.shell.mesh);
        let side = ConcludedSide::of(&femur_shell.mesh, self.side);
        let keys = self.keys(side.side, &bodies, start_mm);
        let case = Case::parse(&keys, "draft", folder)?;
        let of_insert = [insert.remarks(&insert_lies, &alone.shell), alone.remarks()];
        let remarks = [
            with(femur.remarks(&femur_lies, &femur_shell), Some(side.remark)),
            with(of_insert.concat(), origin.remark),
        ];
        let text = case.as_draft_in(folder);
        Ok(Drafted {
            text: with_remarks(text, &remarks),
            remarks: remarks.concat(),
        })
    }

    fn keys(&self, side: Side, [femur, insert]: &[String; 2], (x, z): (f64, f64)) -> String {
        let (side, preset) = (side.word(), self.preset.word());
        format!(
            "title = \"Untitled\"\nside = \"{side}\"\n{femur}start_mm = [{x:.1}, {z:.1}]\n{insert}[machine]\npreset = \"{preset}\"\n"
        )
    }

    fn start_mm(&self, femur: &TriangleMesh, insert: &TriangleMesh) -> (f64, f64) {
        let machine = format!("[machine]\npreset = \"{}\"\n", self.preset.word());
        let case = Case::parse(&machine, "machine", Path::new(""));
        let flexion_rad = case.map_or(0.0, |case| case.start_flexion_rad());
        start_over_the_dishes_mm(femur, insert, flexion_rad).unwrap_or_default()
    }
}

fn keys_of(table: &str, body: &Concluded<'_>, lies: &Orientation) -> String {
    let file = quoted(&body.file.display().to_string());
    let [x, y, z] = Axes::of(&lies.rotation()).words();
    let unit = body.unit.word();
    format!(
        "[{table}]\nshape = \"mesh\"\nfile = {file}\nlength_unit = \"{unit}\"\naxes = [\"{x}\", \"{y}\", \"{z}\"]\n"
    )
}

fn with(mut remarks: Vec<String>, remark: Option<String>) -> Vec<String> {
    remarks.extend(remark);
    remarks
}

fn thickness(insert: &CheckedMesh) -> String {
    if insert.closed {
        return String::new();
    }
    let thickness_mm = GenericInsertShape::default().thickness_mm;
    format!("thickness_mm = {thickness_mm:?}\n")
}

fn with_remarks(text: String, [femur, insert]: &[Vec<String>; 2]) -> String {
    let above = |table: &str, remarks: &[String]| {
        let lines: String = remarks.iter().map(|line| format!("# {line}\n")).collect();
        (format!("\n[{table}]\n"), format!("\n{lines}[{table}]\n"))
    };
    [above("femur", femur), above("insert", insert)]
        .into_iter()
        .fold(text, |text, (table, remarked)| {
            text.replacen(&table, &remarked, 1)
        })
}
