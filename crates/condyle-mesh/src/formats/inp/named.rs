//! Named sets, surfaces and bodies of an Abaqus file.

use std::collections::HashMap;

use super::{Keyword, Reading, fields, plain};
use crate::formats::{error::MeshFileError, hex_draft::DraftHex, text};

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

impl Reading<'_> {
    pub(super) fn node_set(&mut self, keyword: &Keyword) -> Result<(), MeshFileError> {
        let name = self.required(keyword, "NSET")?;
        let mut nodes = self.members(keyword, &self.node_sets)?;
        if let Some(elements) = keyword.value("ELSET") {
            let labels = self
                .element_sets
                .get(&plain(elements))
                .map_or(&[][..], Vec::as_slice);
            self.count_members(keyword.line, 8 * labels.len() as u64)?;
            let hexes = labels
                .iter()
                .filter_map(|&label| self.draft.labelled_hex(label));
            nodes.extend(hexes.flat_map(|hex| hex.nodes));
        }
        self.add_to_node_set(name, &nodes);
        Ok(())
    }

    pub(super) fn add_to_node_set(&mut self, name: &str, nodes: &[u64]) {
        self.draft.set_nodes(name, nodes.iter().copied());
        self.node_sets
            .entry(name.to_ascii_uppercase())
            .or_default()
            .extend(nodes);
    }

    pub(super) fn element_set(&mut self, keyword: &Keyword) -> Result<(), MeshFileError> {
        let name = self.required(keyword, "ELSET")?.to_ascii_uppercase();
        let members = self.members(keyword, &self.element_sets)?;
        self.element_sets.entry(name).or_default().extend(members);
        Ok(())
    }

    /// Members of a set: numbers, names of earlier sets, or with GENERATE first, last, step.
    fn members(
        &self,
        keyword: &Keyword,
        sets: &HashMap<String, Vec<u64>>,
    ) -> Result<Vec<u64>, MeshFileError> {
        let generate = keyword.value("GENERATE").is_some();
        let mut members = Vec::new();
        for &(line, row) in &keyword.data {
            if generate {
                members.extend(self.range(line, row)?);
                continue;
            }
            for field in fields(row) {
                match sets.get(&plain(field)) {
                    Some(set) => {
                        self.count_members(line, set.len() as u64)?;
                        members.extend(set);
                    }
                    None => members.push(self.label(line, field)?),
                }
            }
        }
        Ok(members)
    }

    fn range(
        &self,
        line: usize,
        row: &str,
    ) -> Result<impl Iterator<Item = u64> + use<>, MeshFileError> {
        let numbers: Result<Vec<u64>, _> = fields(row)
            .map(|field| text::number(self.path, line, field))
            .collect();
        let (first, last, step) = match numbers?[..] {
            [first, last] if first <= last => (first, last, 1),
            [first, last, step] if first <= last && step > 0 => (first, last, step),
            _ => {
                let what = "GENERATE takes first, last and a step above 0, with first up to last";
                return Err(self.at(line).error(what));
            }
        };
        self.count_members(line, ((last - first) / step).saturating_add(1))?;
        let step = usize::try_from(step).unwrap_or(usize::MAX);
        Ok((first..=last).step_by(step))
    }
}

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
