//! Nodes and elements of an Abaqus input file, and that there is one body of them.

use super::super::error::MeshFileError;
use super::super::hex_draft::DraftHex;
use super::super::text;
use super::keyword::Keyword;
use super::reading::{Reading, fields};

impl Reading<'_> {
    pub(super) fn only_one(
        &self,
        keyword: &Keyword,
        what: &'static str,
        count: usize,
    ) -> Result<(), MeshFileError> {
        if count < 2 {
            return Ok(());
        }
        let at = self.at(keyword.line);
        Err(MeshFileError::SeveralBodies { at, what })
    }

    pub(super) fn instance(&mut self, keyword: &Keyword) -> Result<(), MeshFileError> {
        self.instances += 1;
        self.only_one(keyword, "instance", self.instances)?;
        for (line, row) in &keyword.data {
            for field in fields(row) {
                if text::number::<f64>(self.path, *line, field)? != 0.0 {
                    let what = "an instance that is moved or turned is not followed; \
                        move the part itself instead";
                    return Err(self.at(*line).error(what));
                }
            }
        }
        Ok(())
    }

    pub(super) fn nodes(&mut self, keyword: &Keyword) -> Result<(), MeshFileError> {
        if keyword
            .value("SYSTEM")
            .is_some_and(|system| !system.eq_ignore_ascii_case("R"))
        {
            let what = "only rectangular coordinates can be read; write the nodes with SYSTEM=R";
            return Err(self.at(keyword.line).error(what));
        }
        let mut labels = Vec::with_capacity(keyword.data.len());
        for &(line, row) in &keyword.data {
            let mut words = fields(row);
            let label = text::number(self.path, line, words.next().unwrap_or_default())?;
            let position = text::coordinates(self.path, line, &mut words)?;
            self.draft.node(Some(line), label, position)?;
            labels.push(label);
        }
        if let Some(set) = keyword.value("NSET") {
            self.add_to_node_set(set, &labels);
        }
        Ok(())
    }

    pub(super) fn elements(&mut self, keyword: &Keyword) -> Result<(), MeshFileError> {
        let kind = keyword
            .value("TYPE")
            .unwrap_or("(none given)")
            .to_ascii_uppercase();
        let mut labels = Vec::with_capacity(keyword.data.len());
        let mut numbers: Vec<u64> = Vec::with_capacity(9);
        let mut first_line = keyword.line;
        for &(line, row) in &keyword.data {
            if numbers.is_empty() {
                first_line = line;
            }
            for field in fields(row) {
                numbers.push(text::number(self.path, line, field)?);
            }
            if !is_hexahedron(&kind) {
                let at = self.at(line);
                let element = numbers.first().copied().unwrap_or_default();
                return Err(MeshFileError::NotHexahedron { at, element, kind });
            }
            if numbers.len() >= 9 {
                labels.push(self.element(first_line, &numbers)?);
                numbers.clear();
            }
        }
        if !numbers.is_empty() {
            return Err(self.wrong_corners(first_line, &numbers));
        }
        if let Some(set) = keyword.value("ELSET") {
            self.element_sets
                .entry(set.to_ascii_uppercase())
                .or_default()
                .extend(labels);
        }
        Ok(())
    }

    fn element(&mut self, line: usize, numbers: &[u64]) -> Result<u64, MeshFileError> {
        let label = numbers[0];
        let nodes =
            <[u64; 8]>::try_from(&numbers[1..]).map_err(|_| self.wrong_corners(line, numbers))?;
        self.draft.hex(DraftHex {
            label,
            line: Some(line),
            nodes,
        })?;
        Ok(label)
    }

    fn wrong_corners(&self, line: usize, numbers: &[u64]) -> MeshFileError {
        let nodes = numbers.len() - 1;
        let what = format!("element {} has {nodes} nodes; C3D8 has eight", numbers[0]);
        self.at(line).error(what)
    }
}

/// C3D8 with any suffix for its integration or formulation has the same eight nodes.
fn is_hexahedron(kind: &str) -> bool {
    kind.starts_with("C3D8")
}
