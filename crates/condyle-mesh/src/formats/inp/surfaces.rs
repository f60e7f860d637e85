//! Element surfaces of an Abaqus input file.

use super::super::error::MeshFileError;
use super::super::hex_draft::DraftHex;
use super::keyword::Keyword;
use super::reading::{Reading, fields, plain};

impl Reading<'_> {
    pub(super) fn surface(&mut self, keyword: &Keyword) -> Result<(), MeshFileError> {
        if keyword
            .value("TYPE")
            .is_some_and(|kind| !kind.eq_ignore_ascii_case("ELEMENT"))
        {
            return Ok(());
        }
        let name = self.required(keyword, "NAME")?;
        for &(line, row) in &keyword.data {
            let mut words = fields(row);
            let set = words.next().unwrap_or_default();
            let elements = match self.element_sets.get(&plain(set)) {
                Some(elements) => elements.clone(),
                None => vec![self.label(line, set)?],
            };
            self.count_members(line, elements.len() as u64)?;
            let quads = match words.next() {
                Some(side) => self.side(line, &elements, side)?,
                None => self.free_faces(line, &elements)?,
            };
            for quad in quads {
                self.draft.quad(name, Some(line), quad);
            }
        }
        Ok(())
    }

    /// Face S1 to S6 of each element.
    fn side(
        &self,
        line: usize,
        elements: &[u64],
        side: &str,
    ) -> Result<Vec<[u64; 4]>, MeshFileError> {
        let face = ["S1", "S2", "S3", "S4", "S5", "S6"]
            .iter()
            .position(|name| name.eq_ignore_ascii_case(side))
            .ok_or_else(|| {
                self.at(line)
                    .error(format!("{side:?} is not a face S1 to S6"))
            })?;
        elements
            .iter()
            .map(|&label| Ok(self.hex(line, label)?.quads()[face]))
            .collect()
    }

    /// Without a face, a surface is all faces of its elements that lie on the outside.
    fn free_faces(&self, line: usize, elements: &[u64]) -> Result<Vec<[u64; 4]>, MeshFileError> {
        let hexes: Result<Vec<_>, _> = elements
            .iter()
            .map(|&label| self.hex(line, label))
            .collect();
        Ok(self.draft.free_quads(hexes?))
    }

    fn hex(&self, line: usize, label: u64) -> Result<&DraftHex, MeshFileError> {
        self.draft.labelled_hex(label).ok_or_else(|| {
            let what = format!("element {label} of this surface is not in the file");
            self.at(line).error(what)
        })
    }
}
