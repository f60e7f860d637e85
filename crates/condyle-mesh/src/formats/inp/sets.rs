//! Sets of nodes and elements of an Abaqus input file.

use std::collections::HashMap;

use super::super::error::MeshFileError;
use super::super::text;
use super::keyword::Keyword;
use super::reading::{Reading, fields, plain};

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
